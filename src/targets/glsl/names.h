// How GLSL spells types and operations, and the words that it keeps for itself.
#pragma once

#include <string_view>

#include "ir/ops.h"
#include "targets/text/namer.h"

namespace shaderx::glsl {

text::ReservedWords reservedWords();
std::string_view typeName(ir::Type type);
// The built-in function of an operation, or empty where it is none.
std::string_view functionName(ir::Op op);
// The binary operator of an operation and how tightly it binds (higher is tighter), or empty.
struct Operator {
    std::string_view text;
    int precedence = 0;
};
Operator operatorOf(ir::Op op);

}  // namespace shaderx::glsl
