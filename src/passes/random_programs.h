// For tests: random programs of which it is known how exactly any two right ways of computing them agree.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "ir/builder.h"
#include "ir/interpret.h"
#include "passes/dice.h"

namespace shaderx::passes {

// A value of a program under way. Where `error` is 0 all numbers are integers small enough for floats, so that no
// order of evaluation may change them; else it bounds what rounding may change.
struct Sample {
    ir::ExprId e;
    float bound = 0;  // of the size of each number
    float error = 0;
    bool exact() const { return error == 0; }
};

// Makes the functions of one module, each a graph of expressions as no builder would simplify it: constants to fold,
// values to share, selects, nested loops, calls of the functions made before.
class RandomProgram {
  public:
    RandomProgram(ir::Module& module, Dice dice) : module_(module), dice_(dice) {
        for (ir::Type t : {ir::Type::Float, ir::Type::Color3, ir::Type::Integer, ir::Type::Boolean}) {
            ir::Uniform u;
            u.name = module_.names->intern("u" + std::to_string(module_.uniforms.size()));
            u.type = t;
            for (int i = 0; i < ir::componentCount(t); i++) u.values.push_back(word(t));
            module_.uniforms.push_back(u);
        }
    }

    // A function of about so many operations; `result` where it must have one result of that type.
    ir::Function& function(std::string_view name, std::size_t operations, ir::Type result = ir::Type::Void,
                           bool hasParams = true);
    // How far results of a function may be off, in their order.
    const std::vector<Sample>& resultsOf(Name name) const {
        for (const Made& m : made_)
            if (m.name == name) return m.results;
        internalError("no such function");
    }
    // Something to give a parameter: whole numbers from -4 to 4.
    ir::Value argument(ir::Type type) {
        ir::Value v;
        v.type = type;
        for (int i = 0; i < ir::componentCount(type); i++) v.words[i] = word(type);
        return v;
    }
    std::uint32_t roll(std::uint32_t n) { return dice_.roll(n); }

  private:
    struct Made {
        Name name;
        std::vector<Sample> results;
    };
    static constexpr float kLimit = 64, kEpsilon = 1e-6f, kWorst = 2e-4f;
    static constexpr std::array kTypes = {ir::Type::Float,   ir::Type::Vector3, ir::Type::Color3,  ir::Type::Boolean,
                                          ir::Type::Integer, ir::Type::Vector2, ir::Type::Vector4, ir::Type::Float};

    std::uint32_t word(ir::Type t) {
        int v = static_cast<int>(roll(9)) - 4;
        switch (ir::info(t).scalar) {
            case ir::Scalar::Boolean:
                return roll(2);
            case ir::Scalar::Integer:
                return static_cast<std::uint32_t>(v);
            case ir::Scalar::Float:
                return std::bit_cast<std::uint32_t>(static_cast<float>(v));
            case ir::Scalar::None:
                break;
        }
        return 0;
    }

    ir::Type type(ir::ExprId e) const { return b_->type(e); }
    Sample put(ir::ExprId e, float bound, float error) {
        Sample s{e, bound, error};
        pool_.push_back(s);
        return s;
    }
    Sample constant(ir::Type t) {
        std::vector<std::uint32_t> words;
        bool same = roll(2);
        for (int i = 0; i < ir::componentCount(t); i++) words.push_back(same && i ? words[0] : word(t));
        return {b_->constant(t, words), 4, 0};
    }
    Sample number(float v) { return {b_->number(v), std::abs(v), 0}; }
    // A value in scope, the later the likelier; bounded by kLimit.
    Sample pick(ir::Type t, bool exact) {
        if (roll(6) == 0) return constant(t);
        if (ir::isFloatVector(t) && roll(8) == 0) {
            ir::ExprId scalar = pick(ir::Type::Float, true).e;
            return {b_->emitRaw(ir::Op::Make, t, std::array{scalar}), kLimit, 0};
        }
        std::size_t tries = pool_.size();
        for (std::size_t i = pool_.size(), left = roll(6); tries-- > 0 && i-- > 0;) {
            const Sample s = pool_[i];
            if (type(s.e) != t || (exact && !s.exact())) continue;
            if (left == 0 || i == 0) return limited(s);
            left--;
        }
        return constant(t);
    }
    Sample limited(Sample s) {
        if (s.bound <= kLimit || ir::info(type(s.e)).scalar == ir::Scalar::Boolean) return s;
        ir::ExprId low = b_->number(-8), high = b_->number(8);
        if (type(s.e) == ir::Type::Integer) low = b_->integer(-8), high = b_->integer(8);
        return {b_->emitRaw(ir::Op::Clamp, type(s.e), std::array{s.e, low, high}), 8, s.error};
    }
    // A vector type that meets t in componentwise operations, or the scalar.
    ir::Type partner(ir::Type t) {
        if (!ir::isFloatVector(t)) return t;
        if (roll(4) == 0) return ir::Type::Float;
        if (ir::componentCount(t) == 3 && roll(4) == 0) return ir::Type::Color3;
        return t;
    }

    void operation();
    void arithmetic(ir::Type t, bool exact);
    void smooth();
    void integers();
    void logic();
    void composition();
    void geometry();
    void choice();
    void call();
    void texture();
    void loop(int depth);
    void result(ir::Function& f, ir::Type wanted, std::vector<Sample>& samples);

    ir::Module& module_;
    Dice dice_;
    ir::Builder* b_ = nullptr;
    std::vector<Sample> pool_;
    std::vector<Made> made_;
};

inline ir::Function& RandomProgram::function(std::string_view name, std::size_t operations, ir::Type wanted,
                                             bool hasParams) {
    using namespace ir;
    Function f;
    f.name = module_.names->intern(name);
    f.isInline = roll(4) == 0;
    for (std::uint32_t i = 0, n = hasParams ? 1 + roll(4) : 0; i < n; i++)
        f.params.push_back({module_.names->intern("p" + std::to_string(i)), kTypes[roll(kTypes.size())]});
    Builder b(module_, f);
    b_ = &b;
    pool_.clear();
    for (std::uint32_t i = 0; i < f.params.size(); i++) put(b.param(i), 4, 0);
    put(b.context(Context::Time), 4, 0);
    put(b.attribute(module_.names->intern("texcoord_0"), Type::Vector2), 4, 0);
    for (const Uniform& u : module_.uniforms) put(b.uniform(u.name, u.type), 4, 0);
    // What a callee is given may be larger than what a test gives.
    for (Sample& s : pool_) s.bound = kLimit;
    for (std::size_t i = 0; i < operations; i++) {
        if (roll(10) == 0) loop(0);
        operation();
    }
    Made m{f.name, {}};
    for (std::uint32_t i = 0, n = wanted == Type::Void ? 1 + roll(3) : 1; i < n; i++) result(f, wanted, m.results);
    made_.push_back(m);
    b_ = nullptr;
    return module_.put(std::move(f));
}

inline void RandomProgram::result(ir::Function& f, ir::Type wanted, std::vector<Sample>& samples) {
    ir::Type t = wanted == ir::Type::Void ? kTypes[roll(kTypes.size())] : wanted;
    Sample s = pick(t, false);
    // Few values are thrown away: the result is a sum over some.
    for (int i = 0; i < 3 && ir::info(t).scalar == ir::Scalar::Float; i++) {
        Sample o = pick(t, false);
        s = {b_->emitRaw(ir::Op::Add, t, std::array{s.e, o.e}), s.bound + o.bound, s.error + o.error};
        if (!s.exact()) s.error += s.bound * kEpsilon;
    }
    s = limited(s);
    samples.push_back(s);
    f.results.push_back({module_.names->intern("r" + std::to_string(f.results.size())), t, s.e});
}

inline void RandomProgram::operation() {
    switch (roll(12)) {
        case 0:
            return integers();
        case 1:
            return logic();
        case 2:
        case 3:
            return composition();
        case 4:
            return geometry();
        case 5:
        case 6:
            return choice();
        case 7:
            return call();
        case 8:
            return roll(3) ? smooth() : texture();
        default:
            return arithmetic(kTypes[roll(3)], roll(3) != 0);
    }
}

inline void RandomProgram::arithmetic(ir::Type t, bool exact) {
    using namespace ir;
    static constexpr Op kOps[] = {Op::Add, Op::Add,  Op::Sub,  Op::Sub,   Op::Mul,  Op::Mul,
                                  Op::Min, Op::Max,  Op::Neg,  Op::Abs,   Op::Mix,  Op::Clamp,
                                  Op::Div, Op::Sign, Op::Step, Op::Floor, Op::Fract};
    Op op = kOps[roll(std::size(kOps))];
    bool steps = op == Op::Sign || op == Op::Step || op == Op::Floor || op == Op::Fract;
    Sample x = pick(t, exact || steps);
    if (ir::info(op).operands == 1) {
        put(b_->emitRaw(op, t, std::array{x.e}), x.bound, x.error);
        return;
    }
    if (op == Op::Div) {  // by a power of two, into a number that is no integer
        ExprId by = b_->number(roll(2) ? 2.0f : -4.0f);
        put(b_->emitRaw(op, t, std::array{x.e, by}), x.bound, x.error + x.bound * kEpsilon);
        return;
    }
    Sample y = pick(partner(t), exact || steps);
    float error = x.error + y.error;
    if (op == Op::Clamp) {
        put(b_->emitRaw(op, t, std::array{x.e, b_->number(-1), b_->number(3)}), std::max(3.0f, x.bound), x.error);
        return;
    }
    if (op == Op::Mix) {
        Sample w = roll(2) ? pick(partner(t), exact) : number(static_cast<float>(roll(3)));
        if (error + w.error > kWorst / 256) return;
        float bound = x.bound + w.bound * (x.bound + y.bound);
        error = error * (1 + w.bound) + w.error * (x.bound + y.bound);
        put(b_->emitRaw(op, t, std::array{x.e, y.e, w.e}), bound, error > 0 ? error + bound * kEpsilon : 0);
        return;
    }
    float bound = x.bound + y.bound;
    if (op == Op::Mul) {
        bound = x.bound * y.bound;
        error = x.error * y.bound + y.error * x.bound;
    }
    if (error > 0) error += bound * kEpsilon;
    if (error > kWorst) return;
    std::array<ExprId, 2> operands{x.e, y.e};
    if (type(y.e) == Type::Float && roll(2)) std::swap(operands[0], operands[1]);
    put(b_->emitRaw(op, resultType(op, std::array{type(operands[0]), type(operands[1])}), operands), bound, error);
}

inline void RandomProgram::smooth() {
    using namespace ir;
    Type t = kTypes[roll(3)];
    Sample x = pick(t, false);
    switch (roll(4)) {
        case 0:
            put(b_->emitRaw(Op::Sin, t, std::array{x.e}), 1, x.error + 4e-6f);
            return;
        case 1:
            put(b_->emitRaw(Op::Cos, t, std::array{x.e}), 1, x.error + 4e-6f);
            return;
        case 2: {
            ExprId positive = b_->emitRaw(Op::Abs, t, std::array{x.e});
            positive = b_->emitRaw(Op::Add, t, std::array{positive, b_->number(1)});
            put(b_->emitRaw(Op::Sqrt, t, std::array{positive}), x.bound, x.error + 16 * kEpsilon);
            return;
        }
        default: {
            ExprId positive = b_->emitRaw(Op::Abs, t, std::array{x.e});
            positive = b_->emitRaw(Op::Add, t, std::array{positive, b_->number(1)});
            Sample power = number(static_cast<float>(roll(3)));
            if (x.error * 2 * kLimit > kWorst / 2) return;
            put(b_->emitRaw(Op::Pow, t, std::array{positive, power.e}), x.bound * x.bound + 130,
                x.error * 2 * kLimit + x.bound * x.bound * 4 * kEpsilon + 1e-5f);
        }
    }
}

inline void RandomProgram::integers() {
    using namespace ir;
    static constexpr Op kTwo[] = {Op::Add, Op::Sub, Op::Mul, Op::Min, Op::Max, Op::BitAnd, Op::BitOr, Op::BitXor};
    Sample x = pick(Type::Integer, true), y = pick(Type::Integer, true);
    ExprId small = b_->integer(static_cast<int>(roll(4)) + 1);
    constexpr float kAny = 1e9f;
    switch (roll(8)) {
        case 0:
            put(b_->emitRaw(Op::Mod, Type::Integer, std::array{x.e, small}), 4, 0);
            return;
        case 1:
            put(b_->emitRaw(Op::Div, Type::Integer, std::array{x.e, small}), x.bound, 0);
            return;
        case 2:
            put(b_->emitRaw(Op::ShiftLeft, Type::Integer, std::array{x.e, small}), kAny, 0);
            return;
        case 3:
            put(b_->emitRaw(roll(2) ? Op::ShiftRight : Op::ShiftRightLogical, Type::Integer, std::array{x.e, small}),
                kAny, 0);
            return;
        case 4:
            put(b_->emitRaw(roll(2) ? Op::Neg : Op::BitNot, Type::Integer, std::array{x.e}), kAny, 0);
            return;
        case 5: {
            Type from = roll(2) ? Type::Float : Type::Boolean;
            put(b_->emitRaw(Op::Convert, Type::Integer, std::array{pick(from, true).e}), kLimit, 0);
            return;
        }
        default:
            put(b_->emitRaw(kTwo[roll(8)], Type::Integer, std::array{x.e, y.e}), kAny, 0);
    }
}

inline void RandomProgram::logic() {
    using namespace ir;
    static constexpr Op kCompare[] = {Op::Less, Op::LessEqual, Op::Equal, Op::NotEqual};
    Type t = roll(2) ? Type::Float : roll(2) ? Type::Integer : Type::Boolean;
    Sample x = pick(t, true), y = roll(6) ? pick(t, true) : x;
    switch (roll(4)) {
        case 0:
            put(b_->emitRaw(Op::Not, Type::Boolean, std::array{pick(Type::Boolean, true).e}), 1, 0);
            return;
        case 1: {
            std::array operands{pick(Type::Boolean, true).e, pick(Type::Boolean, true).e};
            put(b_->emitRaw(roll(2) ? Op::And : Op::Or, Type::Boolean, operands), 1, 0);
            return;
        }
        default: {
            Op op = kCompare[t == Type::Boolean ? 2 + roll(2) : roll(4)];
            put(b_->emitRaw(op, Type::Boolean, std::array{x.e, y.e}), 1, 0);
        }
    }
}

inline void RandomProgram::composition() {
    using namespace ir;
    switch (roll(6)) {
        case 0: {  // parts of one vector or of several values
            Type t = std::array{Type::Vector2, Type::Vector3, Type::Color3, Type::Vector4}[roll(4)];
            std::vector<ExprId> parts;
            float bound = 0, error = 0;
            for (int left = componentCount(t); left > 0;) {
                Sample s = pick(left > 1 && roll(2) ? Type::Vector2 : Type::Float, false);
                parts.push_back(s.e);
                left -= componentCount(type(s.e));
                bound = std::max(bound, s.bound), error = std::max(error, s.error);
            }
            put(b_->emitRaw(Op::Make, t, parts), bound, error);
            return;
        }
        case 1: {
            Sample s = pick(roll(2) ? Type::Vector3 : Type::Color3, false);
            put(b_->emitRaw(Op::Retype, type(s.e) == Type::Color3 ? Type::Vector3 : Type::Color3, std::array{s.e}),
                s.bound, s.error);
            return;
        }
        case 2: {
            Sample s = pick(roll(2) ? Type::Integer : Type::Boolean, true);
            put(b_->emitRaw(Op::Convert, Type::Float, std::array{s.e}), kLimit, 0);
            return;
        }
        case 3: {
            Sample s = pick(Type::Vector3, false), i = limited(pick(Type::Integer, true));
            ExprId index = b_->emitRaw(Op::Clamp, Type::Integer, std::array{i.e, b_->integer(0), b_->integer(2)});
            put(b_->emitRaw(Op::Index, Type::Float, std::array{s.e, index}), s.bound, s.error);
            return;
        }
        default: {
            Sample s = pick(std::array{Type::Vector2, Type::Vector3, Type::Color3, Type::Vector4}[roll(4)], false);
            int n = componentCount(type(s.e)), m = roll(2) ? 1 : 1 + static_cast<int>(roll(4));
            auto at = [&](int k) { return k < m ? static_cast<int>(roll(static_cast<std::uint32_t>(n))) : 0; };
            int x = at(0), y = at(1), z = at(2), w = at(3);
            put(b_->emitRaw(Op::Swizzle, floatVector(m, info(type(s.e)).role), std::array{s.e},
                            swizzleMask(m, x, y, z, w)),
                s.bound, s.error);
        }
    }
}

inline void RandomProgram::geometry() {
    using namespace ir;
    Sample x = pick(Type::Vector3, true), y = pick(Type::Vector3, true);
    switch (roll(5)) {
        case 0:
            put(b_->emitRaw(Op::Dot, Type::Float, std::array{x.e, y.e}), 3 * x.bound * y.bound, 0);
            return;
        case 1:
            put(b_->emitRaw(Op::Cross, Type::Vector3, std::array{x.e, y.e}), 2 * x.bound * y.bound, 0);
            return;
        case 2: {
            ExprId towards = pick(Type::Vector3, true).e;
            put(b_->emitRaw(Op::Faceforward, Type::Vector3, std::array{x.e, y.e, towards}), x.bound, 0);
            return;
        }
        case 3: {  // a matrix from columns, or from one number
            std::array columns{x.e, y.e, pick(Type::Vector3, true).e};
            ExprId m = roll(4) ? b_->emitRaw(Op::Make, Type::Matrix33, columns) : constant(Type::Matrix33).e;
            if (roll(2)) m = b_->emitRaw(Op::Transpose, Type::Matrix33, std::array{m});
            Sample v = pick(Type::Vector3, true);
            if (roll(2))
                put(b_->emitRaw(Op::MulMatrix, Type::Vector3, std::array{m, v.e}), 3 * kLimit * v.bound, 0);
            else
                put(b_->emitRaw(Op::Swizzle, Type::Vector3, std::array{m}, roll(3)), kLimit, 0);
            return;
        }
        default: {
            Sample v = pick(Type::Color3, false);
            put(b_->emitRaw(Op::Length, Type::Float, std::array{v.e}), 2 * v.bound,
                2 * v.error + v.bound * 4 * kEpsilon + 1e-6f);
        }
    }
}

inline void RandomProgram::choice() {
    using namespace ir;
    Type t = kTypes[roll(kTypes.size())];
    Sample c = pick(Type::Boolean, true), x = pick(t, false), y = pick(t, false);
    put(b_->emitRaw(Op::Select, t, std::array{c.e, x.e, y.e}), std::max(x.bound, y.bound), std::max(x.error, y.error));
}

inline void RandomProgram::call() {
    using namespace ir;
    if (made_.empty()) return choice();
    const Made& m = made_[roll(static_cast<std::uint32_t>(made_.size()))];
    const Function& f = *module_.findOwn(m.name);
    std::vector<ExprId> arguments;
    for (const Param& p : f.params) arguments.push_back((roll(3) ? pick(p.type, true) : constant(p.type)).e);
    bool single = f.results.size() == 1;
    ExprId made = b_->emitRaw(Op::Call, single ? f.results[0].type : Type::Tuple, arguments, m.name.index);
    for (std::uint32_t k = 0; k < f.results.size(); k++) {
        if (!single && roll(4) == 0) continue;
        ExprId e = single ? made : b_->emitRaw(Op::Result, f.results[k].type, std::array{made}, k);
        put(e, m.results[k].bound, m.results[k].error);
    }
}

inline void RandomProgram::texture() {
    using namespace ir;
    ExprId image = b_->context(Context::EnvironmentRadiance);
    std::array operands{image, pick(Type::Vector2, true).e, pick(Type::Float, true).e};
    put(b_->emitRaw(Op::TextureLevel, Type::Color3, operands), 4 * kLimit, 0);
}

inline void RandomProgram::loop(int depth) {
    using namespace ir;
    Sample turns = pick(Type::Integer, true);
    ExprId count = roll(2)
                       ? b_->integer(static_cast<int>(roll(5)))
                       : b_->emitRaw(Op::Clamp, Type::Integer, std::array{turns.e, b_->integer(-1), b_->integer(3)});
    std::uint32_t number = b_->beginLoop();
    std::vector<ExprId> first, arguments, operands{count};
    for (std::uint32_t k = 0, n = 1 + roll(3); k < n; k++) {
        Type t = k && roll(2) ? type(first[0]) : kTypes[roll(kTypes.size())];
        first.push_back(limited(pick(t, true)).e);
        arguments.push_back(b_->loopCarried(number, k, t));
    }
    const std::size_t outside = pool_.size();
    put(b_->loopIndex(number), 4, 0);
    for (ExprId a : arguments) put(a, kLimit, 0);
    for (std::uint32_t i = 0, n = 2 + roll(6); i < n; i++) {
        if (depth < 2 && roll(8) == 0) loop(depth + 1);
        operation();
    }
    operands.insert(operands.end(), first.begin(), first.end());
    const bool swaps = roll(3) == 0;
    for (std::size_t k = 0; k < first.size(); k++) {
        ExprId other = arguments[(k + 1) % arguments.size()];
        operands.push_back(swaps && type(other) == type(first[k]) ? other : limited(pick(type(first[k]), true)).e);
    }
    pool_.resize(outside);
    ExprId made = b_->emitRaw(Op::Loop, Type::Tuple, operands, number);
    for (std::uint32_t k = 0; k < first.size(); k++)
        put(b_->emitRaw(Op::Result, type(first[k]), std::array{made}, k), kLimit, 0);
}

// The world of these programs: all whole numbers.
struct RandomWorld final : ir::Environment {
    bool context(ir::Context, ir::Value& v) override {
        for (int i = 0; i < ir::componentCount(v.type); i++) v.set(i, 3);
        return true;
    }
    bool attribute(Name, ir::Value& v) override {
        for (int i = 0; i < ir::componentCount(v.type); i++) v.set(i, static_cast<float>(2 - i));
        return true;
    }
    bool texture(const ir::TextureRead& r, ir::Value& v) override {
        for (int i = 0; i < ir::componentCount(v.type); i++)
            v.set(i, r.uv[0] - r.uv[1] + r.level + static_cast<float>(i));
        return true;
    }
};

}  // namespace shaderx::passes
