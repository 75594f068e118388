// Values of a document as constants of the IR.
#pragma once

#include <string>
#include <string_view>

#include "ir/builder.h"

namespace shaderx::graph {

// The constant of a type that a value text means, or none where the text is not such a value (then `problem` says why).
// Closures and empty texts give the null value. A matrix is written row by row and multiplies row vectors from the
// right, as MaterialX has it; in the IR, whose vectors are columns, its rows become columns.
ir::ExprId constantOf(ir::Builder& b, ir::Type type, std::string_view text, std::string* problem = nullptr);

// Its bits, for uniforms; empty where it is none or has no numbers.
std::vector<std::uint32_t> wordsOf(ir::Type type, std::string_view text);

}  // namespace shaderx::graph
