// Values of a document as constants of the IR.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "doc/definitions.h"
#include "ir/builder.h"

namespace shaderx::graph {

// The bits of a value of a type that has components.
struct Words {
    std::array<std::uint32_t, 16> bits{};
    std::uint32_t count = 0;
    bool isOdd = false;  // not written as the format has it: see doc::parseValue
    std::span<const std::uint32_t> all() const { return {bits.data(), count}; }
};

// Reads a value's text; the empty text is zero. False where the text is not such a value (then `problem` says why) and
// for types without components. A matrix is written row by row and multiplies row vectors from the right, as MaterialX
// has it; in the IR, whose vectors are columns, its rows become columns.
bool readWords(ir::Type type, std::string_view text, Words& words, std::string* problem = nullptr);

// The same as a list, zeros for an empty text; empty where the text is not such a value.
std::vector<std::uint32_t> wordsOf(ir::Type type, std::string_view text);

// The type of a name: one that is built in, or a structure of the documents. What shaders do not have (arrays, names of
// geometry) goes through a program as a text, with which nothing computes. Void for no name.
ir::Type typeOf(const doc::Definitions& definitions, std::string_view name);

// The structures of the documents, as a module holds them.
std::vector<ir::StructType> structsOf(const doc::Definitions& definitions);

// The constant of a structure: "{0.5; {1; 2}}" has a value for each member, and what is missing is the member's
// default. None where the text is no such value.
ir::ExprId structConstant(ir::Builder& b, const doc::Definitions& definitions, ir::Type type, std::string_view text);

// The constant that a value's text means, or none where it means none. Closures and empty texts give the null value.
ir::ExprId constantOf(ir::Builder& b, ir::Type type, std::string_view text);

}  // namespace shaderx::graph
