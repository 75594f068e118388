// Whether a program keeps the rules of ops.h and module.h.
//
// Operands stand before their users, in the number and of the types that the operation asks for; payloads name what
// there is; calls fit their callees; what a loop carries keeps its type, and its arguments are used inside it alone; a
// body computes everything before it is used. A broken rule is a bug of ours: an internal diagnostic, code
// "invalid-ir", that quotes the line of the program with carets below the operand in question.
#pragma once

#include "base/diagnostics.h"
#include "ir/module.h"

namespace shaderx::ir {

// True where the function keeps the rules.
bool validate(const Module& module, const Function& function, Diagnostics& diagnostics);
// All the module owns; not the functions of its sources.
bool validate(const Module& module, Diagnostics& diagnostics);

}  // namespace shaderx::ir
