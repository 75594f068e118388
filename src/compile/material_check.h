// What a material is missing, and what of it is not drawn.
#pragma once

#include "base/diagnostics.h"
#include "doc/document.h"
#include "graph/graph.h"

namespace shaderx {

// False if the graph's first output is a material none of whose shaders is connected. Warnings: no-shader (the shader
// is to come through a port of the graph that it is in: alone it is black), ignored-shader (displacement, a volume, the
// surface of the back).
bool checkMaterial(const doc::Document& document, const graph::Graph& graph, Diagnostics& diagnostics);

}  // namespace shaderx
