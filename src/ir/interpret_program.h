// What the interpreter makes of a function: instructions over a frame of registers.
#pragma once

#include <cstdint>
#include <vector>

#include "base/diagnostics.h"
#include "ir/module.h"

namespace shaderx::ir {

enum class Code : std::uint8_t {
    Execute,      // destination = op(operands), see evaluate.h
    Fetch,        // destination = context, attribute or uniform
    Texture,      // a read or the size
    Derivative,   // the quad's
    Call,         // destination = the callee's results, one after the other
    Copy,         // `words` words from operand 0
    Jump,         // to target
    JumpIfFalse,  // to target if operand 0 is false
    LoopTest,     // to target unless operand 0 (the index) is less than operand 1 (the count)
    LoopNext,     // adds 1 to the index at destination, then to target
    Return,
};

// Where a value is: a word of the frame, or of the constants where the top bit is set.
using Slot = std::uint32_t;
constexpr Slot kConstantSlot = 0x80000000u;

struct Source {
    Type type = Type::Void;
    Slot slot = 0;
};

struct Program;

struct Instruction {
    Code code = Code::Return;
    Op op = Op::Constant;
    Type type = Type::Void;
    Slot destination = 0;
    std::uint32_t firstSource = 0, sourceCount = 0;
    std::uint32_t payload = 0;
    std::uint32_t target = 0;  // of jumps; words of a copy; number in Module::uniforms of a uniform
    ExprId expr;               // for messages
};

struct Program {
    const Function* function = nullptr;
    std::vector<Instruction> code;
    std::vector<Source> sources;
    std::vector<std::uint32_t> constants;
    std::uint32_t frameWords = 0;  // the parameters come first
    std::vector<Source> results = {};
    std::vector<Program*> callees = {};  // of calls, by instruction; null until the first call
};

// Words of a value in a frame: the components, 2 of an image (kind, number), 0 of what cannot be computed.
std::uint32_t frameWords(Type type);

// Whether running the function takes derivatives, in it or in what it calls.
bool takesDerivatives(const Module& module, const Function& function);

// Translates a valid function. False where it needs what the interpreter does not run.
bool translate(const Module& module, const Function& function, Diagnostics& diagnostics, Program& program);

}  // namespace shaderx::ir
