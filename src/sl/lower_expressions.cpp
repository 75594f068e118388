// Lowering: names, components, conditions; what can be assigned.
#include <algorithm>
#include <bit>

#include "sl/lower_state.h"
#include "sl/parser.h"

namespace shaderx::sl {

namespace {

struct NamedNumber {
    std::string_view name;
    float value;
};
// OSL's constants.
constexpr NamedNumber kNumbers[] = {
    {"M_PI", 3.14159265f},      {"M_PI_2", 1.57079633f},  {"M_PI_4", 0.785398163f},    {"M_2_PI", 0.636619772f},
    {"M_1_PI", 0.318309886f},   {"M_2PI", 6.28318531f},   {"M_4PI", 12.5663706f},      {"M_2_SQRTPI", 1.12837917f},
    {"M_E", 2.71828183f},       {"M_LN2", 0.693147181f},  {"M_LN10", 2.30258509f},     {"M_LOG2E", 1.44269504f},
    {"M_LOG10E", 0.434294482f}, {"M_SQRT2", 1.41421356f}, {"M_SQRT1_2", 0.707106781f},
};

const NamedNumber* numberCalled(std::string_view name) {
    if (name.substr(0, 2) != "M_") return nullptr;
    for (const NamedNumber& n : kNumbers)
        if (n.name == name) return &n;
    return nullptr;
}

}  // namespace

std::vector<std::uint32_t> Program::constantsCalled(std::uint32_t unit, Name name) const {
    auto found = constantsByName.find(name);
    if (found == constantsByName.end()) return {};
    for (std::uint32_t c : found->second)
        if (constants[c].unit == unit) return {c};
    return found->second;
}

void namesRead(const Tree& tree, NodeId root, std::vector<Name>& names) {
    std::vector<NodeId> stack{root};
    while (!stack.empty()) {
        const Node& n = tree[stack.back()];
        stack.pop_back();
        if (n.kind == NodeKind::Name) names.push_back(n.name);
        for (std::uint32_t k = 0; k < n.children.count; k++) stack.push_back(tree.child(n, k));
    }
}

bool Lowering::writes(NodeId root) const {
    std::vector<NodeId> stack{root};
    while (!stack.empty()) {
        const Node& n = tree[stack.back()];
        stack.pop_back();
        bool isCall = n.kind == NodeKind::Call && n.type == Type::Void;
        for (std::uint32_t k = 0; k < n.children.count; k++) {
            stack.push_back(tree.child(n, k));
            if (isCall && program.functions.mayWrite(n.name, n.children.count, k)) return true;
        }
    }
    return false;
}

ExprId Lowering::expression(NodeId id) {
    const Node& n = tree[id];
    switch (n.kind) {
        case NodeKind::Integer:
            return b.integer(static_cast<int>(n.bits));
        case NodeKind::Float:
            return b.number(std::bit_cast<float>(n.bits));
        case NodeKind::Boolean:
            return b.boolean(n.bits != 0);
        case NodeKind::String:
            return b.string(n.name);
        case NodeKind::Name:
            return name(n);
        case NodeKind::Placeholder:
            return placeholder(n);
        case NodeKind::Unary:
            return unary(n);
        case NodeKind::Binary:
            return binary(id);
        case NodeKind::Conditional:
            return conditional(n);
        case NodeKind::Call:
            return n.type == Type::Void ? call(n, false) : construct(n);
        case NodeKind::Member:
            return member(id);
        case NodeKind::Index:
            return index(id);
    }
    return {};
}

// The value as an argument of the type would take it; `what` says whose type that is.
ExprId Lowering::converted(ExprId value, Type to, std::uint32_t offset, std::string_view what) {
    if (!value) return {};
    Type from = b.type(value);
    if (conversionRank(from, to) >= 0) return b.convert(value, to);
    std::string_view wanted = ir::info(to).name;
    Diagnostic& d = report.error(offset, "type-mismatch",
                                 fmt::format("expected {} for {}, not {}", wanted, what, ir::info(from).name));
    bool isScalars = ir::isScalar(from) && ir::isScalar(to), isVectors = ir::isVector(from) && ir::isVector(to);
    if (isScalars || (isVectors && ir::componentCount(from) == ir::componentCount(to)))
        d.hint = fmt::format("write '{}(...)'", wanted);
    return {};
}

ExprId Lowering::asCondition(ExprId value, std::uint32_t offset) {
    if (!value || b.type(value) == Type::Boolean) return value;
    Diagnostic& d = report.error(offset, "type-mismatch",
                                 fmt::format("expected boolean for a condition, not {}", ir::info(b.type(value)).name));
    if (ir::isScalar(b.type(value))) d.hint = "compare it: '... != 0'";
    return {};
}

// ---- names ----

ExprId Lowering::constant(const Constant& c) {
    if (!c.isKnown) return {};
    return c.type == Type::String ? b.string(c.text) : b.constant(c.type, c.words);
}

ExprId Lowering::name(const Node& n) {
    if (auto v = visible(n.name)) {
        Place whole;
        whole.variable = *v;
        return read(whole, variables[*v], n.offset);
    }
    auto constants = program.constantsCalled(unitIndex, n.name);
    for (std::uint32_t k = 1; k < constants.size(); k++) {
        const Constant &first = program.constants[constants[0]], &other = program.constants[constants[k]];
        if (first.type == other.type && first.words == other.words && first.text == other.text) continue;
        report.error(n.offset, "ambiguous-name", fmt::format("several files have a constant {}", quoted(text(n.name))));
        return {};
    }
    if (!constants.empty()) return constant(program.constants[constants[0]]);
    if (const NamedNumber* number = numberCalled(text(n.name))) return b.number(number->value);
    ir::Context context;
    if (ir::contextNamed(text(n.name), context)) return b.context(context);
    unknownName(n);
    return {};
}

void Lowering::unknownName(const Node& n) {
    std::string_view word = text(n.name);
    std::vector<std::string_view> known;
    for (std::uint32_t v : scope) known.push_back(text(variables[v].name));
    for (const Constant& c : program.constants) known.push_back(text(c.name));
    for (int c = 0; c < ir::kContexts; c++) known.push_back(ir::info(static_cast<ir::Context>(c)).name);
    if (program.isIncomplete) {
        report.silent();
        return;
    }
    std::string_view near = word.size() <= 64 && known.size() < 2000 ? nearest(word, known) : std::string_view();
    Diagnostic& d = report.error(n.offset, "unknown-name", fmt::format("unknown name {}", quoted(word)));
    if (!near.empty()) d.hint = fmt::format("did you mean '{}'?", near);
    if (typeCalled(word) != Type::Void) d.hint = fmt::format("a value of the type is '{}(...)'", word);
}

ExprId Lowering::placeholder(const Node& n) {
    if (auto v = visible(n.name)) return variables[*v].value;
    std::vector<std::string_view> known;
    for (std::uint32_t v : scope) known.push_back(text(variables[v].name));
    std::string_view near = nearest(text(n.name).substr(0, 64), known);
    Diagnostic& d =
        report.error(n.offset, "unknown-parameter", fmt::format("there is no input {}", quoted(text(n.name))));
    if (!near.empty()) d.hint = fmt::format("did you mean '{}'?", near);
    return {};
}

// What the place had when the variable was `v`.
ExprId Lowering::read(const Place& place, const Variable& v, std::uint32_t offset) {
    std::uint32_t needed = place.isWhole ? allBits(v.type) : 0;
    std::uint32_t mask = static_cast<std::uint32_t>(place.count) << 8;
    for (int k = 0; k < place.count; k++) {
        needed |= 1u << place.at[k];
        mask |= static_cast<std::uint32_t>(place.at[k]) << (2 * k);
    }
    if ((v.assigned & needed) != needed) {
        Diagnostic& d = report.error(offset, "not-assigned",
                                     fmt::format("{} has no value here on every way", quoted(text(v.name))));
        d.notes.push_back({report.at(v.offset), "declared here"});
        set(place.variable, {}, allBits(v.type));  // once is enough
        return {};
    }
    if (!v.value || place.isWhole) return v.value;
    return place.count == 1 ? component(v.value, place.at[0]) : b.swizzle(v.value, mask);
}

// ---- places and components ----

bool Lowering::componentsOf(const Node& n, Type type, bool tell, Place& place) {
    std::string_view letters = text(n.name);
    std::string wrong;
    constexpr std::string_view kSets[] = {"xyzw", "rgba"};
    std::string_view set = kSets[letters.find_first_of("rgba") != std::string_view::npos];
    place.isWhole = false;
    place.count = static_cast<int>(std::min<std::size_t>(letters.size(), 4));
    if (!ir::isFloatVector(type))
        wrong = fmt::format("{} has no components with names", ir::info(type).name);
    else if (letters.size() > 4)
        wrong = fmt::format("{} are more than four components", quoted(letters));
    for (int k = 0; k < place.count && wrong.empty(); k++) {
        std::size_t at = set.find(letters[static_cast<std::size_t>(k)]);
        place.at[k] = static_cast<int>(at & 3);
        if (at == std::string_view::npos || static_cast<int>(at) >= ir::componentCount(type))
            wrong = fmt::format("{} has no components {}", ir::info(type).name, quoted(letters));
    }
    if (wrong.empty()) return true;
    if (tell) report.error(n.offset, "bad-components", wrong);
    return false;
}

bool Lowering::notAssignable(const Node& n, std::string_view why, bool tell) {
    if (tell) report.error(n.offset, "read-only", std::string(why));
    return false;
}

// Where an assignment to the expression goes, or none where it cannot be assigned.
std::optional<Lowering::Place> Lowering::placeOf(NodeId id, bool tell) {
    const Node& n = tree[id];
    Place place;
    if (n.kind == NodeKind::Name) {
        auto v = visible(n.name);
        ir::Context context;
        bool isGlobal = !program.constantsCalled(unitIndex, n.name).empty() || ir::contextNamed(text(n.name), context);
        if (!v && isGlobal) notAssignable(n, fmt::format("{} cannot be assigned", quoted(text(n.name))), tell);
        if (!v && !isGlobal && tell) unknownName(n);
        if (!v) return {};
        std::string_view fixedAs = variables[*v].fixedAs;
        if (!fixedAs.empty()) notAssignable(n, fmt::format("{} is {}", quoted(text(n.name)), fixedAs), tell);
        place.variable = *v;
        return fixedAs.empty() ? std::optional(place) : std::nullopt;
    }
    if (n.kind != NodeKind::Member && n.kind != NodeKind::Index) {
        notAssignable(n, "this cannot be assigned", tell);
        return {};
    }
    auto base = placeOf(tree.child(n, 0), tell);
    if (!base) return {};
    if (!base->isWhole) {
        notAssignable(n, "a component of components cannot be assigned", tell);
        return {};
    }
    Type type = variables[base->variable].type;
    place.variable = base->variable;
    if (n.kind == NodeKind::Member) {
        if (!componentsOf(n, type, tell, place)) return {};
        for (int k = 1; k < place.count; k++)
            if (std::find(place.at, place.at + k, place.at[k]) != place.at + k) {
                notAssignable(n, "the same component twice", tell);
                return {};
            }
        return place;
    }
    const Node& at = tree[tree.child(n, 1)];
    std::uint32_t parts =
        ir::isMatrix(type) ? ir::info(type).columns : static_cast<std::uint32_t>(ir::componentCount(type));
    if (at.kind != NodeKind::Integer || at.bits >= parts || ir::isScalar(type)) {
        notAssignable(n, "only the components of a vector and the columns of a matrix can be assigned, by number",
                      tell);
        return {};
    }
    place.isWhole = false;
    place.count = 1;
    place.at[0] = static_cast<int>(at.bits);
    return place;
}

ExprId Lowering::member(NodeId id) {
    const Node& n = tree[id];
    // Of a variable only the components in question need values.
    if (auto place = placeOf(id, false)) return read(*place, variables[place->variable], n.offset);
    ExprId value = expression(tree.child(n, 0));
    if (value && ir::isStruct(b.type(value))) return structMember(n, value);
    Place place;
    if (!value || !componentsOf(n, b.type(value), true, place)) return {};
    if (place.count == 1) return component(value, place.at[0]);
    int* at = place.at;
    return b.swizzle(value, ir::swizzleMask(place.count, at[0], at[1], at[2], at[3]));
}

ExprId Lowering::structMember(const Node& n, ExprId value) {
    const ir::StructType& s = program.module.structs[ir::structIndex(b.type(value))];
    for (std::uint32_t k = 0; k < s.members.size(); k++)
        if (s.members[k].name == n.name) return b.emit(Op::Member, s.members[k].type, {value}, k);
    Diagnostic& d =
        report.error(n.offset, "unknown-member",
                     fmt::format("{} has no member {}", program.module.names->text(s.name), quoted(text(n.name))));
    std::vector<std::string_view> names;
    for (const ir::Param& m : s.members) names.push_back(program.module.names->text(m.name));
    if (std::string_view near = nearest(text(n.name), names); !near.empty())
        d.hint = fmt::format("did you mean '{}'?", near);
    return {};
}

ExprId Lowering::index(NodeId id) {
    const Node& n = tree[id];
    if (auto place = placeOf(id, false)) return read(*place, variables[place->variable], n.offset);
    ExprId value = expression(tree.child(n, 0)), at = expression(tree.child(n, 1));
    at = converted(at, Type::Integer, tree[tree.child(n, 1)].offset, "an index");
    if (!value || !at) return {};
    const ir::TypeInfo& t = ir::info(b.type(value));
    bool isMatrix = t.columns > 1;
    if (t.rows < 2) {
        report.error(n.offset, "bad-index", fmt::format("{} has no components", t.name));
        return {};
    }
    if (!b.function().isConstant(at))
        return b.emit(Op::Index, isMatrix ? ir::floatVector(t.rows) : Type::Float, {value, at});
    int k = static_cast<int>(b.function().constantWords(at)[0]);
    int parts = isMatrix ? t.columns : t.rows;
    if (k >= 0 && k < parts) return component(value, k);
    report.error(n.offset, "bad-index", fmt::format("{} has components 0 to {}, not {}", t.name, parts - 1, k));
    return {};
}

// ---- operators that ask for their operands ----

ExprId Lowering::unary(const Node& n) {
    ExprId x = expression(tree.child(n, 0));
    if (!x) return {};
    Type t = b.type(x);
    if (n.op == Operator::Not && t == Type::Boolean) return b.op(Op::Not, {x});
    if (n.op == Operator::BitNot && t == Type::Integer) return b.op(Op::BitNot, {x});
    if (n.op == Operator::Neg && ir::isNumeric(t)) return b.op(Op::Neg, {x});
    if (n.op == Operator::Plus && ir::isNumeric(t)) return x;
    doesNotFit(n.op, t, Type::Void, n.offset);
    return {};
}

// Goes along the left spine, so that a sum of a million terms is not deep.
ExprId Lowering::binary(NodeId id) {
    std::vector<NodeId> spine;
    for (; tree[id].kind == NodeKind::Binary; id = tree.child(tree[id], 0)) spine.push_back(id);
    ExprId x = expression(id);
    std::uint32_t offset = tree[id].offset;
    for (; !spine.empty(); spine.pop_back()) {
        const Node& n = tree[spine.back()];
        NodeId right = tree.child(n, 1);
        bool isLogic = n.op == Operator::And || n.op == Operator::Or;
        if (isLogic) x = asCondition(x, offset);
        if (isLogic && writes(right)) {
            // The right side runs, and writes, only where the left one leaves the question open.
            std::vector<Branch> list(2);
            Mark mark = beginBranch();
            ExprId y = condition(right);
            list[0].left = endBranch(mark);
            list[0].condition = x && n.op == Operator::Or ? b.op(Op::Not, {x}) : x;
            merge(list);
            x = x && y ? b.op(n.op == Operator::And ? Op::And : Op::Or, {x, y}) : ExprId();
        } else {
            ExprId y = isLogic ? condition(right) : expression(right);
            x = binaryValue(n.op, x, y, n.offset);
        }
        offset = n.offset;
    }
    return x;
}

ExprId Lowering::conditional(const Node& n) {
    std::vector<Branch> list(2);
    ExprId values[2];
    list[0].condition = condition(tree.child(n, 0));
    for (std::uint32_t k = 0; k < 2; k++) {
        Mark mark = beginBranch();
        values[k] = expression(tree.child(n, k + 1));
        list[k].left = endBranch(mark);
    }
    merge(list);
    if (!values[0] || !values[1]) return {};
    Type x = b.type(values[0]), y = b.type(values[1]), common = x == y ? x : meet(x, y);
    bool isWrong = common == Type::Void || conversionRank(x, common) < 0 || conversionRank(y, common) < 0;
    if (isWrong || common == Type::Texture2D) {
        report.error(n.offset, "type-mismatch",
                     isWrong ? fmt::format("'?:' cannot choose between {} and {}", ir::info(x).name, ir::info(y).name)
                             : "a condition cannot choose between textures");
        return {};
    }
    return select(list[0].condition, b.convert(values[0], common), b.convert(values[1], common));
}

}  // namespace shaderx::sl
