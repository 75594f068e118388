#include "ir/builder.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "base/diagnostics.h"
#include "ir/simplify.h"

namespace shaderx::ir {

Builder::Builder(Module& module, Function& function) : module_(module), f_(function) {
    constexpr std::size_t kRoom = 48;  // most functions are small
    if (f_.exprs.empty()) {
        reserve(kRoom);
        f_.words.reserve(kRoom);
    } else {
        grow(f_.exprs.size());  // a function that is built further keeps its expressions unique
    }
}

// Multiplication by the golden ratio spreads what differs in few bits over the high ones, of which the slot is taken.
static std::uint64_t mix(std::uint64_t h, std::uint64_t v) { return (h ^ v) * 0x9e3779b97f4a7c15ull; }
static std::uint32_t finish(std::uint64_t h) { return static_cast<std::uint32_t>(h >> 32); }

// Operation, type and number of operands at once.
static std::uint64_t head(Op op, Type type, std::size_t operands) {
    return static_cast<std::uint64_t>(op) << 32 | static_cast<std::uint64_t>(type) << 16 | operands;
}

static std::uint32_t hashConstant(Type type, std::span<const std::uint32_t> words) {
    std::uint64_t h = head(Op::Constant, type, words.size());
    for (std::uint32_t w : words) h = mix(h, w) ^ h >> 32;
    return finish(mix(h, 1));
}

static inline std::uint32_t hashExpr(const Expr& e, std::span<const ExprId> operands) {
    std::uint64_t h = mix(head(e.op, e.type, operands.size()), e.payload);
    std::size_t k = 0;
    for (; k + 1 < operands.size(); k += 2)
        h = mix(h ^ h >> 32, operands[k].index | std::uint64_t(operands[k + 1].index) << 32);
    if (k < operands.size()) h = mix(h ^ h >> 32, operands[k].index);
    return finish(h);
}

static bool hasWords(const Expr& e) { return e.op == Op::Constant && componentCount(e.type) > 0; }

void Builder::reserve(std::size_t expressions) {
    f_.exprs.reserve(expressions);
    f_.hints.reserve(expressions);
    f_.operands.reserve(2 * expressions);
    if (expressions * 2 >= slots_.size()) grow(expressions);
}

void Builder::grow(std::size_t expressions) {
    slots_.assign(std::bit_ceil(std::max<std::size_t>(32, expressions * 2 + 2)), 0);
    const std::uint32_t mask = static_cast<std::uint32_t>(slots_.size()) - 1;
    for (std::size_t k = 0; k < f_.exprs.size(); k++) {
        const Expr& e = f_.exprs[k];
        const ExprId id(static_cast<std::uint32_t>(k));
        std::uint32_t i =
            (hasWords(e) ? hashConstant(e.type, f_.constantWords(id)) : hashExpr(e, f_.operandsOf(e))) & mask;
        while (slots_[i]) i = (i + 1) & mask;
        slots_[i] = id.index + 1;
    }
}

inline ExprId Builder::append(const Expr& e, std::uint32_t slot) {
    f_.exprs.push_back(e);
    f_.hints.emplace_back();
    slots_[slot] = static_cast<std::uint32_t>(f_.exprs.size());
    return ExprId(static_cast<std::uint32_t>(f_.exprs.size() - 1));
}

ExprId Builder::intern(const Expr& key, std::span<const ExprId> operands) {
    const std::size_t n = operands.size();
    if (f_.exprs.size() * 2 >= slots_.size() || f_.operands.capacity() - f_.operands.size() < n) {
        // The operands may lie in the very array that grows.
        const std::vector<ExprId> kept(operands.begin(), operands.end());
        if (f_.exprs.size() * 2 >= slots_.size()) grow(f_.exprs.size() * 2);
        f_.operands.reserve(2 * f_.operands.capacity() + n);
        return intern(key, kept);
    }
    const std::uint32_t mask = static_cast<std::uint32_t>(slots_.size()) - 1;
    std::uint32_t i = hashExpr(key, operands) & mask;
    for (; slots_[i]; i = (i + 1) & mask) {
        const Expr& e = f_.exprs[slots_[i] - 1];
        if (e.payload != key.payload || head(e.op, e.type, e.operandCount) != head(key.op, key.type, n)) continue;
        const ExprId* other = f_.operands.data() + e.firstOperand;
        std::size_t k = 0;
        while (k < n && other[k] == operands[k]) k++;
        if (k == n) return ExprId(slots_[i] - 1);
    }
    Expr e = key;
    e.operandCount = static_cast<std::uint16_t>(n);
    ensure(e.operandCount == n, "too many operands");
    e.firstOperand = static_cast<std::uint32_t>(f_.operands.size());
    for (ExprId o : operands) f_.operands.push_back(o);
    return append(e, i);
}

ExprId Builder::constant(Type type, std::span<const std::uint32_t> words) {
    ensure(static_cast<int>(words.size()) == componentCount(type), "constant of another size");
    if (words.empty()) return intern({Op::Constant, 0, 0, type, 0, 0, 0}, {});
    if (f_.exprs.size() * 2 >= slots_.size()) grow(f_.exprs.size() * 2);
    const std::uint32_t mask = static_cast<std::uint32_t>(slots_.size()) - 1;
    std::uint32_t i = hashConstant(type, words) & mask;
    for (; slots_[i]; i = (i + 1) & mask) {
        const Expr& e = f_.exprs[slots_[i] - 1];
        if (e.op == Op::Constant && e.type == type &&
            std::equal(words.begin(), words.end(), f_.words.begin() + e.payload))
            return ExprId(slots_[i] - 1);
    }
    const Expr e{Op::Constant,
                 0,
                 0,
                 type,
                 0,
                 static_cast<std::uint32_t>(f_.operands.size()),
                 static_cast<std::uint32_t>(f_.words.size())};
    f_.words.insert(f_.words.end(), words.begin(), words.end());
    return append(e, i);
}

ExprId Builder::constant(Type type, std::initializer_list<float> values) {
    std::uint32_t words[16];
    int n = componentCount(type);
    for (int i = 0; i < n; i++) {
        float v = values.size() == 1 ? *values.begin() : values.begin()[i];
        words[i] = info(type).scalar == Scalar::Float ? std::bit_cast<std::uint32_t>(v)
                                                      : static_cast<std::uint32_t>(static_cast<int>(v));
    }
    return constant(type, std::span<const std::uint32_t>(words, static_cast<std::size_t>(n)));
}

ExprId Builder::integer(int v) {
    std::uint32_t word = static_cast<std::uint32_t>(v);
    return constant(Type::Integer, std::span<const std::uint32_t>(&word, 1));
}

ExprId Builder::boolean(bool v) {
    std::uint32_t word = v;
    return constant(Type::Boolean, std::span<const std::uint32_t>(&word, 1));
}

ExprId Builder::string(Name text) { return intern({Op::Constant, 0, 0, Type::String, 0, 0, text.index}, {}); }

ExprId Builder::null(Type type) {
    if (type == Type::String) return string(module_.names->intern(""));
    if (componentCount(type)) return constant(type, {0.0f});
    return intern({Op::Constant, 0, 0, type, 0, 0, 0}, {});
}

ExprId Builder::param(std::uint32_t index) {
    ensure(index < f_.params.size(), "no such parameter");
    return intern({Op::Param, 0, 0, f_.params[index].type, 0, 0, index}, {});
}

ExprId Builder::context(Context c) {
    return intern({Op::Context, 0, 0, info(c).type, 0, 0, static_cast<std::uint32_t>(c)}, {});
}

ExprId Builder::attribute(Name name, Type type) { return intern({Op::Attribute, 0, 0, type, 0, 0, name.index}, {}); }

ExprId Builder::uniform(Name name, Type type) { return intern({Op::Uniform, 0, 0, type, 0, 0, name.index}, {}); }

ExprId Builder::emit(Op op, Type type, std::span<const ExprId> operands, std::uint32_t payload) {
    ensure(type != Type::Void, "operands do not fit the operation");
    if (hasRules(op))
        if (ExprId simple = simplify(*this, op, type, operands, payload)) return simple;
    return intern({op, 0, 0, type, 0, 0, payload}, operands);
}

ExprId Builder::op(Op op, std::initializer_list<ExprId> operands) {
    Type types[8];
    ensure(operands.size() <= 8, "too many operands");
    for (std::size_t i = 0; i < operands.size(); i++) types[i] = type(operands.begin()[i]);
    return emit(op, resultType(op, std::span(types, operands.size())), operands);
}

ExprId Builder::make(Type type, std::span<const ExprId> parts) { return emit(Op::Make, type, parts); }

ExprId Builder::swizzle(ExprId value, std::uint32_t mask) {
    const TypeInfo& t = info(type(value));
    if (t.columns > 1) return emit(Op::Swizzle, floatVector(t.rows), {value}, mask);
    if (t.scalar != Scalar::Float) {
        ensure(t.rows == 1, "swizzle of no vector");
        return value;
    }
    return emit(Op::Swizzle, floatVector(swizzleCount(mask), t.role), {value}, mask);
}

ExprId Builder::convert(ExprId value, Type to) {
    Type from = type(value);
    if (from == to) return value;
    const TypeInfo &a = info(from), &b = info(to);
    if (componentCount(from) == 1 && componentCount(to) == 1) return emit(Op::Convert, to, {value});
    if (componentCount(from) == 1 && b.rows > 1 && b.columns == 1) return make(to, {convert(value, Type::Float)});
    if (a.columns == 1 && b.columns == 1 && a.rows == b.rows && a.rows > 1) return emit(Op::Retype, to, {value});
    // A material is its surface or volume shader.
    if (to == Type::Material && (from == Type::SurfaceShader || from == Type::VolumeShader))
        return emit(Op::Retype, to, {value});
    return {};
}

ExprId Builder::select(ExprId condition, ExprId then, ExprId otherwise) {
    ensure(type(then) == type(otherwise), "select of two types");
    return emit(Op::Select, type(then), {condition, then, otherwise});
}

ExprId Builder::call(Name function, Type type, std::span<const ExprId> arguments) {
    return emit(Op::Call, type, arguments, function.index);
}

ExprId Builder::result(ExprId callOrLoop, std::uint32_t k, Type type) {
    return emit(Op::Result, type, {callOrLoop}, k);
}

std::uint32_t Builder::beginLoop() { return f_.loops++; }

ExprId Builder::loopIndex(std::uint32_t loop) {
    return intern({Op::LoopArg, 0, 0, Type::Integer, 0, 0, loop << 8}, {});
}

ExprId Builder::loopCarried(std::uint32_t loop, std::uint32_t k, Type type) {
    ensure(k < 255, "too many carried values");
    return intern({Op::LoopArg, 0, 0, type, 0, 0, loop << 8 | (k + 1)}, {});
}

ExprId Builder::endLoop(std::uint32_t loop, ExprId count, std::span<const ExprId> first, std::span<const ExprId> next) {
    ensure(first.size() == next.size(), "carried values without a next one");
    std::vector<ExprId> operands{count};
    operands.insert(operands.end(), first.begin(), first.end());
    operands.insert(operands.end(), next.begin(), next.end());
    return emit(Op::Loop, Type::Tuple, operands, loop);
}

void Builder::addResult(Name name, ExprId value) { f_.results.push_back({name, type(value), value}); }

void Builder::hint(ExprId e, Name name) {
    if (!f_.hints[e.index]) f_.hints[e.index] = name;
    // What fills a vector is what is computed.
    const Expr& x = f_.exprs[e.index];
    if (x.op != Op::Make || x.operandCount != 1) return;
    Name& inner = f_.hints[f_.operands[x.firstOperand].index];
    if (!inner) inner = name;
}

// The wider of two operand types; a matrix is only as wide as itself or a scalar.
static Type wider(Type a, Type b) {
    const TypeInfo &x = info(a), &y = info(b);
    if (x.scalar != y.scalar || x.scalar == Scalar::None) return Type::Void;
    if (componentCount(b) == 1) return a;
    if (componentCount(a) == 1) return b;
    return x.rows == y.rows && x.columns == y.columns ? a : Type::Void;
}

static Type productType(Type a, Type b) {
    const TypeInfo &x = info(a), &y = info(b);
    if (x.columns < 2 || y.rows != x.rows) return Type::Void;
    return b;
}

Type resultType(Op op, std::span<const Type> t) {
    const OpInfo& o = info(op);
    if (o.operands >= 0 && static_cast<std::size_t>(o.operands) != t.size()) return Type::Void;
    switch (o.rule) {
        case TypeRule::Given:
            return Type::Void;
        case TypeRule::Same:
            return t[0];
        case TypeRule::Wider: {
            Type type = t[0];
            for (Type next : t.subspan(1)) type = type == Type::Void ? type : wider(type, next);
            return type;
        }
        case TypeRule::Scalar:
            return info(t[0]).scalar == Scalar::Float ? Type::Float : Type::Void;
        case TypeRule::Boolean:
            return Type::Boolean;
        case TypeRule::Matrix:
            return productType(t[0], t[1]);
    }
    return Type::Void;
}

std::vector<std::uint32_t> loopsOf(const Function& f) {
    std::vector<std::uint32_t> inside(f.exprs.size(), kNoLoop);
    if (!f.loops) return inside;
    // Of each loop, the one around it; known from what its body takes from that, even where its operands take nothing.
    std::vector<std::uint32_t> outer(f.loops, kNoLoop);
    auto innermost = [](std::uint32_t a, std::uint32_t b) {
        return a == kNoLoop ? b : b == kNoLoop ? a : std::max(a, b);
    };
    bool changed = true;
    while (changed) {  // a few turns for each depth of the nest
        changed = false;
        for (std::size_t i = 0; i < f.exprs.size(); i++) {
            const Expr& e = f.exprs[i];
            const bool isLoop = e.op == Op::Loop || e.op == Op::Lights;
            std::uint32_t now = e.op == Op::LoopArg ? e.payload >> 8 : isLoop ? outer[e.payload] : kNoLoop;
            for (ExprId o : f.operandsOf(e))
                if (!(isLoop && inside[o.index] == e.payload)) now = innermost(now, inside[o.index]);
            if (now != inside[i]) changed = true;
            inside[i] = now;
            if (now == kNoLoop) continue;
            for (ExprId o : f.operandsOf(e)) {
                const std::uint32_t l = inside[o.index];
                if (l == kNoLoop || l >= now || outer[now] == innermost(outer[now], l)) continue;
                outer[now] = innermost(outer[now], l);
                changed = true;
            }
        }
    }
    return inside;
}

std::vector<bool> reachable(const Function& f) {
    std::vector<bool> live(f.exprs.size());
    for (const ResultValue& r : f.results) live[r.value.index] = true;
    for (std::size_t i = f.exprs.size(); i-- > 0;)
        if (live[i])
            for (ExprId o : f.operandsOf(f.exprs[i])) live[o.index] = true;
    return live;
}

// Runs of origins go to where their first expressions went that are left; `at` says where.
static void moveOrigins(Function& f, std::span<const std::uint32_t> at) {
    std::vector<std::pair<std::uint32_t, Name>> moved;
    for (auto [first, origin] : f.origins) {
        while (first < at.size() && at[first] == ExprId::kNone) first++;
        if (first == at.size()) break;
        if (!moved.empty() && moved.back().first == at[first]) moved.pop_back();
        moved.emplace_back(at[first], origin);
    }
    f.origins = std::move(moved);
}

// Whether two expressions of one function are the same operation on the same operands.
static bool isSame(const Function& f, const Expr& a, const Expr& b) {
    if (head(a.op, a.type, a.operandCount) != head(b.op, b.type, b.operandCount)) return false;
    if (hasWords(a))
        return std::equal(f.words.begin() + a.payload, f.words.begin() + a.payload + componentCount(a.type),
                          f.words.begin() + b.payload);
    const ExprId *x = f.operands.data() + a.firstOperand, *y = f.operands.data() + b.firstOperand;
    return a.payload == b.payload && std::equal(x, x + a.operandCount, y);
}

void compact(Function& f) {
    constexpr std::uint32_t kDead = ExprId::kNone;
    const std::size_t n = f.exprs.size();
    std::vector<std::uint32_t> places(n, kDead);  // any other number while it is only known to be needed
    // Plain pointers: the arrays do not move, which a compiler cannot see.
    std::uint32_t* const at = places.data();
    Expr* const exprs = f.exprs.data();
    ExprId* const operands = f.operands.data();
    std::size_t left = 0;
    for (const ResultValue& r : f.results) at[r.value.index] = 0;
    for (std::size_t i = n; i-- > 0;) {
        if (at[i] == kDead) continue;
        left++;
        const ExprId* first = operands + exprs[i].firstOperand;
        for (const ExprId *o = first, *end = first + exprs[i].operandCount; o != end; o++) at[o->index] = 0;
    }
    if (left == n) return;
    std::uint32_t next = 0, operandsLeft = 0, words = 0;
    for (std::size_t i = 0; i < n; i++) {
        if (at[i] == kDead) continue;
        Expr e = exprs[i];
        ensure(operandsLeft <= e.firstOperand, "an arena that is out of order");
        const ExprId* from = operands + e.firstOperand;
        e.firstOperand = operandsLeft;
        for (const ExprId* end = from + e.operandCount; from != end; from++)
            operands[operandsLeft++] = ExprId(at[from->index]);
        if (hasWords(e)) {
            const std::uint32_t count = static_cast<std::uint32_t>(componentCount(e.type));
            ensure(words <= e.payload, "constants that are out of order");
            std::copy_n(f.words.begin() + e.payload, count, f.words.begin() + words);
            e.payload = words;
            words += count;
        }
        at[i] = next;
        f.hints[next] = f.hints[i];
        exprs[next++] = e;
    }
    moveOrigins(f, places);
    f.exprs.resize(next);
    f.hints.resize(next);
    f.operands.resize(operandsLeft);
    f.words.resize(words);
    for (ResultValue& r : f.results) r.value = ExprId(at[r.value.index]);
}

void unify(Function& f) {
    const std::size_t n = f.exprs.size();
    std::vector<std::uint32_t> slots(std::bit_ceil(std::max<std::size_t>(32, n * 2 + 2)));  // as the builder's
    std::vector<ExprId> first(n);
    const std::uint32_t mask = static_cast<std::uint32_t>(slots.size()) - 1;
    bool repeats = false;
    for (std::uint32_t i = 0; i < n; i++) {
        Expr& e = f.exprs[i];
        ExprId* operands = f.operands.data() + e.firstOperand;
        for (std::uint32_t k = 0; repeats && k < e.operandCount; k++) operands[k] = first[operands[k].index];
        const std::uint32_t hash =
            hasWords(e) ? hashConstant(e.type, f.constantWords(ExprId(i))) : hashExpr(e, f.operandsOf(e));
        std::uint32_t slot = hash & mask;
        while (slots[slot] && !isSame(f, f.exprs[slots[slot] - 1], e)) slot = (slot + 1) & mask;
        if (!slots[slot]) slots[slot] = i + 1;
        first[i] = ExprId(slots[slot] - 1);
        if (first[i].index == i) continue;
        repeats = true;
        if (Name& hint = f.hints[first[i].index]; !hint) hint = f.hints[i];
    }
    if (!repeats) return;
    for (ResultValue& r : f.results) r.value = first[r.value.index];
    compact(f);
}

}  // namespace shaderx::ir
