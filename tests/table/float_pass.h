// Runs pixel shaders off-screen over a rectangle of floats.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "draw/driver.h"
#include "ir/types.h"

namespace shaderx::table {

// A uniform's value by its bits, matrices column by column. Names that the shader does not have are passed over.
struct UniformWords {
    std::string name;
    ir::Type type = ir::Type::Float;
    std::vector<std::uint32_t> words;
};
struct SampledTexture {
    std::string sampler;
    GLuint texture = 0;
};

// What to run. The vertex stage gets a triangle that covers everything, its corners told by gl_VertexID.
struct PassJob {
    std::string vertex, pixel;
    std::vector<SampledTexture> textures;
    std::vector<UniformWords> uniforms;
    std::string which;  // an integer uniform that is 0, 1, … in one run after the other
    int runs = 1;
};

class FloatPass {
  public:
    // Null where there is no driver; `reason` says why.
    static std::unique_ptr<FloatPass> open(int width, int height, std::string& reason);
    ~FloatPass();
    FloatPass(const FloatPass&) = delete;
    FloatPass& operator=(const FloatPass&) = delete;

    // One level of RGBA floats, the row at v = 0 first, repeating.
    GLuint addTexture(int width, int height, std::span<const float> rgba, bool linear);
    void removeTexture(GLuint texture);

    // Runs the job: RGBA of every pixel of every run, bottom row first. False where the driver refuses the shader;
    // `log` tells why.
    bool run(const PassJob& job, std::vector<float>& out, std::string& log);

    const std::string& renderer() const { return driver_->renderer; }

  private:
    FloatPass(std::unique_ptr<draw::Driver> driver, int width, int height);
    GLuint compile(GLenum stage, const std::string& text, std::string& log);
    GLuint link(const PassJob& job, std::string& log);
    void setUniform(GLuint program, const UniformWords& value);

    std::unique_ptr<draw::Driver> driver_;
    const draw::Gl& gl_;
    int width_, height_;
    GLuint array_ = 0, indices_ = 0, target_ = 0, framebuffer_ = 0;
};

}  // namespace shaderx::table
