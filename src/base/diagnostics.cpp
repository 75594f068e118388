#include "base/diagnostics.h"

#include <algorithm>

namespace shaderx {

Location locate(std::string_view file, std::string_view text, std::size_t offset) {
    offset = std::min(offset, text.size());
    Location where{std::string(file), 1, 1};
    std::size_t lineStart = 0;
    for (std::size_t i = 0; i < offset; i++)
        if (text[i] == '\n') {
            where.line++;
            lineStart = i + 1;
        }
    where.column = static_cast<std::uint32_t>(offset - lineStart + 1);
    return where;
}

static std::string prefix(const Location& where) {
    std::string out = where.file;
    if (where.line) out += ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
    if (!out.empty()) out += ": ";
    return out;
}

std::string format(const Diagnostic& d) {
    const char* kind = d.severity == Severity::Warning ? "warning: "
                       : d.severity == Severity::Error ? "error: "
                                                       : "internal error: ";
    std::string out = prefix(d.where) + kind + d.message + " [" + d.code + "]\n";
    if (!d.path.empty()) out += "  at: " + d.path + "\n";
    for (const Note& n : d.notes) out += "  note: " + prefix(n.where) + n.message + "\n";
    if (!d.hint.empty()) out += "  hint: " + d.hint + "\n";
    return out;
}

Diagnostic& Diagnostics::add(Severity severity, std::string_view code, std::string message) {
    if (severity != Severity::Warning) errors_++;
    if (severity == Severity::Internal) internals_++;
    Diagnostic& d = all_.emplace_back();
    d.severity = severity;
    d.code = code;
    d.message = std::move(message);
    return d;
}

std::string Diagnostics::text() const {
    std::string out;
    for (const Diagnostic& d : all_) out += format(d);
    return out;
}

// Levenshtein distance, given up (as limit + 1) where it must exceed the limit.
static std::size_t distance(std::string_view a, std::string_view b, std::size_t limit) {
    if (a.size() > b.size()) std::swap(a, b);
    if (b.size() - a.size() > limit) return limit + 1;
    std::vector<std::size_t> row(a.size() + 1);
    for (std::size_t i = 0; i <= a.size(); i++) row[i] = i;
    for (std::size_t j = 1; j <= b.size(); j++) {
        std::size_t diagonal = row[0]++;
        for (std::size_t i = 1; i <= a.size(); i++) {
            std::size_t change = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[i];
            row[i] = std::min({row[i] + 1, row[i - 1] + 1, change});
        }
    }
    return row[a.size()];
}

std::string_view nearest(std::string_view word, const std::vector<std::string_view>& candidates) {
    std::string_view best;
    if (word.size() < 2 || word.size() > 256) return best;  // a letter is like every other
    std::size_t limit = std::max<std::size_t>(1, word.size() / 3), bestDistance = limit + 1;
    for (std::string_view c : candidates)
        if (std::size_t d = distance(word, c, limit); d < bestDistance) {
            best = c;
            bestDistance = d;
        }
    return best;
}

void internalError(const std::string& what) { throw InternalError(what); }

}  // namespace shaderx
