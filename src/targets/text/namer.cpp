#include "targets/text/namer.h"

#include <algorithm>

namespace shaderx::text {

std::size_t NameSet::slotOf(std::string_view name) const {
    std::size_t i = hashText(name) & (slots_.size() - 1);
    auto text = [&](std::uint32_t k) { return std::string_view(text_).substr(at_[k].first, at_[k].second); };
    while (slots_[i] && text(slots_[i] - 1) != name) i = (i + 1) & (slots_.size() - 1);
    return i;
}

void NameSet::insert(std::string_view name) {
    if (at_.size() * 2 >= slots_.size()) {
        slots_.assign(std::max<std::size_t>(64, slots_.size() * 2), 0);
        for (std::uint32_t k = 0; k < at_.size(); k++)
            slots_[slotOf(std::string_view(text_).substr(at_[k].first, at_[k].second))] = k + 1;
    }
    std::uint32_t& slot = slots_[slotOf(name)];
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

std::string identifier(std::string_view text) {
    constexpr std::size_t kLongest = 200;  // well below every language's limit
    std::string out;
    for (char c : text.substr(0, kLongest)) {
        bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        bool digit = c >= '0' && c <= '9';
        if (!letter && !digit) c = '_';
        if (digit && out.empty()) out = "n";
        if (c == '_' && !out.empty() && out.back() == '_') continue;
        out += c;
    }
    return out.empty() || out == "_" ? "v" : out;
}

bool Namer::taken(const std::string& name) const {
    return reserved_.contains(name) || name.rfind("gl_", 0) == 0 || global_.contains(name) || local_.contains(name);
}

std::string Namer::fresh(std::string_view wanted) {
    std::string stem = identifier(wanted);
    if (stem.rfind("gl_", 0) == 0) stem = "v_" + stem.substr(3);
    std::string name = stem;
    if (!stem.empty() && stem.back() >= '0' && stem.back() <= '9') stem += '_';
    if (!taken(name)) return name;
    int& next = next_.try_emplace(stem, 2).first->second;
    do name = stem + std::to_string(next++);
    while (taken(name));
    return name;
}

std::string Namer::global(std::string_view wanted) {
    std::string name = fresh(wanted);
    global_.insert(name);
    return name;
}

std::string Namer::local(std::string_view wanted) {
    std::string name = fresh(wanted);
    local_.insert(name);
    return name;
}

}  // namespace shaderx::text
