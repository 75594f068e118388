// Textures whose colours are in another space than the one that shading works in.
#pragma once

#include <span>

#include "ir/module.h"

namespace shaderx::passes {

// True where a function reads one texture in one place: converting what it gives is as good as converting what it
// reads.
bool isPlainRead(const ir::Function& function);

// A copy of a function, named after it and the conversions, in which every read of a texture that is a parameter is
// converted: `conversions[k]` is the name of a function from color4 to color4 for parameter k, or none. Calls that hand
// such a texture on go to such copies in turn. The module finds all functions named and owns the copies. None where
// something is missing.
Name decodeReads(ir::Module& module, Name function, std::span<const Name> conversions);

}  // namespace shaderx::passes
