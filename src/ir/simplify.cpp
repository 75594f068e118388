#include "ir/simplify.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "ir/evaluate.h"

namespace shaderx::ir {

namespace {

constexpr std::size_t kMaxFolded = 16;

struct Simplifier {
    Builder& b;
    Op op;
    Type type;
    std::span<const ExprId> x;  // operands
    std::uint32_t payload;

    const Function& f() const { return b.function(); }
    const Expr& expr(ExprId e) const { return f()[e]; }
    bool is(ExprId e, Op o) const { return expr(e).op == o; }
    bool isNumber(ExprId e) const { return is(e, Op::Constant) && componentCount(expr(e).type) > 0; }

    // A constant each of whose components is v.
    bool isAll(ExprId e, float v) const {
        if (!isNumber(e)) return false;
        Scalar s = info(expr(e).type).scalar;
        std::uint32_t bits =
            s == Scalar::Float ? std::bit_cast<std::uint32_t>(v) : static_cast<std::uint32_t>(static_cast<int>(v));
        for (std::uint32_t w : f().constantWords(e))
            if (w != bits && !(s == Scalar::Float && v == 0 && w == 0x80000000u)) return false;
        return true;
    }
    bool isTrue(ExprId e) const { return expr(e).type == Type::Boolean && isNumber(e) && f().constantWords(e)[0]; }
    bool isFalse(ExprId e) const { return expr(e).type == Type::Boolean && isNumber(e) && !f().constantWords(e)[0]; }

    // The scalar that fills the vector e, or none.
    ExprId filler(ExprId e) const {
        const Expr& v = expr(e);
        if (!isVector(v.type)) return {};
        if (v.op == Op::Make && v.operandCount == 1 && isScalar(expr(f().operand(e, 0)).type)) return f().operand(e, 0);
        if (v.op != Op::Constant) return {};
        auto words = f().constantWords(e);
        for (std::uint32_t w : words)
            if (w != words[0]) return {};
        std::uint32_t word = words[0];
        return b.constant(Type::Float, std::span<const std::uint32_t>(&word, 1));
    }

    // e in the type of the result.
    ExprId fit(ExprId e) {
        if (expr(e).type == type) return e;
        ExprId fitted = b.convert(e, type);
        return fitted ? fitted : ExprId();
    }
    ExprId zero() { return b.null(type); }

    ExprId run() {
        if (ExprId e = fold()) return e;
        const OpInfo& o = info(op);
        if (o.rule == TypeRule::Wider)
            if (ExprId e = narrow()) return e;
        if (op == Op::GeomProp) return geometricProperty();
        if (op <= Op::Smoothstep) return op >= Op::Neg ? arithmetic() : ExprId();
        if (op <= Op::Determinant) return geometry();
        if (op <= Op::Select) return logic();
        if (op <= Op::Index) return composition();
        if (op == Op::Result) return result();
        if (op == Op::Ddx || op == Op::Ddy) return derivative();
        if (op >= Op::ClosureMix && op <= Op::ClosureLayer) return closure();
        return {};
    }

    // What the host supplies is the same in all pixels.
    ExprId derivative() {
        ExprId of = x[0];
        while (is(of, Op::Swizzle) || is(of, Op::Retype)) of = f().operand(of, 0);
        const Expr& e = f()[of];
        const bool isSupplied =
            e.op == Op::Context && info(static_cast<Context>(e.payload)).source == ContextSource::Uniform;
        return isSupplied || e.op == Op::Constant || e.op == Op::Uniform ? zero() : ExprId();
    }

    // Constants in, constant out.
    ExprId fold() {
        if (x.empty() || x.size() > kMaxFolded || componentCount(type) == 0) return {};
        for (ExprId e : x)
            if (!isNumber(e)) return {};
        return folded();
    }

    ExprId folded() {
        Operand values[kMaxFolded];
        for (std::size_t i = 0; i < x.size(); i++) values[i] = {expr(x[i]).type, f().constantWords(x[i]).data()};
        Value out;
        if (!evaluate(op, type, std::span(values, x.size()), payload, out)) return {};
        return b.constant(type,
                          std::span<const std::uint32_t>(out.words, static_cast<std::size_t>(componentCount(type))));
    }

    // A vector made of one scalar meets the others as that scalar; where all are, the work is done on scalars.
    ExprId narrow() {
        if (!isVector(type)) return {};
        ExprId narrowed[3];
        bool wide = false, changed = false;
        for (std::size_t i = 0; i < x.size(); i++) {
            narrowed[i] = x[i];
            if (ExprId s = filler(x[i])) {
                narrowed[i] = s;
                changed = true;
            } else if (isVector(expr(x[i]).type)) {
                wide = true;
            }
        }
        if (!changed) return {};
        if (wide) {  // the type of the result must still follow from what is left
            for (std::size_t i = 0; i < x.size(); i++)
                if (isVector(expr(narrowed[i]).type) && expr(narrowed[i]).type != type) return {};
            return b.emit(op, type, std::span<const ExprId>(narrowed, x.size()), payload);
        }
        return b.make(type, {b.emit(op, Type::Float, std::span<const ExprId>(narrowed, x.size()), payload)});
    }

    // Constants stand first in a product and last in a sum; else older operands first.
    ExprId ordered() {
        bool swap = x[1].index < x[0].index;
        if (isNumber(x[0]) != isNumber(x[1])) swap = op == Op::Mul ? isNumber(x[1]) : isNumber(x[0]);
        // The role of a vector follows from the first.
        if (info(op).rule == TypeRule::Wider && resultType(op, std::array{expr(x[1]).type, expr(x[0]).type}) != type)
            return {};
        return swap ? b.emit(op, type, {x[1], x[0]}, payload) : ExprId();
    }

    // c1 op (c2 op y) is (c1 op c2) op y, where the constants are scalars or of one type.
    ExprId regroup(std::size_t constant, std::size_t other) {
        ExprId inner = x[other];
        if (!isNumber(x[constant]) || !is(inner, op) || expr(inner).type != type) return {};
        ExprId c2 = f().operand(inner, constant), y = f().operand(inner, other);
        if (!isNumber(c2)) return {};
        ExprId c = b.op(op, {x[constant], c2});
        if (resultType(op, std::array{expr(c).type, expr(y).type}) != type) return {};
        return constant == 0 ? b.emit(op, type, {c, y}) : b.emit(op, type, {y, c});
    }

    ExprId arithmetic() {
        switch (op) {
            case Op::Neg:
                if (is(x[0], Op::Neg)) return f().operand(x[0], 0);
                if (is(x[0], Op::Sub)) {
                    ExprId p = f().operand(x[0], 0), q = f().operand(x[0], 1);
                    if (resultType(Op::Sub, std::array{expr(q).type, expr(p).type}) == type)
                        return b.emit(Op::Sub, type, {q, p});
                }
                return {};
            case Op::Add:
                if (isAll(x[0], 0)) return fit(x[1]);
                if (isAll(x[1], 0)) return fit(x[0]);
                if (is(x[1], Op::Neg)) return b.emit(Op::Sub, type, {x[0], f().operand(x[1], 0)});
                if (is(x[0], Op::Neg) && resultType(op, std::array{expr(x[1]).type, expr(x[0]).type}) == type)
                    return b.emit(Op::Sub, type, {x[1], f().operand(x[0], 0)});
                if (ExprId e = regroup(1, 0)) return e;
                return ordered();
            case Op::Sub:
                if (isAll(x[1], 0)) return fit(x[0]);
                if (isAll(x[0], 0)) return fit(b.op(Op::Neg, {x[1]}));
                if (x[0] == x[1]) return zero();
                if (is(x[1], Op::Neg)) return b.emit(Op::Add, type, {x[0], f().operand(x[1], 0)});
                return {};
            case Op::Mul:
                return product();
            case Op::Div:
                if (isAll(x[1], 1)) return fit(x[0]);
                if (isAll(x[0], 0)) return zero();
                // A value of the document may be 0, and 0 / 0 is 0 by the rule above once it is known.
                if (x[0] == x[1] && varies(x[0], 10)) return b.constant(type, {1.0f});
                return {};
            case Op::Min:
            case Op::Max:
                if (x[0] == x[1]) return x[0];
                return ordered();
            case Op::Pow:
                if (isAll(x[1], 1)) return fit(x[0]);
                if (isAll(x[1], 0)) return b.constant(type, {1.0f});
                if (isAll(x[1], 2) && expr(x[0]).type == type) return b.emit(Op::Mul, type, {x[0], x[0]});
                if (isAll(x[0], 1)) return b.constant(type, {1.0f});
                return {};
            case Op::Mix:
                return mix();
            case Op::Clamp:
                if (is(x[0], Op::Clamp) && f().operand(x[0], 1) == x[1] && f().operand(x[0], 2) == x[2] &&
                    expr(x[0]).type == type)
                    return x[0];
                return {};
            default:
                return {};  // Mod, Atan2, Step, Smoothstep and whatever is no arithmetic: no rule
        }
    }

    ExprId product() {
        if (isAll(x[0], 0) || isAll(x[1], 0)) return zero();
        if (isAll(x[0], 1)) return fit(x[1]);
        if (isAll(x[1], 1)) return fit(x[0]);
        if (isAll(x[0], -1)) return fit(b.op(Op::Neg, {x[1]}));
        if (isAll(x[1], -1)) return fit(b.op(Op::Neg, {x[0]}));
        if (ExprId e = regroup(0, 1)) return e;
        return ordered();
    }

    ExprId mix() {
        ExprId from = x[0], to = x[1], t = x[2];
        if (isAll(t, 0) || from == to) return fit(from);
        if (isAll(t, 1)) return fit(to);
        if (info(type).scalar != Scalar::Float) return {};
        if (isAll(from, 0)) return fit(b.op(Op::Mul, {to, t}));
        if (isAll(to, 0)) return fit(b.op(Op::Mul, {from, b.op(Op::Sub, {b.number(1), t})}));
        return {};
    }

    ExprId geometry() {
        switch (op) {
            case Op::Abs:
            case Op::Normalize:
            case Op::Floor:
            case Op::Ceil:
            case Op::Round:
                if (is(x[0], op)) return x[0];
                return {};
            case Op::Dot:
                if (x[0] == x[1] && is(x[0], Op::Normalize)) return b.number(1);
                return ordered();
            case Op::Transpose:
            case Op::Inverse:
                if (is(x[0], op)) return f().operand(x[0], 0);
                return {};
            default:
                return {};  // no rule
        }
    }

    ExprId logic() {
        switch (op) {
            case Op::Equal:
            case Op::NotEqual:
                return equality();
            case Op::Less:
                if (x[0] == x[1]) return b.boolean(false);
                return {};
            case Op::LessEqual:
                if (x[0] == x[1]) return b.boolean(true);
                return {};
            case Op::And:
                if (isFalse(x[0]) || isFalse(x[1])) return b.boolean(false);
                if (isTrue(x[0]) || x[0] == x[1]) return x[1];
                if (isTrue(x[1])) return x[0];
                return ordered();
            case Op::Or:
                if (isTrue(x[0]) || isTrue(x[1])) return b.boolean(true);
                if (isFalse(x[0]) || x[0] == x[1]) return x[1];
                if (isFalse(x[1])) return x[0];
                return ordered();
            case Op::Not:
                return negation();
            case Op::Select:
                return choice();
            default:
                return {};  // no rule
        }
    }

    ExprId equality() {
        bool same = x[0] == x[1];
        if (same) return b.boolean(op == Op::Equal);
        if (is(x[0], Op::Constant) && is(x[1], Op::Constant) && expr(x[0]).type == Type::String)
            return b.boolean(op == Op::NotEqual);  // equal ones would be one expression
        return ordered();
    }

    ExprId negation() {
        const Expr& e = expr(x[0]);
        ExprId p = e.operandCount ? f().operand(x[0], 0) : ExprId(), q = e.operandCount > 1 ? f().operand(x[0], 1) : p;
        if (e.op == Op::Not) return p;
        if (e.op == Op::Less) return b.emit(Op::LessEqual, type, {q, p});
        if (e.op == Op::LessEqual) return b.emit(Op::Less, type, {q, p});
        if (e.op == Op::Equal) return b.emit(Op::NotEqual, type, {p, q});
        if (e.op == Op::NotEqual) return b.emit(Op::Equal, type, {p, q});
        return {};
    }

    ExprId choice() {
        if (isTrue(x[0]) || x[1] == x[2]) return x[1];
        if (isFalse(x[0])) return x[2];
        if (is(x[0], Op::Not)) return b.emit(op, type, {f().operand(x[0], 0), x[2], x[1]});
        if (type == Type::Boolean) {
            if (isTrue(x[1])) return b.op(Op::Or, {x[0], x[2]});
            if (isFalse(x[2])) return b.op(Op::And, {x[0], x[1]});
            if (isFalse(x[1]) && isTrue(x[2])) return b.op(Op::Not, {x[0]});
        }
        // The same question asked again inside.
        if (is(x[1], Op::Select) && f().operand(x[1], 0) == x[0])
            return b.emit(op, type, {x[0], f().operand(x[1], 1), x[2]});
        if (is(x[2], Op::Select) && f().operand(x[2], 0) == x[0])
            return b.emit(op, type, {x[0], x[1], f().operand(x[2], 2)});
        return {};
    }

    ExprId composition() {
        switch (op) {
            case Op::Make:
                return make();
            case Op::Swizzle:
                return swizzle();
            case Op::Convert:
                if (expr(x[0]).type == type) return x[0];
                return {};
            case Op::Retype:
                if (expr(x[0]).type == type) return x[0];
                if (is(x[0], Op::Retype)) return b.emit(Op::Retype, type, {f().operand(x[0], 0)});
                if (is(x[0], Op::Make)) {
                    std::vector<ExprId> parts(f().operandsOf(x[0]).begin(), f().operandsOf(x[0]).end());
                    return b.make(type, parts);
                }
                return {};
            case Op::Member:
                return member();
            case Op::Index:
                if (isVector(expr(x[0]).type) && isNumber(x[1])) {
                    int i = static_cast<int>(f().constantWords(x[1])[0]);
                    return b.component(x[0], std::clamp(i, 0, componentCount(expr(x[0]).type) - 1));
                }
                return {};
            default:
                return {};  // no rule
        }
    }

    // Component i of a vector where it is known without reading the vector.
    ExprId componentOf(ExprId v, int i) {
        if (ExprId s = filler(v)) return s;
        if (isNumber(v)) {
            std::uint32_t word = f().constantWords(v)[static_cast<std::size_t>(i)];
            return b.constant(Type::Float, std::span<const std::uint32_t>(&word, 1));
        }
        if (is(v, Op::Retype)) return componentOf(f().operand(v, 0), i);
        if (!is(v, Op::Make) || isMatrix(expr(v).type)) return {};
        for (ExprId part : f().operandsOf(v)) {
            int n = componentCount(expr(part).type);
            if (i < n) return n == 1 ? part : b.component(part, i);
            i -= n;
        }
        return {};
    }

    ExprId swizzle() {
        ExprId v = x[0];
        Type from = expr(v).type;
        if (isMatrix(from)) return is(v, Op::Make) ? column(v) : ExprId();
        int n = swizzleCount(payload);
        bool identity = n == componentCount(from);
        for (int i = 0; i < n && identity; i++) identity = swizzleAt(payload, i) == i;
        if (identity) return fit(v);
        if (is(v, Op::Swizzle) && isVector(expr(f().operand(v, 0)).type)) {
            std::uint32_t inner = expr(v).payload;
            auto at = [&](int i) { return swizzleAt(inner, swizzleAt(payload, i)); };
            std::uint32_t mask = swizzleMask(n, at(0), n > 1 ? at(1) : 0, n > 2 ? at(2) : 0, n > 3 ? at(3) : 0);
            return b.emit(op, type, {f().operand(v, 0)}, mask);
        }
        if (is(v, Op::Retype)) return fit(b.swizzle(f().operand(v, 0), payload));
        ExprId parts[4];
        for (int i = 0; i < n; i++)
            if (!(parts[i] = componentOf(v, swizzleAt(payload, i)))) return {};
        return n == 1 ? parts[0] : b.make(type, std::span<const ExprId>(parts, static_cast<std::size_t>(n)));
    }

    ExprId column(ExprId m) {
        if (expr(m).operandCount != info(expr(m).type).columns) return {};
        ExprId c = f().operand(m, payload);
        return isVector(expr(c).type) ? fit(c) : ExprId();
    }

    // A structure is what it was made of; of a choice, the choice of the members.
    ExprId member() {
        if (is(x[0], Op::Make)) return f().operand(x[0], payload);
        if (is(x[0], Op::Constant)) return zero();
        if (!is(x[0], Op::Select)) return {};
        const ExprId condition = f().operand(x[0], 0), then = f().operand(x[0], 1), otherwise = f().operand(x[0], 2);
        const ExprId ofThen = b.emit(Op::Member, type, {then}, payload);
        return b.select(condition, ofThen, b.emit(Op::Member, type, {otherwise}, payload));
    }

    ExprId make() {
        if (isStruct(type)) return {};
        if (x.size() == 1 && expr(x[0]).type == type) return x[0];
        if (isMatrix(type)) return upperPart();
        if (x.size() == 1 && isVector(expr(x[0]).type)) return fit(x[0]);
        if (x.size() < 2) return {};
        // Parts that are vectors made of scalars are those scalars.
        std::vector<ExprId> flat;
        bool changed = false;
        for (ExprId part : x) {
            int n = componentCount(expr(part).type);
            if (n > 1 && (is(part, Op::Make) || is(part, Op::Constant))) {
                changed = true;
                for (int i = 0; i < n; i++) flat.push_back(b.component(part, i));
            } else {
                flat.push_back(part);
            }
        }
        if (changed) return b.make(type, flat);
        if (std::all_of(x.begin(), x.end(), [&](ExprId e) { return e == x[0] && isScalar(expr(e).type); }))
            return b.make(type, {x[0]});
        return gathered();
    }

    // Whether an expression is made of more than constants and uniforms, as far as a look of some depth tells.
    bool varies(ExprId e, int depth) const {
        const Expr& of = expr(e);
        if (of.op == Op::Constant || of.op == Op::Uniform) return false;
        auto operands = f().operandsOf(of);
        return depth == 0 || operands.empty() ||
               std::any_of(operands.begin(), operands.end(), [&](ExprId o) { return varies(o, depth - 1); });
    }

    // make(m[0].xyz, m[1].xyz, m[2].xyz) is the upper left part of m.
    ExprId upperPart() {
        ExprId matrix;
        if (type != Type::Matrix33 || x.size() != 3) return {};
        for (std::uint32_t k = 0; k < 3; k++) {
            if (!is(x[k], Op::Swizzle) || expr(x[k]).payload != swizzleMask(3, 0, 1, 2)) return {};
            ExprId from = f().operand(x[k], 0);
            if (!is(from, Op::Swizzle) || expr(from).payload != k) return {};
            ExprId of = f().operand(from, 0);
            if (expr(of).type != Type::Matrix44 || (matrix && of != matrix)) return {};
            matrix = of;
        }
        return b.make(type, {matrix});
    }

    // make(v.x, v.y, v.z) is v or a swizzle of it.
    ExprId gathered() {
        ExprId source;
        int at[4] = {}, n = 0;
        for (ExprId part : x) {
            if (!is(part, Op::Swizzle)) return {};
            ExprId from = f().operand(part, 0);
            if ((source && from != source) || !isVector(expr(from).type)) return {};
            source = from;
            std::uint32_t mask = expr(part).payload;
            for (int i = 0; i < swizzleCount(mask); i++) at[n++] = swizzleAt(mask, i);
        }
        return fit(b.swizzle(source, swizzleMask(n, at[0], at[1], at[2], at[3])));
    }

    ExprId geometricProperty() {
        if (!is(x[0], Op::Constant)) return {};
        NameTable& names = *b.module().names;
        std::string_view text = names.text(Name(expr(x[0]).payload));
        return b.attribute(names.intern("geomprop_" + std::string(text)), type);
    }

    // A carried value that never changes, or a loop that never turns.
    ExprId result() {
        if (!is(x[0], Op::Loop)) return {};
        auto operands = f().operandsOf(x[0]);
        std::size_t carried = (operands.size() - 1) / 2;
        ExprId count = operands[0], first = operands[1 + payload], next = operands[1 + carried + payload];
        if (isNumber(count) && static_cast<int>(f().constantWords(count)[0]) <= 0) return first;
        if (next == first) return first;
        const Expr& n = expr(next);
        if (n.op == Op::LoopArg && n.payload == (expr(x[0]).payload << 8 | (payload + 1))) return first;
        return {};
    }

    bool isNull(ExprId e) const { return is(e, Op::Constant); }

    ExprId closure() {
        switch (op) {
            case Op::ClosureMix:
                if (isAll(x[2], 0) || x[0] == x[1]) return x[0];
                if (isAll(x[2], 1)) return x[1];
                // How much light passes a BSDF is mixed too, and scaling keeps it.
                if (type == Type::SurfaceShader || type == Type::BSDF) return {};
                if (isNull(x[0])) return b.emit(Op::ClosureScale, type, {x[1], x[2]});
                if (isNull(x[1])) return b.emit(Op::ClosureScale, type, {x[0], b.op(Op::Sub, {b.number(1), x[2]})});
                return {};
            case Op::ClosureAdd:
                if (isNull(x[0])) return x[1];
                if (isNull(x[1])) return x[0];
                return {};
            case Op::ClosureScale:
                if (isNull(x[0]) || isAll(x[1], 1)) return x[0];
                // A BSDF without light of its own still stands before what lies below it.
                if (isAll(x[1], 0) && type != Type::BSDF) return b.null(type);
                return {};
            case Op::ClosureLayer:
                // Nothing over a volume is nothing that a surface has.
                if (isNull(x[0])) return expr(x[1]).type == type ? x[1] : b.null(type);
                if (isNull(x[1])) return x[0];
                return {};
            default:
                return {};  // no other closure is simplified
        }
    }
};

}  // namespace

// True where no rule for arithmetic looks twice at these operands, which is what most are.
static bool isPlain(const Function& f, Op op, std::span<const ExprId> x) {
    for (ExprId o : x) {
        const Op of = f[o].op;
        if (of == Op::Constant || of == Op::Make || of == Op::Neg || of == Op::Sub || of == op) return false;
    }
    // Equal operands, or not in order.
    return x.size() < 2 || x[0].index < x[1].index;
}

ExprId simplify(Builder& b, Op op, Type type, std::span<const ExprId> operands, std::uint32_t payload) {
    if (op >= Op::Neg && op <= Op::Determinant && isPlain(b.function(), op, operands)) return {};
    // The arena may grow while rules build, so the operands are copied.
    if (operands.size() <= kMaxFolded) {
        std::array<ExprId, kMaxFolded> copy;
        for (std::size_t k = 0; k < operands.size(); k++) copy[k] = operands[k];  // few: a call would cost more
        return Simplifier{b, op, type, std::span<const ExprId>(copy.data(), operands.size()), payload}.run();
    }
    const std::vector<ExprId> many(operands.begin(), operands.end());
    return Simplifier{b, op, type, many, payload}.run();
}

}  // namespace shaderx::ir
