// Lowering: operators on values.
#include "sl/lower_state.h"

namespace shaderx::sl {

static std::string_view sign(Operator op) {
    switch (op) {
        case Operator::None:
            return "=";
        case Operator::Add:
        case Operator::Plus:
            return "+";
        case Operator::Sub:
        case Operator::Neg:
            return "-";
        case Operator::Mul:
            return "*";
        case Operator::Div:
            return "/";
        case Operator::Rem:
            return "%";
        case Operator::BitAnd:
            return "&";
        case Operator::BitOr:
            return "|";
        case Operator::BitXor:
            return "^";
        case Operator::ShiftLeft:
            return "<<";
        case Operator::ShiftRight:
            return ">>";
        case Operator::ShiftRightLogical:
            return ">>>";
        case Operator::Less:
            return "<";
        case Operator::LessEqual:
            return "<=";
        case Operator::Greater:
            return ">";
        case Operator::GreaterEqual:
            return ">=";
        case Operator::Equal:
            return "==";
        case Operator::NotEqual:
            return "!=";
        case Operator::And:
            return "&&";
        case Operator::Or:
            return "||";
        case Operator::Not:
            return "!";
        case Operator::BitNot:
            return "~";
    }
    return "";
}

// `y` is Void for unary operators.
void Lowering::doesNotFit(Operator op, Type x, Type y, std::uint32_t offset) {
    const ir::TypeInfo &a = ir::info(x), &c = ir::info(y);
    if (y == Type::Void) {
        report.error(offset, "type-mismatch", fmt::format("'{}' does not take {}", sign(op), a.name));
        return;
    }
    Diagnostic& d =
        report.error(offset, "type-mismatch", fmt::format("'{}' does not take {} and {}", sign(op), a.name, c.name));
    bool isComparison = op >= Operator::Less && op <= Operator::NotEqual;
    if (op == Operator::Rem)
        d.hint = "for floats write 'mod(a, b)'";
    else if (isComparison && (ir::isVector(x) || ir::isVector(y)))
        d.hint = "compare components, or lengths";
    else if (isComparison || ir::isClosure(x) || ir::isClosure(y))
        d.hint = "";
    else if (op == Operator::Mul && ir::isVector(x) && c.columns == a.rows)
        d.hint = "write 'transpose(matrix) * vector'";
    else if (op == Operator::Mul && x == Type::Matrix44 && c.rows == 3)
        d.hint = "write 'matrix * vector4(v, 1.0)' for a point, '... 0.0' for a direction";
    else if (ir::isVector(x) && ir::isVector(y) && a.rows == c.rows)
        d.hint = fmt::format("write '{}(...)' or '{}(...)'", a.name, c.name);
}

ExprId Lowering::binaryValue(Operator op, ExprId x, ExprId y, std::uint32_t offset) {
    if (!x || !y) return {};
    ExprId made;
    if (op >= Operator::Add && op <= Operator::Div)
        made = arithmetic(op, x, y);
    else if (op >= Operator::Rem && op <= Operator::ShiftRightLogical)
        made = bits(op, x, y);
    else if (op >= Operator::Less && op <= Operator::NotEqual)
        made = comparison(op, x, y);
    else if (b.type(x) == Type::Boolean && b.type(y) == Type::Boolean)
        made = b.op(op == Operator::And ? Op::And : Op::Or, {x, y});
    if (!made) doesNotFit(op, b.type(x), b.type(y), offset);
    return made;
}

// Operands of types that meet in `type`: numbers and vectors are brought to its kind, not to its width.
ExprId Lowering::componentwise(Op op, Type type, std::span<const ExprId> operands) {
    ExprId fitted[4];
    for (std::size_t k = 0; k < operands.size(); k++) {
        bool isNarrow = ir::isScalar(b.type(operands[k])) && type != Type::Integer;
        fitted[k] = b.convert(operands[k], isNarrow ? Type::Float : type);
        ensure(static_cast<bool>(fitted[k]), "types that do not meet");
    }
    return b.emit(op, type, std::span<const ExprId>(fitted, operands.size()));
}

ExprId Lowering::arithmetic(Operator op, ExprId x, ExprId y) {
    if (ir::isClosure(b.type(x)) || ir::isClosure(b.type(y))) return closureArithmetic(op, x, y);
    bool hasMatrix = ir::isMatrix(b.type(x)) || ir::isMatrix(b.type(y));
    if (op == Operator::Mul && hasMatrix && !ir::isScalar(b.type(x)) && !ir::isScalar(b.type(y)))
        return matrixProduct(x, y);
    Type type = meet(b.type(x), b.type(y));
    if (type == Type::Void) return {};
    constexpr Op kOps[] = {Op::Add, Op::Sub, Op::Mul, Op::Div};
    ExprId operands[] = {x, y};
    bool isDifference = op == Operator::Sub && type == Type::Point && b.type(x) == b.type(y);
    ExprId made = componentwise(kOps[static_cast<int>(op) - static_cast<int>(Operator::Add)], type, operands);
    return isDifference ? b.convert(made, Type::Vector3) : made;
}

ExprId Lowering::closureArithmetic(Operator op, ExprId x, ExprId y) {
    auto isLobes = [&](ExprId e) {
        return b.type(e) == Type::BSDF || b.type(e) == Type::EDF || b.type(e) == Type::VDF;
    };
    if (op == Operator::Add && isLobes(x) && b.type(x) == b.type(y)) return b.op(Op::ClosureAdd, {x, y});
    if (op != Operator::Mul) return {};
    if (isLobes(y)) std::swap(x, y);
    if (b.type(y) == Type::Integer) y = b.convert(y, Type::Float);
    bool isWeight = b.type(y) == Type::Float || b.type(y) == Type::Color3;
    return isLobes(x) && isWeight ? b.op(Op::ClosureScale, {x, y}) : ExprId();
}

ExprId Lowering::matrixProduct(ExprId x, ExprId y) {
    const ir::TypeInfo &a = ir::info(b.type(x)), &c = ir::info(b.type(y));
    return a.columns > 1 && a.columns == c.rows ? b.op(Op::MulMatrix, {x, y}) : ExprId();
}

ExprId Lowering::bits(Operator op, ExprId x, ExprId y) {
    if (b.type(x) != Type::Integer || b.type(y) != Type::Integer) return {};
    constexpr Op kOps[] = {Op::Mod,        Op::BitAnd,           Op::BitOr, Op::BitXor, Op::ShiftLeft,
                           Op::ShiftRight, Op::ShiftRightLogical};
    return b.op(kOps[static_cast<int>(op) - static_cast<int>(Operator::Rem)], {x, y});
}

ExprId Lowering::comparison(Operator op, ExprId x, ExprId y) {
    Type s = b.type(x), t = b.type(y);
    bool isEquality = op == Operator::Equal || op == Operator::NotEqual;
    bool isSame = s == t && (s == Type::Boolean || s == Type::String) && isEquality;
    bool isNumbers = ir::isNumeric(s) && ir::isNumeric(t) && ir::isScalar(s) && ir::isScalar(t);
    if (!isSame && !isNumbers) return {};
    if (isNumbers) {
        Type common = meet(s, t);
        x = b.convert(x, common);
        y = b.convert(y, common);
    }
    if (op == Operator::Equal) return b.op(Op::Equal, {x, y});
    if (op == Operator::NotEqual) return b.op(Op::NotEqual, {x, y});
    if (op == Operator::Less) return b.op(Op::Less, {x, y});
    if (op == Operator::LessEqual) return b.op(Op::LessEqual, {x, y});
    if (op == Operator::Greater) return b.op(Op::Less, {y, x});
    return b.op(Op::LessEqual, {y, x});
}

}  // namespace shaderx::sl
