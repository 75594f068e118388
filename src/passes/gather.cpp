#include "passes/gather.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/diagnostics.h"
#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

// A truth value that holds, or does not.
struct Literal {
    ExprId condition;
    bool holds;
    friend auto operator<=>(const Literal& a, const Literal& b) {
        return std::pair(a.condition.index, a.holds) <=> std::pair(b.condition.index, b.holds);
    }
    friend bool operator==(const Literal&, const Literal&) = default;
};

// What certainly holds where a value is needed; nothing is known of a value that is not.
struct Need {
    bool known = false;
    std::vector<Literal> literals;  // sorted
};

// Calls of one function.
struct Group {
    Name callee;
    std::vector<ExprId> calls;
    bool isApart = false;  // its calls stay as they are
};

constexpr std::uint32_t kNone = 0xffffffffu, kShared = kNone - 1;
constexpr int kLongWork = 40;  // operations that are worth a loop around two calls, to have them once
constexpr int kMaxDepth = 24;  // of expressions that are looked through to find what two have in common

// Operations of a function with all that it calls.
int workOf(const Module& module, const Function& f, int depth = 0) {
    int work = 0;
    std::vector<bool> live = reachable(f);
    for (std::size_t i = 0; i < f.exprs.size() && work < kLongWork; i++) {
        const Expr& e = f.exprs[i];
        if (!live[i] || e.op <= Op::Uniform || e.op == Op::Result || e.op == Op::Retype) continue;
        const Function* callee = e.op == Op::Call && depth < kMaxDepth ? module.find(Name(e.payload)) : nullptr;
        work += callee ? workOf(module, *callee, depth + 1) : 1;
    }
    return work;
}

struct Gatherer {
    Module& module;
    const Function& from;
    std::size_t n = from.exprs.size();
    std::vector<bool> live = reachable(from);
    std::vector<std::uint32_t> loopOf = loopsOf(from);
    std::vector<Need> needs = std::vector<Need>(n);
    std::vector<bool> afterCall = std::vector<bool>(n);  // depends on a call that may be gathered
    std::vector<Group> groups{};
    std::vector<std::uint32_t> groupOf = std::vector<std::uint32_t>(n, kNone);
    std::vector<std::uint32_t> ownerOf = std::vector<std::uint32_t>(n, kNone);
    std::vector<std::vector<ExprId>> resultsOf = std::vector<std::vector<ExprId>>(n);  // of calls with several
    Function fresh{};
    Builder b{module, fresh};
    Copy copy{from, b};

    bool run() {
        findCalls();
        findNeeds();
        dropUnworthy();
        if (groups.empty()) return false;
        std::vector<std::uint32_t> order;
        while (!sort(order)) {
        }
        findOwners();
        fresh.name = from.name;
        fresh.params = from.params;
        fresh.comment = from.comment;
        for (std::uint32_t unit : order) unit < n ? one(ExprId(unit)) : loop(groups[unit - n]);
        for (const ResultValue& r : from.results) b.addResult(r.name, copy[r.value]);
        return true;
    }

    bool isCandidate(ExprId e) const {
        if (from[e].op != Op::Call || loopOf[e.index] != kNoLoop) return false;
        const Function* callee = module.find(Name(from[e].payload));
        return callee && (holdsLoop(*callee) || workOf(module, *callee) >= kLongWork);
    }

    void findCalls() {
        std::map<Name, std::uint32_t> byName;
        for (std::uint32_t i = 0; i < n; i++) {
            if (!live[i]) continue;
            ExprId e(i);
            for (ExprId o : from.operandsOf(e)) afterCall[i] = afterCall[i] || afterCall[o.index];
            if (from[e].op == Op::Result) resultsOf[from.operand(e, 0).index].push_back(e);
            if (!isCandidate(e)) continue;
            auto [at, isNew] = byName.emplace(Name(from[e].payload), static_cast<std::uint32_t>(groups.size()));
            if (isNew) groups.push_back({at->first, {}, false});
            groups[at->second].calls.push_back(e);
            groupOf[i] = at->second;
            afterCall[i] = true;
        }
    }

    // From users to operands: a value is needed where one of its users is. Of several ways only what holds on all
    // counts.
    void findNeeds() {
        for (const ResultValue& r : from.results) needs[r.value.index].known = true;
        for (std::uint32_t i = static_cast<std::uint32_t>(n); i-- > 0;) {
            if (!live[i]) continue;
            auto operands = from.operandsOf(ExprId(i));
            bool isChoice =
                from.exprs[i].op == Op::Select && !afterCall[operands[0].index] && loopOf[operands[0].index] == kNoLoop;
            for (std::size_t k = 0; k < operands.size(); k++) {
                std::vector<Literal> here = needs[i].literals;
                if (isChoice && k > 0) {
                    here.push_back({operands[0], k == 1});
                    std::sort(here.begin(), here.end());
                    here.erase(std::unique(here.begin(), here.end()), here.end());
                }
                meet(needs[operands[k].index], std::move(here));
            }
        }
    }

    static void meet(Need& need, std::vector<Literal> literals) {
        if (need.known) {
            std::vector<Literal> both;
            std::set_intersection(need.literals.begin(), need.literals.end(), literals.begin(), literals.end(),
                                  std::back_inserter(both));
            literals = std::move(both);
        }
        need = {true, std::move(literals)};
    }

    void dropUnworthy() {
        std::size_t left = 0;
        for (Group& g : groups) {
            bool isAlways =
                std::all_of(g.calls.begin(), g.calls.end(), [&](ExprId c) { return needs[c.index].literals.empty(); });
            g.isApart = isAlways || (g.calls.size() == 1 && !holdsLoop(*module.find(g.callee)));
            left += !g.isApart;
        }
        if (left == 0) groups.clear();
    }

    // Which group's calls alone use a value.
    void findOwners() {
        for (const ResultValue& r : from.results) ownerOf[r.value.index] = kShared;
        for (std::uint32_t i = static_cast<std::uint32_t>(n); i-- > 0;) {
            if (!live[i]) continue;
            std::uint32_t owner = loopFor(ExprId(i)) == kNone ? ownerOf[i] : groupOf[i];
            for (ExprId o : from.operandsOf(ExprId(i))) {
                std::uint32_t& of = ownerOf[o.index];
                of = of == kNone || of == owner ? owner : kShared;
            }
        }
    }

    // The group whose loop gives an expression, or none.
    std::uint32_t loopFor(ExprId e) const {
        std::uint32_t g = groupOf[e.index];
        return g == kNone || groups[g].isApart ? kNone : g;
    }

    // All that is needed, in an order in which a loop follows what any of its calls needs: expressions by their number,
    // groups above them. False where calls of a group need each other's results; the group is then left apart.
    bool sort(std::vector<std::uint32_t>& order) {
        enum : std::uint8_t { New, Open, Done };
        std::vector<std::uint8_t> state(n + groups.size(), New);
        std::vector<std::pair<std::uint32_t, bool>> stack;  // unit, and whether what it needs stands in the order
        auto push = [&](ExprId e) {
            std::uint32_t g = loopFor(e), unit = g == kNone ? e.index : static_cast<std::uint32_t>(n) + g;
            if (state[unit] == Open) {  // a ring, which only a group can have closed
                auto open = std::find_if(stack.rbegin(), stack.rend(), [&](const auto& entry) {
                    return entry.first >= n && state[entry.first] == Open;
                });
                ensure(open != stack.rend(), "an expression needs itself");
                groups[open->first - n].isApart = true;
                return false;
            }
            if (state[unit] == New) stack.push_back({unit, false});
            return true;
        };
        order.clear();
        for (std::uint32_t i = 0; i < n; i++) {
            if (!live[i] || !push(ExprId(i))) continue;
            while (!stack.empty()) {
                auto [unit, isReady] = stack.back();
                if (isReady || state[unit] == Done) {
                    if (state[unit] != Done) order.push_back(unit);
                    state[unit] = Done;
                    stack.pop_back();
                    continue;
                }
                stack.back().second = true;
                state[unit] = Open;
                for (ExprId o : neededBy(unit))
                    if (!push(o)) return false;
            }
        }
        return true;
    }

    std::vector<ExprId> neededBy(std::uint32_t unit) const {
        std::vector<ExprId> all;
        auto add = [&](ExprId e) {
            for (ExprId o : from.operandsOf(e)) all.push_back(o);
        };
        if (unit < n) {
            add(ExprId(unit));
            return all;
        }
        for (ExprId call : groups[unit - n].calls) {
            add(call);
            for (const Literal& l : needs[call.index].literals) all.push_back(l.condition);
        }
        return all;
    }

    void one(ExprId e) {
        if (copy[e]) return;  // the result of a loop
        auto o = from.operandsOf(e);
        if (from[e].op == Op::Select && isNull(o[2]) && vanishes(o[1], {o[0], true}))
            copy.set(e, copy[o[1]]);
        else
            copy.one(e);
    }

    bool isNull(ExprId e) const {
        if (!from.isConstant(e) || !componentCount(from[e].type)) return false;
        auto words = from.constantWords(e);
        return std::all_of(words.begin(), words.end(), [](std::uint32_t w) { return w == 0; });
    }

    // Whether a value is 0 where `literal` fails, because the calls that it comes from are not made then.
    bool vanishes(ExprId root, Literal literal) const {
        std::map<std::uint32_t, bool> of;
        std::vector<std::pair<ExprId, bool>> stack{{root, false}};
        while (!stack.empty()) {
            auto [e, isReady] = stack.back();
            stack.pop_back();
            if (of.count(e.index)) continue;
            if (!isReady && afterCall[e.index] && from[e].op != Op::Call && from[e].op != Op::Result) {
                stack.push_back({e, true});
                for (ExprId o : from.operandsOf(e)) stack.push_back({o, false});
                continue;
            }
            of[e.index] = vanishesBy(e, literal, of);
        }
        return of[root.index];
    }

    bool vanishesBy(ExprId e, Literal literal, const std::map<std::uint32_t, bool>& of) const {
        if (from[e].op == Op::Result || from[e].op == Op::Call) {
            ExprId call = from[e].op == Op::Result ? from.operand(e, 0) : e;
            const auto& literals = needs[call.index].literals;
            return loopFor(call) != kNone && std::binary_search(literals.begin(), literals.end(), literal);
        }
        if (!afterCall[e.index]) return isNull(e);
        auto o = from.operandsOf(e);
        auto zero = [&](std::size_t k) { return of.at(o[k].index); };
        switch (from[e].op) {
            case Op::Mul:
                return zero(0) || zero(1);
            case Op::Add:
            case Op::Sub:
            case Op::Mix:
                return zero(0) && zero(1);
            case Op::Select:
                return zero(1) && zero(2);
            case Op::Neg:
            case Op::Retype:
            case Op::Swizzle:
                return zero(0);
            default:
                return false;
        }
    }

    // The conditions of a call in one.
    ExprId conditionOf(ExprId call) {
        ExprId all = b.boolean(true);
        for (const Literal& l : needs[call.index].literals) {
            ExprId c = copy[l.condition];
            if (Name hint = from.hints[l.condition.index])
                b.rename(c, name(fmt::format("{}_is_used", module.names->text(hint))));
            all = b.op(Op::And, {all, l.holds ? c : b.op(Op::Not, {c})});
        }
        return all;
    }

    Name name(std::string_view text) { return module.names->intern(text); }

    void loop(Group& g) {
        std::vector<ExprId> conditions;
        ExprId count = b.integer(0);
        for (ExprId call : g.calls) {
            conditions.push_back(conditionOf(call));
            count = b.op(Op::Add, {count, b.convert(conditions.back(), Type::Integer)});
        }
        std::size_t calls = g.calls.size();
        bool isAll = std::count(conditions.begin(), conditions.end(), conditions[0]) == static_cast<long>(calls);
        if (calls > 1 && isAll) count = b.select(conditions[0], b.integer(static_cast<int>(calls)), b.integer(0));
        b.hint(count, name("calls"));
        std::uint32_t number = b.beginLoop();
        ExprId which = calls == 1 ? b.integer(0) : b.loopIndex(number);
        std::vector<ExprId> first, next, slots;
        if (!isAll) {
            which = b.loopCarried(number, 0, Type::Integer);
            first.push_back(following(conditions, {}));
            next.push_back(following(conditions, which));
        }
        if (calls > 1) b.hint(which, name("which"));
        ExprId made = call(g, which);
        for (std::size_t k = 0; k < calls; k++)
            for (ExprId result : resultsIn(g.calls[k])) {
                Type type = from[result].type;
                ExprId old = b.loopCarried(number, static_cast<std::uint32_t>(first.size()), type);
                ExprId now = from[result].op == Op::Result ? b.result(made, from[result].payload, type) : made;
                if (from.hints[result.index]) b.hint(old, from.hints[result.index]);
                first.push_back(b.null(type));
                next.push_back(calls > 1 ? b.select(isTurn(g, which, k, k + 1), now, old) : now);
                slots.push_back(result);
            }
        ExprId whole = b.endLoop(number, count, first, next);
        std::uint32_t slot = !isAll;
        for (ExprId result : slots) {
            copy.set(result, b.result(whole, slot++, from[result].type));
            if (from.hints[result.index]) b.hint(copy[result], from.hints[result.index]);
        }
        for (ExprId c : g.calls)
            if (!copy[c]) copy.set(c, whole);
    }

    // What is read of a call: its results, or its one result.
    std::vector<ExprId> resultsIn(ExprId call) const {
        return from[call].type == Type::Tuple ? resultsOf[call.index] : std::vector{call};
    }

    // The first call to make after call number `which`, or of all.
    ExprId following(const std::vector<ExprId>& conditions, ExprId which) {
        std::size_t last = conditions.size() - 1;
        ExprId found = b.integer(static_cast<int>(last));
        for (std::size_t k = last; k-- > (which ? 1u : 0u);) {
            ExprId now = conditions[k];
            if (which) now = b.op(Op::And, {b.op(Op::Less, {which, b.integer(static_cast<int>(k))}), now});
            found = b.select(now, b.integer(static_cast<int>(k)), found);
        }
        return found;
    }

    // What the conditions of a call are called after, if anything.
    Name nameOf(ExprId call) const {
        for (const Literal& l : needs[call.index].literals)
            if (Name hint = from.hints[l.condition.index]) return hint;
        return {};
    }

    // Whether this turn makes one of the calls from `begin` up to `end`.
    ExprId isTurn(const Group& g, ExprId which, std::size_t begin, std::size_t end) {
        if (end == begin + 1) {
            ExprId is = b.op(Op::Equal, {which, b.integer(static_cast<int>(begin))});
            if (Name hint = nameOf(g.calls[begin])) b.hint(is, name(fmt::format("is_{}", module.names->text(hint))));
            return is;
        }
        ExprId from0 = b.op(Op::LessEqual, {b.integer(static_cast<int>(begin)), which});
        ExprId below = b.op(Op::Less, {which, b.integer(static_cast<int>(end))});
        return begin == 0 ? below : end == g.calls.size() ? from0 : b.op(Op::And, {from0, below});
    }

    // The call of a turn.
    ExprId call(const Group& g, ExprId which) {
        const Expr& e = from[g.calls[0]];
        Turn turn{groupOf[g.calls[0].index], which, {}, {}};
        std::vector<ExprId> arguments;
        for (std::size_t p = 0; p < e.operandCount; p++) {
            std::vector<ExprId> given;
            for (ExprId c : g.calls) given.push_back(from.operand(c, p));
            ExprId value = merged(turn, given, 0);
            if (!isSame(given)) b.hint(value, module.find(g.callee)->params[p].name);
            arguments.push_back(value);
        }
        return b.call(g.callee, e.type, arguments);
    }

    // Of the values that the calls of a group take for something, the one for this turn.
    struct Turn {
        std::uint32_t group;
        ExprId which;
        std::map<std::vector<ExprId>, int> gains;
        std::map<std::vector<ExprId>, ExprId> made;
    };

    bool isSame(const std::vector<ExprId>& given) const {
        return std::all_of(given.begin(), given.end(), [&](ExprId x) { return copy[x] == copy[given[0]]; });
    }

    static int kindsIn(const std::vector<ExprId>& given) {
        std::vector<ExprId> kinds(given);
        std::sort(kinds.begin(), kinds.end());
        return static_cast<int>(std::unique(kinds.begin(), kinds.end()) - kinds.begin());
    }

    // Whether two operations have operands of the same types: a closure's mix, say, weighs by a number or a colour.
    bool takeSameTypes(ExprId one, ExprId other) const {
        auto ones = from.operandsOf(one), others = from.operandsOf(other);
        return std::equal(ones.begin(), ones.end(), others.begin(), others.end(),
                          [&](ExprId x, ExprId y) { return from[x].type == from[y].type; });
    }

    // Whether values that nobody else uses are made by one operation, of different operands.
    bool isAlike(const Turn& turn, const std::vector<ExprId>& given) const {
        const Expr& first = from[given[0]];
        if (first.operandCount == 0 || first.op == Op::Loop || first.op == Op::Lights || first.op == Op::Ddx ||
            first.op == Op::Ddy || first.op == Op::TextureGrad || first.op == Op::TextureLevel)
            return false;
        return std::all_of(given.begin(), given.end(), [&](ExprId x) {
            const Expr& e = from[x];
            return ownerOf[x.index] == turn.group && loopOf[x.index] == kNoLoop && groupOf[x.index] == kNone &&
                   e.op == first.op && e.type == first.type && e.payload == first.payload &&
                   e.operandCount == first.operandCount && takeSameTypes(x, given[0]);
        });
    }

    std::vector<ExprId> operandsAt(const std::vector<ExprId>& given, std::size_t k) const {
        std::vector<ExprId> operands;
        for (ExprId x : given) operands.push_back(from.operand(x, k));
        return operands;
    }

    // Operations that are saved by doing what the values have in common in the turn.
    int gainOf(Turn& turn, const std::vector<ExprId>& given, int depth) {
        if (isSame(given)) return 0;
        if (auto known = turn.gains.find(given); known != turn.gains.end()) return known->second;
        int others = kindsIn(given) - 1, gain = -others;
        if (depth < kMaxDepth && isAlike(turn, given)) {
            const Expr& e = from[given[0]];
            const Function* callee = e.op == Op::Call ? module.find(Name(e.payload)) : nullptr;
            int sum = others * (callee ? workOf(module, *callee) : e.op != Op::Result && e.op != Op::Retype);
            for (std::size_t k = 0; k < e.operandCount; k++) sum += gainOf(turn, operandsAt(given, k), depth + 1);
            gain = std::max(gain, sum);
        }
        return turn.gains[given] = gain;
    }

    ExprId merged(Turn& turn, const std::vector<ExprId>& given, int depth) {
        if (isSame(given)) return copy[given[0]];
        if (auto known = turn.made.find(given); known != turn.made.end()) return known->second;
        ExprId value;
        if (gainOf(turn, given, depth) > 1 - kindsIn(given)) {
            const Expr& e = from[given[0]];
            std::vector<ExprId> operands;
            for (std::size_t k = 0; k < e.operandCount; k++)
                operands.push_back(merged(turn, operandsAt(given, k), depth + 1));
            value = b.emit(e.op, e.type, operands, e.payload);
        } else {
            value = chosen(turn, given);
        }
        return turn.made[given] = value;
    }

    // By selects: what most calls take is what a call takes unless it is another's turn.
    ExprId chosen(const Turn& turn, const std::vector<ExprId>& all) {
        std::vector<ExprId> given;
        for (ExprId x : all) given.push_back(copy[x]);
        auto times = [&](ExprId x) { return std::count(given.begin(), given.end(), x); };
        ExprId value =
            *std::max_element(given.begin(), given.end(), [&](ExprId x, ExprId y) { return times(x) < times(y); });
        const ExprId usual = value;
        for (std::size_t end = given.size(); end > 0;) {
            std::size_t begin = end - 1;
            while (begin > 0 && given[begin - 1] == given[end - 1]) begin--;
            if (given[begin] != usual)
                value = b.select(isTurn(groups[turn.group], turn.which, begin, end), given[begin], value);
            end = begin;
        }
        return value;
    }
};

}  // namespace

bool holdsLoop(const Function& f) {
    return std::any_of(f.exprs.begin(), f.exprs.end(),
                       [](const Expr& e) { return e.op == Op::Loop || e.op == Op::Lights; });
}

bool readsImage(const Function& f) {
    return std::any_of(f.exprs.begin(), f.exprs.end(),
                       [](const Expr& e) { return e.op == Op::TextureLevel || e.op == Op::TextureGrad; });
}

bool leadsTo(const Module& module, const Function& f, bool (*what)(const Function&)) {
    std::vector<const Function*> todo{&f};
    for (std::size_t i = 0; i < todo.size(); i++) {
        if (what(*todo[i])) return true;
        for (const Expr& e : todo[i]->exprs) {
            const Function* callee = e.op == Op::Call ? module.find(Name(e.payload)) : nullptr;
            if (callee && std::find(todo.begin(), todo.end(), callee) == todo.end()) todo.push_back(callee);
        }
    }
    return false;
}

void gather(Module& module, Name entry) {
    Function* f = module.findOwn(entry);
    ensure(f, "no entry to gather in");
    Gatherer g{module, *f};
    if (g.run()) module.put(std::move(g.fresh));
}

}  // namespace shaderx::passes
