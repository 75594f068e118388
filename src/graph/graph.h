// The typed graph below an element: only what is upstream of it, in topological order.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/handle.h"
#include "doc/definitions.h"
#include "doc/document.h"
#include "ir/types.h"

namespace shaderx::graph {

using NodeId = Handle<struct GraphNodeTag>;

// Where an input of a node takes its value from.
struct Source {
    enum class Kind : std::uint8_t {
        Default,    // what the nodedef says: its value or its geometric property
        Value,      // written in the document, at `element`
        Node,       // the output `output` of `node`
        Interface,  // the input `input` of the nodedef that the graph implements
        Geometric,  // the geometric property `input`, which a nodegraph's port stands for
    };
    Kind kind = Kind::Default;
    NodeId node;
    std::uint32_t output = 0;
    doc::ElementId element;  // the <input> that holds the value, or stands for the geometric property
    Name input;
    // The colour space that ports between the value and the node say the value is in: the outermost that says one.
    Name colorspace;
};

struct Input {
    const doc::Port* port = nullptr;  // of the nodedef
    ir::Type type = ir::Type::Void;
    Source source;
};

// What all nodes of one definition have in common.
struct NodeKind {
    doc::NodeDef def;
    std::span<const doc::Port> inputs, outputs;  // of the nodedef
};

struct Node {
    doc::ElementId element;
    std::uint32_t kind = 0;        // of Graph::kinds
    std::uint32_t firstInput = 0;  // in the order of the nodedef
};

struct Output {
    Name name;
    ir::Type type;
    Source source;
    doc::ElementId element;  // the <output>, or the node whose output it is
};

// Nodes come after all nodes that they depend on.
struct Graph {
    const doc::Document* document;
    std::vector<NodeKind> kinds;
    std::vector<Node> nodes;
    std::vector<Input> inputs;
    std::vector<Output> outputs;
    std::vector<doc::ElementId> visited;  // nodes and ports upstream, those that could not be built too
    doc::NodeDef interface;  // of which Interface sources are inputs: that of the implementation that this is, or is in
    bool isExact = true;     // all upstream is written as it ought to be; else the check of the document knows more
    bool unknownIsDefault = false;  // to be set before: what reads a node that nothing defines takes its default
    const NodeKind& kindOf(const Node& n) const { return kinds[n.kind]; }
    std::span<const Input> inputsOf(const Node& n) const {
        return {inputs.data() + n.firstInput, kindOf(n).inputs.size()};
    }
};

// Builds the graph below an element: a node (all its outputs, or the one that is named), an <output>, or a nodegraph
// (all its outputs). In the implementation of a nodedef, inputs of the nodedef that the nodegraph does not have itself
// stay open (Interface). Everything upstream is followed without recursion; a cycle is an error that tells its path; a
// node without a nodedef is an error.
// White paper 2.4, steps 1 to 3.
bool build(const doc::Document& document, doc::ElementId element, const doc::Definitions& definitions, Graph& graph,
           Diagnostics& diagnostics);

// As text, for --dump=graph.
std::string print(const Graph& graph, const doc::Definitions& definitions);

}  // namespace shaderx::graph
