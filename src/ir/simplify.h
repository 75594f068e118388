// Rules that make an expression simpler before it is made. Each keeps the value under the semantics of ops.h.
#pragma once

#include "ir/builder.h"

namespace shaderx::ir {

// False for operations that `simplify` leaves as they are.
inline bool hasRules(Op op) {
    return (op >= Op::GeomProp && op <= Op::Index) || op == Op::Result ||
           (op >= Op::ClosureMix && op <= Op::ClosureLayer);
}

// A simpler or constant expression equal to op(operands), or none. May append to the function.
ExprId simplify(Builder& b, Op op, Type type, std::span<const ExprId> operands, std::uint32_t payload);

}  // namespace shaderx::ir
