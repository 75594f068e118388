// The operations of the IR and what they mean.
//
// A function is a graph of pure expressions in one arena, operands before users. There are no statements, variables,
// loads or stores until the pass `place` has run: a branch is `select`, a loop is one `loop` expression whose body is
// whatever depends on its arguments, a call has results and no effects. Equal expressions are one, dead ones are not
// reached, and no pass has to ask what may move: everything may.
//
// Evaluation. Floats are IEEE binary32; operations may be contracted and reassociated where that changes rounding only.
// Passes may assume that no value is NaN or infinite: x * 0 is 0, x - x is 0, x == x is true. What an operation gives
// outside its domain (sqrt of a negative number, log of 0, pow of a negative base, division by 0, asin beyond 1,
// normalize of 0) is not defined but never stops a program; min, max and clamp of a NaN give either operand. Three
// are defined although languages leave them open: smoothstep between equal or falling edges is a step at the second,
// clamp with low above high is high, an index beyond the ends is that of the end.
// Integers have 32 bits and wrap; division by 0 gives any value; shifts take the low 5 bits of their count. Conversion
// of a float to an integer truncates, of a boolean to a number gives 0 or 1, of a number to a boolean compares with 0.
// `select` evaluates what it needs; both sides are pure, so evaluating more is never wrong.
// `ddx`, `ddy` are differences within the 2x2 quad of pixels; `place` puts them at the entry of the entry point, where
// every pixel of a quad evaluates them, so they are only allowed there. Images are read at an explicit level or with
// explicit gradients, so reading one is a pure function.
// A loop runs `count` times (0 if negative). Its carried values start from the first values; after each turn they take
// the next values, all at once. A loop nested in another has the larger number.
#pragma once

#include <cstdint>
#include <string_view>

#include "ir/types.h"

namespace shaderx::ir {

enum class Op : std::uint8_t {
#define OP(name, text, operands, rule) name,
#include "ir/ops.def"
#undef OP
};

enum class TypeRule : std::uint8_t {
    Given,    // said by whoever makes it
    Same,     // the type of the first operand
    Wider,    // componentwise: the operand with most components, its role that of the first so wide
    Scalar,   // the scalar of the first operand's components
    Boolean,  // a truth value
    Matrix,   // of the product
};

struct OpInfo {
    std::string_view name;
    std::int8_t operands;  // -1: any number
    TypeRule rule;
};
inline constexpr OpInfo kOpInfo[] = {
#define OP(name, text, operands, rule) {text, operands, TypeRule::rule},
#include "ir/ops.def"
#undef OP
};
constexpr const OpInfo& info(Op op) { return kOpInfo[static_cast<int>(op)]; }
constexpr int kOps = 0
#define OP(name, text, operands, rule) +1
#include "ir/ops.def"
#undef OP
    ;
// The operation of a name in the text form; false where there is none.
bool opNamed(std::string_view name, Op& op);

enum class Context : std::uint8_t {
#define CONTEXT(name, text, type, source, host) name,
#include "ir/context.def"
#undef CONTEXT
};
enum class ContextSource : std::uint8_t { Uniform, Texture, Vertex, Input };
struct ContextInfo {
    std::string_view name;  // in the shading language and the text form
    Type type;
    ContextSource source;
    std::string_view host;  // the variable that hosts bind
};
inline constexpr ContextInfo kContextInfo[] = {
#define CONTEXT(name, text, type, source, host) {text, Type::type, ContextSource::source, host},
#include "ir/context.def"
#undef CONTEXT
};
constexpr const ContextInfo& info(Context c) { return kContextInfo[static_cast<int>(c)]; }
constexpr int kContexts = 0
#define CONTEXT(name, text, type, source, host) +1
#include "ir/context.def"
#undef CONTEXT
    ;
bool contextNamed(std::string_view name, Context& c);

// Payload of a swizzle of a vector: its count in bits 8 to 10, component i in bits 2i and 2i+1.
constexpr std::uint32_t swizzleMask(int count, int x, int y = 0, int z = 0, int w = 0) {
    return static_cast<std::uint32_t>(count << 8 | x | y << 2 | z << 4 | w << 6);
}
constexpr int swizzleCount(std::uint32_t mask) { return static_cast<int>(mask >> 8 & 7); }
constexpr int swizzleAt(std::uint32_t mask, int i) { return static_cast<int>(mask >> (2 * i) & 3); }

}  // namespace shaderx::ir
