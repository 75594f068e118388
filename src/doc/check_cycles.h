// Finds connections that go round. (Part of checking; not for other rooms.)
#pragma once

#include <vector>

#include "doc/definitions.h"
#include "doc/document.h"
#include "doc/findings.h"

namespace shaderx::doc {

// What checking has resolved, by element index.
struct Resolved {
    std::vector<ElementId> targets;  // of a port: the node, output or input that it reads; none if by value
    std::vector<NodeDef> nodedefs;   // of a node: what it is; of a nodegraph: what it implements
};

// Reports each cycle among nodes once, through nodegraphs too, with its path: "a → b → a".
void reportCycles(const Document& document, const Resolved& resolved, Findings& findings);

// Reports nodegraphs that use, directly or not, the very node that they implement, and nodedefs that inherit in a ring.
void reportRecursiveDefinitions(const Document& document, const Definitions& definitions, const Resolved& resolved,
                                Findings& findings);

}  // namespace shaderx::doc
