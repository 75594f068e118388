#include "targets/text/namer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <iterator>

namespace shaderx::text {

std::size_t NameSet::slotOf(std::string_view name, std::uint32_t hash) const {
    std::size_t i = hash & (slots_.size() - 1);
    while (slots_[i] && text(slots_[i] - 1) != name) i = (i + 1) & (slots_.size() - 1);
    return i;
}

std::pair<std::size_t, bool> NameSet::insert(std::string_view name, std::uint32_t hash) {
    if (slots_.empty()) {
        constexpr std::size_t kUsual = 32;  // names of a function
        at_.reserve(kUsual);
        text_.reserve(8 * kUsual);
    }
    if (at_.size() * 2 >= slots_.size()) {
        slots_.assign(std::max<std::size_t>(64, slots_.size() * 2), 0);
        for (std::uint32_t k = 0; k < at_.size(); k++) slots_[slotOf(text(k), hashText(text(k)))] = k + 1;
    }
    std::uint32_t& slot = slots_[slotOf(name, hash)];
    if (slot) return {slot - 1, false};
    at_.emplace_back(static_cast<std::uint32_t>(text_.size()), static_cast<std::uint32_t>(name.size()));
    text_ += name;
    slot = static_cast<std::uint32_t>(at_.size());
    return {slot - 1, true};
}

void NameSet::clear() {
    if (at_.empty()) return;
    std::fill(slots_.begin(), slots_.end(), 0u);
    at_.clear();
    text_.clear();
}

static constexpr std::size_t kLongest = 200;  // letters of a name, well below every language's limit

// What a character may be in a name.
enum CharacterClass : std::uint8_t { kOther, kLetter, kDigit, kUnderscore };
static constexpr std::array<CharacterClass, 256> kClasses = [] {
    std::array<CharacterClass, 256> classes{};
    for (int c = 'a'; c <= 'z'; c++) classes[static_cast<std::size_t>(c)] = kLetter;
    for (int c = 'A'; c <= 'Z'; c++) classes[static_cast<std::size_t>(c)] = kLetter;
    for (int c = '0'; c <= '9'; c++) classes[static_cast<std::size_t>(c)] = kDigit;
    classes['_'] = kUnderscore;
    return classes;
}();
static CharacterClass classOf(char c) { return kClasses[static_cast<unsigned char>(c)]; }

// Whether a text is a name as it stands, as most are.
static bool isIdentifier(std::string_view text) {
    if (text.empty() || text.size() > kLongest || text == "_" || classOf(text[0]) == kDigit) return false;
    CharacterClass before = kLetter;
    for (char c : text) {
        const CharacterClass now = classOf(c);
        if (now == kOther || (now == kUnderscore && before == kUnderscore)) return false;
        before = now;
    }
    return true;
}

std::string identifier(std::string_view text) {
    text = text.substr(0, kLongest);
    if (isIdentifier(text)) return std::string(text);
    std::string out;
    for (char c : text) {
        if (classOf(c) == kOther) c = '_';
        if (classOf(c) == kDigit && out.empty()) out = "n";
        if (c == '_' && !out.empty() && out.back() == '_') continue;
        out += c;
    }
    return out.empty() || out == "_" ? "v" : out;
}

bool Namer::take(std::string_view name, std::uint32_t hash, NameSet& set) {
    if (name.starts_with("gl_") || reserved_.contains(name, hash)) return false;
    if (&set == &global_) return !local_.contains(name, hash) && global_.insert(name, hash).second;
    if (!global_.contains(name, hash)) return local_.insert(name, hash).second;
    gaveWay_ = true;
    return false;
}

std::string Namer::fresh(std::string_view wanted, NameSet& set) {
    std::string name;
    const std::uint32_t hash = hashText(wanted);
    std::size_t known = numbered_.find(wanted, hash);
    if (known < numbered_.size()) {  // it was taken before
        name = wanted;
    } else {
        bool isTried = isIdentifier(wanted);
        if (isTried && take(wanted, hash, set)) return std::string(wanted);
        name = isTried ? std::string(wanted) : identifier(wanted);
        if (name.starts_with("gl_")) {
            name.replace(0, 2, "v");
            isTried = false;
        }
        if (!isTried && take(name, hashText(name), set)) return name;
        if (classOf(name.back()) == kDigit) name += '_';
        known = numbered_.insert(name, hashText(name)).first;
        if (known == next_.size()) next_.push_back(2);
    }
    const std::size_t stem = name.size();
    do {
        char digits[12];
        name.resize(stem);
        name.append(digits, std::to_chars(digits, std::end(digits), next_[known]++).ptr);
    } while (!take(name, hashText(name), set));
    return name;
}

std::string Namer::global(std::string_view wanted) { return fresh(wanted, global_); }
std::string Namer::local(std::string_view wanted) { return fresh(wanted, local_); }

}  // namespace shaderx::text
