// Which values decide the shape of a shader, so that they are baked while all others stay live.
#pragma once

#include <unordered_set>
#include <vector>

#include "ir/evaluate.h"
#include "ir/module.h"

namespace shaderx::passes {

// Uniforms of the module whose default value lets something vanish from the entry: a weight of exactly 0 or 1 that
// removes a closure, a condition that removes a branch, a bound that removes a loop; and all booleans and integers that
// bound loops. Found by folding with the defaults and walking back from what vanished to the uniforms that
// made it vanish: a product that is 0 is so because of its factors that are 0. `entry` must be specialised.
std::unordered_set<Name> topologyUniforms(const ir::Module& module, const ir::Function& entry);

// Integers that choose which attributes of the mesh the entry reads: those must be known when the vertex inputs are
// declared, of which no device has enough for all sets. `entry` must be specialised.
std::unordered_set<Name> attributeUniforms(const ir::Module& module, const ir::Function& entry);

// What each expression is by the defaults of all uniforms; of type Void where these do not decide it.
std::vector<ir::Value> valuesByDefault(const ir::Module& module, const ir::Function& f);

}  // namespace shaderx::passes
