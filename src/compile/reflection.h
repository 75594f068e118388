// What an application needs to know of a generated shader to bind it, as JSON.
#pragma once

#include <string>
#include <unordered_map>

#include "ir/module.h"
#include "passes/stages.h"

namespace shaderx {

// An object with `element`, `output`, `uniforms` (name, type, default value, document path, kind, stages), `samplers`
// (name, document path, file, address and filter modes, colour space) and `inputs` of the vertex stage.
// `spelled` gives the names as the texts have them, by their names in the module.
std::string reflect(const ir::Module& module, const passes::ShaderInterface& interface, std::string_view element,
                    const std::unordered_map<Name, std::string>& spelled, std::string_view output);

}  // namespace shaderx
