// Drawing for a program that does not link the picture and graphics libraries: they stand in a module that is loaded
// when a picture is asked for.
#pragma once

#include "base/diagnostics.h"
#include "draw/job.h"

namespace shaderx::draw {

// Context::draw by the module libshaderx_draw.so, sought beside the running program and in ../lib. Also reports
// no-module.
bool drawWithModule(const Job& job, Diagnostics& diagnostics);

}  // namespace shaderx::draw
