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

// What a scene's numbers mean.
struct SceneConventions {
    std::string_view colorspace = "lin_rec709";                     // the working space: what shading computes in
    std::string_view distanceUnit = "meter", angleUnit = "degree";  // what functions get
};

// The colour space of a file that a node is given.
struct FileSpace {
    Name name;  // none where nothing says it
    bool isExplicit =
        false;  // said by a port; else of the scope that the file is written in, where a port within may differ
};

// How an instance of a node differs from others of its nodedef, before it is a function: by what is no value of the
// program. For each input the space of its file, as far as any has one; and what tokens in file names stand for.
struct Instance {
    std::span<const FileSpace> files;
    std::span<const std::pair<Name, Name>> tokens;
};

// A conversion between colour spaces.
struct ColorConversion {
    Name function;        // of a color3 or color4; none where there is nothing to do
    bool isKnown = true;  // are both spaces known?
};

constexpr int kUsualSets =
    8;  // of texture coordinates or colours, among which functions of known nodes choose by index

// Finds the function that implements a node. Its parameters are the nodedef's inputs in order, its results the outputs.
class Bodies {
  public:
    virtual ~Bodies() = default;
    // None after reporting why there is none. The module finds the function by that name.
    virtual Name functionOf(doc::NodeDef def, Diagnostics& diagnostics) = 0;
    // The function of an instance that has files. What it reads of a file is already in the working space of the scene,
    // where `decodes` says so; else the caller has to convert the colours that it gives.
    virtual Name instanceOf(doc::NodeDef def, const Instance& instance, bool& decodes, Diagnostics& diagnostics) = 0;
    // Takes the name of a uniform for the whole program; false if it is taken.
    virtual bool takeName(Name name) = 0;
    // The function of a node that reads one of the mesh's sets: made for an index that is beyond the usual ones, or
    // below 0 where it is not known and may be beyond.
    virtual Name setOf(doc::NodeDef def, int index, Diagnostics& diagnostics) = 0;
    // From a colour space to the working space of the scene.
    virtual ColorConversion toWorkingSpace(Name from, ir::Type type, Diagnostics& diagnostics) = 0;
    // A known space that an unknown name may mean, or none.
    virtual std::string_view nearestColorSpace(std::string_view name) = 0;
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
    SceneConventions scene;
    Instance instance;                          // of the node that the graph implements
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
