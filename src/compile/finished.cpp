#include "compile/finished.h"

#include <algorithm>

namespace shaderx {

using namespace ir;

// All that decides what a function becomes: a call says by number what it calls.
void FinishedFunctions::keyOf(const Module& module, const Function& f) {
    key_.clear();
    auto add = [&](std::uint32_t word) { key_.push_back(word); };
    std::string_view stem = module.names->text(f.name);
    add(module.names->intern(stem.substr(0, stem.find('@'))).index);
    add(f.loops);
    add(static_cast<std::uint32_t>(f.params.size()));
    for (const Param& p : f.params) {
        add(p.name.index);
        add(static_cast<std::uint32_t>(p.type));
    }
    add(static_cast<std::uint32_t>(f.results.size()));
    for (const ResultValue& r : f.results) {
        add(r.name.index);
        add(static_cast<std::uint32_t>(r.type));
        add(r.value.index);
    }
    add(static_cast<std::uint32_t>(f.exprs.size()));
    for (const Expr& e : f.exprs) {
        add(static_cast<std::uint32_t>(e.op) << 16 | static_cast<std::uint32_t>(e.type));
        add(e.operandCount);
        add(e.op == Op::Call ? numberOf_.at(Name(e.payload)) : e.payload);
    }
    for (ExprId o : f.operands) add(o.index);
    for (std::uint32_t w : f.words) add(w);
    for (Name hint : f.hints) add(hint.index);
}

void FinishedFunctions::finish(Module& module, std::span<const Name> apart,
                               const std::function<void(Function&)>& make) {
    numberOf_.clear();
    std::unordered_map<std::uint32_t, Name> nameOf;  // of this module's functions, by number
    for (auto& f : module.functions) {
        const Name name = f->name;
        if (std::find(apart.begin(), apart.end(), name) != apart.end()) continue;
        keyOf(module, *f);
        auto [found, isNew] = byContent_.try_emplace(key_, static_cast<std::uint32_t>(made_.size()));
        const std::uint32_t number = found->second;
        if (isNew) {
            make(*f);
            Function kept = *f;
            for (Expr& e : kept.exprs)
                if (e.op == Op::Call) e.payload = numberOf_.at(Name(e.payload));
            made_.push_back(std::make_unique<const Function>(std::move(kept)));
        } else {
            *f = *made_[number];
            f->name = name;
            for (Expr& e : f->exprs)
                if (e.op == Op::Call) e.payload = nameOf.at(e.payload).index;
        }
        numberOf_[name] = number;
        nameOf[number] = name;
    }
}

}  // namespace shaderx
