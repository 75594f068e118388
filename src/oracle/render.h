// Draws a material's program on the CPU, as a driver would draw its text: the same sphere, camera, sky, textures and
// interpolation as in draw/, shaded by the interpreter of the IR. Where the two pictures differ, one of them is wrong.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "base/diagnostics.h"
#include "base/result.h"
#include "image/image.h"
#include "ir/module.h"
#include "passes/stages.h"
#include "scene/settings.h"

namespace shaderx::oracle {

struct RenderJob : scene::Settings {
    // A program whose stages are made. Must not change while it is drawn.
    const ir::Module* module = nullptr;
    const passes::ShaderInterface* interface = nullptr;
    int threads = 0;  // 0: as many as the machine has cores; the picture does not depend on it
    // Told now and then, on the caller's thread, how many of how many batches of pixels are shaded; may be empty.
    std::function<void(std::size_t done, std::size_t all)> progress = {};
};

// What many pictures share: the sphere, and the built-in sky, made when a job first needs it. Serves one thread.
class Studio {
  public:
    Studio();
    ~Studio();
    // Linear float RGBA, colours multiplied by coverage, top row first.
    // Errors: bad-size, what the interpreter reports, and readImage's for the environment. Warnings: missing-texture
    // (the default colour is drawn), unbound-sampler (white is drawn), unbound-attribute, unused-uniform,
    // bad-uniform-value.
    Result<image::Image> render(const RenderJob& job, Diagnostics& diagnostics);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// The same in a studio for this one job.
Result<image::Image> render(const RenderJob& job, Diagnostics& diagnostics);

// Draws and writes job.output. Also errors: unknown-output-format, cannot-write-file.
bool draw(const RenderJob& job, Diagnostics& diagnostics);

}  // namespace shaderx::oracle
