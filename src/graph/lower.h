// From the typed graph to IR: each node becomes a call of the function that implements it.
#pragma once

#include <string_view>

#include "graph/graph.h"
#include "ir/module.h"

namespace shaderx::graph {

// Which values of a document become uniforms.
enum class Interface : std::uint8_t {
    Baked,     // none
    Live,      // what the document authors on nodes or exposes on nodegraphs
    Complete,  // every input of every node, authored or not
};

// Finds the function that implements a node. Its parameters are the nodedef's inputs in order, its results the outputs.
class Bodies {
  public:
    virtual ~Bodies() = default;
    // None after reporting why there is none. The module finds the function by that name.
    virtual Name functionOf(doc::NodeDef def, Diagnostics& diagnostics) = 0;
    // Takes the name of a uniform for the whole program; false if it is taken.
    virtual bool takeName(Name name) = 0;
    // The node of a colour transform such as srgb_texture to lin_rec709, or none.
    virtual doc::NodeDef colorTransform(std::string_view from, std::string_view to, ir::Type type) = 0;
    // How many of a type's base units a unit is (of distances: metres), 0 where it is unknown.
    virtual float unitScale(std::string_view type, std::string_view unit) = 0;
    // The node and its input values that a geometric property means (Nworld: <normal> with space = world), as the
    // <geompropdef> element; none where it is unknown.
    virtual doc::ElementRef geometricProperty(Name name) = 0;
    // The node of a category and output type whose inputs are the given ones.
    virtual doc::NodeDef nodeFor(std::string_view category, ir::Type type) = 0;
};

// A value of the document that a node reads, and what became of it. A port of a nodegraph has one for each reader.
struct Authored {
    Name uniform;            // none: the value is part of the program
    doc::ElementId element;  // the input that holds it; none where it is the nodedef's
    doc::ElementId reader;
    doc::NodeDef def;  // of the reader, and its input
    const doc::Port* port = nullptr;
};

struct LowerOptions {
    Interface interface = Interface::Baked;
    std::string_view targetColorSpace = "lin_rec709";
    std::string_view distanceUnit = "meter", angleUnit = "degree";  // what functions get
    std::vector<Authored>* authored = nullptr;  // gets textures and, unless baked, values; null where nobody asks
    bool traces = false;                        // whether expressions say from which node they come
};

// Appends the graph as the function `name` to the module: one result for each of the graph's outputs (only the first
// where `firstOutputOnly`). As the implementation of `implemented`, its parameters are that nodedef's inputs, and it is
// expanded wherever it is called. Values become constants or uniforms named <node>_<input>, those of a nodegraph's
// interface <nodegraph>_<input>; texture files always become uniforms, without any file being touched. Colours and
// textures given in another colour space or unit are transformed. Unconnected inputs take their nodedef's default value
// (a uniform too where the interface is complete) or geometric property; a value in place of a geometric property is a
// warning. Values keep the names of their nodes.
bool lower(const Graph& graph, const doc::Definitions& definitions, Bodies& bodies, doc::NodeDef implemented, Name name,
           const LowerOptions& options, ir::Module& module, Diagnostics& diagnostics);

}  // namespace shaderx::graph
