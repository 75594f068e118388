// Finds a document's mistakes, and what in it can be rendered.
#pragma once

#include <vector>

#include "doc/definitions.h"
#include "doc/document.h"
#include "doc/findings.h"

namespace shaderx::doc {

struct CheckOptions {
    bool unknownIsDefault = false;  // nodes that nothing defines are warnings
    bool isLibrary = false;         // whose implementations may say what only the library's may
};

// All mistakes of a document at once, in the order of its lines, and which elements they are about. `definitions` must
// have the document itself as one of its documents, else its own nodedefs are unknown.
// Errors: missing-name, duplicate-name, missing-attribute, reserved-attribute, unknown-node, unknown-version,
// unknown-type, no-signature, unknown-input, type-mismatch, bad-value, dangling-nodename, dangling-nodegraph,
// dangling-output, dangling-interfacename, dangling-nodedef, dangling-node, dangling-inherit, dangling-material,
// dangling-look, cycle, inherit-cycle.
// Warnings: odd-value, unknown-choice, ignored-element, unused-input, unused-node, unused-output.
std::vector<Finding> findMistakes(const Document& document, const Definitions& definitions,
                                  const CheckOptions& options = {});

// The same as messages. True if no error is among them.
bool validate(const Document& document, const Definitions& definitions, Diagnostics& diagnostics,
              const CheckOptions& options = {});

// What can be rendered: all material nodes of the document; if there is none,
// all outputs of the document and of its nodegraphs, but for graphs that implement a nodedef; if there is none of these
// either, the outputs of those graphs. In document order.
std::vector<ElementId> renderableElements(const Document& document);

// What a document has that looks like something to render, and why it is none: as the notes of an error where nothing
// else is to be rendered (nothing-to-render), otherwise as warnings (unrendered-material).
void reportUnrendered(const Document& document, bool isAll, Diagnostics& diagnostics);

// True if the nodegraph is the implementation of a nodedef (in this document's own words).
bool isFunctional(const Document& document, ElementId graph);

}  // namespace shaderx::doc
