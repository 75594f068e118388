// How nodes made of others want their textures read.
#pragma once

#include <string_view>

#include "doc/definitions.h"

namespace shaderx::graph {

// What decides one of the ways in which a texture is read, such as its address mode.
struct HintSource {
    Name input;             // an input of the node, or
    doc::ElementRef fixed;  // an input of a node within, whose value it is; none of both: nothing decides it
};

// Which input of a node of `def` decides what `wanted`, an input of nodes that read textures, is for its file `file`.
// Where a graph implements the node, that is what the graph hands to the node that reads the file, however deep; else
// it is the input of that name.
HintSource hintSource(const doc::Definitions& definitions, doc::NodeDef def, Name file, Name wanted);

// An address mode by the words of MaterialX (constant, clamp, periodic, mirror) and `black`: black and clear beyond the
// picture. USD says repeat for periodic, and useMetadata where the file is to say it, which ours do not: that is black
// (Pixar, UsdPreviewSurface). Other words stay.
std::string_view addressMode(std::string_view word);

}  // namespace shaderx::graph
