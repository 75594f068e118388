// Draws a vertex and pixel shader of GLSL off-screen, on a sphere under a sky, with whatever driver the machine has.
//
// The scene: a unit sphere of 128 × 64 patches at the origin, y up, seen from (0, 0, 4) with a field of view of 35°,
// the background cleared to 0. Uniforms and attributes are bound by the names of the MaterialX white paper's Figure 7
// ("MaterialX: Physically Based Shading Ecosystem"): the matrices, u_viewPosition, u_viewDirection, the environment
// maps with u_envMatrix a half turn about y, no light sources. A uniform that nothing sets keeps the default of the
// shader's text.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "draw/job.h"
#include "image/image.h"

namespace shaderx::draw {

// What a driver finds in use once a pair of shaders is linked, each list in the order of names; types as GLSL spells
// them.
struct Active {
    struct Variable {
        std::string name, type;
        std::string block;  // of a uniform that stands in one
        int offset = 0;     // there, in bytes
        friend bool operator==(const Variable&, const Variable&) = default;
    };
    std::vector<Variable> uniforms, inputs;
};

// How long a job takes, in milliseconds; of frames, the median.
struct Timing {
    double compile = 0;  // compiling, linking and the first frame
    double frame = 0;    // from the first command until the driver says that all is done
    double device = -1;  // the part of that which the device spends on drawing, by its own clock; below 0: it has none
};

// A driver with a context of its own and what all jobs share. Drawing makes the context current on the calling thread.
class Context {
  public:
    // Loads the driver. None after reporting no-driver.
    static std::unique_ptr<Context> create(Diagnostics& diagnostics);
    ~Context();

    // Draws one job: linear float RGBA, colours multiplied by coverage, top row first.
    // Errors: driver-rejected (with the driver's log), bad-size, driver-error, and readImage's for the environment.
    // Warnings: missing-texture (the default colour is drawn), unbound-sampler (white is drawn), unbound-attribute,
    // unbound-block (a value in a block stays 0), unused-uniform, bad-uniform-value, texture-reduced.
    Result<image::Image> render(const Job& job, Diagnostics& diagnostics);
    // Draws and writes job.output. Also errors: unknown-output-format, cannot-write-file.
    bool draw(const Job& job, Diagnostics& diagnostics);

    // Links a pair of shaders and asks what is left of its interface. Errors: driver-rejected, driver-error.
    Result<Active> active(const std::string& vertex, const std::string& pixel, Diagnostics& diagnostics);

    // Draws jobs of one size in turn, each as often as `frames` says. Errors as of render.
    Result<std::vector<Timing>> measure(std::span<const Job> jobs, int frames, Diagnostics& diagnostics);

    // The driver's name for itself.
    const std::string& renderer() const;

  private:
    struct State;
    explicit Context(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// The same with a context for this one job.
Result<image::Image> render(const Job& job, Diagnostics& diagnostics);
bool draw(const Job& job, Diagnostics& diagnostics);

}  // namespace shaderx::draw
