#include "table/float_pass.h"

#include <bit>

namespace shaderx::table {

std::unique_ptr<FloatPass> FloatPass::open(int width, int height, std::string& reason) {
    Diagnostics diagnostics;
    std::unique_ptr<draw::Driver> driver = draw::Driver::open(diagnostics);
    if (!driver) {
        reason = diagnostics.text();
        return nullptr;
    }
    return std::unique_ptr<FloatPass>(new FloatPass(std::move(driver), width, height));
}

FloatPass::FloatPass(std::unique_ptr<draw::Driver> driver, int width, int height)
    : driver_(std::move(driver)), gl_(driver_->gl), width_(width), height_(height) {
    gl_.genVertexArrays(1, &array_);
    gl_.bindVertexArray(array_);
    gl_.genBuffers(1, &indices_);
    gl_.bindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
    const std::uint32_t corners[] = {0, 1, 2};
    gl_.bufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
    gl_.genRenderbuffers(1, &target_);
    gl_.bindRenderbuffer(GL_RENDERBUFFER, target_);
    gl_.renderbufferStorage(GL_RENDERBUFFER, GL_RGBA32F, width, height);
    gl_.genFramebuffers(1, &framebuffer_);
    gl_.bindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    gl_.framebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target_);
    gl_.viewport(0, 0, width, height);
}

FloatPass::~FloatPass() {
    gl_.deleteFramebuffers(1, &framebuffer_);
    gl_.deleteRenderbuffers(1, &target_);
    gl_.deleteBuffers(1, &indices_);
    gl_.deleteVertexArrays(1, &array_);
}

GLuint FloatPass::addTexture(int width, int height, std::span<const float> rgba, bool linear) {
    GLuint texture = 0;
    gl_.genTextures(1, &texture);
    gl_.bindTexture(GL_TEXTURE_2D, texture);
    gl_.texImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, rgba.data());
    const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
    gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    return texture;
}

void FloatPass::removeTexture(GLuint texture) { gl_.deleteTextures(1, &texture); }

GLuint FloatPass::compile(GLenum stage, const std::string& text, std::string& log) {
    const GLuint shader = gl_.createShader(stage);
    const char* source = text.c_str();
    gl_.shaderSource(shader, 1, &source, nullptr);
    gl_.compileShader(shader);
    GLint fine = 0;
    gl_.getShaderiv(shader, GL_COMPILE_STATUS, &fine);
    if (fine) return shader;
    char buffer[4096] = "";
    gl_.getShaderInfoLog(shader, sizeof buffer, nullptr, buffer);
    log += buffer;
    gl_.deleteShader(shader);
    return 0;
}

GLuint FloatPass::link(const PassJob& job, std::string& log) {
    const GLuint vertex = compile(GL_VERTEX_SHADER, job.vertex, log);
    const GLuint pixel = compile(GL_FRAGMENT_SHADER, job.pixel, log);
    GLint linked = 0;
    GLuint program = 0;
    if (vertex && pixel) {
        program = gl_.createProgram();
        gl_.attachShader(program, vertex);
        gl_.attachShader(program, pixel);
        gl_.linkProgram(program);
        gl_.getProgramiv(program, GL_LINK_STATUS, &linked);
        char buffer[4096] = "";
        if (!linked) gl_.getProgramInfoLog(program, sizeof buffer, nullptr, buffer);
        log += buffer;
    }
    if (vertex) gl_.deleteShader(vertex);
    if (pixel) gl_.deleteShader(pixel);
    if (linked) return program;
    if (program) gl_.deleteProgram(program);
    return 0;
}

void FloatPass::setUniform(GLuint program, const UniformWords& value) {
    const GLint at = gl_.getUniformLocation(program, value.name.c_str());
    if (at < 0) return;
    if (ir::info(value.type).scalar != ir::Scalar::Float) {
        const GLint number = static_cast<GLint>(value.words[0]);
        gl_.uniform1iv(at, 1, &number);
        return;
    }
    std::vector<float> v;
    for (std::uint32_t w : value.words) v.push_back(std::bit_cast<float>(w));
    switch (ir::componentCount(value.type)) {
        case 1:
            gl_.uniform1fv(at, 1, v.data());
            return;
        case 2:
            gl_.uniform2fv(at, 1, v.data());
            return;
        case 3:
            gl_.uniform3fv(at, 1, v.data());
            return;
        case 4:
            gl_.uniform4fv(at, 1, v.data());
            return;
        case 9:
            gl_.uniformMatrix3fv(at, 1, GL_FALSE, v.data());
            return;
        default:
            gl_.uniformMatrix4fv(at, 1, GL_FALSE, v.data());
            return;  // 16: there are no others
    }
}

bool FloatPass::run(const PassJob& job, std::vector<float>& out, std::string& log) {
    const GLuint program = link(job, log);
    if (!program) return false;
    gl_.useProgram(program);
    for (std::size_t i = 0; i < job.textures.size(); i++) {
        const GLint unit = static_cast<GLint>(i);
        gl_.activeTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        gl_.bindTexture(GL_TEXTURE_2D, job.textures[i].texture);
        const GLint at = gl_.getUniformLocation(program, job.textures[i].sampler.c_str());
        if (at >= 0) gl_.uniform1iv(at, 1, &unit);
    }
    for (const UniformWords& u : job.uniforms) setUniform(program, u);
    const std::size_t size = static_cast<std::size_t>(width_ * height_) * 4;
    out.resize(size * static_cast<std::size_t>(job.runs));
    const GLint which = gl_.getUniformLocation(program, job.which.c_str());
    for (GLint k = 0; k < job.runs; k++) {
        if (which >= 0) gl_.uniform1iv(which, 1, &k);
        gl_.drawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT, nullptr);
        gl_.readPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, out.data() + size * static_cast<std::size_t>(k));
    }
    gl_.deleteProgram(program);
    const GLenum error = gl_.getError();
    if (error != GL_NO_ERROR) log += "the driver reports error " + std::to_string(error);
    return error == GL_NO_ERROR;
}

}  // namespace shaderx::table
