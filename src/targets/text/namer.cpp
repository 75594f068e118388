#include "targets/text/namer.h"

#include <algorithm>

namespace shaderx::text {

bool ReservedWords::contains(std::string_view word) const {
    return std::binary_search(sorted.begin(), sorted.end(), word);
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
    return reserved_.contains(name) || name.rfind("gl_", 0) == 0 || global_.count(name) || local_.count(name);
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

std::string Namer::global(std::string_view wanted) { return *global_.insert(fresh(wanted)).first; }
std::string Namer::local(std::string_view wanted) { return *local_.insert(fresh(wanted)).first; }

}  // namespace shaderx::text
