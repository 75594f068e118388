// The module that holds what drawing needs: programs that do not link the picture and graphics libraries load it when a
// picture is asked for.
#pragma once

#include "base/diagnostics.h"

namespace shaderx::scene {

// A door of libshaderx_draw.so, sought beside the running program and in ../lib: a function that takes a job and the
// diagnostics and returns whether all went well. Null after reporting no-module. Both sides are built together, so C++
// types may pass through it.
using DrawingEntry = int (*)(const void* job, void* diagnostics);
DrawingEntry drawingEntry(const char* name, Diagnostics& diagnostics);

}  // namespace shaderx::scene
