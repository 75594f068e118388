#include "ir/interpret_wide_program.h"

#include <algorithm>
#include <bit>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include "ir/interpret_program.h"
#include "ir/validate.h"

namespace shaderx::ir {
namespace {

constexpr std::size_t kMostInstructions = std::size_t{1} << 18;

// ---- One list: calls expanded, control as brackets ----

enum class FlatCode : std::uint8_t {
    Execute,
    Fetch,
    Texture,
    Derivative,
    Alias,  // dest is source 0 under another name: arguments and results of calls
    Copy,   // dest takes source 0: what a select or a loop leaves
    If,     // source 0
    Else,
    EndIf,
    Loop,     // the test; sources: index, count
    EndLoop,  // dest: index
};

struct FlatInstruction {
    FlatCode code = FlatCode::Execute;
    Op op = Op::Constant;
    Type type = Type::Void;
    Slot dest = 0;
    std::uint32_t firstSource = 0, sourceCount = 0;
    std::uint32_t payload = 0;
    std::uint32_t target = 0;       // words of a copy or an alias; number of a uniform
    std::uint32_t decider = kNone;  // of a copy: the If that it is for; of one of a loop: the loop's number
    WideOrigin origin = {};
    static constexpr std::uint32_t kNone = 0xffffffffu;
};

struct FlatProgram {
    std::vector<FlatInstruction> code;
    std::vector<Source> sources;
    std::vector<std::uint32_t> constants;
    std::uint32_t slots = 0;
    std::vector<Source> results;
    std::vector<std::uint32_t> loopTests;  // by loop number: its Loop
};

struct Flattener {
    const Module& module;
    Diagnostics& diagnostics;
    FlatProgram& out;

    struct OpenIf {
        std::uint32_t begin = 0;
        std::uint32_t end = FlatInstruction::kNone;  // pc of what follows, known after the first side
    };
    // A function under way.
    struct Frame {
        const Program* program = nullptr;
        std::uint32_t pc = 0;
        Slot base = 0, constants = 0, resultsTo = 0;
        std::vector<OpenIf> ifs = {};
        std::unordered_map<std::uint32_t, std::uint32_t> loops = {};  // number by expression
    };
    std::map<const Function*, std::unique_ptr<Program>> programs = {};
    std::map<const Program*, Slot> constantsOf = {};
    std::vector<Frame> frames = {};

    const Program* programOf(const Function& f) {
        std::unique_ptr<Program>& p = programs[&f];
        if (p) return p.get();
        auto made = std::make_unique<Program>();
        if (!validate(module, f, diagnostics) || !translate(module, f, diagnostics, *made)) return nullptr;
        p = std::move(made);
        constantsOf[p.get()] = static_cast<Slot>(out.constants.size());
        out.constants.insert(out.constants.end(), p->constants.begin(), p->constants.end());
        return p.get();
    }

    bool enter(const Function& f, Slot resultsTo) {
        const Program* p = programOf(f);
        if (!p) return false;
        frames.push_back({p, 0, out.slots, constantsOf[p], resultsTo});
        out.slots += p->frameWords;
        return true;
    }

    static Slot moved(const Frame& frame, Slot s) {
        return s & kConstantSlot ? kConstantSlot | ((s & ~kConstantSlot) + frame.constants) : s + frame.base;
    }

    FlatInstruction& add(FlatCode code, const Frame& frame, const Instruction& in) {
        FlatInstruction flat;
        flat.code = code;
        flat.op = in.op;
        flat.type = in.type;
        flat.dest = in.destination + frame.base;
        flat.firstSource = static_cast<std::uint32_t>(out.sources.size());
        flat.sourceCount = in.sourceCount;
        flat.payload = in.payload;
        flat.target = in.target;
        flat.origin = {frame.program->function, in.expr};
        for (std::uint32_t k = 0; k < in.sourceCount; k++) {
            const Source& s = frame.program->sources[in.firstSource + k];
            out.sources.push_back({s.type, moved(frame, s.slot)});
        }
        return out.code.emplace_back(flat);
    }

    void alias(const Frame& frame, Slot dest, const Source& from) {
        FlatInstruction flat;
        flat.code = FlatCode::Alias;
        flat.type = from.type;
        flat.dest = dest;
        flat.firstSource = static_cast<std::uint32_t>(out.sources.size());
        flat.sourceCount = 1;
        flat.target = frameWords(from.type);
        flat.origin = {frame.program->function, {}};
        out.sources.push_back(from);
        out.code.push_back(flat);
    }

    std::uint32_t loopOf(Frame& frame, ExprId e) {
        const auto [it, isNew] = frame.loops.emplace(e.index, static_cast<std::uint32_t>(out.loopTests.size()));
        if (isNew) out.loopTests.push_back(FlatInstruction::kNone);
        return it->second;
    }

    void copy(Frame& frame, const Instruction& in) {
        FlatInstruction& flat = add(FlatCode::Copy, frame, in);
        flat.decider = in.op == Op::Select ? frame.ifs.back().begin : loopOf(frame, in.expr);
    }

    bool call(const Instruction& in) {
        const Frame caller = frames.back();
        const Function* f = module.find(Name(in.payload));
        if (!f || frames.size() > 200) {
            diagnostics.error("cannot-interpret", f ? "calls are nested too deeply" : "the function cannot be run");
            return false;
        }
        if (!enter(*f, caller.base + in.destination)) return false;
        Slot at = frames.back().base;
        for (std::uint32_t k = 0; k < in.sourceCount; k++) {
            const Source& s = caller.program->sources[in.firstSource + k];
            alias(caller, at, {s.type, moved(caller, s.slot)});
            at += frameWords(s.type);
        }
        return true;
    }

    void leave() {
        const Frame done = std::move(frames.back());
        frames.pop_back();
        Slot to = done.resultsTo;
        for (const Source& s : done.program->results) {
            const Source from{s.type, moved(done, s.slot)};
            if (frames.empty())
                out.results.push_back(from);
            else
                alias(done, to, from);
            to += frameWords(s.type);
        }
    }

    void closeIfs(Frame& frame) {
        while (!frame.ifs.empty() && frame.ifs.back().end == frame.pc) {
            out.code.push_back({FlatCode::EndIf});
            frame.ifs.pop_back();
        }
    }

    bool step() {
        closeIfs(frames.back());
        Frame& frame = frames.back();
        const Instruction& in = frame.program->code[frame.pc++];
        switch (in.code) {
            case Code::Execute:
                add(FlatCode::Execute, frame, in);
                break;
            case Code::Fetch:
                add(FlatCode::Fetch, frame, in);
                break;
            case Code::Texture:
                add(FlatCode::Texture, frame, in);
                break;
            case Code::Derivative:
                add(FlatCode::Derivative, frame, in);
                break;
            case Code::Call:
                return call(in);
            case Code::Copy:
                copy(frame, in);
                break;
            case Code::JumpIfFalse:
                frame.ifs.push_back({static_cast<std::uint32_t>(out.code.size())});
                add(FlatCode::If, frame, in);
                break;
            case Code::Jump:
                frame.ifs.back().end = in.target;
                out.code.push_back({FlatCode::Else});
                break;
            case Code::LoopTest: {
                const std::uint32_t loop = loopOf(frame, in.expr);
                out.loopTests[loop] = static_cast<std::uint32_t>(out.code.size());
                add(FlatCode::Loop, frame, in);
                break;
            }
            case Code::LoopNext:
                add(FlatCode::EndLoop, frame, in);
                break;
            case Code::Return:
                leave();
                break;
        }
        return true;
    }

    bool run(const Function& f) {
        if (!enter(f, 0)) return false;
        while (!frames.empty()) {
            if (!step()) return false;
            if (out.code.size() <= kMostInstructions && out.slots <= 4 * kMostInstructions) continue;
            diagnostics.error("program-too-large",
                              fmt::format("'{}' has more than {} instructions when its calls are expanded",
                                          module.names->text(f.name), kMostInstructions));
            return false;
        }
        return true;
    }
};

// ---- What differs from lane to lane ----

struct Varying {
    const FlatProgram& p;
    std::vector<bool> slots;

    bool of(const Source& s) const { return !(s.slot & kConstantSlot) && slots[s.slot]; }
    bool anySource(const FlatInstruction& in) const {
        for (std::uint32_t k = 0; k < in.sourceCount; k++)
            if (of(p.sources[in.firstSource + k])) return true;
        return false;
    }
    // What decides which copy a lane takes part in.
    bool decided(const FlatInstruction& in) const {
        const bool isIf = in.op == Op::Select;
        const std::uint32_t by = isIf ? in.decider : p.loopTests[in.decider];
        return anySource(p.code[by]);
    }

    bool varies(const FlatInstruction& in) const {
        switch (in.code) {
            case FlatCode::Execute:
            case FlatCode::Alias:
                return anySource(in);
            case FlatCode::Fetch:
                if (in.op == Op::Attribute) return true;
                return in.op == Op::Context && in.type != Type::Texture2D &&
                       info(static_cast<Context>(in.payload)).source != ContextSource::Uniform;
            case FlatCode::Texture:
                return in.op != Op::TextureSize || anySource(in);
            case FlatCode::Derivative:
                return true;
            case FlatCode::Copy:
                return anySource(in) || decided(in);
            case FlatCode::If:
            case FlatCode::Else:
            case FlatCode::EndIf:
            case FlatCode::Loop:
            case FlatCode::EndLoop:
                return false;
        }
        return false;
    }

    // Until nothing changes; only what loops carry needs more than one turn.
    void run() {
        for (bool changed = true; changed;) {
            changed = false;
            for (const FlatInstruction& in : p.code) {
                const std::uint32_t words =
                    in.code == FlatCode::Copy || in.code == FlatCode::Alias ? in.target : frameWords(in.type);
                if (!varies(in)) continue;
                for (std::uint32_t i = 0; i < words; i++) {
                    if (slots[in.dest + i]) continue;
                    slots[in.dest + i] = true;
                    changed = true;
                }
            }
        }
    }
};

// ---- Registers and instructions ----

struct Emitter {
    const FlatProgram& p;
    const Varying& varying;
    WideCode& out;

    static constexpr Ref kNoRef = 0xffffffffu;
    std::vector<Ref> refs = {};      // by slot
    std::vector<bool> carried = {};  // by slot: a loop changes it
    std::vector<bool> carriedRegisters = {}, carriedWords = {};
    std::unordered_map<std::uint32_t, Ref> constantWords = {};  // by bits
    std::unordered_map<std::uint32_t, Ref> spread = {};         // registers of constants, by bits
    std::unordered_map<Ref, Ref> broadcasts = {};               // of words, good until control goes another way
    std::uint32_t origin = 0;

    struct OpenIf {
        bool isUniform = false;
        std::uint32_t jump = 0;
    };
    struct OpenLoop {
        bool isUniform = false;
        std::uint32_t test = 0;
    };
    std::vector<OpenIf> ifs = {};
    std::vector<OpenLoop> loops = {};

    // ---- Places ----

    Ref newRegisters(std::uint32_t n) {
        const Ref at = out.registers;
        out.registers += n;
        return at;
    }
    Ref newWords(std::uint32_t n) {
        const Ref at = kUniformRef | static_cast<Ref>(out.words.size());
        out.words.resize(out.words.size() + n, 0);
        return at;
    }
    Ref constant(std::uint32_t bits) {
        const auto [it, isNew] = constantWords.emplace(bits, 0);
        if (isNew) {
            it->second = newWords(1);
            out.words[it->second & ~kUniformRef] = bits;
        }
        return it->second;
    }
    Ref number(float v) { return constant(std::bit_cast<std::uint32_t>(v)); }

    Ref refOf(Slot s) { return s & kConstantSlot ? constant(p.constants[s & ~kConstantSlot]) : refs[s]; }
    Ref ref(const FlatInstruction& in, std::uint32_t k, std::uint32_t i = 0) {
        const Slot s = p.sources[in.firstSource + k].slot;
        return refOf(s + i);
    }
    Type typeOf(const FlatInstruction& in, std::uint32_t k) const { return p.sources[in.firstSource + k].type; }

    static bool isIn(const std::vector<bool>& set, std::uint32_t i) { return i < set.size() && set[i]; }
    static void put(std::vector<bool>& set, std::uint32_t i) {
        if (set.size() <= i) set.resize(i + 1, false);
        set[i] = true;
    }
    bool isCarried(Ref r) const {
        return isUniform(r) ? isIn(carriedWords, r & ~kUniformRef) : isIn(carriedRegisters, r);
    }

    // ---- Instructions ----

    WideInstruction& add(WideOp op, std::uint32_t dest = 0, Ref a = 0, Ref b = 0, Ref c = 0, Ref d = 0) {
        WideInstruction in;
        in.op = op;
        in.dest = dest;
        in.a = a;
        in.b = b;
        in.c = c;
        in.d = d;
        in.origin = origin;
        return out.instructions.emplace_back(in);
    }
    std::uint32_t here() const { return static_cast<std::uint32_t>(out.instructions.size()); }

    // A register with the value of a ref.
    Ref inLanes(Ref r) {
        if (!isUniform(r)) return r;
        const std::uint32_t word = r & ~kUniformRef;
        const auto known = constantWords.find(out.words[word]);
        if (known != constantWords.end() && known->second == r) {
            const auto [it, isNew] = spread.emplace(out.words[word], 0);
            if (isNew) {
                it->second = newRegisters(1);
                out.spread.push_back({it->second, r});
            }
            return it->second;
        }
        const auto [it, isNew] = broadcasts.emplace(r, 0);
        if (!isNew) return it->second;
        const Ref to = it->second = newRegisters(1);
        add(WideOp::Broadcast, to, r);
        return to;
    }

    // The register of a new value.
    Ref value(WideOp op, Ref a, Ref b = 0, Ref c = 0, Ref d = 0) {
        const int n = operandsOf(op);
        a = inLanes(a);
        if (n > 1) b = inLanes(b);
        if (n > 2) c = inLanes(c);
        if (n > 3) d = inLanes(d);
        const Ref to = newRegisters(1);
        add(op, to, a, b, c, d);
        return to;
    }
    // At least two: those with one operand ignore the second.
    static int operandsOf(WideOp op) {
        if (op == WideOp::FMulSub) return 4;
        for (WideOp three :
             {WideOp::FClamp, WideOp::FMix, WideOp::FSmoothstep, WideOp::FMulAdd, WideOp::FSubMul, WideOp::Select})
            if (op == three) return 3;
        return 2;
    }

    // A value that stays although a loop changes where it comes from.
    Ref kept(Ref r) {
        if (!isCarried(r)) return r;
        if (isUniform(r)) {
            const Ref to = newWords(1);
            add(WideOp::UniformMove, to & ~kUniformRef, r);
            return to;
        }
        const Ref to = newRegisters(1);
        add(WideOp::Move, to, r);
        return to;
    }

    void addSources(const FlatInstruction& in, std::vector<WideSource>& made) {
        for (std::uint32_t k = 0; k < in.sourceCount; k++) {
            made.push_back({typeOf(in, k), static_cast<std::uint32_t>(out.refs.size())});
            for (std::uint32_t i = 0; i < frameWords(typeOf(in, k)); i++) {
                const Ref r = ref(in, k, i);  // may make a word, so before the list grows
                out.refs.push_back(r);
            }
        }
    }

    // An instruction with operands of any type, into words or registers of its own.
    WideInstruction& addGeneral(WideOp op, const FlatInstruction& in, bool toWords) {
        const std::uint32_t n = frameWords(in.type);
        const Ref to = toWords ? newWords(n) : newRegisters(n);
        for (std::uint32_t i = 0; i < n; i++) refs[in.dest + i] = to + i;
        std::vector<WideSource> made;
        addSources(in, made);
        WideInstruction& wide = add(op, to & ~kUniformRef);
        wide.irOp = in.op;
        wide.type = in.type;
        wide.payload = in.payload;
        wide.target = in.target;
        wide.firstSource = static_cast<std::uint32_t>(out.sources.size());
        wide.sourceCount = in.sourceCount;
        out.sources.insert(out.sources.end(), made.begin(), made.end());
        return wide;
    }

    // ---- Renaming: what only arranges components costs nothing ----

    // Which component of which operand result component i is; false where the operation computes.
    bool arranged(const FlatInstruction& in, std::uint32_t i, std::uint32_t& k, std::uint32_t& from) const {
        const TypeInfo& first = info(typeOf(in, 0));
        k = 0;
        from = i;
        if (in.op == Op::Retype) return true;
        if (in.op == Op::Swizzle) {
            from = isMatrix(typeOf(in, 0)) ? in.payload * first.rows + i
                                           : static_cast<std::uint32_t>(swizzleAt(in.payload, static_cast<int>(i)));
            return true;
        }
        if (in.op == Op::Transpose) {
            from = i % first.rows * first.rows + i / first.rows;
            return true;
        }
        if (in.op != Op::Make) return false;
        if (in.sourceCount == 1 && in.type == Type::Matrix33 && typeOf(in, 0) == Type::Matrix44)
            from = i / 3 * 4 + i % 3;
        else if (in.sourceCount == 1 && isScalar(typeOf(in, 0)))
            from = 0;
        else
            while (from >= frameWords(typeOf(in, k))) from -= frameWords(typeOf(in, k++));
        return true;
    }

    bool rename(const FlatInstruction& in) {
        std::uint32_t k = 0, from = 0;
        if (in.sourceCount == 0 || !arranged(in, 0, k, from)) return false;
        std::vector<Ref> made;
        for (std::uint32_t i = 0; i < frameWords(in.type); i++) {
            arranged(in, i, k, from);
            made.push_back(kept(ref(in, k, from)));
        }
        std::copy(made.begin(), made.end(), refs.begin() + in.dest);
        return true;
    }

    // ---- Arithmetic ----

    struct Simple {
        Op op;
        WideOp floats, integers;
        int operands;
    };
    // Componentwise operations; Jump: none for that kind.
    static const Simple* simpleOf(Op op) {
        using W = WideOp;
        static constexpr Simple kSimple[] = {
            {Op::Neg, W::FNeg, W::INeg, 1},
            {Op::Add, W::FAdd, W::IAdd, 2},
            {Op::Sub, W::FSub, W::ISub, 2},
            {Op::Mul, W::FMul, W::IMul, 2},
            {Op::Div, W::FDiv, W::Jump, 2},
            {Op::Mod, W::FMod, W::Jump, 2},
            {Op::Min, W::FMin, W::IMin, 2},
            {Op::Max, W::FMax, W::IMax, 2},
            {Op::Pow, W::FPow, W::Jump, 2},
            {Op::Atan2, W::FAtan2, W::Jump, 2},
            {Op::Step, W::FStep, W::Jump, 2},
            {Op::Clamp, W::FClamp, W::Jump, 3},
            {Op::Mix, W::FMix, W::Jump, 3},
            {Op::Smoothstep, W::FSmoothstep, W::Jump, 3},
            {Op::Abs, W::FAbs, W::Jump, 1},
            {Op::Sign, W::FSign, W::Jump, 1},
            {Op::Floor, W::FFloor, W::Jump, 1},
            {Op::Ceil, W::FCeil, W::Jump, 1},
            {Op::Round, W::FRound, W::Jump, 1},
            {Op::Fract, W::FFract, W::Jump, 1},
            {Op::Exp, W::FExp, W::Jump, 1},
            {Op::Exp2, W::FExp2, W::Jump, 1},
            {Op::Log, W::FLog, W::Jump, 1},
            {Op::Log2, W::FLog2, W::Jump, 1},
            {Op::Sqrt, W::FSqrt, W::Jump, 1},
            {Op::InverseSqrt, W::FInverseSqrt, W::Jump, 1},
            {Op::Sin, W::FSin, W::Jump, 1},
            {Op::Cos, W::FCos, W::Jump, 1},
            {Op::Tan, W::FTan, W::Jump, 1},
            {Op::Asin, W::FAsin, W::Jump, 1},
            {Op::Acos, W::FAcos, W::Jump, 1},
            {Op::Atan, W::FAtan, W::Jump, 1},
            {Op::Radians, W::FRadians, W::Jump, 1},
            {Op::Degrees, W::FDegrees, W::Jump, 1},
            {Op::BitAnd, W::Jump, W::BitAnd, 2},
            {Op::BitOr, W::Jump, W::BitOr, 2},
            {Op::BitXor, W::Jump, W::BitXor, 2},
            {Op::BitNot, W::Jump, W::BitNot, 1},
            {Op::ShiftLeft, W::Jump, W::ShiftLeft, 2},
            {Op::ShiftRight, W::Jump, W::ShiftRight, 2},
            {Op::ShiftRightLogical, W::Jump, W::ShiftRightLogical, 2},
        };
        for (const Simple& s : kSimple)
            if (s.op == op) return &s;
        return nullptr;
    }

    bool simple(const FlatInstruction& in) {
        const Simple* s = simpleOf(in.op);
        if (!s) return false;
        const Scalar kind = info(in.type).scalar;
        const WideOp op = kind == Scalar::Float ? s->floats : kind == Scalar::Integer ? s->integers : WideOp::Jump;
        if (op == WideOp::Jump) return false;
        std::vector<Ref> made;
        for (std::uint32_t i = 0; i < frameWords(in.type); i++) {
            Ref operands[3] = {};
            for (std::uint32_t k = 0; k < in.sourceCount; k++)
                operands[k] = ref(in, k, isScalar(typeOf(in, k)) ? 0 : i);
            for (std::uint32_t k = in.sourceCount; k < 3; k++) operands[k] = operands[0];
            made.push_back(value(op, operands[0], operands[1], operands[2]));
        }
        std::copy(made.begin(), made.end(), refs.begin() + in.dest);
        return true;
    }

    bool comparison(const FlatInstruction& in) {
        const bool floats = info(typeOf(in, 0)).scalar == Scalar::Float;
        using W = WideOp;
        W op = W::Jump;
        if (in.op == Op::Equal) op = floats ? W::FEqual : W::IEqual;
        if (in.op == Op::NotEqual) op = floats ? W::FNotEqual : W::INotEqual;
        if (in.op == Op::Less) op = floats ? W::FLess : W::ILess;
        if (in.op == Op::LessEqual) op = floats ? W::FLessEqual : W::ILessEqual;
        if (in.op == Op::And) op = W::BAnd;
        if (in.op == Op::Or) op = W::BOr;
        if (in.op == Op::Not) op = W::BNot;
        if (op == W::Jump) return false;
        refs[in.dest] = value(op, ref(in, 0), ref(in, in.sourceCount > 1 ? 1 : 0));
        return true;
    }

    bool convert(const FlatInstruction& in) {
        const Scalar from = info(typeOf(in, 0)).scalar, to = info(in.type).scalar;
        const Ref a = ref(in, 0);
        if (from == to)
            refs[in.dest] = kept(a);
        else if (to == Scalar::Boolean)
            refs[in.dest] = value(from == Scalar::Float ? WideOp::FToB : WideOp::IToB, a, a);
        else if (to == Scalar::Integer)
            refs[in.dest] = value(from == Scalar::Float ? WideOp::FToI : WideOp::IToB, a, a);
        else
            refs[in.dest] = value(WideOp::IToF, from == Scalar::Integer ? a : value(WideOp::IToB, a, a), a);
        return true;
    }

    Ref dot(const FlatInstruction& in, std::uint32_t a, std::uint32_t b) {
        Ref sum = value(WideOp::FMul, ref(in, a, 0), ref(in, b, 0));
        for (std::uint32_t i = 1; i < frameWords(typeOf(in, a)); i++)
            sum = value(WideOp::FMulAdd, ref(in, a, i), ref(in, b, i), sum);
        return sum;
    }

    void refract(const FlatInstruction& in, std::vector<Ref>& made) {
        using W = WideOp;
        const Ref eta = ref(in, 2), d = dot(in, 1, 0), one = number(1), zero = number(0);
        const Ref rest = value(W::FSub, one, value(W::FMul, d, d));
        const Ref k = value(W::FSubMul, value(W::FMul, eta, eta), rest, one);
        const Ref isTotal = value(W::FLess, k, zero);
        const Ref along = value(W::FAdd, value(W::FMul, eta, d), value(W::FSqrt, k, k));
        for (std::uint32_t i = 0; i < frameWords(in.type); i++) {
            const Ref bent = value(W::FSubMul, along, ref(in, 1, i), value(W::FMul, eta, ref(in, 0, i)));
            made.push_back(value(W::Select, isTotal, zero, bent));
        }
    }

    void multiplyMatrix(const FlatInstruction& in, std::vector<Ref>& made) {
        const TypeInfo &a = info(typeOf(in, 0)), &b = info(typeOf(in, 1));
        for (std::uint32_t column = 0; column < b.columns; column++)
            for (std::uint32_t row = 0; row < a.rows; row++) {
                Ref sum = number(0);
                for (std::uint32_t i = 0; i < a.columns; i++)
                    sum = value(WideOp::FMulAdd, ref(in, 0, i * a.rows + row), ref(in, 1, column * b.rows + i), sum);
                made.push_back(sum);
            }
    }

    bool geometry(const FlatInstruction& in) {
        using W = WideOp;
        std::vector<Ref> made;
        const std::uint32_t n = frameWords(in.type);
        if (in.op == Op::Dot) {
            made = {dot(in, 0, 1)};
        } else if (in.op == Op::Length) {
            const Ref d = dot(in, 0, 0);
            made = {value(W::FSqrt, d, d)};
        } else if (in.op == Op::Distance) {
            Ref sum = number(0);
            for (std::uint32_t i = 0; i < frameWords(typeOf(in, 0)); i++) {
                const Ref d = value(W::FSub, ref(in, 0, i), ref(in, 1, i));
                sum = value(W::FMulAdd, d, d, sum);
            }
            made = {value(W::FSqrt, sum, sum)};
        } else if (in.op == Op::Normalize) {
            const Ref d = dot(in, 0, 0), l = value(W::FSqrt, d, d);
            for (std::uint32_t i = 0; i < n; i++) made.push_back(value(W::FDiv, ref(in, 0, i), l));
        } else if (in.op == Op::Cross) {
            for (std::uint32_t i = 0; i < 3; i++) {
                const std::uint32_t j = (i + 1) % 3, k = (i + 2) % 3;
                made.push_back(value(W::FMulSub, ref(in, 0, j), ref(in, 1, k), ref(in, 0, k), ref(in, 1, j)));
            }
        } else if (in.op == Op::Reflect) {
            const Ref twice = value(W::FMul, number(2), dot(in, 1, 0));
            for (std::uint32_t i = 0; i < n; i++)
                made.push_back(value(W::FSubMul, twice, ref(in, 1, i), ref(in, 0, i)));
        } else if (in.op == Op::Faceforward) {
            const Ref keep = value(W::FLess, dot(in, 2, 1), number(0));
            for (std::uint32_t i = 0; i < n; i++)
                made.push_back(value(W::Select, keep, ref(in, 0, i), value(W::FNeg, ref(in, 0, i), ref(in, 0, i))));
        } else if (in.op == Op::Refract) {
            refract(in, made);
        } else if (in.op == Op::MulMatrix) {
            multiplyMatrix(in, made);
        } else {
            return false;
        }
        std::copy(made.begin(), made.end(), refs.begin() + in.dest);
        return true;
    }

    bool select(const FlatInstruction& in) {
        if (in.op != Op::Select) return false;
        std::vector<Ref> made;
        for (std::uint32_t i = 0; i < frameWords(in.type); i++)
            made.push_back(value(WideOp::Select, ref(in, 0), ref(in, 1, i), ref(in, 2, i)));
        std::copy(made.begin(), made.end(), refs.begin() + in.dest);
        return true;
    }

    void execute(const FlatInstruction& in) {
        if (rename(in)) return;
        if (!varying.slots[in.dest]) {
            addGeneral(WideOp::UniformExecute, in, true);
            return;
        }
        if (in.op == Op::Convert && isScalar(in.type) && isScalar(typeOf(in, 0)) && convert(in)) return;
        if (simple(in) || comparison(in) || geometry(in) || select(in)) return;
        addGeneral(WideOp::LaneExecute, in, false);
    }

    // ---- World ----

    void fetch(const FlatInstruction& in) {
        if (in.type == Type::Texture2D) {
            const bool isContext = in.op == Op::Context;
            refs[in.dest] =
                constant(static_cast<std::uint32_t>(isContext ? TextureRef::Kind::Context : TextureRef::Kind::Uniform));
            refs[in.dest + 1] = constant(in.payload);
        } else if (varying.slots[in.dest]) {
            addGeneral(WideOp::LaneFetch, in, false);
        } else {
            WideInstruction& wide = addGeneral(WideOp::UniformFetch, in, true);
            if (in.op != Op::Uniform) return;
            wide.target = static_cast<std::uint32_t>(out.uniforms.size());
            out.uniforms.push_back(out.module->uniforms[in.target].values);
        }
    }

    void texture(const FlatInstruction& in) {
        if (in.op == Op::TextureSize) {
            const bool isOne = !varying.slots[in.dest];
            addGeneral(isOne ? WideOp::UniformTextureSize : WideOp::LaneTextureSize, in, isOne);
            return;
        }
        // The places must stand in registers one after the other.
        std::vector<Ref> places;
        for (std::uint32_t k = 1; k < in.sourceCount; k++)
            for (std::uint32_t i = 0; i < frameWords(typeOf(in, k)); i++) places.push_back(inLanes(ref(in, k, i)));
        bool inOrder = true;
        for (std::size_t i = 1; i < places.size(); i++) inOrder = inOrder && places[i] == places[0] + i;
        if (!inOrder) {
            const Ref to = newRegisters(static_cast<std::uint32_t>(places.size()));
            for (std::uint32_t i = 0; i < places.size(); i++) add(WideOp::Move, to + i, places[i]);
            places[0] = to;
        }
        const Ref image[2] = {ref(in, 0, 0), ref(in, 0, 1)};
        const Ref to = newRegisters(frameWords(in.type));
        WideInstruction& wide = add(WideOp::Texture, to, places[0], image[0], image[1]);
        wide.irOp = in.op;
        wide.type = in.type;
        for (std::uint32_t i = 0; i < frameWords(in.type); i++) refs[in.dest + i] = to + i;
    }

    void derivative(const FlatInstruction& in) {
        out.takesDerivatives = true;
        std::vector<Ref> made;
        for (std::uint32_t i = 0; i < frameWords(in.type); i++)
            made.push_back(value(in.op == Op::Ddx ? WideOp::Ddx : WideOp::Ddy, ref(in, 0, i), ref(in, 0, i)));
        std::copy(made.begin(), made.end(), refs.begin() + in.dest);
    }

    // ---- Control ----

    // Words that a copy writes have a fixed place, since several copies write them.
    Ref placeOf(Slot s, bool isOfLoop) {
        Ref& r = refs[s];
        if (r == kNoRef) r = varying.slots[s] ? newRegisters(1) : newWords(1);
        if (isOfLoop) isUniform(r) ? put(carriedWords, r & ~kUniformRef) : put(carriedRegisters, r);
        return r;
    }

    void copy(const FlatInstruction& in) {
        for (std::uint32_t i = 0; i < in.target; i++) {
            const Ref from = ref(in, 0, i), to = placeOf(in.dest + i, in.op != Op::Select);
            if (isUniform(to)) {
                add(WideOp::UniformMove, to & ~kUniformRef, from);
                broadcasts.erase(to);
            } else {
                add(WideOp::MoveMasked, to, inLanes(from));
            }
        }
    }

    void openIf(const FlatInstruction& in) {
        const Ref condition = ref(in, 0);
        ifs.push_back({isUniform(condition), here()});
        add(isUniform(condition) ? WideOp::JumpIfFalse : WideOp::If, 0, condition);
        broadcasts.clear();
    }

    void otherwise() {
        const std::uint32_t jump = here();
        add(ifs.back().isUniform ? WideOp::Jump : WideOp::Else);
        out.instructions[ifs.back().jump].target = here();
        ifs.back().jump = jump;
        broadcasts.clear();
    }

    void endIf() {
        out.instructions[ifs.back().jump].target = here();
        if (!ifs.back().isUniform) add(WideOp::EndIf);
        ifs.pop_back();
        broadcasts.clear();
    }

    void openLoop(const FlatInstruction& in) {
        const Ref index = ref(in, 0), count = ref(in, 1);
        const bool isOne = isUniform(index) && isUniform(count);
        if (!isOne) add(WideOp::LoopEnter);
        loops.push_back({isOne, here()});
        add(isOne ? WideOp::LoopTest : WideOp::LoopTestLanes, 0, index, count);
        broadcasts.clear();
    }

    void endLoop(const FlatInstruction& in) {
        const OpenLoop loop = loops.back();
        loops.pop_back();
        const Ref index = refs[in.dest];
        add(isUniform(index) ? WideOp::LoopNext : WideOp::LoopNextLanes, 0, index).target = loop.test;
        out.instructions[loop.test].target = here();
        if (!loop.isUniform) add(WideOp::LoopExit);
        broadcasts.clear();
    }

    void emit(const FlatInstruction& in) {
        if (in.origin.function) {
            origin = static_cast<std::uint32_t>(out.origins.size());
            out.origins.push_back(in.origin);
        }
        switch (in.code) {
            case FlatCode::Execute:
                return execute(in);
            case FlatCode::Fetch:
                return fetch(in);
            case FlatCode::Texture:
                return texture(in);
            case FlatCode::Derivative:
                return derivative(in);
            case FlatCode::Alias: {
                std::vector<Ref> made;
                for (std::uint32_t i = 0; i < in.target; i++) made.push_back(kept(ref(in, 0, i)));
                std::copy(made.begin(), made.end(), refs.begin() + in.dest);
                return;
            }
            case FlatCode::Copy:
                return copy(in);
            case FlatCode::If:
                return openIf(in);
            case FlatCode::Else:
                return otherwise();
            case FlatCode::EndIf:
                return endIf();
            case FlatCode::Loop:
                return openLoop(in);
            case FlatCode::EndLoop:
                return endLoop(in);
        }
    }

    void run(const Function& f) {
        refs.assign(p.slots, kNoRef);
        Slot at = 0;
        for (const Param& param : f.params)
            for (std::uint32_t i = 0; i < frameWords(param.type); i++) refs[at++] = newRegisters(1);
        for (const FlatInstruction& in : p.code) emit(in);
        for (const Source& s : p.results)
            for (std::uint32_t i = 0; i < frameWords(s.type); i++) {
                const Ref r = refOf(s.slot + i);
                out.results.push_back(r);
            }
    }
};

}  // namespace

Result<WideProgram> WideProgram::prepare(const Module& module, const Function& function, Diagnostics& diagnostics) {
    FlatProgram flat;
    if (!Flattener{module, diagnostics, flat}.run(function)) return Failure{};
    Varying varying{flat, std::vector<bool>(flat.slots, false)};
    std::size_t parameters = 0;
    for (const Param& param : function.params) parameters += frameWords(param.type);
    std::fill_n(varying.slots.begin(), parameters, true);
    varying.run();
    auto code = std::make_shared<WideCode>();
    code->module = &module;
    code->parameters = static_cast<std::uint32_t>(parameters);
    code->origins.emplace_back();
    Emitter{flat, varying, *code}.run(function);
    return WideProgram(std::move(code));
}

bool WideProgram::takesDerivatives() const { return code_->takesDerivatives; }

}  // namespace shaderx::ir
