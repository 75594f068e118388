#include "compile/finished.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace shaderx {

using namespace ir;

// All that decides what a function becomes: a call says by number what it calls.
void FinishedFunctions::keyOf(const Module& module, const Function& f) {
    constexpr std::size_t kExprWords = sizeof(Expr) / sizeof(std::uint32_t);
    const std::string_view stem = module.names->text(f.name);
    const std::size_t interface = 2 * f.params.size() + 3 * f.results.size();
    key_.resize(5 + interface + f.exprs.size() * kExprWords + f.operands.size() + f.words.size() + f.hints.size());
    std::uint32_t* to = key_.data();
    auto add = [&](std::uint32_t word) { *to++ = word; };
    auto addAll = [&](const auto& list) {
        static_assert(std::has_unique_object_representations_v<std::remove_cvref_t<decltype(list[0])>>);
        const std::size_t size = list.size() * sizeof(list[0]);
        if (size) std::memcpy(to, list.data(), size);
        to += size / sizeof(std::uint32_t);
    };
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
    std::uint32_t* exprs = to;
    addAll(f.exprs);
    for (std::size_t i = 0; i < f.exprs.size(); i++)
        if (f.exprs[i].op == Op::Call) exprs[(i + 1) * kExprWords - 1] = numberOf_.at(Name(f.exprs[i].payload));
    addAll(f.operands);
    addAll(f.words);
    addAll(f.hints);
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
