// Several calls of a long function become one loop over those that are needed.
#pragma once

#include "ir/module.h"

namespace shaderx::passes {

// True for a function that itself runs a loop: the one kind of work that is worth skipping on every machine. (Machines
// that compute many pixels at once run both sides of a branch where any pixel takes it, some wherever one stands; all
// of them end a loop that no pixel continues.)
bool holdsLoop(const ir::Function& f);
bool readsImage(const ir::Function& f);
// True if this holds for the function or any that it calls, directly or not.
bool leadsTo(const ir::Module& module, const ir::Function& f, bool (*what)(const ir::Function&));

// Finds the function's calls of functions that hold a loop, and under which conditions their results are needed: those
// of the selects on every way from a call to a result of the entry. Calls of one function become one loop, whose turns
// are the calls that are needed, in their order:
//
//     int calls = int(a) + int(b);                        how many
//     int last = -1;
//     for (int i = 0; i < calls; i++) {
//         int which = a && last < 0 ? 0 : 1;              the next
//         x = f(which == 0 ? of_first : of_second, …);
//         last = which;
//         first = which == 0 ? x : first;                 what is not called stays 0
//         second = which == 1 ? x : second;
//     }
//
// Calls of another function each of which serves one of these calls alone become a loop of at most one turn inside, or,
// where that function chooses itself whether to run its loops, one call in every turn.
//
// A call that is needed under a condition, and whose function is called once, becomes a loop of at most one turn. What
// is needed always, and calls that need each other's results, stay as they are. A select that gave 0 where its call is
// not needed goes. Where a condition has a name, what it decides is called after it: has_NAME, is_NAME. `entry` is
// one of the module's own functions.
void gather(ir::Module& module, Name entry);

}  // namespace shaderx::passes
