// Functions as a target prints them, kept from one material of a document to the next.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "base/hash.h"
#include "ir/module.h"

namespace shaderx {

// Materials of one document call much the same functions. What a function becomes follows from its content and that of
// the functions that it calls, so it is made once for each content, whatever the functions are called in a module.
class FinishedFunctions {
  public:
    // Finishes the module's functions from the first on, callees before callers, but for those named in `apart`; `make`
    // finishes one that is new.
    void finish(ir::Module& module, std::span<const Name> apart, const std::function<void(ir::Function&)>& make);
    // Of the functions finished last: equal numbers for equal content.
    const std::unordered_map<Name, std::uint32_t>& numbers() const { return numberOf_; }

  private:
    using Key = std::vector<std::uint32_t>;
    // Of the first half, which has most of the operations and tells nearly all functions apart.
    struct KeyHash {
        std::size_t operator()(const Key& key) const noexcept {
            return hashWords(std::span(key).first(key.size() / 2));
        }
    };
    void keyOf(const ir::Module& module, const ir::Function& f);

    std::unordered_map<Key, std::uint32_t, KeyHash> byContent_;
    std::vector<std::unique_ptr<const ir::Function>> made_;  // by number
    std::unordered_map<Name, std::uint32_t> numberOf_;       // of this module's functions
    Key key_;
};

}  // namespace shaderx
