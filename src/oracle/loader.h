// Drawing by the interpreter for a program that does not link the picture libraries.
#pragma once

#include "base/diagnostics.h"
#include "oracle/render.h"

namespace shaderx::oracle {

// draw() by the drawing module. Also reports no-module.
bool drawWithModule(const RenderJob& job, Diagnostics& diagnostics);

}  // namespace shaderx::oracle
