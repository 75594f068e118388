#include "draw/draw.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <new>

#include <fmt/format.h>

#include "draw/driver.h"
#include "draw/textures.h"
#include "scene/picture.h"
#include "scene/sky.h"
#include "scene/sphere.h"

namespace shaderx::draw {

using image::Image;

namespace {

// The environment in the driver's memory.
struct EnvironmentMaps {
    Bound radiance, irradiance;
    int levels = 0;

    EnvironmentMaps() = default;
    EnvironmentMaps(const scene::Environment& environment, TextureSet& textures)
        : radiance(textures.addMap(environment.radiance, true)),
          irradiance(textures.addMap(environment.irradiance, false)) {
        for (int side = std::max(environment.radiance.width, environment.radiance.height); side > 0; side /= 2)
            levels++;
    }
};

// The sphere in the driver's memory.
struct Geometry {
    const Gl& gl;
    GLuint buffers[7] = {};  // positions, normals, tangents, bitangents, texcoords, colors, triangles
    GLsizei indexCount = 0;

    Geometry(const Gl& driver, const scene::Mesh& mesh)
        : gl(driver), indexCount(static_cast<GLsizei>(mesh.triangles.size())) {
        gl.genBuffers(7, buffers);
        for (int i = 0; i < scene::kMeshArrays; i++) {
            const std::vector<float>& values = scene::valuesOf(mesh, static_cast<scene::MeshArray>(i));
            fill(buffers[i], values.data(), values.size() * sizeof(float));
        }
        fill(buffers[6], mesh.triangles.data(), mesh.triangles.size() * sizeof(unsigned));
    }
    ~Geometry() { gl.deleteBuffers(7, buffers); }
    Geometry(const Geometry&) = delete;
    Geometry& operator=(const Geometry&) = delete;

    void fill(GLuint buffer, const void* data, std::size_t size) const {
        gl.bindBuffer(GL_ARRAY_BUFFER, buffer);
        gl.bufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(size), data, GL_STATIC_DRAW);
    }
};

// An active uniform of a linked program.
struct Uniform {
    GLint location = -1;
    GLenum type = 0;
    GLint count = 1;  // of an array's elements
    // Of those in a block, which have no location.
    GLint block = -1, offset = 0, matrixStride = 0, arrayStride = 0;
    bool isSet = false;
};

// An active attribute of a linked program.
struct Attribute {
    std::string name;
    GLuint location = 0;
    GLenum type = 0;
};

// A uniform block on its way to the driver.
struct Block {
    std::string name;
    std::vector<unsigned char> bytes;
    GLuint buffer = 0;
};

// How many components a uniform type has, and of which kind; 0 for what is not a value.
struct Shape {
    int components = 0;
    enum class Kind : std::uint8_t { Float, Integer, Matrix } kind = Kind::Float;
};

Shape shapeOf(GLenum type) {
    switch (type) {
        case GL_FLOAT:
            return {1, Shape::Kind::Float};
        case GL_FLOAT_VEC2:
            return {2, Shape::Kind::Float};
        case GL_FLOAT_VEC3:
            return {3, Shape::Kind::Float};
        case GL_FLOAT_VEC4:
            return {4, Shape::Kind::Float};
        case GL_INT:
        case GL_BOOL:
            return {1, Shape::Kind::Integer};
        case GL_INT_VEC2:
        case GL_BOOL_VEC2:
            return {2, Shape::Kind::Integer};
        case GL_INT_VEC3:
        case GL_BOOL_VEC3:
            return {3, Shape::Kind::Integer};
        case GL_INT_VEC4:
        case GL_BOOL_VEC4:
            return {4, Shape::Kind::Integer};
        case GL_FLOAT_MAT3:
            return {9, Shape::Kind::Matrix};
        case GL_FLOAT_MAT4:
            return {16, Shape::Kind::Matrix};
        default:
            return {};
    }
}

// Draws one job; owns what the job needs of the driver.
struct Renderer {
    const Gl& gl;
    const Geometry& geometry;
    const Job& job;
    Diagnostics& diagnostics;
    EnvironmentMaps environment;
    int side;  // of the picture that is drawn: size × supersampling

    TextureSet textures{gl};
    GLuint program = 0, vertexArray = 0, framebuffer = 0, colour = 0, depth = 0;
    std::map<std::string, Uniform> uniforms{};  // arrays without their "[0]"
    std::vector<Block> blocks{};
    std::vector<Bound> units{};

    ~Renderer();
    bool prepareLinked();
    void use() const;
    void drawOnce() const;
    bool succeeded();
    bool run(Image& out);
    GLuint compile(GLenum stage, const std::string& text, const char* name);
    bool link();
    void rejected(const std::string& what, const std::string& log);
    void listUniforms();
    void listBlocks();
    bool findInBlock(GLuint index, Uniform& uniform);
    void store(const Uniform& uniform, const Shape& shape, const std::vector<float>& values);
    void fillBlocks();
    void set(const std::string& name, const std::vector<float>& values, bool byUser = false);
    void setUniforms();
    void bindTextures();
    Bound textureOf(const std::string& uniform);
    std::vector<Attribute> attributes() const;
    void bindAttributes();
    bool makeTarget();
};

Renderer::~Renderer() {
    gl.bindFramebuffer(GL_FRAMEBUFFER, 0);
    gl.useProgram(0);
    gl.bindVertexArray(0);
    gl.deleteProgram(program);
    gl.deleteVertexArrays(1, &vertexArray);
    gl.deleteFramebuffers(1, &framebuffer);
    gl.deleteTextures(1, &colour);
    gl.deleteRenderbuffers(1, &depth);
    for (const Block& block : blocks) gl.deleteBuffers(1, &block.buffer);
}

void Renderer::rejected(const std::string& what, const std::string& log) {
    Diagnostic& d = diagnostics.error("driver-rejected", "the driver rejected " + what);
    constexpr std::size_t kMaxLines = 40;
    for (std::size_t at = 0; at < log.size() && d.notes.size() < kMaxLines;) {
        const std::size_t end = std::min(log.find('\n', at), log.size());
        if (end > at) d.notes.emplace_back().message = log.substr(at, end - at);
        at = end + 1;
    }
}

GLuint Renderer::compile(GLenum stage, const std::string& text, const char* name) {
    const GLuint shader = gl.createShader(stage);
    const GLchar* start = text.c_str();
    const GLint length = static_cast<GLint>(text.size());
    gl.shaderSource(shader, 1, &start, &length);
    gl.compileShader(shader);
    GLint ok = 0, logLength = 0;
    gl.getShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    gl.getShaderiv(shader, GL_INFO_LOG_LENGTH, &logLength);
    std::string log(static_cast<std::size_t>(std::max(logLength, 1)), '\0');
    gl.getShaderInfoLog(shader, logLength, &logLength, log.data());
    log.resize(static_cast<std::size_t>(logLength));
    rejected(fmt::format("the {} shader", name), log);
    gl.deleteShader(shader);
    return 0;
}

bool Renderer::link() {
    const GLuint vertex = compile(GL_VERTEX_SHADER, job.vertex, "vertex");
    const GLuint pixel = compile(GL_FRAGMENT_SHADER, job.pixel, "pixel");
    program = gl.createProgram();
    GLint ok = vertex && pixel, logLength = 0;
    if (ok) {
        gl.attachShader(program, vertex);
        gl.attachShader(program, pixel);
        gl.linkProgram(program);
        gl.getProgramiv(program, GL_LINK_STATUS, &ok);
        if (!ok) {
            gl.getProgramiv(program, GL_INFO_LOG_LENGTH, &logLength);
            std::string log(static_cast<std::size_t>(std::max(logLength, 1)), '\0');
            gl.getProgramInfoLog(program, logLength, &logLength, log.data());
            log.resize(static_cast<std::size_t>(logLength));
            rejected("the vertex and pixel shaders together", log);
        }
    }
    if (vertex) gl.deleteShader(vertex);
    if (pixel) gl.deleteShader(pixel);
    return ok != 0;
}

void Renderer::listBlocks() {
    GLint count = 0;
    gl.getProgramiv(program, GL_ACTIVE_UNIFORM_BLOCKS, &count);
    for (GLuint i = 0; i < static_cast<GLuint>(count); i++) {
        GLint size = 0, length = 0;
        gl.getActiveUniformBlockiv(program, i, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
        gl.getActiveUniformBlockiv(program, i, GL_UNIFORM_BLOCK_NAME_LENGTH, &length);
        Block& block = blocks.emplace_back();
        block.name.resize(static_cast<std::size_t>(std::max(length, 1)));
        gl.getActiveUniformBlockName(program, i, length, &length, block.name.data());
        block.name.resize(static_cast<std::size_t>(length));
        block.bytes.resize(static_cast<std::size_t>(size));
    }
}

bool Renderer::findInBlock(GLuint index, Uniform& uniform) {
    auto ask = [&](GLenum what, GLint& answer) { gl.getActiveUniformsiv(program, 1, &index, what, &answer); };
    ask(GL_UNIFORM_BLOCK_INDEX, uniform.block);
    if (uniform.block < 0) return false;
    ask(GL_UNIFORM_OFFSET, uniform.offset);
    ask(GL_UNIFORM_MATRIX_STRIDE, uniform.matrixStride);
    ask(GL_UNIFORM_ARRAY_STRIDE, uniform.arrayStride);
    return true;
}

void Renderer::listUniforms() {
    listBlocks();
    GLint count = 0, longest = 0;
    gl.getProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
    gl.getProgramiv(program, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
    std::string buffer(static_cast<std::size_t>(longest) + 1, '\0');
    for (GLint i = 0; i < count; i++) {
        Uniform uniform;
        GLsizei length = 0;
        gl.getActiveUniform(program, static_cast<GLuint>(i), static_cast<GLsizei>(buffer.size()), &length,
                            &uniform.count, &uniform.type, buffer.data());
        std::string name = buffer.substr(0, static_cast<std::size_t>(length));
        uniform.location = gl.getUniformLocation(program, name.c_str());
        if (uniform.location < 0 && !findInBlock(static_cast<GLuint>(i), uniform)) continue;  // the driver's own
        if (name.ends_with("[0]")) name.resize(name.size() - 3);
        uniforms[name] = uniform;
    }
}

GLint toInteger(float v) {
    return std::isnan(v) ? 0 : static_cast<GLint>(std::round(std::clamp(v, -2147483520.f, 2147483520.f)));
}

// Values of a uniform in a block, at the places that the driver told.
void Renderer::store(const Uniform& uniform, const Shape& shape, const std::vector<float>& values) {
    const std::size_t components = static_cast<std::size_t>(shape.components);
    const bool isMatrix = shape.kind == Shape::Kind::Matrix;
    const std::size_t rows = !isMatrix ? components : components == 9 ? 3 : 4;
    for (std::size_t i = 0; i < values.size(); i++) {
        const std::size_t at = static_cast<std::size_t>(uniform.offset) +
                               i / components * static_cast<std::size_t>(std::max(uniform.arrayStride, 0)) +
                               i % components / rows * static_cast<std::size_t>(std::max(uniform.matrixStride, 0)) +
                               i % rows * 4;
        const GLint integer = toInteger(values[i]);
        const void* word = shape.kind == Shape::Kind::Integer ? static_cast<const void*>(&integer) : &values[i];
        std::vector<unsigned char>& bytes = blocks[static_cast<std::size_t>(uniform.block)].bytes;
        if (at + 4 <= bytes.size()) std::memcpy(&bytes[at], word, 4);
    }
}

void Renderer::fillBlocks() {
    for (const auto& [name, uniform] : uniforms)
        if (uniform.block >= 0 && !uniform.isSet)
            diagnostics.warning("unbound-block",
                                fmt::format("nothing sets '{}' in the uniform block '{}': it is 0", name,
                                            blocks[static_cast<std::size_t>(uniform.block)].name));
    for (GLuint i = 0; i < blocks.size(); i++) {
        Block& block = blocks[i];
        gl.genBuffers(1, &block.buffer);
        gl.bindBuffer(GL_UNIFORM_BUFFER, block.buffer);
        gl.bufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(block.bytes.size()), block.bytes.data(),
                      GL_STATIC_DRAW);
        gl.uniformBlockBinding(program, i, i);
        gl.bindBufferBase(GL_UNIFORM_BUFFER, i, block.buffer);
    }
}

// Sets a uniform if the shader has it. What the user names and the shader lacks, or cannot hold, is a warning.
void Renderer::set(const std::string& name, const std::vector<float>& values, bool byUser) {
    const auto found = uniforms.find(name.ends_with("[0]") ? name.substr(0, name.size() - 3) : name);
    if (found == uniforms.end()) {
        if (byUser) diagnostics.warning("unused-uniform", fmt::format("the shader does not use a uniform '{}'", name));
        return;
    }
    Uniform& uniform = found->second;
    const Shape shape = shapeOf(uniform.type);
    const std::size_t components = static_cast<std::size_t>(shape.components);
    if (components == 0 || values.empty() || values.size() % components != 0 ||
        values.size() / components > static_cast<std::size_t>(uniform.count)) {
        if (byUser)
            diagnostics.warning(
                "bad-uniform-value",
                fmt::format("the uniform '{}' cannot hold {} values; it keeps its own", name, values.size()));
        return;
    }
    uniform.isSet = true;
    if (uniform.block >= 0) return store(uniform, shape, values);
    const GLsizei n = static_cast<GLsizei>(values.size() / components);
    const GLint at = uniform.location;
    if (shape.kind == Shape::Kind::Matrix) {
        (components == 9 ? gl.uniformMatrix3fv : gl.uniformMatrix4fv)(at, n, GL_FALSE, values.data());
    } else if (shape.kind == Shape::Kind::Float) {
        const PFNGLUNIFORM1FVPROC setters[] = {gl.uniform1fv, gl.uniform2fv, gl.uniform3fv, gl.uniform4fv};
        setters[components - 1](at, n, values.data());
    } else {
        std::vector<GLint> rounded;
        for (const float v : values) rounded.push_back(toInteger(v));
        const PFNGLUNIFORM1IVPROC setters[] = {gl.uniform1iv, gl.uniform2iv, gl.uniform3iv, gl.uniform4iv};
        setters[components - 1](at, n, rounded.data());
    }
}

void Renderer::setUniforms() {
    for (const UniformValue& value : job.defaults) set(value.name, value.values);
    for (const scene::NamedMatrix& m : scene::sceneMatrices()) set(m.uniform, {m.value.begin(), m.value.end()});
    set("u_viewPosition", {0, 0, scene::kEyeDistance});
    set("u_viewDirection", {0, 0, -1});
    set("u_envRadianceMips", {static_cast<float>(environment.levels)});
    set("u_envRadianceSamples", {static_cast<float>(std::max(job.samples, 0))});
    set("u_envLightIntensity", {1});
    set("u_numActiveLightSources", {0});
    for (const UniformValue& value : job.uniforms) set(value.name, value.values, true);
    fillBlocks();
}

Bound Renderer::textureOf(const std::string& uniform) {
    if (uniform == "u_envRadiance") return environment.radiance;
    if (uniform == "u_envIrradiance") return environment.irradiance;
    for (const Texture& texture : job.textures)
        if (texture.uniform == uniform) return textures.addMaterial(texture, diagnostics);
    diagnostics.warning("unbound-sampler",
                        fmt::format("no picture is given for the sampler '{}': white is drawn", uniform));
    return textures.addColour({1, 1, 1, 1});
}

void Renderer::bindTextures() {
    for (const auto& [name, uniform] : uniforms) {
        if (uniform.type == GL_SAMPLER_2D) {
            const std::vector<GLint> unit(static_cast<std::size_t>(uniform.count), static_cast<GLint>(units.size()));
            gl.uniform1iv(uniform.location, uniform.count, unit.data());
            units.push_back(textureOf(name));
        } else if (shapeOf(uniform.type).components == 0) {
            diagnostics.warning("unbound-sampler",
                                fmt::format("the uniform '{}' is of a type that is not bound", name));
        }
    }
}

void Renderer::bindAttributes() {
    gl.genVertexArrays(1, &vertexArray);
    gl.bindVertexArray(vertexArray);
    for (const Attribute& a : attributes()) {
        const scene::MeshArray array = scene::meshArrayOf(a.name);
        if (array == scene::MeshArray::None) {
            const auto usual = std::find_if(job.attributes.begin(), job.attributes.end(),
                                            [&](const scene::UniformValue& v) { return v.name == a.name; });
            if (usual != job.attributes.end()) {
                std::array<float, 4> value{0, 0, 0, 1};
                std::copy_n(usual->values.begin(), std::min<std::size_t>(4, usual->values.size()), value.begin());
                gl.vertexAttrib4fv(a.location, value.data());
                continue;
            }
            diagnostics.warning("unbound-attribute",
                                fmt::format("the sphere has no attribute '{}': it reads as 0", a.name));
            continue;
        }
        gl.bindBuffer(GL_ARRAY_BUFFER, geometry.buffers[static_cast<int>(array)]);
        gl.enableVertexAttribArray(a.location);
        gl.vertexAttribPointer(a.location, scene::kMeshComponents[static_cast<int>(array)], GL_FLOAT, GL_FALSE, 0,
                               nullptr);
    }
    gl.bindBuffer(GL_ELEMENT_ARRAY_BUFFER, geometry.buffers[6]);
}

std::vector<Attribute> Renderer::attributes() const {
    std::vector<Attribute> all;
    GLint count = 0, longest = 0;
    gl.getProgramiv(program, GL_ACTIVE_ATTRIBUTES, &count);
    gl.getProgramiv(program, GL_ACTIVE_ATTRIBUTE_MAX_LENGTH, &longest);
    std::string buffer(static_cast<std::size_t>(longest) + 1, '\0');
    for (GLint i = 0; i < count; i++) {
        GLsizei length = 0;
        GLint elements = 0;
        Attribute a;
        gl.getActiveAttrib(program, static_cast<GLuint>(i), static_cast<GLsizei>(buffer.size()), &length, &elements,
                           &a.type, buffer.data());
        a.name = buffer.substr(0, static_cast<std::size_t>(length));
        const GLint location = gl.getAttribLocation(program, a.name.c_str());
        if (location < 0) continue;  // built in, such as gl_VertexID
        a.location = static_cast<GLuint>(location);
        all.push_back(std::move(a));
    }
    return all;
}

bool Renderer::makeTarget() {
    gl.genFramebuffers(1, &framebuffer);
    gl.bindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.genTextures(1, &colour);
    gl.bindTexture(GL_TEXTURE_2D, colour);
    gl.texImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, side, side, 0, GL_RGBA, GL_FLOAT, nullptr);
    gl.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    gl.framebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
    gl.genRenderbuffers(1, &depth);
    gl.bindRenderbuffer(GL_RENDERBUFFER, depth);
    gl.renderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, side, side);
    gl.framebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    return gl.checkFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

// All but linking, which is to be done.
bool Renderer::prepareLinked() {
    gl.useProgram(program);
    listUniforms();
    if (!makeTarget()) {
        diagnostics.error("driver-error", fmt::format("the driver gives no picture of {0}×{0} pixels", side));
        return false;
    }
    setUniforms();
    bindTextures();
    bindAttributes();
    return true;
}

// Makes the driver's state that of this job, if another one was drawn since prepare().
void Renderer::use() const {
    gl.useProgram(program);
    gl.bindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl.bindVertexArray(vertexArray);
    for (std::size_t i = 0; i < units.size(); i++) {
        gl.activeTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        gl.bindTexture(GL_TEXTURE_2D, units[i].texture);
        gl.bindSampler(static_cast<GLuint>(i), units[i].sampler);
    }
    gl.activeTexture(GL_TEXTURE0);
    for (GLuint i = 0; i < blocks.size(); i++) gl.bindBufferBase(GL_UNIFORM_BUFFER, i, blocks[i].buffer);
    gl.viewport(0, 0, side, side);
    gl.enable(GL_DEPTH_TEST);
    gl.enable(GL_CULL_FACE);
    gl.frontFace(GL_CCW);
    gl.clearColor(0, 0, 0, 0);
}

void Renderer::drawOnce() const {
    gl.clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    gl.drawElements(GL_TRIANGLES, geometry.indexCount, GL_UNSIGNED_INT, nullptr);
}

bool Renderer::succeeded() {
    const GLenum error = gl.getError();
    if (error != GL_NO_ERROR)
        diagnostics.error("driver-error", fmt::format("the driver failed while drawing, with code {:#06x}", error));
    return error == GL_NO_ERROR;
}

// Bottom row first, as the driver gives it.
bool Renderer::run(Image& out) {
    if (!link() || !prepareLinked()) return false;
    use();
    drawOnce();
    out = Image::ofFloats(side, side, 4);
    gl.readPixels(0, 0, side, side, GL_RGBA, GL_FLOAT, out.floats.data());
    return succeeded();
}

}  // namespace

static std::string_view spelled(GLenum type) {
    switch (type) {
        case GL_FLOAT:
            return "float";
        case GL_FLOAT_VEC2:
            return "vec2";
        case GL_FLOAT_VEC3:
            return "vec3";
        case GL_FLOAT_VEC4:
            return "vec4";
        case GL_INT:
            return "int";
        case GL_BOOL:
            return "bool";
        case GL_FLOAT_MAT3:
            return "mat3";
        case GL_FLOAT_MAT4:
            return "mat4";
        case GL_SAMPLER_2D:
            return "sampler2D";
        default:
            return "another type";
    }
}

struct Context::State {
    std::unique_ptr<Driver> driver;
    std::unique_ptr<Geometry> geometry;
    std::unique_ptr<TextureSet> textures;
    EnvironmentMaps sky;  // made when the first job asks for it

    Result<Image> render(const Job& job, Diagnostics& diagnostics);

    ~State() {
        driver->makeCurrent();
        textures.reset();
        geometry.reset();
    }
};

Context::Context(std::unique_ptr<State> state) : state_(std::move(state)) {}
Context::~Context() = default;

std::unique_ptr<Context> Context::create(Diagnostics& diagnostics) {
    std::unique_ptr<Driver> driver = Driver::open(diagnostics);
    if (!driver) return nullptr;
    const Gl& gl = driver->gl;
    auto geometry = std::make_unique<Geometry>(gl, scene::makeSphere(128, 64));
    auto textures = std::make_unique<TextureSet>(gl);
    std::unique_ptr<State> state(new State{std::move(driver), std::move(geometry), std::move(textures), {}});
    return std::unique_ptr<Context>(new Context(std::move(state)));
}

const std::string& Context::renderer() const { return state_->driver->renderer; }

Result<Image> Context::render(const Job& job, Diagnostics& diagnostics) {
    try {
        return state_->render(job, diagnostics);
    } catch (const std::bad_alloc&) {
        diagnostics.error("bad-size", fmt::format("a picture of {0}×{0} pixels does not fit into memory", job.size));
        return Failure{};
    }
}

Result<Active> Context::active(const std::string& vertex, const std::string& pixel, Diagnostics& diagnostics) {
    const Gl& gl = state_->driver->gl;
    if (!state_->driver->makeCurrent()) {
        diagnostics.error("driver-error", "the driver's context cannot be made current");
        return Failure{};
    }
    Job job;
    job.vertex = vertex;
    job.pixel = pixel;
    Renderer renderer{gl, *state_->geometry, job, diagnostics, {}, 1};
    if (!renderer.link()) return Failure{};
    renderer.listUniforms();
    Active active;
    for (const auto& [name, u] : renderer.uniforms) {
        const std::string block = u.block < 0 ? "" : renderer.blocks[static_cast<std::size_t>(u.block)].name;
        active.uniforms.push_back({name, std::string(spelled(u.type)), block, u.offset});
    }
    for (const Attribute& a : renderer.attributes())
        active.inputs.push_back({a.name, std::string(spelled(a.type)), "", 0});
    std::sort(active.inputs.begin(), active.inputs.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return active;
}

namespace {

double median(std::vector<double> values) {
    if (values.empty()) return -1;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

// A job while it is measured.
struct Measured {
    std::unique_ptr<Renderer> renderer;
    double compile = 0;
    std::vector<double> frames = {}, device = {};
};

// One frame, timed by the host's clock and, where the device has one, by that.
void timeFrame(const Gl& gl, Measured& m, GLuint query) {
    m.renderer->use();
    gl.finish();
    const auto start = std::chrono::steady_clock::now();
    if (query) gl.beginQuery(GL_TIME_ELAPSED, query);
    m.renderer->drawOnce();
    if (query) gl.endQuery(GL_TIME_ELAPSED);
    gl.finish();
    m.frames.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    if (!query) return;
    GLuint64 nanoseconds = 0;
    gl.getQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    m.device.push_back(static_cast<double>(nanoseconds) / 1e6);
}

}  // namespace

Result<std::vector<Timing>> Context::measure(std::span<const Job> jobs, int frames, Diagnostics& diagnostics) {
    const Gl& gl = state_->driver->gl;
    if (!state_->driver->makeCurrent()) {
        diagnostics.error("driver-error", "the driver's context cannot be made current");
        return Failure{};
    }
    if (!state_->sky.levels) state_->sky = EnvironmentMaps(scene::builtInSky(), *state_->textures);
    std::vector<Measured> all;
    for (const Job& job : jobs) {
        Measured& m = all.emplace_back(Measured{
            std::unique_ptr<Renderer>(new Renderer{gl, *state_->geometry, job, diagnostics, state_->sky, job.size})});
        gl.finish();
        const auto start = std::chrono::steady_clock::now();
        if (!m.renderer->link()) return Failure{};
        const auto linked = std::chrono::steady_clock::now();
        if (!m.renderer->prepareLinked()) return Failure{};
        m.renderer->use();
        gl.finish();
        const auto ready = std::chrono::steady_clock::now();
        m.renderer->drawOnce();
        gl.finish();
        const auto drawn = std::chrono::steady_clock::now();
        m.compile = std::chrono::duration<double, std::milli>(linked - start + (drawn - ready)).count();
    }
    GLint bits = 0;
    GLuint query = 0;
    gl.getQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &bits);
    if (bits > 0) gl.genQueries(1, &query);
    for (int i = 0; i < frames; i++)
        for (Measured& m : all) timeFrame(gl, m, query);
    if (query) gl.deleteQueries(1, &query);
    std::vector<Timing> times;
    for (Measured& m : all) {
        if (!m.renderer->succeeded()) return Failure{};
        times.push_back({m.compile, median(m.frames), median(m.device)});
    }
    return times;
}

Result<Image> Context::State::render(const Job& job, Diagnostics& diagnostics) {
    const Gl& gl = driver->gl;
    if (!driver->makeCurrent()) {
        diagnostics.error("driver-error", "the driver's context cannot be made current");
        return Failure{};
    }
    GLint maxTexture = 0, maxBuffer = 0;
    gl.getIntegerv(GL_MAX_TEXTURE_SIZE, &maxTexture);
    gl.getIntegerv(GL_MAX_RENDERBUFFER_SIZE, &maxBuffer);
    const int factor = scene::supersampling(job), maxSide = std::min(maxTexture, maxBuffer);
    if (job.size < 1 || factor > maxSide || job.size > maxSide / factor) {
        diagnostics.error("bad-size", fmt::format("a picture of {0}×{0} pixels from {1}×{1} samples each is not drawn: "
                                                  "the driver takes 1 to {2} a side",
                                                  job.size, factor, maxSide));
        return Failure{};
    }
    Renderer renderer{gl, *geometry, job, diagnostics, {}, job.size * factor};
    if (!job.environment.empty()) {
        const Result<scene::Environment> loaded = scene::loadEnvironment(job.environment, maxTexture, diagnostics);
        if (!loaded) return Failure{};
        renderer.environment = EnvironmentMaps(scene::inWorkingSpace(*loaded, job), renderer.textures);
    } else if (job.working) {
        renderer.environment = EnvironmentMaps(scene::inWorkingSpace(scene::builtInSky(), job), renderer.textures);
    } else {
        if (!sky.levels) sky = EnvironmentMaps(scene::builtInSky(), *textures);
        renderer.environment = sky;
    }
    Image drawn;
    if (!renderer.run(drawn)) return Failure{};
    return flipped(factor == 1 ? drawn : scene::reduced(drawn, factor));
}

bool Context::draw(const Job& job, Diagnostics& diagnostics) {
    if (!scene::checkOutput(job, diagnostics)) return false;
    const Result<Image> picture = render(job, diagnostics);
    return picture && scene::writePicture(job, *picture, diagnostics);
}

Result<Image> render(const Job& job, Diagnostics& diagnostics) {
    const std::unique_ptr<Context> context = Context::create(diagnostics);
    if (!context) return Failure{};
    return context->render(job, diagnostics);
}

bool draw(const Job& job, Diagnostics& diagnostics) {
    const std::unique_ptr<Context> context = Context::create(diagnostics);
    return context && context->draw(job, diagnostics);
}

}  // namespace shaderx::draw
