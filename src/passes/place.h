// Decides where each value is computed, and which values get a name.
#pragma once

#include "ir/module.h"

namespace shaderx::passes {

struct PlaceOptions {
    // The function is the entry of a stage: images read with the derivatives of their coordinates, at its outermost
    // level, do not need these derivatives as values (a target may read them with its own implicit ones).
    bool isEntry = false;
    // An expression whose text would be longer than this many characters is split by naming parts of it.
    int longestText = 120;
    // To know how long names are.
    const NameTable* names = nullptr;
};

// Fills the function's body. Every value that more than one expression uses is computed once, at the nearest point that
// dominates its uses, outside of loops that it does not change with, and inside the branch if only that branch uses it.
// Selects become branches where a side holds a loop or much work of its own, else they stay expressions.
// After Click, Global Code Motion / Global Value Numbering (1995): schedule late, then leave loops.
void place(ir::Function& function, const PlaceOptions& options);

// True for values that cost nothing to name again: constants, parameters, uniforms, loop arguments, results.
bool isFree(const ir::Function& f, ir::ExprId e);

}  // namespace shaderx::passes
