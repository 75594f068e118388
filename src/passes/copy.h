// Copies a function's expressions into another function, which simplifies them on the way.
#pragma once

#include <vector>

#include "ir/builder.h"

namespace shaderx::passes {

// What became of each expression of the source function. Loops get new numbers, in the old order, above those in use.
class Copy {
  public:
    Copy(const ir::Function& from, ir::Builder& to) : from_(from), to_(to), loopBase_(to.function().loops) {
        to.function().loops += from.loops;
        map_.resize(from.exprs.size());
    }
    ir::ExprId operator[](ir::ExprId e) const { return map_[e.index]; }
    void set(ir::ExprId e, ir::ExprId copy) { map_[e.index] = copy; }
    // The copies of an expression's operands; valid until the next call.
    std::span<const ir::ExprId> operands(ir::ExprId e);
    // Copies one expression whose operands are copied, its hint too.
    ir::ExprId one(ir::ExprId e) { return one(e, from_[e].type); }
    // The same as another type of as many components.
    ir::ExprId one(ir::ExprId e, ir::Type type);
    // The same, of operands that no rule makes simpler.
    ir::ExprId plain(ir::ExprId e, ir::Type type);

  private:
    const ir::Function& from_;
    ir::Builder& to_;
    std::uint32_t loopBase_;
    std::vector<ir::ExprId> map_, operands_;
};

}  // namespace shaderx::passes
