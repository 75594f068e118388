// Removes what nobody uses: functions, their parameters and results, expressions.
#pragma once

#include <span>

#include "ir/module.h"

namespace shaderx::passes {

// Keeps what the entries need. Their own parameters and results stay; other functions lose parameters that they do not
// read and results that nobody reads, and the calls follow. Functions end up callees first, entries last.
void prune(ir::Module& module, std::span<const Name> entries);

}  // namespace shaderx::passes
