#include "fuzz/check_document.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>

#include "compile/compile.h"
#include "draw/draw.h"
#include "fuzz/wobble.h"
#include "oracle/render.h"
#include "support.h"

namespace shaderx::fuzz {

using image::Image;

namespace {

constexpr int kSize = 16, kSamples = 4, kManySamples = 1024;  // of a picture, and of the environment
constexpr int kRuns = 6, kMoreRuns = 60;                      // with random rounding
constexpr double kSpread = 0.02, kTolerance = 2e-5, kSampled = 1e-3, kNoise = 0.05;
// Drivers filter with weights of few bits: the OpenGL specification, 4.6, section 8.14, leaves the number to them.
constexpr double kFiltered = 5e-4;

// Small pictures of noise: colours, a grey one, and one with a coverage.
std::vector<std::string> writePictures(const std::string& folder) {
    std::vector<std::string> names;
    std::uint32_t state = 1;
    for (int channels : {3, 1, 4}) {
        Image picture = Image::ofBytes(channels == 1 ? 4 : 8, 8, channels);
        for (std::uint8_t& b : picture.bytes)
            b = static_cast<std::uint8_t>((state = state * 1664525u + 1013904223u) >> 24);
        names.push_back(fmt::format("noise{}.png", channels));
        Diagnostics ignored;
        image::writePng(folder + "/" + names.back(), picture, ignored);
    }
    return names;
}

// What the reference compiler of the language says against a pair of shaders; empty if nothing.
std::string complaint(const Shader& shader) {
    glslang::TShader vertex(EShLangVertex), pixel(EShLangFragment);
    glslang::TProgram program;
    const auto parse = [&](glslang::TShader& s, const std::string& text) {
        const char* start = text.c_str();
        s.setStrings(&start, 1);
        const bool ok = s.parse(GetDefaultResources(), 100, false, EShMsgDefault);
        program.addShader(&s);
        return ok ? std::string() : std::string(s.getInfoLog()) + "\n" + text;
    };
    std::string found = parse(vertex, shader.vertex) + parse(pixel, shader.pixel);
    if (found.empty() && !program.link(EShMsgDefault)) found = program.getInfoLog();
    return found;
}

struct Bounds {
    float low = 0, high = 0;
    bool isFinite = true;

    double size() const { return std::max({1.0, std::fabs(double(low)), std::fabs(double(high))}); }
    bool says() const { return isFinite && double(high) - low <= kSpread * size(); }
    bool holds(float v, double tolerance = kTolerance) const {
        const double slack = double(high) - low + tolerance * size();
        return v >= low - slack && v <= high + slack;
    }
};

// One interface of an element, compiled, and what its pictures may look like.
struct Candidate {
    Shader shader;
    scene::Settings settings = {};
    std::optional<Wobbly> wobbly = {};
    std::vector<Bounds> bounds = {};
    int runs = 0;
};

}  // namespace

struct DocumentChecker::State {
    tests::OwnFolder folder = {};
    std::vector<std::string> pictures = writePictures(folder.path().string());
    std::unique_ptr<draw::Context> driver = {};
    oracle::Studio studio = {};

    State() {
        glslang::InitializeProcess();
        // Mesa's software driver: compile fast, and let each pixel have its own level of detail, as the language has
        // it.
        ::setenv("GALLIVM_PERF", "nopt,no_quad_lod", 0);
        ::setenv("LP_NUM_THREADS", "1", 0);
        ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
        Diagnostics loading;
        driver = draw::Context::create(loading);
    }
    ~State() { glslang::FinalizeProcess(); }

    scene::Settings settingsOf(const Shader& shader) const {
        scene::Settings s;
        s.size = kSize;
        s.samples = kSamples;
        for (const TextureBinding& t : shader.textures) {
            scene::Texture texture{
                t.uniform, t.file.empty() ? "" : folder / t.file, t.uAddress, t.vAddress, t.filter, {}, t.path};
            for (std::size_t i = 0; i < t.defaultColor.size() && i < 4; i++)
                texture.defaultColor[i] = t.defaultColor[i];
            s.textures.push_back(texture);
        }
        return s;
    }

    Result<Image> interpret(const Candidate& c, const ir::Module& module, Diagnostics& diagnostics) {
        oracle::RenderJob job{c.settings, &module, &c.shader.program->interface, 1};
        return studio.render(job, diagnostics);
    }

    // Runs with random rounding until there are so many.
    std::string widen(Candidate& c, int runs) {
        if (!c.wobbly) c.wobbly.emplace(c.shader.program->module);
        for (; c.runs < runs; c.runs++) {
            Diagnostics diagnostics;
            c.wobbly->shake(static_cast<std::uint32_t>(c.runs));
            const Result<Image> picture = interpret(c, c.wobbly->module(), diagnostics);
            if (!picture) return "the interpreter refuses it\n" + diagnostics.text();
            const bool first = c.bounds.empty();
            c.bounds.resize(picture->floats.size());
            for (std::size_t i = 0; i < c.bounds.size(); i++) {
                const float v = picture->floats[i];
                Bounds& b = c.bounds[i];
                b.low = first ? v : std::min(b.low, v);
                b.high = first ? v : std::max(b.high, v);
                b.isFinite = b.isFinite && std::isfinite(v);
            }
        }
        return {};
    }

    static std::string at(std::size_t i) {
        const std::size_t pixel = i / 4, side = static_cast<std::size_t>(kSize);
        return fmt::format("pixel ({}, {}), component {}", pixel % side, pixel / side, i % 4);
    }

    // Whether reflections are estimated with a few samples of the environment.
    static bool samples(const Candidate& c) {
        const auto& contexts = c.shader.program->interface.pixelUniforms.contexts;
        return std::count(contexts.begin(), contexts.end(), ir::Context::EnvironmentRadiance) > 0;
    }

    std::string compareWithDriver(Candidate& c, Verdict& verdict) {
        if (!driver) return {};
        Diagnostics diagnostics;
        const Result<Image> drawn = driver->render(draw::Job{c.settings, c.shader.vertex, c.shader.pixel}, diagnostics);
        if (!drawn) return "the driver refuses it\n" + diagnostics.text() + c.shader.pixel;
        const double tolerance = samples(c) ? kSampled : c.shader.textures.empty() ? kTolerance : kFiltered;
        for (std::size_t i = 0; i < c.bounds.size(); i++) {
            const float v = drawn->floats[i];
            if (c.bounds[i].says() && !c.bounds[i].holds(v, tolerance))
                if (std::string e = widen(c, kMoreRuns); !e.empty()) return e;
            const Bounds& b = c.bounds[i];
            if (!b.says()) {
                verdict.excused++;
                continue;
            }
            verdict.compared++;
            if (!b.holds(v, tolerance))
                return fmt::format("{}: the driver has {:.9g}, the interpreter {:.9g} to {:.9g}; the pixel is {}\n{}",
                                   at(i), v, b.low, b.high, fmt::join(std::span(&drawn->floats[i / 4 * 4], 4), ", "),
                                   c.shader.pixel);
        }
        return {};
    }

    // Whether many samples bring two forms together.
    bool agreeInTheLimit(Candidate& a, Candidate& b, std::size_t i) {
        float found[2] = {};
        for (Candidate* c : {&a, &b}) {
            Diagnostics diagnostics;
            c->settings.samples = kManySamples;
            const Result<Image> picture = interpret(*c, c->shader.program->module, diagnostics);
            c->settings.samples = kSamples;
            if (!picture) return false;
            found[c == &b] = picture->floats[i];
        }
        return std::fabs(found[0] - found[1]) <= kNoise * std::max(1.0f, std::fabs(found[0]));
    }

    std::string compareInterfaces(Candidate& a, Candidate& b) {
        // Which samples these are may differ in a form made for known parameters.
        const double tolerance = samples(a) || samples(b) ? kNoise : kTolerance;
        const auto differ = [&](std::size_t i) {
            const Bounds &x = a.bounds[i], &y = b.bounds[i];
            return x.says() && y.says() && !x.holds(y.low, tolerance) && !x.holds(y.high, tolerance) &&
                   !y.holds(x.low, tolerance) && !y.holds(x.high, tolerance);
        };
        for (std::size_t i = 0; i < a.bounds.size(); i++) {
            if (!differ(i)) continue;
            for (Candidate* c : {&a, &b})
                if (std::string e = widen(*c, kMoreRuns); !e.empty()) return e;
            if (!differ(i) || (tolerance == kNoise && agreeInTheLimit(a, b, i))) continue;
            return fmt::format("{}: live gives {:.9g} to {:.9g}, another interface {:.9g} to {:.9g}\n{}{}", at(i),
                               a.bounds[i].low, a.bounds[i].high, b.bounds[i].low, b.bounds[i].high, a.shader.pixel,
                               b.shader.pixel);
        }
        return {};
    }

    std::string checkElement(Compiler& compiler, const doc::Document& document, doc::ElementId element, Interface drawn,
                             Verdict& verdict) {
        std::vector<Candidate> candidates;
        std::size_t drawnAt = 0;
        for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete}) {
            Diagnostics diagnostics;
            GenerateOptions options;
            options.interface = interface;
            Result<Shader> shader = compiler.generate(document, element, options, diagnostics);
            if (!shader) return "does not generate\n" + diagnostics.text();
            if (std::string e = complaint(*shader); !e.empty()) return "the reference compiler refuses it\n" + e;
            if (interface == Interface::Complete && drawn != interface) continue;  // long programs, slow to run
            if (interface == drawn) drawnAt = candidates.size();
            candidates.push_back({*shader});
            candidates.back().settings = settingsOf(*shader);
            if (std::string e = widen(candidates.back(), kRuns); !e.empty()) return e;
        }
        for (std::size_t i = 1; i < candidates.size(); i++)
            if (std::string e = compareInterfaces(candidates[0], candidates[i]); !e.empty()) return e;
        return compareWithDriver(candidates[drawnAt], verdict);
    }
};

DocumentChecker::DocumentChecker() : state_(std::make_unique<State>()) {}
DocumentChecker::~DocumentChecker() = default;
bool DocumentChecker::hasDriver() const { return state_->driver != nullptr; }
const std::vector<std::string>& DocumentChecker::pictures() const { return state_->pictures; }

Verdict DocumentChecker::check(const std::string& text, Interface drawn) {
    Verdict verdict;
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    const auto document = compiler.read("random.mtlx", text, none, diagnostics);
    if (!document || !compiler.validate(*document, diagnostics)) {
        verdict.failure = "not valid\n" + diagnostics.text();
        return verdict;
    }
    for (doc::ElementId element : compiler.renderableElements(*document)) {
        verdict.failure = state_->checkElement(compiler, *document, element, drawn, verdict);
        if (verdict.failure.empty()) continue;
        verdict.failure = document->path(element) + ": " + verdict.failure;
        break;
    }
    return verdict;
}

}  // namespace shaderx::fuzz
