// Gives every thing in a generated text a name of its own that the language allows.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/names.h"

namespace shaderx::text {

// The words that a name must not be, keywords and built-in functions: `slots` is a table of them by hashText.
struct ReservedWords {
    std::span<const std::string_view> words;
    std::span<const std::uint16_t> slots;  // word + 1 or 0, open addressing, a power of two long
    bool contains(std::string_view word, std::uint32_t hash) const {
        const std::uint32_t mask = static_cast<std::uint32_t>(slots.size()) - 1;
        for (std::uint32_t i = hash & mask; slots[i]; i = (i + 1) & mask)
            if (words[slots[i] - 1u] == word) return true;
        return false;
    }
};

// The slots for words known when compiling.
template <std::size_t N>
constexpr auto reservedSlots(const std::array<std::string_view, N>& words) {
    std::array<std::uint16_t, std::bit_ceil(4 * N)> slots{};
    for (std::size_t k = 0; k < N; k++) {
        std::size_t i = hashText(words[k]) & (slots.size() - 1);
        while (slots[i]) i = (i + 1) & (slots.size() - 1);
        slots[i] = static_cast<std::uint16_t>(k + 1);
    }
    return slots;
}

// Names in use; hashes are those of hashText.
class NameSet {
  public:
    bool contains(std::string_view name, std::uint32_t hash) const {
        return !slots_.empty() && slots_[slotOf(name, hash)] != 0;
    }
    // The number of the name, or how many there are.
    std::size_t find(std::string_view name, std::uint32_t hash) const {
        const std::uint32_t slot = slots_.empty() ? 0 : slots_[slotOf(name, hash)];
        return slot ? slot - 1 : size();
    }
    // The number of the name, and whether it is new.
    std::pair<std::size_t, bool> insert(std::string_view name, std::uint32_t hash);
    void clear();
    std::size_t size() const { return at_.size(); }
    std::string_view operator[](std::size_t k) const { return text(k); }

  private:
    std::size_t slotOf(std::string_view name, std::uint32_t hash) const;
    std::string_view text(std::size_t k) const { return std::string_view(text_).substr(at_[k].first, at_[k].second); }
    std::string text_;                                         // all of them, one after the other
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at_;  // first character and length
    std::vector<std::uint32_t> slots_;                         // name + 1 or 0
};

// Names of a whole text, and of one function at a time inside it.
class Namer {
  public:
    explicit Namer(ReservedWords reserved) : reserved_(reserved) {}
    // A free name as near to `wanted` as the rules allow: letters, digits and single underscores, no digit first, not
    // reserved; numbered where taken. Never taken again in the whole text.
    std::string global(std::string_view wanted);
    // Forgets the local names of the function before.
    void enterFunction() {
        local_.clear();
        numbered_.clear();
        next_.clear();
        gaveWay_ = false;
    }
    const NameSet& locals() const { return local_; }
    bool isGlobal(std::string_view name) const { return global_.contains(name, hashText(name)); }
    // Whether a local name of this function is another than was wanted because of a global one.
    bool gaveWay() const { return gaveWay_; }
    // Free within the function and different from every global name.
    std::string local(std::string_view wanted);

  private:
    // Puts a name into one of the sets; false where it is taken.
    bool take(std::string_view name, std::uint32_t hash, NameSet& set);
    std::string fresh(std::string_view wanted, NameSet& set);

    ReservedWords reserved_;
    NameSet global_, local_;
    bool gaveWay_ = false;
    NameSet numbered_;       // names that were taken
    std::vector<int> next_;  // of these, the number to try next
};

// `text` with everything that can't stand in a name replaced by '_', runs of '_' made one; "v" if nothing is left.
std::string identifier(std::string_view text);

}  // namespace shaderx::text
