#include "oracle/render.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "ir/interpret_wide.h"
#include "oracle/raster.h"
#include "oracle/texture.h"
#include "oracle/threads.h"
#include "scene/picture.h"
#include "scene/sky.h"
#include "scene/sphere.h"

namespace shaderx::oracle {

using image::Image;
using ir::Context;
using ir::ContextSource;
using ir::kLanes;
using ir::LaneMask;
using ir::LaneWords;
using ir::Type;
using ir::Value;

namespace {

constexpr int kMaxSide = 16384;

// What all lanes of all runs see alike.
struct World {
    std::map<Context, Value> contexts;
    std::map<Name, Value> uniforms;  // that the job sets
    std::map<Context, std::shared_ptr<const Texture>> maps;
    std::map<Name, std::shared_ptr<const Texture>> textures;

    const Texture* texture(const ir::TextureRef& ref) const {
        if (ref.kind == ir::TextureRef::Kind::Context) {
            const auto found = maps.find(ref.context);
            return found == maps.end() ? nullptr : found->second.get();
        }
        if (ref.kind != ir::TextureRef::Kind::Uniform) return nullptr;
        const auto found = textures.find(ref.uniform);
        return found == textures.end() ? nullptr : found->second.get();
    }
};

// What is the same in both stages: the host's values and the textures.
struct StageEnvironment : ir::WideEnvironment {
    const World& world;
    explicit StageEnvironment(const World& w) : world(w) {}

    bool context(Context c, Value& v) override {
        const auto found = world.contexts.find(c);
        if (found == world.contexts.end()) return false;
        std::copy(std::begin(found->second.words), std::end(found->second.words), v.words);
        return true;
    }
    bool uniform(Name name, Value& v) override {
        const auto found = world.uniforms.find(name);
        if (found == world.uniforms.end()) return false;
        v = found->second;
        return true;
    }
    bool texture(const ir::WideTextureRead& read, std::span<LaneWords> channels) override {
        const Texture* texture = world.texture(read.texture);
        for (LaneMask left = read.lanes; left; left &= left - 1) {
            const std::size_t lane = static_cast<std::size_t>(std::countr_zero(left));
            Colour colour{};
            if (texture) colour = texture->at(read.uv[0].f(lane), read.uv[1].f(lane), levelAt(*texture, read, lane));
            for (std::size_t c = 0; c < channels.size(); c++) channels[c].set(lane, colour[c]);
        }
        return true;
    }
    bool textureSize(const ir::TextureRef& ref, Value& v) override {
        const Texture* texture = world.texture(ref);
        v.set(0, texture ? static_cast<float>(texture->width()) : 1);
        v.set(1, texture ? static_cast<float>(texture->height()) : 1);
        return true;
    }

    // A quad has one level of detail, that of its first pixel.
    static float levelAt(const Texture& texture, const ir::WideTextureRead& read, std::size_t lane) {
        if (!read.hasGradients) return read.level->f(lane);
        const std::size_t first = lane & ~std::size_t{3};
        const float ddx[2] = {read.ddx[0].f(first), read.ddx[1].f(first)};
        const float ddy[2] = {read.ddy[0].f(first), read.ddy[1].f(first)};
        return texture.levelOf(ddx, ddy);
    }
};

// ---- The vertex stage ----

struct VertexEnvironment final : StageEnvironment {
    const ir::Module& module;
    const scene::Mesh& mesh;
    const std::vector<scene::UniformValue>& usual;  // of attributes that the mesh lacks
    std::size_t first = 0;                          // vertex of lane 0

    VertexEnvironment(const World& w, const ir::Module& m, const scene::Mesh& sphere, const scene::Settings& settings)
        : StageEnvironment(w), module(m), mesh(sphere), usual(settings.attributes) {}

    const std::vector<float>* usualOf(std::string_view host) const {
        for (const scene::UniformValue& v : usual)
            if (v.name == host) return &v.values;
        return nullptr;
    }
    bool isKnown(std::string_view host) const {
        return scene::meshArrayOf(host) != scene::MeshArray::None || usualOf(host);
    }
    // As OpenGL fills up attributes: with (0, 0, 0, 1). What the mesh lacks is what it usually is, or reads as that.
    bool fill(std::string_view host, std::span<LaneWords> words) const {
        const scene::MeshArray array = scene::meshArrayOf(host);
        const bool isOfMesh = array != scene::MeshArray::None;
        const std::vector<float>* values = isOfMesh ? &scene::valuesOf(mesh, array) : usualOf(host);
        const std::size_t stride =
            isOfMesh ? static_cast<std::size_t>(scene::kMeshComponents[static_cast<int>(array)]) : 0;
        const std::size_t components = isOfMesh ? stride : values ? values->size() : 0;
        for (std::size_t c = 0; c < words.size(); c++)
            for (std::size_t lane = 0; lane < kLanes; lane++) {
                const std::size_t at = (first + lane) * stride + c;
                const float otherwise = c == 3 ? 1.0f : 0.0f;
                words[c].set(lane, c < components && at < values->size() ? (*values)[at] : otherwise);
            }
        return true;
    }
    bool varying(Context c, Type, std::span<LaneWords> words) override { return fill(ir::info(c).host, words); }
    bool attribute(Name name, Type, std::span<LaneWords> words) override {
        return fill(passes::inputName(module.names->text(name)), words);
    }
};

// Results of the vertex stage: positions, and for each varying its components one after the other.
struct Vertices {
    std::vector<Position> positions;
    struct Array {
        std::size_t components = 0;
        std::vector<float> values;
    };
    std::vector<Array> varyings;
};

bool runVertices(const RenderJob& job, const World& world, const scene::Mesh& mesh, Vertices& out,
                 Diagnostics& diagnostics) {
    const ir::Function* f = job.module->findOwn(job.interface->vertex);
    const Result<ir::WideProgram> program = ir::WideProgram::prepare(*job.module, *f, diagnostics);
    if (!program) return false;
    ir::WideInterpreter interpreter(*program);
    VertexEnvironment environment(world, *job.module, mesh, job);
    for (const passes::VertexInput& input : job.interface->inputs) {
        const std::string_view name = job.module->names->text(input.name);
        if (!environment.isKnown(name))
            diagnostics.warning("unbound-attribute",
                                fmt::format("the sphere has no attribute '{}': it reads as 0", name));
    }
    std::size_t words = 0;
    for (const ir::ResultValue& r : f->results) words += static_cast<std::size_t>(ir::componentCount(r.type));
    const std::size_t count = mesh.positions.size() / 3;
    out.positions.resize(count);
    for (std::size_t k = 1; k < f->results.size(); k++) {
        const std::size_t n = static_cast<std::size_t>(ir::componentCount(f->results[k].type));
        out.varyings.push_back({n, std::vector<float>(n * count)});
    }
    std::vector<LaneWords> results(words);
    for (std::size_t first = 0; first < count; first += kLanes) {
        environment.first = first;
        if (!interpreter.run(~LaneMask{0}, {}, results, environment, diagnostics)) return false;
        for (std::size_t lane = 0; lane < kLanes && first + lane < count; lane++) {
            for (std::size_t c = 0; c < 4; c++) out.positions[first + lane][c] = results[c].f(lane);
            std::size_t at = 4;
            for (Vertices::Array& a : out.varyings)
                for (std::size_t c = 0; c < a.components; c++)
                    a.values[(first + lane) * a.components + c] = results[at++].f(lane);
        }
    }
    return true;
}

// ---- The pixel stage ----

// A pixel that is shaded, where the picture shows it or because its quad needs it.
struct Fragment {
    std::uint32_t triangle = 0;
    int x = 0, y = 0;
    bool shown = false;
};

struct PixelEnvironment final : StageEnvironment {
    const RenderJob& job;
    const scene::Mesh& mesh;
    const Vertices& vertices;
    std::array<const unsigned*, kLanes> corners = {};  // by lane: the triangle's
    std::array<std::array<float, 3>, kLanes> weights = {};

    PixelEnvironment(const World& w, const RenderJob& j, const scene::Mesh& m, const Vertices& v)
        : StageEnvironment(w), job(j), mesh(m), vertices(v) {}

    void place(std::span<const Fragment> fragments, int side) {
        for (std::size_t lane = 0; lane < kLanes; lane++) {
            const Fragment& f = fragments[std::min(lane, fragments.size() - 1)];
            corners[lane] = &mesh.triangles[f.triangle * std::size_t{3}];
            const unsigned* c = corners[lane];
            weights[lane] = Weights(vertices.positions[c[0]], vertices.positions[c[1]], vertices.positions[c[2]], side)
                                .at(f.x, f.y);
        }
    }
    bool interpolate(Name name, std::span<LaneWords> words) const {
        const auto& varyings = job.interface->varyings;
        std::size_t k = 0;
        while (k < varyings.size() && varyings[k].name != name) k++;
        if (k == varyings.size() || vertices.varyings[k].components != words.size()) return false;
        const Vertices::Array& a = vertices.varyings[k];
        for (std::size_t c = 0; c < words.size(); c++)
            for (std::size_t lane = 0; lane < kLanes; lane++) {
                float sum = 0;
                for (std::size_t i = 0; i < 3; i++)
                    sum += weights[lane][i] * a.values[corners[lane][i] * a.components + c];
                words[c].set(lane, sum);
            }
        return true;
    }
    bool varying(Context c, Type, std::span<LaneWords> words) override {
        return interpolate(job.module->names->find(ir::info(c).host), words);
    }
    bool attribute(Name name, Type, std::span<LaneWords> words) override { return interpolate(name, words); }
};

std::vector<Fragment> fragmentsOf(std::span<const Quad> quads, bool whole) {
    std::vector<Fragment> out;
    for (const Quad& q : quads)
        for (int i = 0; i < 4; i++) {
            const bool shown = (q.covered >> i & 1) != 0;
            if (shown || whole) out.push_back({q.triangle, q.x + (i & 1), q.y + (i >> 1), shown});
        }
    return out;
}

// All fragments, 64 at a time, by as many threads as asked for. Each batch writes pixels of its own.
struct PixelStage {
    const RenderJob& job;
    const World& world;
    const scene::Mesh& mesh;
    const Vertices& vertices;
    const ir::WideProgram& program;
    std::vector<Fragment> fragments;
    int side;
    Image& out;

    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};

    std::size_t batches() const { return (fragments.size() + kLanes - 1) / kLanes; }

    bool shade(std::size_t batch, ir::WideInterpreter& interpreter, PixelEnvironment& environment,
               Diagnostics& diagnostics) const {
        const std::size_t first = batch * kLanes, n = std::min(kLanes, fragments.size() - first);
        const std::span<const Fragment> some(&fragments[first], n);
        environment.place(some, side);
        std::array<LaneWords, 5> results;  // a colour, and whether it is discarded
        const bool discards = job.module->findOwn(job.interface->pixel)->results.size() > 1;
        const LaneMask mask = n == kLanes ? ~LaneMask{0} : (LaneMask{1} << n) - 1;
        const std::span<LaneWords> used(results.data(), discards ? 5 : 4);
        if (!interpreter.run(mask, {}, used, environment, diagnostics)) return false;
        for (std::size_t lane = 0; lane < n; lane++) {
            if (!some[lane].shown || (discards && results[4].lane[lane])) continue;
            float* pixel = &out.floats[out.index(some[lane].x, side - 1 - some[lane].y, 0)];
            for (std::size_t c = 0; c < 4; c++) pixel[c] = results[c].f(lane);
        }
        return true;
    }

    void work(Diagnostics& diagnostics, bool tells) {
        ir::WideInterpreter interpreter(program, {.maxSteps = std::uint64_t{1} << 40});
        PixelEnvironment environment(world, job, mesh, vertices);
        while (!failed) {
            const std::size_t batch = next++;
            if (tells && job.progress) job.progress(std::min(batch, batches()), batches());
            if (batch >= batches()) return;
            if (!shade(batch, interpreter, environment, diagnostics)) failed = true;
        }
    }

    bool run(Diagnostics& diagnostics) {
        const std::size_t count = threadCount(job.threads, batches());
        std::vector<Diagnostics> found(count);
        runThreads(count, [&](std::size_t i) { work(found[i], i == 0); });
        for (const Diagnostics& d : found) {
            if (!d.hasErrors()) continue;
            for (const Diagnostic& one : d.all()) diagnostics.add(one.severity, one.code, one.message) = one;
            break;
        }
        return !failed;
    }
};

// ---- The host's side ----

// The environment as textures.
struct Sky {
    std::shared_ptr<const Texture> radiance, irradiance;

    explicit Sky(const scene::Environment& e)
        : radiance(std::make_shared<const Texture>(e.radiance, true, Sampling{})),
          irradiance(std::make_shared<const Texture>(e.irradiance, false, Sampling{})) {}
};

struct Host {
    const RenderJob& job;
    const scene::Mesh& mesh;
    std::optional<Sky>& builtIn;  // filled by the first who needs it
    Diagnostics& diagnostics;
    World world = {};
    // A file that textures are made of.
    struct Picture {
        std::shared_ptr<const Image> image = nullptr;  // none: cannot be read
        Diagnostics reading = {};
        bool isTold = false;
    };
    std::map<std::string, Picture> pictures = {};

    static Value valueOf(Type type, std::span<const float> values) {
        Value v;
        v.type = type;
        for (std::size_t i = 0; i < values.size(); i++) {
            const float rounded = std::round(std::clamp(values[i], -2147483520.f, 2147483520.f));
            if (ir::info(type).scalar == ir::Scalar::Float)
                v.set(static_cast<int>(i), values[i]);
            else
                v.words[i] = std::isnan(values[i]) ? 0 : static_cast<std::uint32_t>(static_cast<std::int32_t>(rounded));
            if (type == Type::Boolean) v.words[i] = v.words[i] != 0;
        }
        return v;
    }

    void set(Context c, std::span<const float> values) { world.contexts[c] = valueOf(ir::info(c).type, values); }

    void setContexts(int levels) {
        for (int i = 0; i < ir::kContexts; i++) {
            const Context c = static_cast<Context>(i);
            if (ir::info(c).source != ContextSource::Uniform) continue;
            const std::vector<std::uint32_t> usual = passes::defaultOf(c);
            Value& v = world.contexts[c];
            v.type = ir::info(c).type;
            std::copy(usual.begin(), usual.end(), v.words);
            for (const scene::NamedMatrix& m : scene::sceneMatrices())
                if (m.uniform == ir::info(c).host) set(c, m.value);
        }
        set(Context::ViewPosition, std::array{0.0f, 0.0f, scene::kEyeDistance});
        set(Context::ViewDirection, std::array{0.0f, 0.0f, -1.0f});
        set(Context::EnvironmentMips, std::array{static_cast<float>(levels)});
        set(Context::EnvironmentSamples, std::array{static_cast<float>(std::max(job.samples, 0))});
        set(Context::EnvironmentIntensity, std::array{1.0f});
        set(Context::ActiveLights, std::array{0.0f});
    }

    bool fits(const scene::UniformValue& value, Type type) {
        if (value.values.size() == static_cast<std::size_t>(ir::componentCount(type))) return true;
        diagnostics.warning("bad-uniform-value", fmt::format("the uniform '{}' cannot hold {} values; it keeps its own",
                                                             value.name, value.values.size()));
        return false;
    }

    void setUniforms() {
        std::set<Context> contexts;
        std::set<Name> uniforms;
        for (const passes::StageUniforms* stage : {&job.interface->vertexUniforms, &job.interface->pixelUniforms}) {
            contexts.insert(stage->contexts.begin(), stage->contexts.end());
            uniforms.insert(stage->uniforms.begin(), stage->uniforms.end());
        }
        for (const scene::UniformValue& value : job.uniforms) {
            bool isUsed = false;
            for (Context c : contexts)
                if (ir::info(c).source == ContextSource::Uniform && ir::info(c).host == value.name) {
                    isUsed = true;
                    if (fits(value, ir::info(c).type)) set(c, value.values);
                }
            for (const ir::Uniform& u : job.module->uniforms)
                if (uniforms.count(u.name) && job.module->names->text(u.name) == value.name) {
                    isUsed = true;
                    if (fits(value, u.type)) world.uniforms[u.name] = valueOf(u.type, value.values);
                }
            if (!isUsed)
                diagnostics.warning("unused-uniform",
                                    fmt::format("the shader does not use a uniform '{}'", value.name));
        }
    }

    // Reads the files that textures are made of, each once.
    void readPictures() {
        std::vector<std::pair<const std::string*, Picture*>> reads;
        for (const scene::Texture& texture : job.textures)
            if (!texture.file.empty()) {
                const auto [at, isNew] = pictures.try_emplace(texture.file);
                if (isNew) reads.emplace_back(&at->first, &at->second);
            }
        inThreads(reads.size(), [&](std::size_t i) {
            Picture& picture = *reads[i].second;
            if (const Result<Image> read = image::readImage(*reads[i].first, picture.reading))
                picture.image = std::make_shared<const Image>(flipped(*read));
        });
    }

    // Does pieces of work in the job's threads.
    template <class Work>
    void inThreads(std::size_t pieces, Work&& work) const {
        std::atomic<std::size_t> next{0};
        runThreads(threadCount(job.threads, pieces), [&](std::size_t) {
            for (std::size_t i = next++; i < pieces; i = next++) work(i);
        });
    }

    const Image* pictureOf(const scene::Texture& texture) {
        if (texture.file.empty()) return nullptr;
        Picture& picture = pictures.at(texture.file);
        if (!picture.image && !std::exchange(picture.isTold, true))
            scene::warnOfMissing(texture, picture.reading, diagnostics);
        return picture.image.get();
    }

    static std::shared_ptr<const Texture> plain(const float (&rgba)[4]) {
        Image one = Image::ofFloats(1, 1, 4);
        std::copy(std::begin(rgba), std::end(rgba), one.floats.begin());
        return std::make_shared<const Texture>(one, false, Sampling{});
    }

    static std::shared_ptr<const Texture> textureOf(const scene::Texture& texture, const Image* picture) {
        if (!picture) return plain(texture.defaultColor);
        Sampling sampling{
            addressNamed(texture.uAddress), addressNamed(texture.vAddress), texture.filter == "closest", {}};
        if (texture.uAddress != "black" && texture.vAddress != "black")
            std::copy(std::begin(texture.defaultColor), std::end(texture.defaultColor), sampling.border.begin());
        return std::make_shared<const Texture>(*picture, true, sampling);
    }

    void loadTextures() {
        struct Making {
            const scene::Texture& from;
            const Image* picture;
            std::shared_ptr<const Texture>& to;
        };
        std::vector<Making> made;
        readPictures();
        for (Name name : job.interface->pixelUniforms.uniforms) {
            const ir::Uniform* uniform = job.module->uniform(name);
            if (!uniform || uniform->type != Type::Texture2D) continue;
            const std::string text(job.module->names->text(name));
            const auto given = std::find_if(job.textures.begin(), job.textures.end(),
                                            [&](const scene::Texture& t) { return t.uniform == text; });
            if (given != job.textures.end()) {
                made.push_back({*given, pictureOf(*given), world.textures[name]});
                continue;
            }
            diagnostics.warning("unbound-sampler",
                                fmt::format("no picture is given for the sampler '{}': white is drawn", text));
            world.textures[name] = plain({1, 1, 1, 1});
        }
        inThreads(made.size(), [&](std::size_t i) { made[i].to = textureOf(made[i].from, made[i].picture); });
    }

    bool makeWorld() {
        std::optional<Sky> own;
        if (!job.environment.empty()) {
            const Result<scene::Environment> loaded = scene::loadEnvironment(job.environment, kMaxSide, diagnostics);
            if (!loaded) return false;
            own.emplace(scene::inWorkingSpace(*loaded, job));
        } else if (job.working) {
            own.emplace(scene::inWorkingSpace(scene::builtInSky(), job));
        } else if (!builtIn) {
            builtIn.emplace(scene::builtInSky());
        }
        const Sky& sky = own ? *own : *builtIn;
        world.maps[Context::EnvironmentRadiance] = sky.radiance;
        world.maps[Context::EnvironmentIrradiance] = sky.irradiance;
        setContexts(sky.radiance->levels());
        setUniforms();
        loadTextures();
        return true;
    }

    Result<Image> run() {
        const int factor = scene::supersampling(job);
        if (job.size < 1 || factor > kMaxSide || job.size > kMaxSide / factor) {
            diagnostics.error("bad-size", fmt::format("a picture of {0}×{0} pixels from {1}×{1} samples each is not "
                                                      "drawn: 1 to {2} a side are",
                                                      job.size, factor, kMaxSide));
            return Failure{};
        }
        const int side = job.size * factor;
        if (!makeWorld()) return Failure{};
        Vertices vertices;
        if (!runVertices(job, world, mesh, vertices, diagnostics)) return Failure{};
        const ir::Function* pixel = job.module->findOwn(job.interface->pixel);
        const Result<ir::WideProgram> program = ir::WideProgram::prepare(*job.module, *pixel, diagnostics);
        if (!program) return Failure{};
        Image out = Image::ofFloats(side, side, 4);
        const std::vector<Quad> quads = rasterise(vertices.positions, mesh.triangles, side);
        PixelStage stage{job,  world, mesh, vertices, *program, fragmentsOf(quads, program->takesDerivatives()),
                         side, out};
        if (!stage.run(diagnostics)) return Failure{};
        return factor == 1 ? std::move(out) : scene::reduced(out, factor);
    }
};

}  // namespace

struct Studio::State {
    scene::Mesh mesh = scene::makeSphere(128, 64);
    std::optional<Sky> sky = {};
};

Studio::Studio() : state_(std::make_unique<State>()) {}
Studio::~Studio() = default;

Result<Image> Studio::render(const RenderJob& job, Diagnostics& diagnostics) {
    try {
        return Host{job, state_->mesh, state_->sky, diagnostics}.run();
    } catch (const std::bad_alloc&) {
        diagnostics.error("bad-size", fmt::format("a picture of {0}×{0} pixels does not fit into memory", job.size));
        return Failure{};
    }
}

Result<Image> render(const RenderJob& job, Diagnostics& diagnostics) { return Studio().render(job, diagnostics); }

bool draw(const RenderJob& job, Diagnostics& diagnostics) {
    if (!scene::checkOutput(job, diagnostics)) return false;
    const Result<Image> picture = render(job, diagnostics);
    return picture && scene::writePicture(job, *picture, diagnostics);
}

}  // namespace shaderx::oracle
