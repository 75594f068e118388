#include "ir/interpret_wide.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "ir/interpret_program.h"
#include "ir/interpret_wide_program.h"
#include "ir/text.h"

namespace shaderx::ir {

namespace {

using Word = std::uint32_t;

constexpr double kPi = 3.14159265358979323846;

inline float asFloat(Word w) { return std::bit_cast<float>(w); }
inline Word asWord(float v) { return std::bit_cast<Word>(v); }
inline std::int32_t asSigned(Word w) { return static_cast<std::int32_t>(w); }

// As std::floor, sign of zero included, without a call.
inline float floorOf(float x) {
    const bool isSmall = std::fabs(x) < 8388608.0f;  // larger ones are whole
    const float small = isSmall ? x : 0.0f;
    const float whole = static_cast<float>(static_cast<std::int32_t>(small));
    const float down = whole > small ? whole - 1.0f : whole;
    return isSmall ? asFloat(asWord(down) | (asWord(x) & 0x80000000u)) : x;
}

inline float clampOf(float x, float low, float high) {
    const float above = x < low ? low : x;
    return high < above ? high : above;
}

inline float smoothstep(float low, float high, float x) {
    const float t = clampOf((x - low) / (high - low), 0.0f, 1.0f);
    const float smooth = t * t * (3.0f - 2.0f * t), step = x >= high ? 1.0f : 0.0f;
    return low < high ? smooth : step;
}

inline Word truncated(float v) {
    if (!(v == v)) return 0;
    if (v >= 2147483648.0f) return 0x7fffffffu;
    if (v <= -2147483648.0f) return 0x80000000u;
    return static_cast<Word>(static_cast<std::int32_t>(v));
}

// Loops over all lanes, in a form that compilers turn into vector code. Lanes that do not run compute something too,
// which nobody reads.
template <class F>
inline void everyLane(LaneWords& to, F f) {
    Word* __restrict out = to.lane;
    for (std::size_t i = 0; i < kLanes; i++) out[i] = f(i);
}

template <class F>
inline void runningLanes(LaneMask mask, F f) {
    for (; mask; mask &= mask - 1) f(static_cast<std::size_t>(std::countr_zero(mask)));
}

LaneMask lanesWhere(const LaneWords& condition) {
    LaneMask mask = 0;
    for (std::size_t i = 0; i < kLanes; i++) mask |= static_cast<LaneMask>(condition.lane[i] != 0) << i;
    return mask;
}

// Whether each quad is in the mask as a whole or not at all.
bool isOfQuads(LaneMask mask) {
    const LaneMask first = 0x1111111111111111u;
    const LaneMask any = (mask | mask >> 1 | mask >> 2 | mask >> 3) & first;
    return mask == any * 15;
}

}  // namespace

struct WideInterpreter::State {
    const WideProgram program;
    const WideCode& code;
    InterpreterOptions options;
    std::vector<LaneWords> registers;
    std::vector<Word> words;
    std::uint64_t steps = 0;

    // Of one run.
    WideEnvironment* environment = nullptr;
    Diagnostics* diagnostics = nullptr;
    LaneMask all = 0, mask = 0;
    struct Kept {
        LaneMask outer = 0, others = 0;
    };
    std::vector<Kept> kept = {};

    State(const WideProgram& p, InterpreterOptions o) : program(p), code(program.code()), options(o) {
        registers.resize(code.registers + std::size_t{1});
        for (const auto& [r, from] : code.spread)
            std::fill_n(registers[r].lane, kLanes, code.words[from & ~kUniformRef]);
    }

    bool fail(const WideInstruction& in, std::string_view problem, std::string message) {
        Diagnostic& d = diagnostics->error(problem, std::move(message));
        const WideOrigin& from = code.origins[in.origin];
        if (!from.function) return false;
        const std::string line = from.expr ? printExpr(*code.module, *from.function, from.expr) : "return";
        d.notes.push_back({{}, fmt::format("in {}:\n    {}", code.module->names->text(from.function->name), line)});
        return false;
    }

    Word wordAt(Ref r, std::size_t lane) const {
        return isUniform(r) ? words[r & ~kUniformRef] : registers[r].lane[lane];
    }
    Word wordOf(Ref r) const { return words[r & ~kUniformRef]; }

    // ---- Operations of any type ----

    // The operands as one lane sees them.
    struct Gathered {
        Operand operands[16];
        Word words[16][16];
        std::size_t count = 0;
    };
    void gather(const WideInstruction& in, std::size_t lane, Gathered& out) const {
        out.count = in.sourceCount;
        for (std::uint32_t k = 0; k < in.sourceCount; k++) {
            const WideSource& s = code.sources[in.firstSource + k];
            for (std::uint32_t i = 0; i < frameWords(s.type); i++)
                out.words[k][i] = wordAt(code.refs[s.firstRef + i], lane);
            out.operands[k] = {s.type, out.words[k]};
        }
    }

    bool executeOne(const WideInstruction& in, std::size_t lane, Word* result) {
        Gathered g;
        gather(in, lane, g);
        if (execute(in.irOp, in.type, std::span<const Operand>(g.operands, g.count), in.payload, result)) return true;
        return fail(in, "cannot-interpret", fmt::format("the interpreter does not run '{}'", info(in.irOp).name));
    }

    bool executeLanes(const WideInstruction& in) {
        bool fine = true;
        runningLanes(mask, [&](std::size_t lane) {
            Word result[16];
            fine = fine && executeOne(in, lane, result);
            if (fine) scatter(in, lane, result);
        });
        return fine;
    }
    void scatter(const WideInstruction& in, std::size_t lane, const Word* result) {
        for (std::uint32_t i = 0; i < frameWords(in.type); i++) registers[in.dest + i].lane[lane] = result[i];
    }

    // ---- World ----

    bool noValue(const WideInstruction& in) {
        return fail(in, "no-value", "nothing supplies the value that the program asks for");
    }

    bool fetchWords(const WideInstruction& in) {
        Value v;
        v.type = in.type;
        bool known = true;
        if (in.irOp == Op::Context) {
            known = environment->context(static_cast<Context>(in.payload), v);
        } else if (!environment->uniform(Name(in.payload), v)) {
            const auto& usual = code.uniforms[in.target];
            known = usual.size() == frameWords(in.type);
            if (known) std::copy(usual.begin(), usual.end(), v.words);
        }
        if (!known || v.type != in.type) return noValue(in);
        std::copy_n(v.words, frameWords(in.type), words.begin() + in.dest);
        return true;
    }

    std::span<LaneWords> resultOf(const WideInstruction& in) {
        return {registers.data() + in.dest, frameWords(in.type)};
    }

    bool fetchLanes(const WideInstruction& in) {
        const bool known = in.irOp == Op::Attribute
                               ? environment->attribute(Name(in.payload), in.type, resultOf(in))
                               : environment->varying(static_cast<Context>(in.payload), in.type, resultOf(in));
        return known || noValue(in);
    }

    static TextureRef imageOf(Word kind, Word number) {
        TextureRef t;
        t.kind = static_cast<TextureRef::Kind>(kind);
        if (t.kind == TextureRef::Kind::Uniform) t.uniform = Name(number);
        if (t.kind == TextureRef::Kind::Context) t.context = static_cast<Context>(number);
        return t;
    }

    // One read for the lanes of each image.
    bool texture(const WideInstruction& in) {
        const LaneWords* places = &registers[in.a];
        for (LaneMask left = mask; left;) {
            const std::size_t first = static_cast<std::size_t>(std::countr_zero(left));
            const Word kind = wordAt(in.b, first), number = wordAt(in.c, first);
            LaneMask lanes = left;
            if (!isUniform(in.b) || !isUniform(in.c))
                runningLanes(left, [&](std::size_t i) {
                    if (wordAt(in.b, i) != kind || wordAt(in.c, i) != number) lanes &= ~(LaneMask{1} << i);
                });
            left &= ~lanes;
            WideTextureRead read;
            read.texture = imageOf(kind, number);
            read.lanes = lanes;
            read.uv = places;
            read.hasGradients = in.irOp == Op::TextureGrad;
            if (read.hasGradients) {
                read.ddx = places + 2;
                read.ddy = places + 4;
            } else {
                read.level = places + 2;
            }
            if (lanes == mask) return environment->texture(read, resultOf(in)) || noValue(in);
            std::vector<LaneWords> some(frameWords(in.type));
            if (!environment->texture(read, some)) return noValue(in);
            for (std::size_t c = 0; c < some.size(); c++)
                runningLanes(lanes, [&](std::size_t i) { registers[in.dest + c].lane[i] = some[c].lane[i]; });
        }
        return true;
    }

    bool sizeOf(const WideInstruction& in, std::size_t lane, Value& v) {
        const Ref* image = &code.refs[code.sources[in.firstSource].firstRef];
        v.type = in.type;
        return environment->textureSize(imageOf(wordAt(image[0], lane), wordAt(image[1], lane)), v) || noValue(in);
    }

    bool textureSize(const WideInstruction& in) {
        Value v;
        if (in.op == WideOp::UniformTextureSize) {
            if (!sizeOf(in, 0, v)) return false;
            std::copy_n(v.words, frameWords(in.type), words.begin() + in.dest);
            return true;
        }
        bool fine = true;
        runningLanes(mask, [&](std::size_t lane) {
            fine = fine && sizeOf(in, lane, v);
            if (fine) scatter(in, lane, v.words);
        });
        return fine;
    }

    // The difference to the neighbour: bit 0 of a lane's number is x, bit 1 is y.
    bool derivative(const WideInstruction& in) {
        if (!isOfQuads(all)) return fail(in, "needs-quad", "a derivative needs a quad of pixels");
        if (!isOfQuads(mask)) return fail(in, "non-uniform", "only some pixels of a quad reach a derivative");
        const LaneWords& a = registers[in.a];
        const std::size_t step = in.op == WideOp::Ddx ? 1 : 2;
        everyLane(registers[in.dest],
                  [&](std::size_t i) { return asWord(asFloat(a.lane[i | step]) - asFloat(a.lane[i & ~step])); });
        return true;
    }

    // ---- Control: where to go on ----

    std::uint32_t branch(const WideInstruction& in, std::uint32_t next) {
        const LaneMask then = mask & lanesWhere(registers[in.a]);
        kept.push_back({mask, mask & ~then});
        mask = then ? then : kept.back().others;
        if (then) return next;
        kept.back().others = 0;
        return in.target;
    }

    std::uint32_t otherwise(const WideInstruction& in, std::uint32_t next) {
        if (!kept.back().others) return in.target;
        mask = kept.back().others;
        return next;
    }

    void restore() {
        mask = kept.back().outer;
        kept.pop_back();
    }

    std::uint32_t testLanes(const WideInstruction& in, std::uint32_t next) {
        LaneMask goOn = 0;
        runningLanes(mask, [&](std::size_t i) {
            goOn |= static_cast<LaneMask>(asSigned(wordAt(in.a, i)) < asSigned(wordAt(in.b, i))) << i;
        });
        if (!goOn) return in.target;
        mask = goOn;
        return next;
    }

    void move(const WideInstruction& in) {
        LaneWords& to = registers[in.dest];
        const LaneWords& from = registers[in.a];
        if (mask == all)
            to = from;
        else
            runningLanes(mask, [&](std::size_t i) { to.lane[i] = from.lane[i]; });
    }

    bool executeWords(const WideInstruction& in) {
        Word result[16];
        if (!executeOne(in, 0, result)) return false;
        std::copy_n(result, frameWords(in.type), words.begin() + in.dest);
        return true;
    }

    bool advance();
};

// One turn of the loop is one instruction.
bool WideInterpreter::State::advance() {
    const std::uint32_t end = static_cast<std::uint32_t>(code.instructions.size());
    LaneWords* const r = registers.data();
    for (std::uint32_t at = 0; at < end;) {
        const WideInstruction& in = code.instructions[at++];
        if (++steps > options.maxSteps)
            return fail(in, "step-limit", fmt::format("the program runs for more than {} steps", options.maxSteps));
        switch (in.op) {
            case WideOp::Jump:
                at = in.target;
                break;
            case WideOp::JumpIfFalse:
                if (!wordOf(in.a)) at = in.target;
                break;
            case WideOp::LoopTest:
                if (asSigned(wordOf(in.a)) >= asSigned(wordOf(in.b))) at = in.target;
                break;
            case WideOp::LoopNext:
                words[in.a & ~kUniformRef]++;
                at = in.target;
                break;
            case WideOp::If:
                at = branch(in, at);
                break;
            case WideOp::Else:
                at = otherwise(in, at);
                break;
            case WideOp::LoopEnter:
                kept.push_back({mask, 0});
                break;
            case WideOp::LoopTestLanes:
                at = testLanes(in, at);
                break;
            case WideOp::LoopNextLanes:
                runningLanes(mask, [&](std::size_t i) { r[in.a].lane[i]++; });
                at = in.target;
                break;
            case WideOp::EndIf:
            case WideOp::LoopExit:
                restore();
                break;
            case WideOp::UniformMove:
                words[in.dest] = wordOf(in.a);
                break;
            case WideOp::Broadcast:
                std::fill_n(r[in.dest].lane, kLanes, wordOf(in.a));
                break;
            case WideOp::Move:
                r[in.dest] = r[in.a];
                break;
            case WideOp::MoveMasked:
                move(in);
                break;
            case WideOp::UniformExecute:
                if (!executeWords(in)) return false;
                break;
            case WideOp::UniformFetch:
                if (!fetchWords(in)) return false;
                break;
            case WideOp::LaneExecute:
                if (!executeLanes(in)) return false;
                break;
            case WideOp::LaneFetch:
                if (!fetchLanes(in)) return false;
                break;
            case WideOp::Texture:
                if (!texture(in)) return false;
                break;
            case WideOp::UniformTextureSize:
            case WideOp::LaneTextureSize:
                if (!textureSize(in)) return false;
                break;
            case WideOp::Ddx:
            case WideOp::Ddy:
                if (!derivative(in)) return false;
                break;
            case WideOp::Select: {
                const Word *a = r[in.a].lane, *b = r[in.b].lane, *c = r[in.c].lane;
                everyLane(r[in.dest], [=](std::size_t i) { return a[i] ? b[i] : c[i]; });
                break;
            }
            case WideOp::FMulSub: {
                const Word *a = r[in.a].lane, *b = r[in.b].lane, *c = r[in.c].lane, *d = r[in.d].lane;
                everyLane(r[in.dest], [=](std::size_t i) {
                    return asWord(asFloat(a[i]) * asFloat(b[i]) - asFloat(c[i]) * asFloat(d[i]));
                });
                break;
            }
#define LANES(name, ...)                                                                     \
    case WideOp::name: {                                                                     \
        [[maybe_unused]] const Word *a = r[in.a].lane, *b = r[in.b].lane, *c = r[in.c].lane; \
        __VA_ARGS__;                                                                         \
        break;                                                                               \
    }
#define FLOATS1(name, value)                               \
    LANES(name, everyLane(r[in.dest], [=](std::size_t i) { \
              const float x = asFloat(a[i]);               \
              return asWord(value);                        \
          }))
#define FLOATS2(name, value)                                    \
    LANES(name, everyLane(r[in.dest], [=](std::size_t i) {      \
              const float x = asFloat(a[i]), y = asFloat(b[i]); \
              return asWord(value);                             \
          }))
#define FLOATS3(name, value)                                                       \
    LANES(name, everyLane(r[in.dest], [=](std::size_t i) {                         \
              const float x = asFloat(a[i]), y = asFloat(b[i]), z = asFloat(c[i]); \
              return asWord(value);                                                \
          }))
#define COMPARE(name, value)                                                     \
    LANES(name, everyLane(r[in.dest], [=](std::size_t i) {                       \
              [[maybe_unused]] const float x = asFloat(a[i]), y = asFloat(b[i]); \
              return value ? Word{1} : Word{0};                                  \
          }))
#define WORDS1(name, value)                                \
    LANES(name, everyLane(r[in.dest], [=](std::size_t i) { \
              const Word x = a[i];                         \
              return value;                                \
          }))
#define WORDS2(name, value)                                \
    LANES(name, everyLane(r[in.dest], [=](std::size_t i) { \
              const Word x = a[i], y = b[i];               \
              return value;                                \
          }))
#define FUNCTION1(name, value)                                        \
    LANES(name, runningLanes(mask, [&](std::size_t i) {               \
              const double x = asFloat(a[i]);                         \
              r[in.dest].lane[i] = asWord(static_cast<float>(value)); \
          }))
#define FUNCTION2(name, value)                                        \
    LANES(name, runningLanes(mask, [&](std::size_t i) {               \
              const double x = asFloat(a[i]), y = asFloat(b[i]);      \
              r[in.dest].lane[i] = asWord(static_cast<float>(value)); \
          }))
#include "ir/interpret_wide.def"
        }
    }
    return true;
}

WideInterpreter::WideInterpreter(const WideProgram& program, InterpreterOptions options)
    : state_(new State(program, options)) {}
WideInterpreter::~WideInterpreter() = default;

bool WideInterpreter::run(LaneMask lanes, std::span<const LaneWords> arguments, std::span<LaneWords> results,
                          WideEnvironment& environment, Diagnostics& diagnostics) {
    State& s = *state_;
    s.environment = &environment;
    s.diagnostics = &diagnostics;
    s.all = s.mask = lanes;
    s.kept.clear();
    s.steps = 0;
    s.words = s.code.words;
    if (arguments.size() != s.code.parameters || results.size() != s.code.results.size()) {
        diagnostics.error("argument-count", fmt::format("the function takes {} components and gives {}",
                                                        s.code.parameters, s.code.results.size()));
        return false;
    }
    std::copy(arguments.begin(), arguments.end(), s.registers.begin());
    if (lanes && !s.advance()) return false;
    for (std::size_t k = 0; k < results.size(); k++) {
        const Ref from = s.code.results[k];
        if (isUniform(from))
            std::fill_n(results[k].lane, kLanes, s.wordOf(from));
        else
            results[k] = s.registers[from];
    }
    return true;
}

std::uint64_t WideInterpreter::steps() const { return state_->steps; }

}  // namespace shaderx::ir
