// Specialisation: what is constant folds, what cannot contribute goes, functions are cloned on constant arguments.
#pragma once

#include <unordered_set>

#include "base/diagnostics.h"
#include "ir/module.h"

namespace shaderx::passes {

// Rebuilds the module's function `entry` and, as clones of their own, all functions that it calls:
// - small functions, those marked inline and those with derivatives or closures expand where they are called;
// - any other call goes to a clone made for its constant arguments and for vectors that repeat one scalar (so that an
//   isotropic roughness is known to be one); clones for equal arguments are one, and clones that would differ in
//   numbers alone are one that takes the numbers;
// - uniforms named in `baked` become constants of their default values;
// - `known` becomes true where its operand is, else false.
// Afterwards every function that the entry reaches belongs to the module. A function that is missing, or a nest of
// calls too deep, is an error.
bool specialise(ir::Module& module, Name entry, const std::unordered_set<Name>& baked, Diagnostics& diagnostics);

// Expands in a function of a library what specialise would expand whatever the arguments are: done once, when the
// library is made, it is not done for every material.
void flatten(ir::Module& module, ir::Function& function);

}  // namespace shaderx::passes
