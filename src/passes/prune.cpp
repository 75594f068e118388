#include "passes/prune.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/diagnostics.h"
#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

// A call and the number of the function that it calls.
struct Call {
    std::uint32_t expr, callee;
};

// A function and what is needed of it: truths.
struct Use {
    Function* function;
    std::vector<char> results, params{};
    std::vector<char> live{};  // expressions
    std::vector<Call> calls{};
    bool isEntry = false;
    bool isStale = true;      // other results are needed than when it was marked
    bool readsLess = false;   // fewer parameters than its callers knew
    bool isNarrowed = false;  // results or parameters go
    Name alias{};             // an earlier function that is the same
};

struct Pruner {
    Module& module;
    std::vector<Use> uses{};
    std::unordered_map<Name, std::uint32_t> numbers{};
    std::vector<std::uint32_t> order{};   // callees first
    std::vector<std::uint32_t> callOf{};  // of the function under way: by expression the callee's number
    std::vector<ExprId> instead{};        // of results of calls that have one left: the call

    // Numbers the functions that the entries lead to, and their calls.
    void find(std::span<const Name> entries) {
        for (Name e : entries) numberOf(e);
        for (std::uint32_t n = 0; n < uses.size(); n++) {
            const Function& f = *uses[n].function;
            std::vector<Call> calls;
            for (std::uint32_t i = 0; i < f.exprs.size(); i++)
                if (f.exprs[i].op == Op::Call) calls.push_back({i, numberOf(Name(f.exprs[i].payload))});
            uses[n].calls = std::move(calls);
        }
    }

    std::uint32_t numberOf(Name name) {
        const auto [known, isNew] = numbers.try_emplace(name, static_cast<std::uint32_t>(uses.size()));
        if (!isNew) return known->second;
        Function* f = module.findOwn(name);
        ensure(f, "a call of a function that is not the module's own");
        uses.push_back({f, std::vector<char>(f->results.size(), false)});
        return known->second;
    }

    // Callees first, each once, those that live calls lead to; the call graph has no cycles. All calls are live where
    // nothing was marked.
    void sort(std::span<const Name> entries) {
        order.clear();
        std::vector<char> isKnown(uses.size());
        std::vector<std::pair<std::uint32_t, std::size_t>> stack;  // and the call to look at next
        auto push = [&](std::uint32_t number) {
            if (!isKnown[number]) stack.push_back({number, 0});
            isKnown[number] = true;
        };
        for (Name e : entries) {
            push(numbers[e]);
            while (!stack.empty()) {
                auto& [number, next] = stack.back();
                const Use& use = uses[number];
                while (next < use.calls.size() && !use.live.empty() && !use.live[use.calls[next].expr]) next++;
                if (next < use.calls.size()) {
                    push(use.calls[next++].callee);
                } else {
                    order.push_back(number);
                    stack.pop_back();
                }
            }
        }
    }

    // What the needed results of a function need. In round 0, before the callees' parameters are known, every argument
    // counts as read, and the callees learn which of their results are. In later ones callees come first.
    void mark(Use& use, int round) {
        const bool first = round == 0;
        auto changed = [&](const Call& c) { return uses[c.callee].readsLess; };
        if (!use.isStale && std::none_of(use.calls.begin(), use.calls.end(), changed)) {
            use.readsLess = round == 1 && hasFalse(use.params);
            return;
        }
        const Function& f = *use.function;
        use.isStale = false;
        const std::vector<char> before = round > 1 ? use.params : std::vector<char>();
        use.live.assign(f.exprs.size(), false);
        use.params.assign(f.params.size(), false);
        for (std::size_t i = 0; i < f.results.size(); i++)
            if (use.results[i]) use.live[f.results[i].value.index] = true;
        char* live = use.live.data();
        std::size_t call = use.calls.size();  // the calls before the expression under way
        for (std::size_t i = f.exprs.size(); i-- > 0;) {
            const Expr& e = f.exprs[i];
            if (e.op == Op::Call) call--;
            if (!live[i]) continue;
            if (e.op == Op::Call && !first) {
                const std::vector<char>& read = uses[use.calls[call].callee].params;
                for (std::size_t k = 0; k < e.operandCount; k++)
                    if (read[k]) live[f.operands[e.firstOperand + k].index] = true;
                continue;
            }
            const ExprId* operands = f.operands.data() + e.firstOperand;
            for (std::size_t k = 0; k < e.operandCount; k++) live[operands[k].index] = true;
            if (e.op == Op::Param) use.params[e.payload] = true;
        }
        use.readsLess = round == 1 ? hasFalse(use.params) : round > 1 && use.params != before;
        if (first) read(use, [&](std::uint32_t callee, std::uint32_t k) { uses[callee].results[k] = true; });
    }

    // Calls visit(callee, k) for each result of a call that a live expression reads.
    template <class F>
    void read(const Use& use, F&& visit) {
        if (use.calls.empty()) return;
        const Function& f = *use.function;
        callOf.resize(std::max(callOf.size(), f.exprs.size()));
        for (const Call& c : use.calls) callOf[c.expr] = c.callee;
        for (std::size_t i = use.calls[0].expr; i < f.exprs.size(); i++) {
            const Expr& e = f.exprs[i];
            if (!use.live[i]) continue;
            if (e.op == Op::Call && e.type != Type::Tuple) visit(callOf[i], 0);
            if (e.op != Op::Result) continue;
            const ExprId of = f.operands[e.firstOperand];
            if (f[of].op == Op::Call) visit(callOf[of.index], e.payload);
        }
    }

    // Forgets results that only dead expressions read, now that parameters nobody reads are known; true if there are
    // any.
    bool forget() {
        std::vector<std::vector<char>> needed(uses.size());
        for (std::size_t n = 0; n < uses.size(); n++) needed[n].assign(uses[n].results.size(), uses[n].isEntry);
        for (std::size_t i = order.size(); i-- > 0;) {
            const std::vector<char>& own = needed[order[i]];
            if (std::find(own.begin(), own.end(), true) == own.end()) continue;
            read(uses[order[i]], [&](std::uint32_t callee, std::uint32_t k) { needed[callee][k] = true; });
        }
        bool less = false;
        for (std::size_t n = 0; n < uses.size(); n++) {
            if (needed[n] == uses[n].results) continue;
            less = uses[n].isStale = true;
            uses[n].results = std::move(needed[n]);
        }
        return less;
    }

    // Whether anything of the function goes, or of the interface of those that it calls.
    bool isChanged(Use& use) const {
        use.isNarrowed = hasFalse(use.results) || (!use.isEntry && hasFalse(use.params));
        if (use.isNarrowed || hasFalse(use.live)) return true;
        return std::any_of(use.calls.begin(), use.calls.end(),
                           [&](const Call& c) { return uses[c.callee].isNarrowed || uses[c.callee].alias; });
    }
    static bool hasFalse(const std::vector<char>& v) { return std::find(v.begin(), v.end(), false) != v.end(); }

    // Takes what goes out of a function, in place: what is left is as simple as it was.
    void narrow(Use& use) {
        if (!isChanged(use)) return;
        Function& f = *use.function;
        std::vector<std::uint32_t> param(f.params.size());
        std::uint32_t params = 0;
        for (std::size_t i = 0; i < f.params.size(); i++) {
            if (!use.isEntry && !use.params[i]) continue;
            param[i] = params;
            f.params[params++] = f.params[i];
        }
        f.params.resize(params);
        std::size_t results = 0;
        for (std::size_t i = 0; i < f.results.size(); i++)
            if (use.results[i]) f.results[results++] = f.results[i];
        f.results.resize(results);
        instead.assign(f.exprs.size(), ExprId());
        callOf.resize(std::max(callOf.size(), f.exprs.size()));
        for (const Call& c : use.calls) callOf[c.expr] = c.callee;
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            Expr& e = f.exprs[i];
            if (!use.live[i]) continue;
            for (std::uint32_t k = e.firstOperand; k < e.firstOperand + e.operandCount; k++)
                if (ExprId other = instead[f.operands[k].index]) f.operands[k] = other;
            if (e.op == Op::Param)
                e.payload = param[e.payload];
            else if (e.op == Op::Call)
                call(f, e, uses[callOf[i]]);
            else if (e.op == Op::Result && f[f.operand(ExprId(i), 0)].op == Op::Call)
                result(f, ExprId(i));
        }
        for (ResultValue& r : f.results)
            if (instead[r.value.index]) r.value = instead[r.value.index];
        for (const Call& c : use.calls)
            if (Name other = uses[c.callee].alias) f.exprs[c.expr].payload = other.index;
        compact(f);
        if (use.calls.size() > 1 && callsTwice(f)) unify(f);
    }

    // The callee is narrowed already, so its results and parameters are those that are left.
    static void call(Function& f, Expr& e, const Use& callee) {
        std::uint16_t kept = 0;
        for (std::uint32_t k = 0; k < e.operandCount; k++)
            if (callee.params[k]) f.operands[e.firstOperand + kept++] = f.operands[e.firstOperand + k];
        e.operandCount = kept;
        const std::vector<ResultValue>& results = callee.function->results;
        e.type = results.size() == 1 ? results[0].type : Type::Tuple;
    }

    void result(Function& f, ExprId id) {
        const ExprId of = f.operand(id, 0);
        Expr& e = f.exprs[id.index];
        if (f[of].type != Type::Tuple) {
            instead[id.index] = of;
            if (!f.hints[of.index]) f.hints[of.index] = f.hints[id.index];
            return;
        }
        const Use& use = uses[callOf[of.index]];
        std::uint32_t k = 0;
        for (std::uint32_t i = 0; i < e.payload; i++) k += use.results[i];
        e.payload = k;
    }

    static bool sameOperands(const Function& f, const Expr& a, const Expr& b) {
        auto x = f.operandsOf(a), y = f.operandsOf(b);
        return std::equal(x.begin(), x.end(), y.begin(), y.end());
    }

    // Calls that differed in what went may be one now.
    static bool callsTwice(const Function& f) {
        std::vector<ExprId> calls;
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            const Expr& e = f.exprs[i];
            if (e.op != Op::Call) continue;
            for (ExprId c : calls)
                if (f[c].payload == e.payload && sameOperands(f, f[c], e)) return true;
            calls.push_back(ExprId(i));
        }
        return false;
    }

    // What is left of two functions may be the same; then the later is an alias of the earlier.
    bool mergedWithEarlier(Use& use, const std::vector<Name>& earlier) {
        for (Name name : earlier)
            if (equal(*uses[numbers[name]].function, *use.function)) {
                use.alias = name;
                return true;
            }
        return false;
    }

    static bool equal(const Function& a, const Function& b) {
        auto sameTypes = [](const auto& x, const auto& y) {
            return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                              [](const auto& p, const auto& q) { return p.type == q.type; });
        };
        auto sameExpr = [](const Expr& x, const Expr& y) {
            return x.op == y.op && x.type == y.type && x.operandCount == y.operandCount &&
                   x.firstOperand == y.firstOperand && x.payload == y.payload;
        };
        if (!sameTypes(a.params, b.params) || !sameTypes(a.results, b.results)) return false;
        for (std::size_t i = 0; i < a.results.size(); i++)
            if (a.results[i].value != b.results[i].value) return false;
        return a.operands == b.operands && a.words == b.words &&
               std::equal(a.exprs.begin(), a.exprs.end(), b.exprs.begin(), b.exprs.end(), sameExpr);
    }
};

}  // namespace

void prune(Module& module, std::span<const Name> entries) {
    Pruner p{module};
    p.find(entries);
    p.sort(entries);
    for (Name e : entries) {
        Use& use = p.uses[p.numbers[e]];
        use.isEntry = true;
        use.results.assign(use.results.size(), true);
    }
    for (std::size_t i = p.order.size(); i-- > 0;) p.mark(p.uses[p.order[i]], 0);
    int round = 1;
    do {
        for (std::uint32_t n : p.order) p.mark(p.uses[n], round);
        round++;
    } while (p.forget());
    p.sort(entries);
    std::vector<Name> names;
    for (std::uint32_t n : p.order) {
        Use& use = p.uses[n];
        p.narrow(use);
        if (use.isEntry || !p.mergedWithEarlier(use, names)) names.push_back(use.function->name);
    }
    module.keepOnly(names);
}

}  // namespace shaderx::passes
