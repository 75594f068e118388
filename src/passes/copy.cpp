#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

std::span<const ExprId> Copy::operands(ExprId e) {
    std::span<const ExprId> from = from_.operandsOf(e);
    if (operands_.size() < from.size()) operands_.resize(from.size());
    for (std::size_t k = 0; k < from.size(); k++) operands_[k] = map_[from[k].index];
    return {operands_.data(), from.size()};
}

ExprId Copy::one(ExprId id, Type type) {
    const Expr& e = from_[id];
    std::uint32_t payload = e.payload;
    ExprId made;
    if (e.op == Op::Constant && componentCount(e.type)) {
        made = to_.constant(type, from_.constantWords(id));
    } else {
        if (e.op == Op::LoopArg) payload += loopBase_ << 8;
        if (e.op == Op::Loop || e.op == Op::Lights) payload += loopBase_;
        made = to_.emit(e.op, type, operands(id), payload);
    }
    map_[id.index] = made;
    if (from_.hints[id.index]) to_.hint(made, from_.hints[id.index]);
    return made;
}

}  // namespace shaderx::passes
