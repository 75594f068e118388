#include "targets/text/namer.h"

#include <algorithm>

namespace shaderx::text {

std::size_t NameSet::slotOf(std::string_view name, std::uint32_t hash) const {
    std::size_t i = hash & (slots_.size() - 1);
    while (slots_[i] && text(slots_[i] - 1) != name) i = (i + 1) & (slots_.size() - 1);
    return i;
}

void NameSet::insert(std::string_view name, std::uint32_t hash) {
    if (at_.size() * 2 >= slots_.size()) {
        slots_.assign(std::max<std::size_t>(64, slots_.size() * 2), 0);
        for (std::uint32_t k = 0; k < at_.size(); k++) slots_[slotOf(text(k), hashText(text(k)))] = k + 1;
    }
    std::uint32_t& slot = slots_[slotOf(name, hash)];
    if (slot) return;
    at_.emplace_back(static_cast<std::uint32_t>(text_.size()), static_cast<std::uint32_t>(name.size()));
    text_ += name;
    slot = static_cast<std::uint32_t>(at_.size());
}

void NameSet::clear() {
    if (at_.empty()) return;
    std::fill(slots_.begin(), slots_.end(), 0u);
    at_.clear();
    text_.clear();
}

static bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
static bool isDigit(char c) { return c >= '0' && c <= '9'; }

// Whether a text is a name as it stands, as most are.
static bool isIdentifier(std::string_view text) {
    if (text.empty() || text == "_" || isDigit(text[0])) return false;
    char before = 'a';
    for (char c : text) {
        if (!isLetter(c) && !isDigit(c) && (c != '_' || before == '_')) return false;
        before = c;
    }
    return true;
}

std::string identifier(std::string_view text) {
    constexpr std::size_t kLongest = 200;  // well below every language's limit
    text = text.substr(0, kLongest);
    if (isIdentifier(text)) return std::string(text);
    std::string out;
    for (char c : text) {
        bool letter = isLetter(c), digit = isDigit(c);
        if (!letter && !digit) c = '_';
        if (digit && out.empty()) out = "n";
        if (c == '_' && !out.empty() && out.back() == '_') continue;
        out += c;
    }
    return out.empty() || out == "_" ? "v" : out;
}

bool Namer::taken(std::string_view name, std::uint32_t hash) {
    const bool isGlobal = global_.contains(name, hash);
    gaveWay_ = gaveWay_ || isGlobal;
    return isGlobal || reserved_.contains(name, hash) || name.starts_with("gl_") || local_.contains(name, hash);
}

std::string Namer::fresh(std::string_view wanted, NameSet& set) {
    std::string stem = identifier(wanted);
    if (stem.starts_with("gl_")) stem = "v_" + stem.substr(3);
    std::string name = stem;
    std::uint32_t hash = hashText(name);
    if (taken(name, hash)) {
        if (stem.back() >= '0' && stem.back() <= '9') stem += '_';
        int& next = next_.try_emplace(stem, 2).first->second;
        do {
            name = stem + std::to_string(next++);
            hash = hashText(name);
        } while (taken(name, hash));
    }
    set.insert(name, hash);
    return name;
}

std::string Namer::global(std::string_view wanted) { return fresh(wanted, global_); }
std::string Namer::local(std::string_view wanted) { return fresh(wanted, local_); }

}  // namespace shaderx::text
