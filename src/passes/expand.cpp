#include "passes/expand.h"

#include <algorithm>
#include <functional>
#include <unordered_map>
#include <unordered_set>

#include "base/diagnostics.h"
#include "passes/copy.h"
#include "passes/gather.h"

namespace shaderx::passes {

using namespace ir;

namespace {

constexpr int kMaxDepth = 64;       // of calls in calls
constexpr std::size_t kShort = 24;  // operations up to which a function that is called once is short

// The results of an expanded call, and how many expressions there were before it.
struct Expanded {
    std::uint32_t before = 0;
    std::vector<ExprId> results;
};

struct Expander {
    Module& module;
    std::function<bool(const Function&)> isWanted;
    std::unordered_map<Name, const Function*> wanted{};  // by callee, null for what stays a call
    int depth = 0;

    // The function to expand a call of, or none.
    const Function* wantedOf(const Expr& e) {
        if (e.op != Op::Call) return nullptr;
        auto [at, isNew] = wanted.try_emplace(Name(e.payload), nullptr);
        if (!isNew) return at->second;
        const Function* callee = module.find(at->first);
        return at->second = callee && isWanted(*callee) ? callee : nullptr;
    }

    // The function anew, with every call of a wanted function expanded.
    void rewrite(Name name) {
        const Function* old = module.findOwn(name);
        ensure(old, "no function to expand in");
        auto expands = [&](const Expr& e) { return wantedOf(e) != nullptr; };
        if (std::none_of(old->exprs.begin(), old->exprs.end(), expands)) return;
        Function fresh = headOf(*old);
        Builder b(module, fresh);
        b.reserve(old->exprs.size());
        std::vector<ExprId> arguments;
        for (std::uint32_t i = 0; i < fresh.params.size(); i++) arguments.push_back(b.param(i));
        std::vector<ExprId> results = expand(*old, b, arguments);
        for (std::size_t i = 0; i < results.size(); i++) b.addResult(old->results[i].name, results[i]);
        compact(fresh);
        module.put(std::move(fresh));
    }

    // Copies a function's expressions to where `b` builds, with arguments for parameters; the results.
    std::vector<ExprId> expand(const Function& from, Builder& b, std::span<const ExprId> arguments) {
        Copy copy(from, b);
        std::unordered_map<std::uint32_t, Expanded> calls;  // by source expression
        std::vector<char> isSame(from.exprs.size());        // nothing that was expanded is in it
        for (std::uint32_t i = 0; i < from.exprs.size(); i++) {
            ExprId id(i);
            const Expr& e = from.exprs[i];
            const Function* callee = depth < kMaxDepth ? wantedOf(e) : nullptr;
            if (e.op == Op::Param) {
                copy.set(id, arguments[e.payload]);
                isSame[i] = depth == 0;
            } else if (callee) {
                auto operands = copy.operands(id);
                std::vector<ExprId> given(operands.begin(), operands.end());
                Expanded& made = calls[i];
                made.before = static_cast<std::uint32_t>(b.function().exprs.size());
                copy.follow(id);
                depth++;
                made.results = expand(*callee, b, given);
                depth--;
                if (e.type != Type::Tuple) take(b, copy, id, made, 0, from.hints[i]);
            } else if (e.op == Op::Result && !calls.empty() && calls.count(from.operand(id, 0).index)) {
                take(b, copy, id, calls[from.operand(id, 0).index], e.payload, from.hints[i]);
            } else if (e.op == Op::Known) {
                ExprId x = copy[from.operand(id, 0)];
                copy.set(id, b.function().isConstant(x) ? x : b.boolean(false));
            } else if (depth == 0 && areAll(from.operandsOf(e), isSame)) {
                copy.raw(id);  // as simple as it was
                isSame[i] = true;
            } else {
                copy.one(id);
            }
        }
        std::vector<ExprId> results;
        for (const ResultValue& r : from.results) results.push_back(copy[r.value]);
        return results;
    }

    static bool areAll(std::span<const ExprId> operands, const std::vector<char>& truths) {
        return std::all_of(operands.begin(), operands.end(), [&](ExprId o) { return truths[o.index] != 0; });
    }

    // A name that the caller gives to a result goes before the one that the value has inside the function called,
    // unless the value is older than the call.
    static void take(Builder& b, Copy& copy, ExprId id, const Expanded& call, std::uint32_t k, Name hint) {
        ExprId value = call.results[k];
        copy.set(id, value);
        if (hint && value.index >= call.before)
            b.rename(value, hint);
        else if (hint)
            b.hint(value, hint);
    }
};

bool isLong(const Function& f) { return holdsLoop(f) || readsImage(f); }

bool isShort(const Function& f) {
    std::size_t operations = 0;
    for (const Expr& e : f.exprs)
        operations += e.op > Op::Uniform && e.op != Op::Swizzle && e.op != Op::Retype && e.op != Op::Result;
    return operations <= kShort && !isLong(f);
}

}  // namespace

void expandToLongWork(Module& module, Name entry) {
    Expander{module, [&](const Function& f) { return !isLong(f) && leadsTo(module, f, isLong); }}.rewrite(entry);
}

void expandCalledOnce(Module& module, Name entry) {
    std::vector<Name> reached{entry};
    std::unordered_map<Name, int> calls;
    for (std::size_t i = 0; i < reached.size(); i++) {
        for (const Expr& e : module.findOwn(reached[i])->exprs)
            if (e.op == Op::Call && calls[Name(e.payload)]++ == 0) reached.push_back(Name(e.payload));
    }
    std::unordered_set<Name> once;
    for (auto [name, count] : calls)
        if (count == 1 && isShort(*module.findOwn(name))) once.insert(name);
    if (once.empty()) return;
    Expander expander{module, [&](const Function& f) { return once.count(f.name) > 0; }};
    for (Name name : reached)
        if (!once.count(name)) expander.rewrite(name);
}

}  // namespace shaderx::passes
