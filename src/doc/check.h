// Finds a document's mistakes, and what in it can be rendered.
#pragma once

#include <vector>

#include "doc/definitions.h"
#include "doc/document.h"

namespace shaderx::doc {

// Reports all mistakes of a document at once, in the order of its lines. `definitions` must have the document
// itself as one of its documents, else its own nodedefs are unknown. True if there are none (warnings may be).
// Errors: missing-name, duplicate-name, missing-attribute, unknown-node, unknown-version, no-signature, unknown-input,
// type-mismatch, bad-value, dangling-nodename, dangling-nodegraph, dangling-output, dangling-interfacename,
// dangling-nodedef, dangling-node, dangling-inherit, dangling-material, dangling-look, cycle, inherit-cycle.
// Warnings: unused-input.
bool validate(const Document& document, const Definitions& definitions, Diagnostics& diagnostics);

// What can be rendered: all material nodes of the document; if there is none,
// all outputs of the document and of its nodegraphs, but for graphs that implement a nodedef; if there is none of these
// either, the outputs of those graphs. In document order.
std::vector<ElementId> renderableElements(const Document& document);

// True if the nodegraph is the implementation of a nodedef (in this document's own words).
bool isFunctional(const Document& document, ElementId graph);

}  // namespace shaderx::doc
