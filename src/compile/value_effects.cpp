#include "compile/value_effects.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace shaderx {

// `idle`: inputs of one node.
static void say(const doc::Document& document, const std::vector<doc::ElementId>& idle, Diagnostics& diagnostics) {
    constexpr std::size_t kNamed = 4;
    std::string names;
    for (std::size_t i = 0; i < std::min(kNamed, idle.size()); i++)
        names += fmt::format("{}'{}'", i ? ", " : "", document.text(document[idle[i]].name));
    if (idle.size() > kNamed) names += fmt::format(" and {} more", idle.size() - kNamed);
    const bool isOne = idle.size() == 1;
    Diagnostic& n = diagnostics.note(
        "idle-value", fmt::format("the value{} of {} {} no effect", isOne ? "" : "s", names, isOne ? "has" : "have"));
    const doc::ElementId at = isOne ? idle[0] : document[idle[0]].parent;
    n.where = document.locate(at);
    n.path = document.path(at);
}

void ValueEffects::report(const doc::Document& document, Diagnostics& diagnostics) {
    // Of several findings for an input, one that has an effect comes first and decides.
    std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) {
        return a.input < b.input || (a.input == b.input && a.hasEffect > b.hasEffect);
    });
    std::vector<doc::ElementId> idle;
    for (std::size_t i = 0; i < found_.size(); i++) {
        if (found_[i].hasEffect || (i > 0 && found_[i].input == found_[i - 1].input)) continue;
        if (!idle.empty() && document[idle[0]].parent != document[found_[i].input].parent) {
            say(document, idle, diagnostics);
            idle.clear();
        }
        idle.push_back(found_[i].input);
    }
    if (!idle.empty()) say(document, idle, diagnostics);
}

}  // namespace shaderx
