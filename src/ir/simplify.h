// Rules that make an expression simpler before it is made. Each keeps the value under the semantics of ops.h.
#pragma once

#include "ir/builder.h"

namespace shaderx::ir {

// A simpler or constant expression equal to op(operands), or none. May append to the function.
ExprId simplify(Builder& b, Op op, Type type, std::span<const ExprId> operands, std::uint32_t payload);

}  // namespace shaderx::ir
