#include "fuzz/wobble.h"

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include <fmt/format.h>

#include "ir/builder.h"

namespace shaderx::fuzz {

using namespace ir;

namespace {

// How an operation rounds.
enum class Rounding : std::uint8_t {
    None,      // exact, or a choice among its operands
    Once,      // the result is rounded
    Operands,  // terms cancel inside of it: right for operands that are a little off (backward stable)
    Approximate,
    Read,
    Derivative,
};

Rounding roundingOf(Op op) {
    switch (op) {
        case Op::Add:
        case Op::Sub:
        case Op::Mul:
        case Op::Div:
        case Op::Radians:
        case Op::Degrees:
        case Op::Length:
        case Op::Normalize:
        case Op::Sqrt:
        case Op::InverseSqrt:
            return Rounding::Once;
        case Op::Mod:
        case Op::Mix:
        case Op::Smoothstep:
        case Op::Fract:
        case Op::Dot:
        case Op::Cross:
        case Op::Distance:
        case Op::Reflect:
        case Op::Refract:
        case Op::MulMatrix:
        case Op::Inverse:
        case Op::Determinant:
            return Rounding::Operands;
        case Op::Pow:
        case Op::Atan2:
        case Op::Exp:
        case Op::Exp2:
        case Op::Log:
        case Op::Log2:
        case Op::Sin:
        case Op::Cos:
        case Op::Tan:
        case Op::Asin:
        case Op::Acos:
        case Op::Atan:
            return Rounding::Approximate;
        case Op::Context:
        case Op::Attribute:
        case Op::TextureLevel:
        case Op::TextureGrad:
            return Rounding::Read;
        case Op::Ddx:
        case Op::Ddy:
            return Rounding::Derivative;
        default:
            return Rounding::None;
    }
}

// Drivers compute these by a short polynomial.
bool isArc(Op op) { return op == Op::Asin || op == Op::Acos || op == Op::Atan || op == Op::Atan2; }

}  // namespace

struct Wobbly::Copier {
    Wobbly& to;
    const Function& from;
    Function fresh = {};
    Builder b{to.module_, fresh};
    std::vector<ExprId> map = std::vector<ExprId>(from.exprs.size());

    Copier(Wobbly& w, const Function& f) : to(w), from(f) {}

    ExprId raw(Op op, Type type, std::initializer_list<ExprId> o) {
        return b.emitRaw(op, type, std::span(o.begin(), o.size()));
    }
    Type typeOf(Op op, ExprId x, ExprId y) const { return resultType(op, std::array{b.type(x), b.type(y)}); }
    ExprId two(Op op, ExprId x, ExprId y) { return raw(op, typeOf(op, x, y), {x, y}); }
    ExprId one(Op op, ExprId x) { return raw(op, b.type(x), {x}); }
    ExprId knob(Kind kind, Type type) {
        Uniform u;
        u.name = to.module_.names->intern(fmt::format("@knob{}", to.module_.uniforms.size()));
        u.type = type;
        u.values.resize(static_cast<std::size_t>(componentCount(type)));
        to.knobs_.push_back({to.module_.uniforms.size(), kind});
        to.module_.uniforms.push_back(u);
        return b.uniform(u.name, type);
    }
    static bool moves(Type t) { return info(t).scalar == Scalar::Float && !isMatrix(t); }
    ExprId moved(ExprId e, Kind kind) {
        return moves(b.type(e)) ? raw(Op::Mul, b.type(e), {e, knob(kind, b.type(e))}) : e;
    }

    // 1 where x is 0, above 0, below 0; else 0, but of what is no number neither: it stays what it is.
    ExprId isZero(ExprId x) { return two(Op::Sub, b.number(1), one(Op::Abs, sign(x))); }
    ExprId isPositive(ExprId x) { return two(Op::Max, sign(x), b.number(0)); }
    ExprId sign(ExprId x) {
        const ExprId nothing = two(Op::Mul, two(Op::Min, one(Op::Abs, x), b.number(1)), b.number(0));
        return two(Op::Add, one(Op::Sign, x), nothing);
    }
    ExprId isNegative(ExprId x) { return isPositive(one(Op::Neg, x)); }
    ExprId no(ExprId truth) { return two(Op::Sub, b.number(1), truth); }

    // Where an operation of these operands is not defined, by component; the operands are moved into its domain.
    std::optional<ExprId> undefined(Op op, std::vector<ExprId>& o) {
        switch (op) {
            case Op::Div:
            case Op::Mod: {
                ExprId bad = isZero(o[1]);
                o[1] = two(Op::Add, o[1], bad);
                return bad;
            }
            case Op::Sqrt: {
                ExprId bad = isNegative(o[0]);
                o[0] = one(Op::Abs, o[0]);
                return bad;
            }
            case Op::InverseSqrt:
            case Op::Log:
            case Op::Log2: {
                ExprId bad = no(isPositive(o[0]));
                o[0] = two(Op::Add, one(Op::Abs, o[0]), bad);
                return bad;
            }
            case Op::Pow: {
                ExprId atZero = two(Op::Mul, isZero(o[0]), no(isPositive(o[1])));
                ExprId bad = two(Op::Add, isNegative(o[0]), atZero);
                o[0] = two(Op::Add, one(Op::Abs, o[0]), bad);
                return bad;
            }
            case Op::Asin:
            case Op::Acos: {
                ExprId bad = isPositive(two(Op::Sub, one(Op::Abs, o[0]), b.number(1)));
                o[0] = raw(Op::Clamp, b.type(o[0]), {o[0], b.number(-1), b.number(1)});
                return bad;
            }
            case Op::Atan2:
                return two(Op::Mul, isZero(o[0]), isZero(o[1]));
            case Op::Normalize: {
                ExprId bad = isZero(raw(Op::Length, Type::Float, {o[0]}));
                o[0] = two(Op::Add, o[0], bad);
                return bad;
            }
            default:
                return {};
        }
    }

    // Any number in the components where `bad` is 1: 0 times infinity would not be 0, so the bad ones are chosen.
    ExprId anything(ExprId value, ExprId bad) {
        const Type type = b.type(value);
        std::vector<ExprId> parts;
        const int n = componentCount(type);
        ExprId any = knob(Kind::Any, type);
        for (int i = 0; i < n; i++) {
            const auto part = [&](ExprId e) { return componentCount(b.type(e)) == 1 ? e : component(e, i); };
            ExprId isBad = raw(Op::Less, Type::Boolean, {b.number(0.5f), part(bad)});
            parts.push_back(raw(Op::Select, Type::Float, {isBad, part(any), part(value)}));
        }
        return n == 1 ? parts[0] : b.emitRaw(Op::Make, type, parts);
    }
    ExprId component(ExprId e, int i) { return b.emitRaw(Op::Swizzle, Type::Float, std::array{e}, swizzleMask(1, i)); }

    // A read at no place gives no number.
    ExprId spread(ExprId value, const std::vector<ExprId>& o) {
        for (int i = 0; i < 2; i++) value = two(Op::Add, value, two(Op::Mul, component(o[1], i), b.number(0)));
        return value;
    }

    // Division by 0 and conversion of what is too large, of integers.
    std::optional<ExprId> undefinedInteger(const Expr& e, std::vector<ExprId>& o) {
        if (e.type != Type::Integer) return {};
        if (e.op == Op::Div || e.op == Op::Mod) {
            ExprId bad = raw(Op::Equal, Type::Boolean, {o[1], b.integer(0)});
            o[1] = raw(Op::Select, Type::Integer, {bad, b.integer(1), o[1]});
            return bad;
        }
        if (e.op == Op::Convert && b.type(o[0]) == Type::Float) {
            // What is no number is not below anything either.
            ExprId bad = one(Op::Not, raw(Op::Less, Type::Boolean, {one(Op::Abs, o[0]), b.number(2e9f)}));
            o[0] = raw(Op::Select, Type::Float, {bad, b.number(0), o[0]});
            return bad;
        }
        return {};
    }

    void copyOne(ExprId id) {
        const Expr& e = from[id];
        ExprId& out = map[id.index];
        if (e.op == Op::Constant && componentCount(e.type)) {
            out = b.constant(e.type, from.constantWords(id));
            return;
        }
        std::vector<ExprId> o;
        for (ExprId operand : from.operandsOf(e)) o.push_back(map[operand.index]);
        const Rounding rounding = roundingOf(e.op);
        std::optional<ExprId> bad, badInteger = undefinedInteger(e, o);
        if (moves(e.type)) {
            if (rounding == Rounding::Operands || rounding == Rounding::Approximate)
                for (ExprId& x : o) x = moved(x, Kind::Factor);
            bad = undefined(e.op, o);
        }
        out = b.emitRaw(e.op, e.type, o, e.payload);
        if (badInteger) out = raw(Op::Select, e.type, {*badInteger, knob(Kind::Any, Type::Integer), out});
        if (!moves(e.type)) return;
        if (bad) out = anything(out, *bad);
        if (e.op == Op::TextureLevel || e.op == Op::TextureGrad) out = spread(out, o);
        switch (rounding) {
            case Rounding::None:
                return;
            case Rounding::Once:
            case Rounding::Operands:
                out = moved(out, Kind::Factor);
                return;
            case Rounding::Approximate:
                out = moved(out, Kind::Approximate);
                out = two(Op::Add, out, knob(isArc(e.op) ? Kind::Coarse : Kind::Absolute, e.type));
                return;
            case Rounding::Read:
                if (e.op == Op::Context && info(static_cast<Context>(e.payload)).source != ContextSource::Vertex)
                    return;
                out = moved(out, Kind::Factor);
                out = two(Op::Add, out, knob(Kind::Absolute, e.type));
                return;
            case Rounding::Derivative:  // each pixel's own rounding of what is subtracted
                out = moved(out, Kind::Factor);
                out = two(Op::Add, out, two(Op::Mul, one(Op::Abs, o[0]), knob(Kind::Absolute, e.type)));
                return;
        }
    }

    void run() {
        fresh.name = from.name;
        fresh.params = from.params;
        fresh.loops = from.loops;
        for (std::uint32_t i = 0; i < from.exprs.size(); i++) copyOne(ExprId(i));
        for (const ResultValue& r : from.results) fresh.results.push_back({r.name, r.type, map[r.value.index]});
        to.module_.put(std::move(fresh));
    }
};

Wobbly::Wobbly(const Module& program) : module_(*program.names) {
    module_.uniforms = program.uniforms;
    module_.leaves = program.leaves;
    module_.structs = program.structs;
    module_.externs = program.externs;
    for (const auto& f : program.functions) Copier(*this, *f).run();
    shake(0);
}

void Wobbly::shake(std::uint32_t seed) {
    std::mt19937 random(seed);
    // Sure to lie on both sides of whatever is compared, and what spreads to all that is computed with it.
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr float kAny[] = {
        -3e3f, -7.3f, -0.37f, 0, 0, 0.93f, 7.3f, kInfinity, std::numeric_limits<float>::quiet_NaN()};
    // Some runs round as the interpreter does, for what is undefined at one number alone.
    const float sign = seed % 4 == 0 ? 0.0f : 1.0f;
    for (const Knob& k : knobs_) {
        Uniform& u = module_.uniforms[k.uniform];
        for (std::uint32_t& word : u.values) {
            const std::uint32_t raw = random();
            const float share = sign * (static_cast<float>(raw % 65536) / 32767.5f - 1);  // -1 … 1
            float v = 0;
            switch (k.kind) {
                case Kind::Factor:
                    v = 1 + share * 4e-7f;
                    break;
                case Kind::Approximate:
                    v = 1 + share * 5e-5f;
                    break;
                case Kind::Absolute:
                    v = share * 1e-6f;
                    break;
                case Kind::Coarse:
                    v = share * 3e-4f;
                    break;
                case Kind::Any:
                    v = kAny[raw % std::size(kAny)];
                    break;
            }
            if (u.type == Type::Integer && !std::isfinite(v)) v = 1e9f;
            word = u.type == Type::Integer ? static_cast<std::uint32_t>(static_cast<std::int32_t>(v))
                                           : std::bit_cast<std::uint32_t>(v);
        }
    }
}

}  // namespace shaderx::fuzz
