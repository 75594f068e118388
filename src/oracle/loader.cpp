#include "oracle/loader.h"

#include "scene/loader.h"

namespace shaderx::oracle {

bool drawWithModule(const RenderJob& job, Diagnostics& diagnostics) {
    const scene::DrawingEntry entry = scene::drawingEntry("shaderx_oracle_run", diagnostics);
    return entry && entry(&job, &diagnostics) != 0;
}

}  // namespace shaderx::oracle
