// Specialisation: what is constant folds, what cannot contribute goes, functions are cloned on constant arguments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/diagnostics.h"
#include "base/hash.h"
#include "ir/module.h"

namespace shaderx::passes {

// Specialised functions of libraries, kept for the next material: those of one document have much in common. Names in
// them are of one table, functions are found in the same libraries. What is made with them has the same bytes as what
// is made without.
struct Specialisations {
    // Of which function a clone is, and for which arguments.
    using Key = std::vector<std::uint32_t>;
    struct KeyHash {
        std::size_t operator()(const Key& key) const noexcept { return hashWords(key); }
    };
    struct Clone {
        ir::Function function;  // without a name if it is small enough to be expanded
        Name stem;              // of the function that it is a clone of
        const Key* key = nullptr;
    };
    std::unordered_map<Key, Clone, KeyHash> byKey;
    std::vector<const Clone*> named;

    void clear() {
        named.clear();
        byKey.clear();
    }
};

// How far calls may expand before that is an error.
struct ExpansionLimits {
    std::uint32_t depth = 128;           // calls within calls
    std::size_t expressions = 1u << 20;  // of the functions called, counted for each call
};

// Rebuilds the module's function `entry` and, as clones of their own, all functions that it calls:
// - small functions, those marked inline and those with derivatives or closures expand where they are called;
// - any other call goes to a clone made for its constant arguments and for vectors that repeat one scalar (so that an
//   isotropic roughness is known to be one); clones for equal arguments are one, and clones that would differ in
//   numbers alone are one that takes the numbers;
// - uniforms named in `baked` become constants of their default values;
// - `known` becomes true where its operand is, else false.
// Afterwards every function that the entry reaches belongs to the module. A function that is missing, or an
// expansion beyond the limits, is an error.
bool specialise(ir::Module& module, Name entry, const std::unordered_set<Name>& baked, Specialisations& made,
                Diagnostics& diagnostics, const ExpansionLimits& limits = {});
bool specialise(ir::Module& module, Name entry, const std::unordered_set<Name>& baked, Diagnostics& diagnostics);

// Expands in a function of a library what specialise would expand whatever the arguments are: done once, when the
// library is made, it is not done for every material.
void flatten(ir::Module& module, ir::Function& function);

}  // namespace shaderx::passes
