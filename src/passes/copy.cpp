#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

std::span<const ExprId> Copy::operands(ExprId e) {
    operands_.clear();
    for (ExprId o : from_.operandsOf(e)) operands_.push_back(map_[o.index]);
    return operands_;
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
    set(id, made);
    if (from_.hints[id.index]) to_.hint(made, from_.hints[id.index]);
    return made;
}

}  // namespace shaderx::passes
