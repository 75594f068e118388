#include "ir/module.h"

#include <algorithm>
#include <iterator>

#include "base/diagnostics.h"

namespace shaderx::ir {

Name Function::originOf(ExprId e) const {
    auto isAfter = [](std::uint32_t i, const auto& origin) { return i < origin.first; };
    auto after = std::upper_bound(origins.begin(), origins.end(), e.index, isAfter);
    return after == origins.begin() ? Name() : std::prev(after)->second;
}

Function& Module::add(Name name) {
    Function*& slot = byName_[name];
    if (!slot) slot = functions.emplace_back(std::make_unique<Function>()).get();
    slot->name = name;
    return *slot;
}

Function& Module::put(Function function) {
    Function*& slot = byName_[function.name];
    if (slot) {
        *slot = std::move(function);
        return *slot;
    }
    functions.push_back(std::make_unique<Function>(std::move(function)));
    return *(slot = functions.back().get());
}

Function* Module::findOwn(Name name) const {
    auto it = byName_.find(name);
    return it == byName_.end() ? nullptr : it->second;
}

const Function* Module::find(Name name) const {
    if (const Function* own = findOwn(name)) return own;
    for (FunctionSource* source : sources)
        if (const Function* f = source->find(name)) return f;
    return nullptr;
}

void Module::keepOnly(std::span<const Name> kept) {
    std::unordered_map<Name, std::size_t> places;
    places.reserve(kept.size());
    for (Name name : kept) places.emplace(name, places.size());
    std::vector<std::unique_ptr<Function>> ordered(places.size());
    for (std::unique_ptr<Function>& f : functions) {
        auto place = places.find(f->name);
        if (place == places.end())
            byName_.erase(f->name);
        else
            ordered[place->second] = std::move(f);
    }
    std::erase(ordered, nullptr);
    functions = std::move(ordered);
}

Uniform* Module::uniform(Name name) {
    for (; uniformsKnown_ < uniforms.size(); uniformsKnown_++)
        uniformByName_.emplace(uniforms[uniformsKnown_].name, uniformsKnown_);
    auto it = uniformByName_.find(name);
    return it == uniformByName_.end() ? nullptr : &uniforms[it->second];
}

const LeafInfo* Module::leaf(Name name) const {
    for (const LeafInfo& l : leaves)
        if (l.name == name) return &l;
    for (FunctionSource* source : sources)
        if (const LeafInfo* l = source->findLeaf(name)) return l;
    return nullptr;
}

}  // namespace shaderx::ir
