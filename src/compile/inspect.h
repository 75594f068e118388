// What the compiler knows of a material, as text for people and as JSON for programs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "passes/cost.h"
#include "passes/lobes.h"

namespace shaderx {

// Of one element, what was asked for.
struct Inspection {
    std::string element;
    std::optional<std::vector<passes::Lobe>> lobes;
    std::optional<std::vector<passes::NodeCost>> costs;
    std::optional<std::vector<std::string>> withoutEffect;  // as Shader has it
};

std::string inspectionText(std::span<const Inspection> found);
std::string inspectionJson(std::span<const Inspection> found);

}  // namespace shaderx
