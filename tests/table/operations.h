// The operations of ops.def as subjects.
#pragma once

#include "table/check.h"

namespace shaderx::table {

// Operations that this table does not run, with the reason; empty for all others.
std::string_view exemption(ir::Op op);

// One subject for each way in which an operation meets types: all that `resultType` and the interpreter accept, and
// for the operations of given type, those that the sources of nodes can produce. The functions are added to `program`.
std::vector<Subject> operations(ir::Module& program);

}  // namespace shaderx::table
