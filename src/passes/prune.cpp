#include "passes/prune.h"

#include <algorithm>
#include <unordered_map>

#include "base/diagnostics.h"
#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

// What is needed of a function.
struct Use {
    std::vector<bool> results, params;
    std::vector<bool> live;  // expressions
    bool isChanged = false;
};

struct Pruner {
    Module& module;
    std::unordered_map<Name, Use> uses{};
    std::vector<Function*> order{};  // callees first
    std::unordered_map<Name, Name> alias{};

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
            std::size_t i = stack.back().second++;
            if (i == f->exprs.size()) {
                order.push_back(f);
                stack.pop_back();
            } else if (f->exprs[i].op == Op::Call) {
                push(Name(f->exprs[i].payload));
            }
        }
    }

    // What the needed results of a function need. Before the callees' parameters are known (`first`), every argument
    // counts as read, and the callees learn which of their results are.
    void mark(Function& f, bool first) {
        Use& use = uses[f.name];
        use.live.assign(f.exprs.size(), false);
        use.params.assign(f.params.size(), false);
        for (std::size_t i = 0; i < f.results.size(); i++)
            if (use.results[i]) use.live[f.results[i].value.index] = true;
        for (std::size_t i = f.exprs.size(); i-- > 0;) {
            if (!use.live[i]) continue;
            const Expr& e = f.exprs[i];
            auto operands = f.operandsOf(e);
            bool selective = !first && e.op == Op::Call;
            for (std::size_t k = 0; k < operands.size(); k++)
                if (!selective || uses[Name(e.payload)].params[k]) use.live[operands[k].index] = true;
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
    bool narrow(std::span<const Name> entries) {
        std::unordered_map<Name, std::vector<bool>> read;
        for (Function* f : order) read[f->name].assign(f->results.size(), false);
        for (Name e : entries) read[e] = uses[e].results;
        for (std::size_t i = order.size(); i-- > 0;) {
            const Function& f = *order[i];
            const std::vector<bool>& needed = read[f.name];
            if (std::find(needed.begin(), needed.end(), true) == needed.end()) continue;
            for (std::size_t k = 0; k < f.exprs.size(); k++) {
                const Expr& e = f.exprs[k];
                if (!uses[f.name].live[k]) continue;
                if (e.op == Op::Call && e.type != Type::Tuple) read[Name(e.payload)][0] = true;
                if (e.op == Op::Result && f[f.operandsOf(e)[0]].op == Op::Call)
                    read[Name(f[f.operandsOf(e)[0]].payload)][e.payload] = true;
            }
        }
        bool less = false;
        for (Function* f : order) {
            less = less || read[f->name] != uses[f->name].results;
            uses[f->name].results = std::move(read[f->name]);
        }
        return less;
    }

    // Whether anything of the function goes, or of those that it calls.
    bool isChanged(const Function& f, bool isEntry) {
        const Use& use = uses[f.name];
        auto any = [](const std::vector<bool>& v) { return std::find(v.begin(), v.end(), false) != v.end(); };
        if (any(use.live) || any(use.results) || (!isEntry && any(use.params))) return true;
        for (const Expr& e : f.exprs)
            if (e.op == Op::Call && (uses[Name(e.payload)].isChanged || alias.count(Name(e.payload)))) return true;
        return false;
    }

    void rebuild(Function& f, bool isEntry) {
        Use& use = uses[f.name];
        if (!isChanged(f, isEntry)) return;
        use.isChanged = true;
        Function fresh;
        fresh.name = f.name;
        fresh.comment = f.comment;
        fresh.isInline = f.isInline;
        std::vector<std::uint32_t> param(f.params.size());
        for (std::size_t i = 0; i < f.params.size(); i++)
            if (isEntry || use.params[i]) {
                param[i] = static_cast<std::uint32_t>(fresh.params.size());
                fresh.params.push_back(f.params[i]);
            }
        Builder b(module, fresh);
        b.reserve(f.exprs.size());
        Copy copy(f, b);
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            if (!use.live[i]) continue;
            ExprId id(i);
            const Expr& e = f.exprs[i];
            if (e.op == Op::Param)
                copy.set(id, b.param(param[e.payload]));
            else if (e.op == Op::Call)
                call(b, f, id, copy);
            else if (e.op == Op::Result && f[f.operand(id, 0)].op == Op::Call)
                result(b, f, id, copy);
            else
                copy.one(id);
        }
        for (std::size_t i = 0; i < f.results.size(); i++)
            if (use.results[i]) b.addResult(f.results[i].name, copy[f.results[i].value]);
        f = std::move(fresh);
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

    // The callee is rebuilt already, so its results and parameters are those that are left.
    void call(Builder& b, const Function& f, ExprId id, Copy& copy) {
        Name name(f[id].payload);
        const Use& use = uses[name];
        const Function& callee = *module.findOwn(name);
        std::vector<ExprId> arguments;
        std::span<const ExprId> all = f.operandsOf(id);
        for (std::size_t i = 0; i < all.size(); i++)
            if (use.params[i]) arguments.push_back(copy[all[i]]);
        Type type = callee.results.size() == 1 ? callee.results[0].type : Type::Tuple;
        auto merged = alias.find(name);
        copy.set(id, b.call(merged == alias.end() ? name : merged->second, type, arguments));
        if (f.hints[id.index]) b.hint(copy[id], f.hints[id.index]);
    }

    void result(Builder& b, const Function& f, ExprId id, Copy& copy) {
        ExprId made = copy[f.operand(id, 0)];
        const Use& use = uses[Name(f[f.operand(id, 0)].payload)];
        std::uint32_t k = 0;
        for (std::uint32_t i = 0; i < f[id].payload; i++) k += use.results[i];
        if (b.type(made) == Type::Tuple) made = b.result(made, k, f[id].type);
        copy.set(id, made);
        if (f.hints[id.index]) b.hint(made, f.hints[id.index]);
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
    while (p.narrow(entries));
    auto isEntry = [&](Name n) {
        for (Name e : entries)
            if (e == n) return true;
        return false;
    };
    std::vector<Name> names;
    for (Function* f : p.order) {
        const std::vector<bool>& used = p.uses[f->name].results;
        if (std::find(used.begin(), used.end(), true) == used.end()) continue;  // only dead calls led to it
        p.rebuild(*f, isEntry(f->name));
        if (isEntry(f->name) || !p.mergedWithEarlier(*f, names)) names.push_back(f->name);
    }
    module.keepOnly(names);
}

}  // namespace shaderx::passes
