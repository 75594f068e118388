#include <algorithm>

#include "passes/copy.h"
#include "targets/glsl/glsl.h"

namespace shaderx::glsl {

using namespace ir;

namespace {

// All vectors of one size are one type here.
Type erased(Type t) {
    switch (t) {
        case Type::Color3:
        case Type::Point:
        case Type::Normal:
            return Type::Vector3;
        case Type::Color4:
            return Type::Vector4;
        default:
            return t;  // every other type is what it is
    }
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
    Module& module;
    const Function& from;
    Function fresh{};
    Builder b{module, fresh};
    passes::Copy copy{from, b};

    void run() {
        fresh.name = from.name;
        fresh.comment = from.comment;
        for (const Param& p : from.params) fresh.params.push_back({p.name, erased(p.type)});
        b.reserve(from.exprs.size());
        for (std::uint32_t i = 0; i < from.exprs.size(); i++) one(ExprId(i));
        for (const ResultValue& r : from.results) b.addResult(r.name, copy[r.value]);
        compact(fresh);
    }

    void one(ExprId id) {
        const Expr& e = from[id];
        Type type = erased(e.type);
        std::span<const ExprId> o = copy.operands(id);
        ExprId made;
        if (e.op == Op::Retype && b.type(o[0]) == type) {
            made = o[0];
        } else if (type != e.type && (e.op == Op::Context || e.op == Op::Uniform || e.op == Op::Attribute)) {
            // What comes from outside keeps the type that it is declared with.
            made = b.emit(Op::Retype, type, {copy.one(id)});
        } else if (e.op == Op::Known) {
            made = b.boolean(false);
        } else if (isMatrix(type) && takesNoMatrix(e.op)) {
            made = byColumns(e.op, type, o);
        } else if (info(e.op).rule == TypeRule::Wider && isVector(type)) {
            made = componentwise(e.op, type, o);
        } else if ((e.op == Op::TextureLevel || e.op == Op::TextureGrad) && type != Type::Vector4) {
            made = b.swizzle(b.emit(e.op, Type::Vector4, o), swizzleMask(componentCount(type), 0, 1, 2));
        } else if (e.op == Op::Mod && type == Type::Integer) {
            // The language's own remainder is undefined for negative numbers, its quotient is not.
            made = b.op(Op::Sub, {o[0], b.op(Op::Mul, {o[1], b.op(Op::Div, {o[0], o[1]})})});
        } else if (e.op == Op::Less && b.type(o[0]) == Type::Boolean) {
            made = b.op(Op::And, {b.op(Op::Not, {o[0]}), o[1]});
        } else if (e.op == Op::LessEqual && b.type(o[0]) == Type::Boolean) {
            made = b.op(Op::Or, {b.op(Op::Not, {o[0]}), o[1]});
        } else {
            // A role that went may have stood between a vector and its parts.
            const bool isComposed = e.op >= Op::Make && e.op <= Op::Index;
            isComposed ? copy.one(id, type) : copy.plain(id, type);
            return;
        }
        copy.set(id, made);
        if (from.hints[id.index]) b.hint(made, from.hints[id.index]);
    }

    ExprId byColumns(Op op, Type type, std::span<const ExprId> o) {
        const Type column = floatVector(info(type).rows);
        std::vector<ExprId> columns;
        for (std::uint32_t c = 0; c < info(type).columns; c++) {
            std::vector<ExprId> parts(o.begin(), o.end());
            for (ExprId& part : parts)
                if (isMatrix(b.type(part))) part = b.swizzle(part, c);
            columns.push_back(info(op).rule == TypeRule::Wider ? componentwise(op, column, parts)
                                                               : b.emit(op, column, parts));
        }
        return b.make(type, columns);
    }

    ExprId componentwise(Op op, Type type, std::span<const ExprId> operands) {
        ExprId o[3];
        const std::size_t n = operands.size();
        std::copy(operands.begin(), operands.end(), o);
        bool both = op == Op::Smoothstep || op == Op::Clamp;  // two edges: both scalar or both vectors
        bool anyVector = false;
        std::size_t first = op == Op::Clamp ? 1 : 0;
        for (std::size_t k = first; both && k < first + 2; k++) anyVector = anyVector || isVector(b.type(o[k]));
        bool spread = false;
        for (std::size_t k = 0; k < n; k++) {
            if (isVector(b.type(o[k])) || (takesScalar(op, k) && !(both && anyVector))) continue;
            // Made without the rules that would narrow it again.
            o[k] = b.emit(Op::Make, type, {o[k]});
            spread = true;
        }
        return spread ? b.emitRaw(op, type, std::span(o, n)) : b.emit(op, type, std::span<const ExprId>(o, n));
    }
};

}  // namespace

void legalise(Module& module, Function& function) {
    Legaliser l{module, function};
    l.run();
    l.fresh.name = function.name;
    function = std::move(l.fresh);
}

}  // namespace shaderx::glsl
