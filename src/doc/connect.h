// What the ports of a document are connected to.
#pragma once

#include "doc/document.h"

namespace shaderx::doc {

// Where an <input>, or an <output> of a graph or document, takes its value from.
struct Connection {
    enum class Kind : std::uint8_t {
        None,       // by value or default
        Node,       // target: the node; output: which one, may be none
        Output,     // target: an <output> of a nodegraph or of the scope
        Interface,  // target: the <input> of the surrounding nodegraph, none if only its nodedef may have it
        Dangling,   // `attribute` names nothing
    };
    Kind kind = Kind::None;
    ElementId target;
    Name output;     // as written
    Name attribute;  // what makes the connection: nodename, nodegraph, output or interfacename
    // What the port says beside it, none where it does not.
    Name value, colorspace, defaultgeomprop;
};

// Resolves the connection of a port. Names are looked up beside the node (for its inputs), beside the graph (for a
// nodegraph's inputs) or in the graph (for its outputs), in the port's namespace first. A nodegraph without a chosen
// output means its first one.
Connection connection(const Document& document, ElementId port);

// The <nodegraph> or root that the element stands in.
ElementId scopeOf(const Document& document, ElementId element);

// True for the elements that are nodes: children of the root or of a nodegraph with any category that the format does
// not itself use (nodedef, look, input, …).
bool isNode(const Document& document, ElementId element);

}  // namespace shaderx::doc
