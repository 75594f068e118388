#include "doc/xml_errors.h"

#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace shaderx::doc {

namespace {

constexpr std::string_view kBlank = " \t\r\n";

struct Scanner {
    struct Open {
        std::string_view name;
        std::size_t offset;
    };
    std::string_view text;
    std::size_t at = 0;
    std::vector<Open> open{};
    std::optional<XmlProblem> problem{};

    bool starts(std::string_view with) const { return text.substr(at).starts_with(with); }
    bool atEnd() const { return at >= text.size(); }
    void fail(std::size_t offset, std::string message) { problem = XmlProblem{offset, std::move(message), {}, {}}; }
    void failOpen(std::size_t offset, std::string message) {
        fail(offset, std::move(message));
        problem->opened = open.back().offset;
        problem->openedName = open.back().name;
    }
    void skipBlanks() { at = std::min(text.size(), text.find_first_not_of(kBlank, at)); }
    std::string_view name() {
        std::size_t begin = at;
        while (!atEnd() && !std::strchr(" \t\r\n/>=<\"'&?!", text[at])) at++;
        return text.substr(begin, at - begin);
    }
    std::string found() const {
        if (atEnd()) return "the end of the file";
        unsigned char c = static_cast<unsigned char>(text[at]);
        return c < 0x20 || c >= 0x7f ? fmt::format("byte {:#04x}", c) : fmt::format("'{}'", text[at]);
    }

    void skipTo(std::string_view end, std::string_view what) {
        std::size_t found = text.find(end, at);
        if (found == std::string_view::npos) fail(at, fmt::format("{} is not closed: expected '{}'", what, end));
        at = found + end.size();
    }
    void doctype() {
        std::size_t begin = at;
        for (int depth = 0; !atEnd(); at++) {
            if (text[at] == '[') depth++;
            if (text[at] == ']') depth--;
            if (text[at] == '>' && depth <= 0) return;
        }
        fail(begin, "the document type is not closed: expected '>'");
    }

    void closingTag() {
        std::size_t begin = at;
        at += 2;
        std::string_view n = name();
        if (open.empty()) return fail(begin, fmt::format("unexpected closing tag </{}>: no element is open", n));
        if (n != open.back().name)
            return failOpen(begin, fmt::format("expected </{}>, found </{}>", open.back().name, n));
        skipBlanks();
        if (!starts(">")) return fail(at, fmt::format("expected '>' after '</{}', found {}", n, found()));
        at++;
        open.pop_back();
    }

    void attribute(std::string_view tag) {
        std::size_t begin = at;
        std::string_view n = name();
        if (n.empty())
            return fail(at, fmt::format("expected an attribute, '>' or '/>' in the tag <{}>, found {}", tag, found()));
        skipBlanks();
        if (!starts("=")) return fail(at, fmt::format("expected '=' after the attribute '{}', found {}", n, found()));
        at++;
        skipBlanks();
        if (!starts("\"") && !starts("'"))
            return fail(at, fmt::format("expected a quoted value for the attribute '{}', found {}", n, found()));
        char quote = text[at];
        std::size_t end = text.find(quote, at + 1);
        if (end == std::string_view::npos || text.substr(at, end - at).find('<') != std::string_view::npos)
            return fail(begin, fmt::format("the value of the attribute '{}' is not closed: expected {}", n, quote));
        at = end + 1;
        if (!atEnd() && !std::strchr(" \t\r\n/>?", text[at]))
            fail(at, fmt::format("expected a blank, '>' or '/>' after the attribute '{}', found {}", n, found()));
    }

    void openingTag() {
        std::size_t begin = at++;
        std::string_view n = name();
        if (n.empty()) return fail(at, fmt::format("expected an element's name after '<', found {}", found()));
        while (!problem) {
            skipBlanks();
            if (atEnd()) return fail(begin, fmt::format("the tag <{}> is not closed: expected '>'", n));
            if (starts("/>")) {
                at += 2;
                return;
            }
            if (starts(">")) {
                at++;
                open.push_back({n, begin});
                return;
            }
            attribute(n);
        }
    }

    void run() {
        while (!problem) {
            at = text.find('<', at);
            if (at == std::string_view::npos) break;
            if (starts("<!--"))
                skipTo("-->", "the comment");
            else if (starts("<![CDATA["))
                skipTo("]]>", "the CDATA section");
            else if (starts("<!DOCTYPE"))
                doctype();
            else if (starts("<?"))
                skipTo("?>", "the processing instruction");
            else if (starts("</"))
                closingTag();
            else
                openingTag();
        }
        if (!problem && !open.empty())
            failOpen(text.size(), fmt::format("expected </{}> before the end of the file", open.back().name));
    }
};

// The length of the UTF-8 character at the start of the text, 0 if it is none (RFC 3629).
std::size_t characterLength(const unsigned char* p, std::size_t left) {
    unsigned char c = p[0];
    if (c == 0) return 0;
    if (c < 0x80) return 1;
    std::size_t n = c >= 0xC2 && c < 0xE0 ? 2 : c >= 0xE0 && c < 0xF0 ? 3 : c >= 0xF0 && c < 0xF5 ? 4 : 0;
    if (n == 0 || left < n) return 0;
    for (std::size_t i = 1; i < n; i++)
        if ((p[i] & 0xC0) != 0x80) return 0;
    bool wrong = (c == 0xE0 && p[1] < 0xA0) || (c == 0xED && p[1] >= 0xA0) ||  // overlong; surrogates
                 (c == 0xF0 && p[1] < 0x90) || (c == 0xF4 && p[1] >= 0x90);    // overlong; beyond U+10FFFF
    return wrong ? 0 : n;
}

}  // namespace

std::optional<XmlProblem> findXmlProblem(std::string_view text) {
    Scanner scanner{text};
    scanner.run();
    return scanner.problem;
}

std::optional<std::size_t> findBadByte(std::string_view text) {
    const unsigned char* p = reinterpret_cast<const unsigned char*>(text.data());
    for (std::size_t i = 0; i < text.size();) {
        if (i + 32 <= text.size()) {  // ASCII at once: no high bit set, and no byte is zero
            constexpr std::uint64_t kHigh = 0x8080808080808080u, kOnes = 0x0101010101010101u;
            std::uint64_t a = 0, b = 0, c = 0, d = 0;
            std::memcpy(&a, p + i, 8);
            std::memcpy(&b, p + i + 8, 8);
            std::memcpy(&c, p + i + 16, 8);
            std::memcpy(&d, p + i + 24, 8);
            // Taking one off sets the high bit of a byte that is zero.
            std::uint64_t high = a | b | c | d | (a - kOnes) | (b - kOnes) | (c - kOnes) | (d - kOnes);
            if ((high & kHigh) == 0) {
                i += 32;
                continue;
            }
        }
        std::size_t n = characterLength(p + i, text.size() - i);
        if (n == 0) return i;
        i += n;
    }
    return {};
}

// The number of a reference whose digits start the text; none if it is no reference.
static std::optional<std::uint32_t> referenceValue(std::string_view digits) {
    bool hex = digits.starts_with('x');
    std::uint32_t value = 0;
    std::size_t first = hex ? 1 : 0, at = first;
    for (; at < digits.size() && digits[at] != ';'; at++) {
        char c = digits[at];
        std::uint32_t digit = c >= '0' && c <= '9'          ? static_cast<std::uint32_t>(c - '0')
                              : hex && c >= 'a' && c <= 'f' ? static_cast<std::uint32_t>(c - 'a' + 10)
                              : hex && c >= 'A' && c <= 'F' ? static_cast<std::uint32_t>(c - 'A' + 10)
                                                            : 16;
        if (digit == 16) return {};
        if (value <= 0x10FFFF) value = value * (hex ? 16 : 10) + digit;
    }
    if (at == digits.size() || at == first) return {};
    return value;
}

// XML 1.0, production 2.
static bool isXmlCharacter(std::uint32_t c) {
    if (c < 0x20) return c == '\t' || c == '\n' || c == '\r';
    return c < 0xD800 || (c >= 0xE000 && c <= 0x10FFFF && c != 0xFFFE && c != 0xFFFF);
}

// Where a comment or CDATA section that is open at `at` ends; `at` where none is.
static std::size_t endOfText(std::string_view text, std::size_t at) {
    for (auto [open, close] : {std::pair<std::string_view, std::string_view>{"<!--", "-->"}, {"<![CDATA[", "]]>"}}) {
        std::size_t begin = text.rfind(open, at);
        if (begin == std::string_view::npos) continue;
        std::size_t end = text.find(close, begin);
        if (end == std::string_view::npos || end > at) return end;
    }
    return at;
}

std::optional<std::size_t> findBadReference(std::string_view text) {
    for (std::size_t at = text.find("&#"); at != std::string_view::npos; at = text.find("&#", at)) {
        std::optional<std::uint32_t> value = referenceValue(text.substr(at + 2));
        if (!value || isXmlCharacter(*value)) {
            at += 2;
            continue;
        }
        std::size_t end = endOfText(text, at);
        if (end == at) return at;
        at = end;
    }
    return {};
}

}  // namespace shaderx::doc
