// Makes expressions: folds constants, simplifies, and gives equal expressions one handle.
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include "ir/module.h"

namespace shaderx::ir {

// Appends to one function. Whoever builds asks for what it wants; what it gets may be an older or simpler expression of
// the same value (simplify.h has the rules). Types must fit (`resultType`), else it is an internal error.
class Builder {
  public:
    Builder(Module& module, Function& function);
    Module& module() { return module_; }
    Function& function() { return f_; }
    const Function& function() const { return f_; }
    // Makes room for as many expressions in all.
    void reserve(std::size_t expressions);

    ExprId constant(Type type, std::span<const std::uint32_t> words);
    ExprId constant(Type type, std::initializer_list<float> values);  // one value fills the type
    ExprId number(float v) { return constant(Type::Float, {v}); }
    ExprId integer(int v);
    ExprId boolean(bool v);
    ExprId string(Name text);
    ExprId null(Type type);  // the empty closure; zero for numbers; the empty string

    ExprId param(std::uint32_t index);  // of Function::params
    ExprId context(Context c);
    ExprId attribute(Name name, Type type);
    ExprId uniform(Name name, Type type);

    // Any operation whose type follows from its operands.
    ExprId op(Op op, std::initializer_list<ExprId> operands);
    // Any operation at all.
    ExprId emit(Op op, Type type, std::span<const ExprId> operands, std::uint32_t payload = 0);
    ExprId emit(Op op, Type type, std::initializer_list<ExprId> operands, std::uint32_t payload = 0) {
        return emit(op, type, std::span(operands.begin(), operands.size()), payload);
    }
    // Exactly this expression, for targets that need the form and not a simpler one.
    ExprId emitRaw(Op op, Type type, std::span<const ExprId> operands, std::uint32_t payload = 0) {
        return intern({op, 0, 0, type, 0, 0, payload}, operands);
    }

    ExprId make(Type type, std::span<const ExprId> parts);
    ExprId make(Type type, std::initializer_list<ExprId> parts) {
        return make(type, std::span(parts.begin(), parts.size()));
    }
    ExprId swizzle(ExprId value, std::uint32_t mask);  // see swizzleMask; keeps the role where the count stays 3 or 4
    ExprId component(ExprId value, int i) { return swizzle(value, swizzleMask(1, i)); }
    // The value as another type where one follows from it: scalars convert, a scalar fills a vector, a vector of as
    // many components changes its role. None where nothing follows.
    ExprId convert(ExprId value, Type type);
    ExprId select(ExprId condition, ExprId then, ExprId otherwise);

    ExprId call(Name function, Type type, std::span<const ExprId> arguments);
    ExprId result(ExprId callOrLoop, std::uint32_t k, Type type);

    // A loop: ask for its number, build the body from its arguments, then close it.
    std::uint32_t beginLoop();
    ExprId loopIndex(std::uint32_t loop);
    ExprId loopCarried(std::uint32_t loop, std::uint32_t k, Type type);
    ExprId endLoop(std::uint32_t loop, ExprId count, std::span<const ExprId> first, std::span<const ExprId> next);

    void addResult(Name name, ExprId value);
    // Names a value for the reader; the first name stays.
    void hint(ExprId e, Name name);
    // Names a value in spite of an older name.
    void rename(ExprId e, Name name) { f_.hints[e.index] = name; }

    Type type(ExprId e) const { return f_.exprs[e.index].type; }

  private:
    ExprId intern(const Expr& key, std::span<const ExprId> operands);
    ExprId append(const Expr& e, std::uint32_t slot);
    void grow(std::size_t expressions);

    Module& module_;
    Function& f_;
    std::vector<std::uint32_t> slots_;  // open addressing: expression + 1
};

// The type of op(operands) by the op's rule, or Void where the operands do not fit.
Type resultType(Op op, std::span<const Type> operands);

// Number of the loop that an expression's value changes with (the innermost one), or kNoLoop; filled for a function by
// loopsOf. A `loop` expression itself belongs to the loop around it.
constexpr std::uint32_t kNoLoop = 0xffffffffu;
std::vector<std::uint32_t> loopsOf(const Function& f);

// Marks what the results need.
std::vector<bool> reachable(const Function& f);

// Drops what the results do not need; the others keep their order. The function must not have been placed.
void compact(Function& f);

// Makes equal expressions one again, after a pass that took out what told them apart, and drops what nothing needs.
void unify(Function& f);

}  // namespace shaderx::ir
