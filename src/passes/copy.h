// Copies a function's expressions into another function, which simplifies them on the way.
#pragma once

#include <array>
#include <initializer_list>
#include <vector>

#include "ir/builder.h"

namespace shaderx::passes {

// What became of each expression of the source function. Loops get new numbers, in the old order, above those in use.
class Copy {
  public:
    Copy(const ir::Function& from, ir::Builder& to)
        : from_(from), to_(to), loopBase_(to.function().loops), isTraced_(!from.origins.empty()) {
        to.function().loops += from.loops;
        map_.resize(from.exprs.size());
    }
    ir::ExprId operator[](ir::ExprId e) const { return map_[e.index]; }
    void set(ir::ExprId e, ir::ExprId copy) { map_[e.index] = copy; }
    // The copies of an expression's operands; valid until the next call.
    std::span<const ir::ExprId> operands(ir::ExprId e);
    // Says that what is made now comes from where an expression does, if its function tells.
    void follow(ir::ExprId e) {
        if (isTraced_) to_.function().beginOrigin(from_.originOf(e));
    }
    // Copies one expression whose operands are copied, its hint and origin too.
    ir::ExprId one(ir::ExprId e) { return one(e, from_[e].type); }
    // The same as another type of as many components.
    ir::ExprId one(ir::ExprId e, ir::Type type);
    // The same without a look for something simpler.
    ir::ExprId raw(ir::ExprId e);

  private:
    static constexpr std::size_t kFew = 4;  // operands, for which no memory is asked
    std::span<const ir::ExprId> fewOperands(const ir::Expr& e, std::array<ir::ExprId, kFew>& few) const;

    const ir::Function& from_;
    ir::Builder& to_;
    std::uint32_t loopBase_;
    bool isTraced_;
    std::vector<ir::ExprId> map_, operands_;
};

// What a function is called with and as, to build its expressions anew.
ir::Function headOf(const ir::Function& function);

// Appends expressions as they are, by no rules: for passes that leave nothing to simplify. Equal ones are not one.
class Appender {
  public:
    explicit Appender(ir::Function& function) : f_(function) {}
    void reserve(const ir::Function& like);
    ir::ExprId append(ir::Op op, ir::Type type, std::span<const ir::ExprId> operands, std::uint32_t payload = 0,
                      Name hint = {});
    ir::ExprId append(ir::Op op, ir::Type type, std::initializer_list<ir::ExprId> operands, std::uint32_t payload = 0,
                      Name hint = {}) {
        return append(op, type, std::span(operands.begin(), operands.size()), payload, hint);
    }
    // A constant that has words.
    ir::ExprId constant(ir::Type type, std::span<const std::uint32_t> words, Name hint = {});
    ir::Type type(ir::ExprId e) const { return f_.exprs[e.index].type; }

  private:
    ir::Function& f_;
};

}  // namespace shaderx::passes
