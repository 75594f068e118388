// Gives every thing in a generated text a name of its own that the language allows.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace shaderx::text {

// The words that a name must not be: keywords and built-in functions. Sorted, so that it can be searched.
struct ReservedWords {
    std::span<const std::string_view> sorted;
    bool contains(std::string_view word) const;
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
        next_.clear();
    }
    // Free within the function and different from every global name.
    std::string local(std::string_view wanted);

  private:
    bool taken(const std::string& name) const;
    std::string fresh(std::string_view wanted);

    ReservedWords reserved_;
    std::unordered_set<std::string> global_, local_;
    std::unordered_map<std::string, int> next_;  // number to try next, by name
};

// `text` with everything that can't stand in a name replaced by '_', runs of '_' made one; "v" if nothing is left.
std::string identifier(std::string_view text);

}  // namespace shaderx::text
