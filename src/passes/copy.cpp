#include "passes/copy.h"

#include <array>

namespace shaderx::passes {

using namespace ir;

static constexpr std::size_t kFew = 4;  // operands, for which no memory is asked

std::span<const ExprId> Copy::operands(ExprId e) {
    std::span<const ExprId> from = from_.operandsOf(e);
    if (operands_.size() < from.size()) operands_.resize(from.size());
    for (std::size_t k = 0; k < from.size(); k++) operands_[k] = map_[from[k].index];
    return {operands_.data(), from.size()};
}

ExprId Copy::one(ExprId id, Type type) {
    const Expr& e = from_[id];
    std::uint32_t payload = e.payload;
    if (e.op == Op::LoopArg) payload += loopBase_ << 8;
    if (e.op == Op::Loop || e.op == Op::Lights) payload += loopBase_;
    ExprId made;
    if (e.op == Op::Constant && componentCount(e.type)) {
        made = to_.constant(type, from_.constantWords(id));
    } else if (e.operandCount <= kFew) {
        std::array<ExprId, kFew> few;
        const ExprId* from = from_.operands.data() + e.firstOperand;
        for (std::uint32_t k = 0; k < e.operandCount; k++) few[k] = map_[from[k].index];
        made = to_.emit(e.op, type, std::span<const ExprId>(few.data(), e.operandCount), payload);
    } else {
        made = to_.emit(e.op, type, operands(id), payload);
    }
    map_[id.index] = made;
    if (from_.hints[id.index]) to_.hint(made, from_.hints[id.index]);
    return made;
}

ExprId Copy::plain(ExprId id, Type type) {
    const Expr& e = from_[id];
    if (e.op == Op::Constant || e.op == Op::LoopArg || e.op == Op::Loop || e.op == Op::Lights) return one(id, type);
    ExprId made = to_.emitRaw(e.op, type, operands(id), e.payload);
    map_[id.index] = made;
    if (from_.hints[id.index]) to_.hint(made, from_.hints[id.index]);
    return made;
}

}  // namespace shaderx::passes
