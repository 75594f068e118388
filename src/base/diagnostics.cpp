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

char32_t characterAt(std::string_view text, std::size_t& size) {
    auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    size = first < 0xC0 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    char32_t c = size == 1 ? first : first & (0x7Fu >> size);
    bool whole = size <= text.size() && (first < 0x80 || size > 1);
    for (std::size_t i = 1; whole && i < size; i++) {
        whole = (byte(i) & 0xC0) == 0x80;
        c = c << 6 | (byte(i) & 0x3Fu);
    }
    if (!whole) size = 1;
    return whole ? c : first;
}

// They move the cursor, set colours, end the line or turn the direction of the text around them.
bool isControl(char32_t c) {
    return c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x61C || c == 0x200E || c == 0x200F || c == 0x2028 ||
           c == 0x2029 || (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

std::string visible(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    while (!text.empty()) {
        std::size_t size = 1;
        const char32_t c = characterAt(text, size);
        if (!isControl(c) && (c < 0x80 || size > 1)) {
            out += text.substr(0, size);
        } else if (c == '\n' || c == '\r' || c == '\t') {
            out += c == '\n' ? "\\n" : c == '\r' ? "\\r" : "\\t";
        } else {
            constexpr char kDigits[] = "0123456789abcdef";
            out += c < 0x100 ? "\\x" : "\\u";
            for (int shift = c < 0x100 ? 4 : 12; shift >= 0; shift -= 4) out += kDigits[c >> shift & 15];
        }
        text.remove_prefix(size);
    }
    return out;
}

std::string visibleLines(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (;;) {
        const std::size_t end = text.find_first_of("\n\t");
        out += visible(text.substr(0, end));
        if (end == std::string_view::npos) return out;
        out += text[end];
        text.remove_prefix(end + 1);
    }
}

// A note may show a line of a program below itself, set in.
static std::string visibleNote(std::string_view text) {
    constexpr std::string_view kBelow = "\n    ";
    std::string out;
    for (std::size_t at; (at = text.find(kBelow)) != std::string_view::npos; text.remove_prefix(at + kBelow.size()))
        out.append(visible(text.substr(0, at))).append(kBelow);
    return out + visible(text);
}

static std::string prefix(const Location& where) {
    std::string out = visible(where.file);
    if (where.line) out += ":" + std::to_string(where.line) + ":" + std::to_string(where.column);
    if (!out.empty()) out += ": ";
    return out;
}

std::string format(const Diagnostic& d) {
    static constexpr std::string_view kKinds[] = {"note: ", "warning: ", "error: ", "internal error: "};
    std::string out = prefix(d.where).append(kKinds[static_cast<std::size_t>(d.severity)]) + visible(d.message) + " [" +
                      d.code + "]\n";
    if (!d.path.empty()) out += "  at: " + visible(d.path) + "\n";
    for (const Note& n : d.notes) out += "  note: " + prefix(n.where) + visibleNote(n.message) + "\n";
    if (!d.hint.empty()) out += "  hint: " + visible(d.hint) + "\n";
    return out;
}

Diagnostic& Diagnostics::add(Diagnostic diagnostic) {
    if (diagnostic.severity >= Severity::Error) errors_++;
    if (diagnostic.severity == Severity::Internal) internals_++;
    return all_.emplace_back(std::move(diagnostic));
}

Diagnostic& Diagnostics::add(Severity severity, std::string_view code, std::string message) {
    return add(Diagnostic{severity, std::string(code), std::move(message), {}, {}, {}, {}});
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

bool Unrepeated::isNew(const Diagnostic& d) {
    std::string key = d.code;
    for (std::string_view part :
         {std::string_view(d.message), std::string_view(d.where.file), std::string_view(d.path)})
        key.append(1, '\0').append(part);
    key.append(1, '\0').append(std::to_string(d.where.line)).append(1, ':').append(std::to_string(d.where.column));
    return said_.insert(std::move(key)).second;
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
