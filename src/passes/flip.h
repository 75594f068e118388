// Textures of hosts that load pictures with their top row first.
#pragma once

#include "ir/module.h"

namespace shaderx::passes {

// Makes every read of a texture of the document, in all functions of the module, one at 1 - v. The maps of the
// environment stay as they are: how they lie is a matter of their projection.
void flipTextures(ir::Module& module);

}  // namespace shaderx::passes
