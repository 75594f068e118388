// How nodes made of others want their textures read.
#pragma once

#include <string_view>
#include <vector>

#include "doc/definitions.h"

namespace shaderx::graph {

// What decides one of the ways in which a texture is read, such as its address mode.
struct HintSource {
    Name input;             // an input of the node, or
    doc::ElementRef fixed;  // an input of a node within, whose value it is; none of both: nothing decides it
};

// The node that reads the file `file` of a node of `def`: the node itself or, where a graph implements it, the one that
// the graph hands the file to, however deep.
class TextureReader {
  public:
    TextureReader(const doc::Definitions& definitions, doc::NodeDef def, Name file);
    // Which input of the outermost node decides what `wanted`, an input of nodes that read textures, is: what the
    // graphs hand on, else the input of that name.
    HintSource source(Name wanted) const;

  private:
    std::vector<doc::ElementRef> within_;  // the nodes on the way to the one that reads the file, outermost first
};

// An address mode by the words of MaterialX (constant, clamp, periodic, mirror) and `black`: black and clear beyond the
// picture. USD says repeat for periodic, and useMetadata where the file is to say it, which ours do not: that is black
// (Pixar, UsdPreviewSurface). Other words stay.
std::string_view addressMode(std::string_view word);

}  // namespace shaderx::graph
