// What the wide interpreter runs: one list of instructions over registers of 64 lanes and words that serve all lanes.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "ir/interpret_wide.h"

namespace shaderx::ir {

// Where one component is: a register, or a word that serves all lanes where the top bit is set.
using Ref = std::uint32_t;
constexpr Ref kUniformRef = 0x80000000u;
constexpr bool isUniform(Ref r) { return (r & kUniformRef) != 0; }

// Operands are a, b, c, d.
enum class WideOp : std::uint8_t {
    // Control. The uniform ones decide for all lanes at once and leave the mask as it is.
    Jump,           // to target
    JumpIfFalse,    // to target if the word a is false
    LoopTest,       // to target unless word a (the index) is less than word b (the count)
    LoopNext,       // adds 1 to the index, word a, then to target
    If,             // goes on with the lanes where register a holds; if none, those where not, from target
    Else,           // with the other lanes; to target if there are none
    EndIf,          // with all lanes as before the If
    LoopEnter,      // keeps the mask for LoopExit
    LoopTestLanes,  // goes on with the lanes where a is less than b (registers or words); to target if there are none
    LoopNextLanes,  // adds 1 to register a, then to target
    LoopExit,
    // Values
    UniformExecute,  // words from dest on = op(operands), see evaluate.h
    UniformFetch,    // words from dest on = context or uniform
    UniformMove,     // word dest = word a
    UniformTextureSize,
    LaneExecute,  // registers from dest on = op(operands), lane by lane
    LaneFetch,    // registers from dest on = context or attribute
    Texture,      // registers from dest on = a read
    LaneTextureSize,
    Ddx,
    Ddy,
    Broadcast,   // register dest = word a
    Move,        // register dest = register a
    MoveMasked,  // the same in the lanes that run
    Select,      // a ? b : c, any words
    FMulSub,     // a * b - c * d
#define FLOATS1(name, value) name,
#define FLOATS2(name, value) name,
#define FLOATS3(name, value) name,
#define FUNCTION1(name, value) name,
#define FUNCTION2(name, value) name,
#define WORDS1(name, value) name,
#define WORDS2(name, value) name,
#define COMPARE(name, value) name,
#include "ir/interpret_wide.def"
#undef FLOATS1
#undef FLOATS2
#undef FLOATS3
#undef FUNCTION1
#undef FUNCTION2
#undef WORDS1
#undef WORDS2
#undef COMPARE
};

struct WideInstruction {
    WideOp op = WideOp::Jump;
    Op irOp = Op::Constant;
    Type type = Type::Void;
    std::uint32_t dest = 0;
    Ref a = 0, b = 0, c = 0, d = 0;
    std::uint32_t target = 0;       // of jumps; of a uniform its number in WideCode::uniforms
    std::uint32_t firstSource = 0;  // in WideCode::sources
    std::uint32_t sourceCount = 0;
    std::uint32_t payload = 0;
    std::uint32_t origin = 0;  // in WideCode::origins
};

// An operand of several components: refs[firstRef … + components).
struct WideSource {
    Type type = Type::Void;
    std::uint32_t firstRef = 0;
};

// For messages: which expression of which function.
struct WideOrigin {
    const Function* function = nullptr;
    ExprId expr;
};

struct WideCode {
    const Module* module = nullptr;
    std::vector<WideInstruction> instructions;
    std::vector<WideSource> sources;
    std::vector<Ref> refs;
    std::vector<std::uint32_t> words;                   // that serve all lanes, as a run begins: the constants
    std::vector<std::vector<std::uint32_t>> uniforms;   // values in the module
    std::vector<std::pair<std::uint32_t, Ref>> spread;  // registers that hold a constant all the time
    std::uint32_t registers = 0;                        // the parameters come first
    std::uint32_t parameters = 0;
    std::vector<Ref> results;
    std::vector<WideOrigin> origins;
    bool takesDerivatives = false;
};

}  // namespace shaderx::ir
