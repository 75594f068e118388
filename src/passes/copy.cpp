#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

std::span<const ExprId> Copy::operands(ExprId e) {
    std::span<const ExprId> from = from_.operandsOf(e);
    if (operands_.size() < from.size()) operands_.resize(from.size());
    for (std::size_t k = 0; k < from.size(); k++) operands_[k] = map_[from[k].index];
    return {operands_.data(), from.size()};
}

inline std::span<const ExprId> Copy::fewOperands(const Expr& e, std::array<ExprId, kFew>& few) const {
    const ExprId* from = from_.operands.data() + e.firstOperand;
    for (std::uint32_t k = 0; k < e.operandCount; k++) few[k] = map_[from[k].index];
    return {few.data(), e.operandCount};
}

ExprId Copy::one(ExprId id, Type type) {
    follow(id);
    const Expr& e = from_[id];
    std::uint32_t payload = e.payload;
    if (e.op == Op::LoopArg) payload += loopBase_ << 8;
    if (e.op == Op::Loop || e.op == Op::Lights) payload += loopBase_;
    ExprId made;
    if (e.op == Op::Constant && componentCount(e.type)) {
        made = to_.constant(type, from_.constantWords(id));
    } else if (e.operandCount <= kFew) {
        std::array<ExprId, kFew> few;
        made = to_.emit(e.op, type, fewOperands(e, few), payload);
    } else {
        made = to_.emit(e.op, type, operands(id), payload);
    }
    map_[id.index] = made;
    if (from_.hints[id.index]) to_.hint(made, from_.hints[id.index]);
    return made;
}

ExprId Copy::raw(ExprId id) {
    follow(id);
    const Expr& e = from_[id];
    const bool isLoop = e.op == Op::LoopArg || e.op == Op::Loop || e.op == Op::Lights;
    if (isLoop || (e.op == Op::Constant && componentCount(e.type))) return one(id);
    ExprId made;
    if (e.operandCount <= kFew) {
        std::array<ExprId, kFew> few;
        made = to_.emitRaw(e.op, e.type, fewOperands(e, few), e.payload);
    } else {
        made = to_.emitRaw(e.op, e.type, operands(id), e.payload);
    }
    map_[id.index] = made;
    if (from_.hints[id.index]) to_.hint(made, from_.hints[id.index]);
    return made;
}

Function headOf(const Function& f) {
    Function head;
    head.name = f.name;
    head.params = f.params;
    head.comment = f.comment;
    head.isInline = f.isInline;
    return head;
}

void Appender::reserve(const Function& like) {
    f_.exprs.reserve(like.exprs.size());
    f_.hints.reserve(like.exprs.size());
    f_.operands.reserve(like.operands.size());
    f_.words.reserve(like.words.size());
}

ExprId Appender::append(Op op, Type type, std::span<const ExprId> operands, std::uint32_t payload, Name hint) {
    f_.exprs.push_back({op, 0, static_cast<std::uint16_t>(operands.size()), type, 0,
                        static_cast<std::uint32_t>(f_.operands.size()), payload});
    for (ExprId o : operands) f_.operands.push_back(o);
    f_.hints.push_back(hint);
    return ExprId(static_cast<std::uint32_t>(f_.exprs.size() - 1));
}

ExprId Appender::constant(Type type, std::span<const std::uint32_t> words, Name hint) {
    const std::uint32_t first = static_cast<std::uint32_t>(f_.words.size());
    f_.words.insert(f_.words.end(), words.begin(), words.end());
    return append(Op::Constant, type, std::span<const ExprId>(), first, hint);
}

}  // namespace shaderx::passes
