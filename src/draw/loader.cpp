#include "draw/loader.h"

#include "scene/loader.h"

namespace shaderx::draw {

bool drawWithModule(const Job& job, Diagnostics& diagnostics) {
    const scene::DrawingEntry entry = scene::drawingEntry("shaderx_draw_run", diagnostics);
    return entry && entry(&job, &diagnostics) != 0;
}

}  // namespace shaderx::draw
