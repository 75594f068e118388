#include <algorithm>
#include <array>
#include <bit>

#include "passes/copy.h"
#include "passes/place.h"
#include "targets/glsl/glsl.h"

namespace shaderx::glsl {

using namespace ir;

namespace {

// All vectors of one size are one type here.
Type erased(Type t) {
    if (t == Type::Color3 || t == Type::Point || t == Type::Normal) return Type::Vector3;
    return t == Type::Color4 ? Type::Vector4 : t;
}

// Which operands of a built-in function may stay scalar when the others are vectors.
bool takesScalar(Op op, std::size_t operand) {
    switch (op) {
        case Op::Add:
        case Op::Sub:
        case Op::Mul:
        case Op::Div:
            return true;
        case Op::Min:
        case Op::Max:
        case Op::Mod:
            return operand == 1;
        case Op::Clamp:
            return operand > 0;
        case Op::Mix:
            return operand == 2;
        case Op::Step:
            return operand == 0;
        case Op::Smoothstep:
            return operand < 2;
        default:
            return false;  // pow, atan
    }
}

// Functions that the language has for numbers and vectors, while a matrix is any other componentwise operand to us.
bool takesNoMatrix(Op op) {
    switch (op) {
        case Op::Add:
        case Op::Sub:
        case Op::Mul:
        case Op::Div:
        case Op::Neg:
        case Op::Transpose:
        case Op::Inverse:
            return false;
        default:
            return info(op).rule == TypeRule::Wider || (info(op).rule == TypeRule::Same && info(op).operands == 1);
    }
}

struct Legaliser {
    const Function& from;
    Function fresh{};
    passes::Appender b{fresh};
    std::vector<ExprId> copy = std::vector<ExprId>(from.exprs.size());
    std::vector<ExprId> operands{};
    bool mayRepeat = false;

    void run() {
        fresh.name = from.name;
        fresh.comment = from.comment;
        fresh.loops = from.loops;
        for (const Param& p : from.params) fresh.params.push_back({p.name, erased(p.type)});
        b.reserve(from);
        for (std::uint32_t i = 0; i < from.exprs.size(); i++) {
            const Expr& e = from.exprs[i];
            if (operands.size() < e.operandCount) operands.resize(e.operandCount);
            const ExprId* old = from.operands.data() + e.firstOperand;
            for (std::uint32_t k = 0; k < e.operandCount; k++) operands[k] = copy[old[k].index];
            copy[i] = one(ExprId(i), {operands.data(), e.operandCount});
            if (Name hint = from.hints[i]; hint && !fresh.hints[copy[i].index]) fresh.hints[copy[i].index] = hint;
        }
        for (const ResultValue& r : from.results)
            fresh.results.push_back({r.name, b.type(copy[r.value.index]), copy[r.value.index]});
        compact(fresh);
    }

    ExprId one(ExprId id, std::span<const ExprId> o) {
        const Expr& e = from[id];
        const Type type = erased(e.type);
        if (e.op == Op::Constant && componentCount(type)) return b.constant(type, from.constantWords(id));
        if (e.op == Op::Retype && b.type(o[0]) == type) {
            mayRepeat = mayRepeat || !passes::isFree(fresh, o[0]);  // what was done in both roles
            return o[0];
        }
        if (e.op == Op::Swizzle && fresh[o[0]].op == Op::Retype) return part(fresh.operand(o[0], 0), type, e.payload);
        // What comes from outside keeps the type that it is declared with.
        if (type != e.type && (e.op == Op::Context || e.op == Op::Uniform || e.op == Op::Attribute))
            return b.append(Op::Retype, type, {b.append(e.op, e.type, {}, e.payload)});
        if (e.op == Op::Known) {
            const std::uint32_t no = 0;
            return b.constant(Type::Boolean, std::span(&no, 1));
        }
        if (isMatrix(type) && takesNoMatrix(e.op)) return byColumns(e.op, type, o);
        if (e.op == Op::Mod && type == Type::Integer) {
            // The language's own remainder is undefined for negative numbers, its quotient is not.
            ExprId quotient = b.append(Op::Div, type, {o[0], o[1]});
            return b.append(Op::Sub, type, {o[0], b.append(Op::Mul, type, {o[1], quotient})});
        }
        if (e.op == Op::Smoothstep || e.op == Op::Clamp || (info(e.op).rule == TypeRule::Wider && isVector(type)))
            return componentwise(e.op, type, o);
        if ((e.op == Op::TextureLevel || e.op == Op::TextureGrad) && type != Type::Vector4)
            return b.append(Op::Swizzle, type, {b.append(e.op, Type::Vector4, o)},
                            swizzleMask(componentCount(type), 0, 1, 2));
        if ((e.op == Op::Less || e.op == Op::LessEqual) && b.type(o[0]) == Type::Boolean)
            return b.append(e.op == Op::Less ? Op::And : Op::Or, type, {b.append(Op::Not, type, {o[0]}), o[1]});
        if (e.op == Op::Index) return b.append(e.op, type, {o[0], within(o[1], info(from[from.operand(id, 0)].type))});
        return b.append(e.op, type, o, e.payload);
    }

    // An index that the language defines: of a component, or of a column of a matrix.
    ExprId within(ExprId index, const TypeInfo& of) {
        const std::int32_t last = (of.columns > 1 ? of.columns : of.rows) - 1;
        if (!fresh.isConstant(index)) return b.append(Op::Clamp, Type::Integer, {index, integer(0), integer(last)});
        return integer(std::clamp(static_cast<std::int32_t>(fresh.constantWords(index)[0]), 0, last));
    }

    // A part of what comes from outside in another role.
    ExprId part(ExprId whole, Type type, std::uint32_t mask) {
        const Type own = floatVector(swizzleCount(mask), info(b.type(whole)).role);
        ExprId made = b.append(Op::Swizzle, own, {whole}, mask);
        return own == type ? made : b.append(Op::Retype, type, {made});
    }

    ExprId byColumns(Op op, Type type, std::span<const ExprId> o) {
        const Type column = floatVector(info(type).rows);
        std::vector<ExprId> columns;
        for (std::uint32_t c = 0; c < info(type).columns; c++) {
            std::vector<ExprId> parts(o.begin(), o.end());
            for (ExprId& part : parts)
                if (isMatrix(b.type(part))) part = b.append(Op::Swizzle, column, {part}, c);
            columns.push_back(info(op).rule == TypeRule::Wider ? componentwise(op, column, parts)
                                                               : b.append(op, column, parts));
        }
        return b.append(Op::Make, type, columns);
    }

    // A vector of one number.
    ExprId spread(ExprId number, Type type) {
        if (!fresh.isConstant(number)) return b.append(Op::Make, type, {number});
        std::array<std::uint32_t, 4> words;
        words.fill(fresh.constantWords(number)[0]);
        return b.constant(type,
                          std::span<const std::uint32_t>(words).first(static_cast<std::size_t>(componentCount(type))));
    }

    ExprId number(float v) {
        const std::uint32_t word = std::bit_cast<std::uint32_t>(v);
        return b.constant(Type::Float, std::span(&word, 1));
    }

    ExprId integer(std::int32_t v) {
        const std::uint32_t word = static_cast<std::uint32_t>(v);
        return b.constant(Type::Integer, std::span(&word, 1));
    }

    // How the edges of smoothstep and clamp lie, as far as constants say.
    enum class Edges { Rising, Falling, Unknown };
    Edges edges(ExprId low, ExprId high) const {
        if (!fresh.isConstant(low) || !fresh.isConstant(high) || b.type(low) == Type::Integer) return Edges::Unknown;
        const std::span<const std::uint32_t> lows = fresh.constantWords(low), highs = fresh.constantWords(high);
        const std::size_t n = std::max(lows.size(), highs.size());
        std::size_t rising = 0;
        for (std::size_t i = 0; i < n; i++)
            rising += std::bit_cast<float>(lows[lows.size() == 1 ? 0 : i]) <
                      std::bit_cast<float>(highs[highs.size() == 1 ? 0 : i]);
        return rising == n ? Edges::Rising : rising == 0 ? Edges::Falling : Edges::Unknown;
    }

    // The language leaves both undefined unless the edges rise. As smoothstep is the same from either end, it can start
    // at `high`, where it is 1 however the edges lie.
    ExprId clampAnyway(Type type, std::span<const ExprId> o) {
        return componentwise(Op::Min, type, std::array{componentwise(Op::Max, type, std::array{o[0], o[1]}), o[2]});
    }
    ExprId smoothstepAnyway(Type type, ExprId low, ExprId high, ExprId x) {
        auto wider = [&](ExprId e, ExprId f) { return isVector(b.type(e)) ? b.type(e) : b.type(f); };
        ExprId span = b.append(Op::Sub, wider(high, low), {high, low});
        span = b.append(Op::Max, b.type(span), {span, number(1e-20f)});
        ExprId t = b.append(Op::Sub, wider(high, x), {high, x});
        t = b.append(Op::Clamp, type, {b.append(Op::Div, type, {t, span}), number(0), number(1)});
        const ExprId slope = b.append(Op::Sub, type, {number(3), b.append(Op::Mul, type, {number(2), t})});
        return b.append(Op::Sub, type, {number(1), b.append(Op::Mul, type, {b.append(Op::Mul, type, {t, t}), slope})});
    }

    ExprId componentwise(Op op, Type type, std::span<const ExprId> given) {
        if (op == Op::Clamp && edges(given[1], given[2]) != Edges::Rising) return clampAnyway(type, given);
        if (op == Op::Smoothstep) {
            const Edges lie = edges(given[0], given[1]);
            if (lie == Edges::Falling) return componentwise(Op::Step, type, given.subspan(1));
            if (lie == Edges::Unknown) return smoothstepAnyway(type, given[0], given[1], given[2]);
        }
        if (!isVector(type)) return b.append(op, type, given);
        ExprId o[3];
        const std::size_t n = given.size();
        std::copy(given.begin(), given.end(), o);
        bool both = op == Op::Smoothstep || op == Op::Clamp;  // two edges: both scalar or both vectors
        bool anyVector = false;
        std::size_t first = op == Op::Clamp ? 1 : 0;
        for (std::size_t k = first; both && k < first + 2; k++) anyVector = anyVector || isVector(b.type(o[k]));
        for (std::size_t k = 0; k < n; k++) {
            if (isVector(b.type(o[k])) || (takesScalar(op, k) && !(both && anyVector))) continue;
            o[k] = spread(o[k], type);
        }
        return b.append(op, type, std::span<const ExprId>(o, n));
    }
};

}  // namespace

void legalise(Function& function) {
    Legaliser l{function};
    l.run();
    function = std::move(l.fresh);
    if (l.mayRepeat) unify(function);
}

}  // namespace shaderx::glsl
