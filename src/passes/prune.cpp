#include "passes/prune.h"

#include <algorithm>
#include <unordered_map>

#include "base/diagnostics.h"
#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

// What is needed of a function: truths.
struct Use {
    std::vector<char> results, params;
    std::vector<char> live;            // expressions
    std::vector<std::uint32_t> calls;  // expressions
    bool isStale = true;               // other results are needed than when it was marked
    bool isNarrowed = false;           // results or parameters go
};

struct Pruner {
    Module& module;
    std::unordered_map<Name, Use> uses{};
    std::vector<Function*> order{};  // callees first
    std::unordered_map<Name, Name> alias{};
    std::vector<ExprId> instead{};  // of results of calls that have one left: the call

    // Callees first, each once; the call graph has no cycles.
    void sort(Name entry) {
        std::vector<std::pair<Function*, std::size_t>> stack;
        auto push = [&](Name name) {
            Function* f = module.findOwn(name);
            ensure(f, "a call of a function that is not the module's own");
            if (uses.count(name)) return;
            uses[name].results.assign(f->results.size(), false);
            stack.push_back({f, 0});
        };
        push(entry);
        while (!stack.empty()) {
            Function* f = stack.back().first;
            std::size_t i = stack.back().second;
            while (i < f->exprs.size() && f->exprs[i].op != Op::Call) i++;
            stack.back().second = i + 1;
            if (i == f->exprs.size()) {
                order.push_back(f);
                stack.pop_back();
            } else {
                uses[f->name].calls.push_back(static_cast<std::uint32_t>(i));
                push(Name(f->exprs[i].payload));
            }
        }
    }

    // What the needed results of a function need. Before the callees' parameters are known (`first`), every argument
    // counts as read, and the callees learn which of their results are.
    void mark(Function& f, bool first) {
        Use& use = uses[f.name];
        if (!use.isStale && use.calls.empty()) return;
        use.isStale = false;
        use.live.assign(f.exprs.size(), false);
        use.params.assign(f.params.size(), false);
        for (std::size_t i = 0; i < f.results.size(); i++)
            if (use.results[i]) use.live[f.results[i].value.index] = true;
        for (std::size_t i = f.exprs.size(); i-- > 0;) {
            if (!use.live[i]) continue;
            const Expr& e = f.exprs[i];
            auto operands = f.operandsOf(e);
            if (e.op == Op::Call && !first) {
                const std::vector<char>& read = uses[Name(e.payload)].params;
                for (std::size_t k = 0; k < operands.size(); k++)
                    if (read[k]) use.live[operands[k].index] = true;
                continue;
            }
            for (ExprId o : operands) use.live[o.index] = true;
            if (e.op == Op::Param) use.params[e.payload] = true;
            if (first && e.op == Op::Call && e.type != Type::Tuple) uses[Name(e.payload)].results[0] = true;
            if (first && e.op == Op::Result) {
                const Expr& source = f[operands[0]];
                if (source.op == Op::Call) uses[Name(source.payload)].results[e.payload] = true;
            }
        }
    }

    // Forgets results that only dead expressions read, now that parameters nobody reads are known; true if there are
    // any.
    bool forget(std::span<const Name> entries) {
        std::unordered_map<Name, std::vector<char>> read;
        for (Function* f : order) read[f->name].assign(f->results.size(), false);
        for (Name e : entries) read[e] = uses[e].results;
        for (std::size_t i = order.size(); i-- > 0;) {
            const Function& f = *order[i];
            const std::vector<char>& needed = read[f.name];
            if (std::find(needed.begin(), needed.end(), true) == needed.end()) continue;
            const Use& use = uses[f.name];
            if (use.calls.empty()) continue;
            const std::vector<char>& live = use.live;
            for (std::size_t k = use.calls[0]; k < f.exprs.size(); k++) {
                const Expr& e = f.exprs[k];
                if (!live[k]) continue;
                if (e.op == Op::Call && e.type != Type::Tuple) read[Name(e.payload)][0] = true;
                if (e.op == Op::Result && f[f.operandsOf(e)[0]].op == Op::Call)
                    read[Name(f[f.operandsOf(e)[0]].payload)][e.payload] = true;
            }
        }
        bool less = false;
        for (Function* f : order) {
            Use& use = uses[f->name];
            std::vector<char>& now = read[f->name];
            if (now == use.results) continue;
            less = use.isStale = true;
            use.results = std::move(now);
        }
        return less;
    }

    // Whether anything of the function goes, or of the interface of those that it calls.
    bool isChanged(const Function& f, bool isEntry) {
        Use& use = uses[f.name];
        use.isNarrowed = hasFalse(use.results) || (!isEntry && hasFalse(use.params));
        if (use.isNarrowed || hasFalse(use.live)) return true;
        return std::any_of(use.calls.begin(), use.calls.end(), [&](std::uint32_t c) {
            const Name callee(f.exprs[c].payload);
            return uses[callee].isNarrowed || alias.count(callee);
        });
    }
    static bool hasFalse(const std::vector<char>& v) { return std::find(v.begin(), v.end(), false) != v.end(); }

    // Takes what goes out of a function, in place: what is left is as simple as it was.
    void narrow(Function& f, bool isEntry) {
        if (!isChanged(f, isEntry)) return;
        const Use& use = uses[f.name];
        std::vector<std::uint32_t> param(f.params.size());
        std::uint32_t params = 0;
        for (std::size_t i = 0; i < f.params.size(); i++) {
            if (!isEntry && !use.params[i]) continue;
            param[i] = params;
            f.params[params++] = f.params[i];
        }
        f.params.resize(params);
        std::size_t results = 0;
        for (std::size_t i = 0; i < f.results.size(); i++)
            if (use.results[i]) f.results[results++] = f.results[i];
        f.results.resize(results);
        instead.assign(f.exprs.size(), ExprId());
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            Expr& e = f.exprs[i];
            if (!use.live[i]) continue;
            for (std::uint32_t k = e.firstOperand; k < e.firstOperand + e.operandCount; k++)
                if (ExprId other = instead[f.operands[k].index]) f.operands[k] = other;
            if (e.op == Op::Param)
                e.payload = param[e.payload];
            else if (e.op == Op::Call)
                call(f, e);
            else if (e.op == Op::Result && f[f.operand(ExprId(i), 0)].op == Op::Call)
                result(f, ExprId(i));
        }
        for (ResultValue& r : f.results)
            if (instead[r.value.index]) r.value = instead[r.value.index];
        for (std::uint32_t c : use.calls)
            if (auto merged = alias.find(Name(f.exprs[c].payload)); merged != alias.end())
                f.exprs[c].payload = merged->second.index;
        compact(f);
        if (use.calls.size() > 1 && callsTwice(f)) unify(module, f);
    }

    // The callee is narrowed already, so its results and parameters are those that are left.
    void call(Function& f, Expr& e) {
        const Name name(e.payload);
        const Use& use = uses[name];
        const Function& callee = *module.findOwn(name);
        std::uint16_t kept = 0;
        for (std::uint32_t k = 0; k < e.operandCount; k++)
            if (use.params[k]) f.operands[e.firstOperand + kept++] = f.operands[e.firstOperand + k];
        e.operandCount = kept;
        e.type = callee.results.size() == 1 ? callee.results[0].type : Type::Tuple;
    }

    void result(Function& f, ExprId id) {
        const ExprId of = f.operand(id, 0);
        Expr& e = f.exprs[id.index];
        if (f[of].type != Type::Tuple) {
            instead[id.index] = of;
            if (!f.hints[of.index]) f.hints[of.index] = f.hints[id.index];
            return;
        }
        const Use& use = uses[Name(f[of].payload)];
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
    bool mergedWithEarlier(const Function& f, const std::vector<Name>& earlier) {
        for (Name name : earlier)
            if (equal(*module.findOwn(name), f)) {
                alias[f.name] = name;
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
    for (Name e : entries) p.sort(e);
    for (Name e : entries) p.uses[e].results.assign(module.findOwn(e)->results.size(), true);
    for (std::size_t i = p.order.size(); i-- > 0;) p.mark(*p.order[i], true);
    do
        for (Function* f : p.order) p.mark(*f, false);
    while (p.forget(entries));
    auto isEntry = [&](Name n) {
        for (Name e : entries)
            if (e == n) return true;
        return false;
    };
    std::vector<Name> names;
    for (Function* f : p.order) {
        const std::vector<char>& used = p.uses[f->name].results;
        if (std::find(used.begin(), used.end(), true) == used.end()) continue;  // only dead calls led to it
        p.narrow(*f, isEntry(f->name));
        if (isEntry(f->name) || !p.mergedWithEarlier(*f, names)) names.push_back(f->name);
    }
    module.keepOnly(names);
}

}  // namespace shaderx::passes
