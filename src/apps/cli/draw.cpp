// The command that draws a material.
#include <algorithm>
#include <bit>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "apps/cli/progress.h"
#include "apps/cli/session.h"
#include "draw/loader.h"
#include "oracle/loader.h"

namespace shaderx::cli {

// A file of a document: as it is, beside the document, or below a search path.
static std::string resolved(const Options& options, const std::string& document, const std::string& file) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (file.empty() || fs::path(file).is_absolute()) return file;
    // A set of tiles is no file, which has been said: the default colour is drawn.
    if (file.find("<UDIM>") != std::string::npos || file.find("<UVTILE>") != std::string::npos) return {};
    fs::path beside = fs::path(document).parent_path() / file;
    if (fs::exists(beside, ignored)) return beside.string();
    for (const std::string& path : options.paths)
        if (fs::exists(fs::path(path) / file, ignored)) return (fs::path(path) / file).string();
    return beside.string();
}

// A value by its bits, as numbers of any kind are set.
static std::vector<float> numbersOf(ir::Type type, std::span<const std::uint32_t> words) {
    std::vector<float> numbers;
    for (std::uint32_t w : words)
        numbers.push_back(ir::info(type).scalar == ir::Scalar::Float ? std::bit_cast<float>(w)
                                                                     : static_cast<float>(static_cast<int>(w)));
    return numbers;
}

static Result<Shader> shaderOf(Session& s, const std::string& file, const doc::Document& document,
                               doc::ElementId element) {
    Diagnostics diagnostics;
    Result<Shader> shader = s.compiler.generate(document, element, s.how(), diagnostics);
    s.reportElement(file, document, element, diagnostics);
    return shader;
}

// The space that the shader works in, where pictures and light have to be taken from it and to it.
static std::optional<scene::WorkingSpace> workingSpace(const Compiler& compiler, const std::string& name) {
    const std::optional<doc::ColorSpace> space = compiler.colorSpace(name), display = compiler.colorSpace("lin_rec709");
    if (!space || !display || space->isData) return {};
    const doc::Matrix3 to = doc::matrixBetween(*space, *display), from = doc::matrixBetween(*display, *space);
    if (doc::isIdentity(to) && doc::isSameCurve(*space, *display)) return {};
    scene::WorkingSpace working;
    std::copy(to.begin(), to.end(), working.toRec709.begin());
    std::copy(from.begin(), from.end(), working.fromRec709.begin());
    if (space->curve == doc::ColorSpace::Curve::Srgb) working.curve = scene::WorkingSpace::Curve::Srgb;
    if (space->curve == doc::ColorSpace::Curve::Gamma) working.curve = scene::WorkingSpace::Curve::Gamma;
    working.gamma = static_cast<float>(space->gamma);
    return working;
}

static scene::Settings settingsOf(const Options& options, const Session& s, const std::string& file,
                                  const doc::Document& document, const Shader& shader) {
    scene::Settings settings;
    settings.size = options.size;
    settings.samples = options.samples;
    settings.environment = options.environment;
    settings.exposure = options.exposure;
    settings.output = options.picture;
    settings.working = workingSpace(s.compiler, options.colorspace);
    for (const UniformBinding& u : shader.uniforms)
        if (u.block >= 0) settings.defaults.push_back({u.name, numbersOf(u.type, u.value)});
    for (const VertexInputBinding& in : shader.inputs)
        if (!in.value.empty()) settings.attributes.push_back({in.name, numbersOf(in.type, in.value)});
    for (const TextureBinding& t : shader.textures) {
        scene::Texture texture{
            t.uniform, resolved(options, file, t.file), t.uAddress, t.vAddress, t.filter, {0, 0, 0, 0}, t.path};
        if (doc::ElementId input = document.find(t.path))
            texture.where = document.locate(input, document.known().value);
        std::size_t n = t.defaultColor.size();
        for (std::size_t i = 0; i < 4; i++)
            texture.defaultColor[i] = n == 1 ? t.defaultColor[0] : i < n ? t.defaultColor[i] : i == 3 ? 1.0f : 0.0f;
        settings.textures.push_back(std::move(texture));
    }
    return settings;
}

// A picture shows one element.
static void tellOthers(Session& s, const doc::Document& document, const std::vector<doc::ElementId>& elements) {
    constexpr std::size_t kNamed = 4;
    Diagnostics diagnostics;
    Diagnostic& n = diagnostics.note("first-of-several", fmt::format("'{}' is drawn, the first of {} elements",
                                                                     document.path(elements[0]), elements.size()));
    n.where = document.locate(elements[0]);
    n.path = document.path(elements[0]);
    std::string others;
    for (std::size_t i = 1; i < std::min(elements.size(), kNamed + 1); i++)
        others += (i > 1 ? ", " : "") + document.path(elements[i]);
    n.hint = "--element draws another: " + others + (elements.size() > kNamed + 1 ? ", …" : "");
    s.report(diagnostics);
}

int draw(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    const std::string& file = options.files[0];
    std::unique_ptr<doc::Document> document = s.read(file);
    if (!document) return s.exitCode();
    std::vector<doc::ElementId> elements = s.elements(*document);
    if (elements.empty()) return s.exitCode();
    if (elements.size() > 1) tellOthers(s, *document, elements);
    Result<Shader> shader = shaderOf(s, file, *document, elements[0]);
    if (!shader || !options.dump.empty()) return s.exitCode();

    scene::Settings settings = settingsOf(options, s, file, *document, *shader);
    Diagnostics diagnostics;
    if (options.with == "interpreter") {
        Progress progress(options.progress);
        oracle::RenderJob job{std::move(settings), &shader->program->module, &shader->program->interface};
        job.threads = options.jobs < 0 ? 0 : options.jobs;
        job.progress = [&](std::size_t done, std::size_t all) { progress.at(done, all); };
        oracle::drawWithModule(job, diagnostics);
    } else {
        draw::Job job{std::move(settings), shader->vertex, shader->pixel};
        draw::drawWithModule(job, diagnostics);
    }
    s.report(diagnostics);
    return s.exitCode();
}

}  // namespace shaderx::cli
