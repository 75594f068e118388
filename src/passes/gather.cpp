#include "passes/gather.h"

#include <algorithm>
#include <array>
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

// Lists of what certainly holds somewhere, by number; nothing does in number 0.
class Facts {
  public:
    const std::vector<Literal>& operator[](std::uint32_t number) const { return lists_[number]; }  // sorted

    // One list and a literal more.
    std::uint32_t with(std::uint32_t number, Literal literal) {
        return made({number, literal.condition.index, literal.holds}, [&] {
            std::vector<Literal> all = lists_[number];
            auto at = std::lower_bound(all.begin(), all.end(), literal);
            if (at == all.end() || *at != literal) all.insert(at, literal);
            return all;
        });
    }
    // What holds in both of two.
    std::uint32_t common(std::uint32_t one, std::uint32_t other) {
        if (one == other) return one;
        return made({one, other, 2}, [&] {
            const auto &x = lists_[one], &y = lists_[other];
            std::vector<Literal> both;
            std::set_intersection(x.begin(), x.end(), y.begin(), y.end(), std::back_inserter(both));
            return both;
        });
    }

  private:
    template <class Make>
    std::uint32_t made(std::array<std::uint32_t, 3> how, Make&& make) {
        auto [at, isNew] = made_.try_emplace(how, static_cast<std::uint32_t>(lists_.size()));
        if (isNew) lists_.push_back(make());
        return at->second;
    }

    std::vector<std::vector<Literal>> lists_{{}};
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> made_;
};

constexpr std::uint32_t kNone = 0xffffffffu, kShared = kNone - 1;

// Calls of one function.
struct Group {
    Name callee;
    std::vector<ExprId> calls;
    bool isApart = false;          // its calls stay as they are
    bool isAlways = false;         // a loop around it makes its call in every turn, for the function skips itself
    std::uint32_t within = kNone;  // the group in whose loop its calls are made
};

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

// Whether a function itself chooses to run its loops, or not.
bool skipsItself(const Function& f) {
    const std::vector<std::uint32_t> inside = loopsOf(f);
    auto isNone = [&](ExprId e) { return f.isConstant(e) && f.constantWords(e)[0] == 0; };
    for (std::size_t i = 0; i < f.exprs.size(); i++) {
        if (f.exprs[i].op == Op::Lights) return false;
        if (f.exprs[i].op != Op::Loop || inside[i] != kNoLoop) continue;
        ExprId count = f.operandsOf(f.exprs[i])[0];
        if (f[count].op != Op::Select || !(isNone(f.operand(count, 1)) || isNone(f.operand(count, 2)))) return false;
    }
    return true;
}

struct Gatherer {
    Module& module;
    const Function& from;
    std::size_t n = from.exprs.size();
    std::vector<bool> live = reachable(from);
    std::vector<std::uint32_t> loopOf = loopsOf(from);
    Facts facts{};
    std::vector<std::uint32_t> needs = std::vector<std::uint32_t>(n, kNone);  // what holds where a value is needed
    std::vector<char> afterCall = std::vector<char>(n);                       // depends on a call that may be gathered
    std::vector<Group> groups{};
    std::vector<std::uint32_t> groupOf = std::vector<std::uint32_t>(n, kNone);
    std::vector<std::uint32_t> ownerOf{}, userOf{};                            // see findOwners
    std::vector<std::uint32_t> within = std::vector<std::uint32_t>(n, kNone);  // group in whose loop it is computed
    std::map<ExprId, std::vector<ExprId>> resultsOf{};                         // of calls with several
    std::vector<ExprId> needed{};                                              // see neededBy
    Function fresh{};
    Builder b{module, fresh};
    Copy copy{from, b};

    bool run() {
        findCalls();
        findNeeds();
        dropUnworthy();
        if (groups.empty()) return false;
        std::vector<std::uint32_t> order;
        do {
            findOwners();
            findInner();
        } while (!sort(order));
        fresh.name = from.name;
        fresh.params = from.params;
        fresh.comment = from.comment;
        for (std::uint32_t unit : order) unit < n ? one(ExprId(unit)) : loop(groups[unit - n]);
        for (const ResultValue& r : from.results) b.addResult(r.name, copy[r.value]);
        return true;
    }

    void findCalls() {
        std::map<Name, std::uint32_t> byName;  // kNone for what is not worth a loop
        for (std::uint32_t i = 0; i < n; i++) {
            if (!live[i]) continue;
            ExprId e(i);
            for (ExprId o : from.operandsOf(e)) afterCall[i] |= afterCall[o.index];
            if (from[e].op == Op::Result && groupOf[from.operand(e, 0).index] != kNone)
                resultsOf[from.operand(e, 0)].push_back(e);
            if (from[e].op != Op::Call || loopOf[i] != kNoLoop) continue;
            auto [at, isNew] = byName.emplace(Name(from[e].payload), kNone);
            if (isNew && isWorthLoop(at->first)) {
                at->second = static_cast<std::uint32_t>(groups.size());
                groups.push_back({at->first, {}});
            }
            if (at->second == kNone) continue;
            groups[at->second].calls.push_back(e);
            groupOf[i] = at->second;
            afterCall[i] = true;
        }
    }

    bool isWorthLoop(Name name) const {
        const Function* callee = module.find(name);
        return callee && (holdsLoop(*callee) || workOf(module, *callee) >= kLongWork);
    }

    // From users to operands: a value is needed where one of its users is. Of several ways only what holds on all
    // counts.
    void findNeeds() {
        for (const ResultValue& r : from.results) needs[r.value.index] = 0;
        for (std::uint32_t i = static_cast<std::uint32_t>(n); i-- > 0;) {
            if (!live[i]) continue;
            auto operands = from.operandsOf(ExprId(i));
            bool isChoice =
                from.exprs[i].op == Op::Select && !afterCall[operands[0].index] && loopOf[operands[0].index] == kNoLoop;
            for (std::size_t k = 0; k < operands.size(); k++) {
                const std::uint32_t here = isChoice && k > 0 ? facts.with(needs[i], {operands[0], k == 1}) : needs[i];
                std::uint32_t& need = needs[operands[k].index];
                need = need == kNone ? here : facts.common(need, here);
            }
        }
    }

    // What certainly holds where a value that is needed is.
    const std::vector<Literal>& known(ExprId e) const { return facts[needs[e.index]]; }

    void dropUnworthy() {
        std::size_t left = 0;
        for (Group& g : groups) {
            bool isAlways = std::all_of(g.calls.begin(), g.calls.end(), [&](ExprId c) { return known(c).empty(); });
            g.isApart = isAlways || (g.calls.size() == 1 && !holdsLoop(*module.find(g.callee)));
            left += !g.isApart;
        }
        if (left == 0) groups.clear();
    }

    // Which group's calls alone use a value, and which call of it alone.
    void findOwners() {
        ownerOf.assign(n, kNone);
        userOf.assign(n, kNone);
        for (const ResultValue& r : from.results) ownerOf[r.value.index] = userOf[r.value.index] = kShared;
        auto add = [](std::uint32_t& of, std::uint32_t one) { of = of == kNone || of == one ? one : kShared; };
        for (std::uint32_t i = static_cast<std::uint32_t>(n); i-- > 0;) {
            if (!live[i]) continue;
            const bool isCall = loopFor(ExprId(i)) != kNone;
            for (ExprId o : from.operandsOf(ExprId(i))) {
                add(ownerOf[o.index], isCall ? groupOf[i] : ownerOf[i]);
                add(userOf[o.index], isCall ? i : userOf[i]);
            }
        }
    }

    // Groups each of whose calls serves one call of another group: that group's loop makes them, and what comes of
    // them.
    void findInner() {
        within.assign(n, kNone);
        for (Group& g : groups) {
            g.within = kNone;
            g.isAlways = false;
        }
        for (Group& g : groups) {
            const std::uint32_t outer = ownerOf[g.calls[0].index];
            if (g.isApart || outer >= groups.size() || groups[outer].within != kNone || !servesOneEach(g, outer))
                continue;
            g.within = outer;
            g.isAlways = skipsItself(*module.find(g.callee));
            for (ExprId c : g.calls) within[c.index] = outer;
        }
        for (std::uint32_t i = 0; i < n; i++)
            if (live[i] && loopFor(ExprId(i)) == kNone)
                for (ExprId o : from.operandsOf(ExprId(i)))
                    if (within[o.index] != kNone) within[i] = within[o.index];
    }

    bool servesOneEach(const Group& g, std::uint32_t outer) const {
        std::vector<std::uint32_t> users;
        for (ExprId c : g.calls) {
            if (ownerOf[c.index] != outer || userOf[c.index] == kShared) return false;
            for (ExprId o : from.operandsOf(c))
                if (afterCall[o.index]) return false;
            users.push_back(userOf[c.index]);
        }
        std::sort(users.begin(), users.end());
        return std::adjacent_find(users.begin(), users.end()) == users.end();
    }

    // The group whose loop gives an expression, or none.
    std::uint32_t loopFor(ExprId e) const {
        std::uint32_t g = groupOf[e.index];
        return g == kNone || groups[g].isApart ? kNone : g;
    }

    // What gives an expression in the order: itself or, above those, a loop.
    std::uint32_t unitOf(ExprId e) const {
        const std::uint32_t g = within[e.index] != kNone ? within[e.index] : loopFor(e);
        return g == kNone ? e.index : static_cast<std::uint32_t>(n) + g;
    }

    // All that is needed, in an order in which a loop follows what any of its calls needs: expressions by their number,
    // groups above them. False where calls of a group need each other's results; the group is then left apart.
    bool sort(std::vector<std::uint32_t>& order) {
        enum : std::uint8_t { New, Open, Done };
        std::vector<std::uint8_t> state(n + groups.size(), New);
        std::vector<std::pair<std::uint32_t, bool>> stack;  // unit, and whether what it needs stands in the order
        auto push = [&](ExprId e) {
            std::uint32_t unit = unitOf(e);
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

    const std::vector<ExprId>& neededBy(std::uint32_t unit) {
        std::vector<ExprId>& all = needed;
        all.clear();
        auto add = [&](ExprId e) {
            for (ExprId o : from.operandsOf(e))
                if (unit < n || unitOf(o) != unit) all.push_back(o);
        };
        if (unit < n) {
            add(ExprId(unit));
            return all;
        }
        for (const Group& g : groups)
            if (&g == &groups[unit - n] || g.within == unit - n)
                for (ExprId call : g.calls) {
                    add(call);
                    for (const Literal& l : known(call)) all.push_back(l.condition);
                }
        for (std::uint32_t i = 0; i < n; i++)
            if (within[i] == unit - n) add(ExprId(i));
        return all;
    }

    void one(ExprId e) {
        if (copy[e]) return;  // the result of a loop
        auto o = from.operandsOf(e);
        if (from[e].op == Op::Select && isNull(o[2]) && vanishes(o[1], {o[0], true}))
            copy.set(e, copy[o[1]]);
        else if (afterCall[e.index])
            copy.one(e);
        else
            copy.raw(e);  // as simple as it was
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
            const auto& literals = known(call);
            return loopFor(call) != kNone && !groups[loopFor(call)].isAlways &&
                   std::binary_search(literals.begin(), literals.end(), literal);
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

    // The conditions of a call in one, but for some.
    ExprId conditionOf(ExprId call, const std::vector<Literal>& but = {}) {
        ExprId all = b.boolean(true);
        for (const Literal& l : known(call)) {
            if (std::binary_search(but.begin(), but.end(), l)) continue;
            ExprId c = copy[l.condition];
            if (Name hint = from.hints[l.condition.index])
                b.rename(c, name(fmt::format("has_{}", module.names->text(hint))));
            all = b.op(Op::And, {all, l.holds ? c : b.op(Op::Not, {c})});
        }
        return all;
    }

    Name name(std::string_view text) { return module.names->intern(text); }

    // The turns of a group's loop: which call is made, and whether it is a certain one, where that was asked.
    struct Turns {
        const Group& group;
        ExprId which;
        std::vector<ExprId> is = std::vector<ExprId>(group.calls.size());
    };

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
            ExprId last = b.loopCarried(number, 0, Type::Integer);
            b.hint(last, name("last"));
            which = following(conditions, last);
            first.push_back(b.integer(-1));
            next.push_back(which);
        }
        if (calls > 1) b.hint(which, name("which"));
        Turns turns{g, which};
        makeInner(turns);
        ExprId made = call(g.calls, {turns, groupOf[g.calls[0].index], {}, {}});
        for (std::size_t k = 0; k < calls; k++)
            for (ExprId result : resultsIn(g.calls[k])) {
                Type type = from[result].type;
                ExprId old = b.loopCarried(number, static_cast<std::uint32_t>(first.size()), type);
                ExprId now = from[result].op == Op::Result ? b.result(made, from[result].payload, type) : made;
                if (from.hints[result.index]) b.hint(old, from.hints[result.index]);
                first.push_back(b.null(type));
                next.push_back(calls > 1 ? b.select(isTurn(turns, k, k + 1), now, old) : now);
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

    // In a turn of a group's loop, what its call needs of other groups, and what comes of that.
    void makeInner(Turns& turns) {
        const std::uint32_t number = groupOf[turns.group.calls[0].index];
        for (const Group& g : groups)
            if (g.within == number && g.isAlways)
                everyTurn(turns, g);
            else if (g.within == number)
                innerLoop(turns, g);
        for (std::uint32_t i = 0; i < n; i++)
            if (within[i] == number && loopFor(ExprId(i)) == kNone) one(ExprId(i));
    }

    // The call of an inner group that serves a call of the outer one, or none.
    ExprId servantOf(const Group& g, ExprId outer) const {
        auto at =
            std::find_if(g.calls.begin(), g.calls.end(), [&](ExprId c) { return userOf[c.index] == outer.index; });
        return at == g.calls.end() ? ExprId() : *at;
    }

    // The call that an inner group makes in a turn of the loop around it; any where none is needed.
    ExprId innerCall(Turns& turns, const Group& g) {
        std::vector<ExprId> calls;  // by turn
        for (ExprId outer : turns.group.calls) {
            ExprId c = servantOf(g, outer);
            calls.push_back(c ? c : g.calls[0]);
        }
        return call(calls, {turns, groupOf[g.calls[0].index], {}, {}});
    }

    // Whether a turn needs a call of an inner group.
    ExprId isNeeded(Turns& turns, const Group& g) {
        ExprId some = b.boolean(false), any = some, condition;
        bool isOneCondition = true;
        for (std::size_t k = 0; k < turns.group.calls.size(); k++) {
            ExprId c = servantOf(g, turns.group.calls[k]);
            if (!c) continue;
            ExprId now = conditionOf(c, known(turns.group.calls[k]));
            ExprId is = isTurn(turns, k, k + 1);
            isOneCondition = isOneCondition && (!condition || condition == now);
            condition = now;
            some = b.op(Op::Or, {some, is});
            any = b.op(Op::Or, {any, b.op(Op::And, {is, now})});
        }
        return isOneCondition ? b.op(Op::And, {condition, some}) : any;
    }

    void everyTurn(Turns& turns, const Group& g) {
        ExprId made = innerCall(turns, g);
        for (ExprId c : g.calls) {
            copy.set(c, made);
            for (ExprId result : resultsIn(c))
                if (from[result].op == Op::Result)
                    copy.set(result, b.result(made, from[result].payload, from[result].type));
            for (ExprId result : resultsIn(c))
                if (from.hints[result.index]) b.hint(copy[result], from.hints[result.index]);
        }
    }

    // A loop of at most one turn, of which the call stays 0 unless the turn around it needs one.
    void innerLoop(Turns& turns, const Group& g) {
        ExprId count = b.convert(isNeeded(turns, g), Type::Integer);
        std::uint32_t number = b.beginLoop();
        ExprId made = innerCall(turns, g);
        std::map<std::uint32_t, std::uint32_t> slots;  // by result
        std::vector<ExprId> first, next;
        for (ExprId c : g.calls)
            for (ExprId result : resultsIn(c)) {
                const bool isPart = from[result].op == Op::Result;
                const std::uint32_t k = isPart ? from[result].payload : 0;
                if (!slots.emplace(k, static_cast<std::uint32_t>(first.size())).second) continue;
                const Type type = from[result].type;
                ExprId old = b.loopCarried(number, static_cast<std::uint32_t>(first.size()), type);
                if (from.hints[result.index]) b.hint(old, from.hints[result.index]);
                first.push_back(b.null(type));
                next.push_back(isPart ? b.result(made, k, type) : made);
            }
        ExprId whole = b.endLoop(number, count, first, next);
        for (ExprId c : g.calls) {
            for (ExprId result : resultsIn(c)) {
                const std::uint32_t k = from[result].op == Op::Result ? from[result].payload : 0;
                copy.set(result, b.result(whole, slots[k], from[result].type));
                if (from.hints[result.index]) b.hint(copy[result], from.hints[result.index]);
            }
            if (!copy[c]) copy.set(c, whole);
        }
    }

    // What is read of a call: its results, or its one result.
    std::vector<ExprId> resultsIn(ExprId call) const {
        return from[call].type == Type::Tuple ? resultsOf.at(call) : std::vector{call};
    }

    // The first call to make after call number `which`, -1 before all.
    ExprId following(const std::vector<ExprId>& conditions, ExprId which) {
        std::size_t last = conditions.size() - 1;
        ExprId found = b.integer(static_cast<int>(last));
        for (std::size_t k = last; k-- > 0;) {
            ExprId isAfter = b.op(Op::Less, {which, b.integer(static_cast<int>(k))});
            found = b.select(b.op(Op::And, {isAfter, conditions[k]}), b.integer(static_cast<int>(k)), found);
        }
        return found;
    }

    // What the conditions of a call are called after, if anything.
    Name nameOf(ExprId call) const {
        for (const Literal& l : known(call))
            if (Name hint = from.hints[l.condition.index]) return hint;
        return {};
    }

    // Whether this turn makes one of the calls from `begin` up to `end`.
    ExprId isTurn(Turns& turns, std::size_t begin, std::size_t end) {
        const Group& g = turns.group;
        const ExprId which = turns.which;
        if (end == begin + 1) {
            ExprId& is = turns.is[begin];
            if (is) return is;
            is = b.op(Op::Equal, {which, b.integer(static_cast<int>(begin))});
            if (Name hint = nameOf(g.calls[begin])) b.hint(is, name(fmt::format("is_{}", module.names->text(hint))));
            return is;
        }
        ExprId from0 = b.op(Op::LessEqual, {b.integer(static_cast<int>(begin)), which});
        ExprId below = b.op(Op::Less, {which, b.integer(static_cast<int>(end))});
        return begin == 0 ? below : end == g.calls.size() ? from0 : b.op(Op::And, {from0, below});
    }

    // Of the values that the calls of a group take for something, the one for this turn.
    struct Turn {
        Turns& of;
        std::uint32_t group;  // that is called
        std::map<std::vector<ExprId>, int> gains;
        std::map<std::vector<ExprId>, ExprId> made;
    };

    // The call of a turn, one of `calls`.
    ExprId call(const std::vector<ExprId>& calls, Turn turn) {
        const Expr& e = from[calls[0]];
        const Name callee(e.payload);
        std::vector<ExprId> arguments;
        for (std::size_t p = 0; p < e.operandCount; p++) {
            std::vector<ExprId> given;
            for (ExprId c : calls) given.push_back(from.operand(c, p));
            ExprId value = merged(turn, given, 0);
            if (!isSame(given)) b.hint(value, module.find(callee)->params[p].name);
            arguments.push_back(value);
        }
        return b.call(callee, e.type, arguments);
    }

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
            // What a gathered call gives is a result of its loop, and that is one operation no more.
            if (e.op == Op::Result && groupOf[from.operand(x, 0).index] != kNone) return false;
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
    ExprId chosen(Turn& turn, const std::vector<ExprId>& all) {
        std::vector<ExprId> given;
        for (ExprId x : all) given.push_back(copy[x]);
        auto times = [&](ExprId x) { return std::count(given.begin(), given.end(), x); };
        ExprId value =
            *std::max_element(given.begin(), given.end(), [&](ExprId x, ExprId y) { return times(x) < times(y); });
        const ExprId usual = value;
        for (std::size_t end = given.size(); end > 0;) {
            std::size_t begin = end - 1;
            while (begin > 0 && given[begin - 1] == given[end - 1]) begin--;
            if (given[begin] != usual) value = b.select(isTurn(turn.of, begin, end), given[begin], value);
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
