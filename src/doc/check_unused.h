// Finds what nothing reads. (Part of checking; not for other rooms.)
#pragma once

#include <vector>

#include "doc/check_cycles.h"
#include "doc/document.h"
#include "doc/findings.h"

namespace shaderx::doc {

// Reports inputs of nodegraphs, nodes and outputs that nothing reads and that are not rendered themselves. `isRead`
// has, by element index, the inputs that an interfacename names.
void reportUnused(const Document& document, const Resolved& resolved, const std::vector<bool>& isRead,
                  Findings& findings);

}  // namespace shaderx::doc
