// Lowering: variables, what branches leave in them, and where they return.
#include <algorithm>

#include "sl/lower_state.h"

namespace shaderx::sl {

std::uint32_t Lowering::declare(Name name, Type type, std::uint32_t offset, std::string_view fixedAs) {
    if (auto other = visible(name); other && variables[*other].level == level) {
        Diagnostic& d = report.error(offset, "duplicate-name", fmt::format("{} exists already", quoted(text(name))));
        d.notes.push_back({report.at(variables[*other].offset), "here"});
    }
    std::uint32_t made = static_cast<std::uint32_t>(variables.size());
    Variable v;
    v.name = name;
    v.type = type;
    v.offset = offset;
    v.fixedAs = fixedAs;
    v.level = level;
    variables.push_back(v);
    scope.push_back(made);
    seen[name].push_back(made);
    return made;
}

std::optional<std::uint32_t> Lowering::visible(Name name) const {
    auto found = seen.find(name);
    if (found == seen.end() || found->second.empty()) return {};
    return found->second.back();
}

void Lowering::leaveBlock(std::size_t scopeSize) {
    for (; scope.size() > scopeSize; scope.pop_back()) seen[variables[scope.back()].name].pop_back();
    level--;
}

std::uint32_t Lowering::allBits(Type t) {
    int parts = ir::isMatrix(t) ? ir::info(t).columns : std::max(1, ir::componentCount(t));
    return (1u << parts) - 1;
}

void Lowering::set(std::uint32_t variable, ExprId value, std::uint32_t assigned) {
    Variable& v = variables[variable];
    if (branches > 0) changes.push_back({variable, v.value, v.assigned});
    v.value = value;
    v.assigned = assigned;
}

// Names a value after a variable, unless what it is says more.
void Lowering::hint(ExprId value, Name name) {
    if (!value) return;
    Op op = b.function()[value].op;
    bool isNamed = op == Op::Param || op == Op::Context || op == Op::Attribute || op == Op::Uniform;
    if (!isNamed && op != Op::Constant) b.hint(value, name);
}

Type Lowering::placeType(const Place& place) const {
    Type t = variables[place.variable].type;
    if (place.isWhole) return t;
    const ir::TypeInfo& i = ir::info(t);
    return ir::isMatrix(t) ? ir::floatVector(i.rows) : ir::floatVector(place.count, i.role);
}

// A component of a vector, a column of a matrix.
ExprId Lowering::component(ExprId value, int i) {
    if (!value) return {};
    return ir::isMatrix(b.type(value)) ? b.swizzle(value, static_cast<std::uint32_t>(i)) : b.component(value, i);
}

void Lowering::assign(const Place& place, ExprId value) {
    Variable& v = variables[place.variable];
    if (place.isWhole) {
        hint(value, v.name);
        return set(place.variable, value, allBits(v.type));
    }
    std::uint32_t assigned = v.assigned;
    for (int k = 0; k < place.count; k++) assigned |= 1u << place.at[k];
    ExprId base = v.assigned ? v.value : b.null(v.type), made;
    if (base && value) {
        int n = ir::isMatrix(v.type) ? ir::info(v.type).columns : ir::componentCount(v.type);
        ExprId parts[4];
        for (int i = 0; i < n; i++) parts[i] = component(base, i);
        for (int k = 0; k < place.count; k++) parts[place.at[k]] = place.count == 1 ? value : component(value, k);
        made = b.make(v.type, std::span<const ExprId>(parts, static_cast<std::size_t>(n)));
        hint(made, v.name);
    }
    set(place.variable, made, assigned);
}

ExprId Lowering::select(ExprId condition, ExprId then, ExprId otherwise) {
    if (!condition || !then || !otherwise) return {};
    return then == otherwise ? then : b.select(condition, then, otherwise);
}

std::vector<ExprId> Lowering::selectAll(ExprId condition, const std::vector<ExprId>& then,
                                        const std::vector<ExprId>& otherwise) {
    std::vector<ExprId> made(then.size());
    for (std::size_t k = 0; k < then.size(); k++) made[k] = select(condition, then[k], otherwise[k]);
    return made;
}

Lowering::Mark Lowering::beginBranch() {
    branches++;
    return {changes.size(), variables.size()};
}

// What the branch left in older variables, by variable; their values are as before it again.
std::vector<Lowering::Change> Lowering::endBranch(Mark mark) {
    branches--;
    std::vector<Change> left;
    for (std::size_t i = mark.changes; i < changes.size(); i++)
        if (changes[i].variable < mark.variables) left.push_back({changes[i].variable, {}, 0});
    std::sort(left.begin(), left.end(), [](const Change& x, const Change& y) { return x.variable < y.variable; });
    left.erase(std::unique(left.begin(), left.end(),
                           [](const Change& x, const Change& y) { return x.variable == y.variable; }),
               left.end());
    for (Change& c : left) {
        c.value = variables[c.variable].value;
        c.assigned = variables[c.variable].assigned;
    }
    for (; changes.size() > mark.changes; changes.pop_back()) {
        const Change& c = changes.back();
        variables[c.variable].value = c.value;
        variables[c.variable].assigned = c.assigned;
    }
    return left;
}

// What one of two branches leaves. Both lists are in the order of variables.
std::vector<Lowering::Change> Lowering::mergeLeft(ExprId condition, const std::vector<Change>& then,
                                                  const std::vector<Change>& otherwise) {
    std::vector<Change> made;
    for (std::size_t i = 0, k = 0; i < then.size() || k < otherwise.size();) {
        bool inThen = k == otherwise.size() || (i < then.size() && then[i].variable <= otherwise[k].variable);
        bool inOther = i == then.size() || (k < otherwise.size() && otherwise[k].variable <= then[i].variable);
        std::uint32_t variable = inThen ? then[i].variable : otherwise[k].variable;
        const Variable& v = variables[variable];
        Change x{variable, v.value, v.assigned}, y = x;
        if (inThen) x = then[i++];
        if (inOther) y = otherwise[k++];
        std::uint32_t assigned = x.assigned & y.assigned;
        ExprId value = assigned ? select(condition, x.value, y.value) : ExprId();
        hint(value, v.name);
        made.push_back({variable, value, assigned});
    }
    return made;
}

Lowering::Flow Lowering::mergeFlow(ExprId condition, const Flow& then, const Flow& otherwise) {
    using Ends = Flow::Ends;
    if (then.ends == Ends::Never && otherwise.ends == Ends::Never) return {};
    Flow made;
    if (then.ends == Ends::Never)
        made.results = otherwise.results;
    else if (otherwise.ends == Ends::Never)
        made.results = then.results;
    else
        made.results = selectAll(condition, then.results, otherwise.results);
    bool isAlways = then.ends == Ends::Always && otherwise.ends == Ends::Always;
    made.ends = isAlways ? Ends::Always : Ends::Sometimes;
    auto returned = [&](const Flow& f) {
        return f.ends == Ends::Sometimes ? f.condition : b.boolean(f.ends == Ends::Always);
    };
    auto both = [&](Op op, ExprId x, ExprId y) { return x && y ? b.op(op, {x, y}) : ExprId(); };
    ExprId opposite = condition ? b.op(Op::Not, {condition}) : ExprId();
    if (isAlways) return made;
    if (then.ends == Ends::Always)
        made.condition = both(Op::Or, condition, returned(otherwise));
    else if (then.ends == Ends::Never)
        made.condition = both(Op::And, opposite, returned(otherwise));
    else if (otherwise.ends == Ends::Always)
        made.condition = both(Op::Or, opposite, then.condition);
    else if (otherwise.ends == Ends::Never)
        made.condition = both(Op::And, condition, then.condition);
    else
        made.condition = select(condition, then.condition, otherwise.condition);
    return made;
}

// Branches in the order in which their conditions are asked, the last without condition: sets the variables to what the
// branch taken leaves, where one that always returns leaves nothing.
Lowering::Flow Lowering::merge(std::vector<Branch>& list) {
    std::vector<Change> left = std::move(list.back().left);
    Flow flow = std::move(list.back().flow);
    for (std::size_t i = list.size() - 1; i-- > 0;) {
        Branch& branch = list[i];
        if (flow.ends == Flow::Ends::Always)
            left = std::move(branch.left);
        else if (branch.flow.ends != Flow::Ends::Always)
            left = mergeLeft(branch.condition, branch.left, left);
        flow = mergeFlow(branch.condition, branch.flow, flow);
    }
    for (const Change& c : left) set(c.variable, c.value, c.assigned);
    return flow;
}

// Parts of a list of statements, one after the other.
Lowering::Flow Lowering::join(const std::vector<Flow>& parts) {
    if (parts.empty()) return {};
    Flow made = parts.back();
    for (std::size_t i = parts.size() - 1; i-- > 0;) {
        const Flow& part = parts[i];
        made.results = selectAll(part.condition, part.results, made.results);
        if (made.ends == Flow::Ends::Always) continue;
        made.condition = part.condition && made.condition ? b.op(Op::Or, {part.condition, made.condition}) : ExprId();
    }
    return made;
}

}  // namespace shaderx::sl
