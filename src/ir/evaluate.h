// The value of an operation on constant operands.
#pragma once

#include <cstdint>
#include <span>

#include "ir/ops.h"

namespace shaderx::ir {

// Numbers of one value: floats and integers by their bits, booleans 0 or 1. A matrix column by column.
struct Value {
    Type type = Type::Void;
    std::uint32_t words[16] = {};

    float f(int i) const;
    int i(int i) const { return static_cast<int>(words[i]); }
    bool b() const { return words[0] != 0; }
    void set(int i, float v);
};

// Where the words of an operand are.
struct Operand {
    Type type = Type::Void;
    const std::uint32_t* words = nullptr;
};

// Evaluates an operation that needs nothing but its operands' values (arithmetic, functions, comparison, composition).
// False where the operation is not of that kind (contexts, images, calls, loops, closures, strings) or where folding
// must not happen because the result is not finite. Floats are rounded as binary32 at every step.
bool evaluate(Op op, Type type, std::span<const Operand> operands, std::uint32_t payload, Value& result);
bool evaluate(Op op, Type type, std::span<const Value> operands, std::uint32_t payload, Value& result);

// The same for running programs, which nothing stops: results may be infinite or NaN, integers divided by 0 give 0, a
// float too large for an integer gives the nearest one, an index out of range the nearest component. `result` has room
// for the components of `type` and does not overlap the operands.
bool execute(Op op, Type type, std::span<const Operand> operands, std::uint32_t payload, std::uint32_t* result);

}  // namespace shaderx::ir
