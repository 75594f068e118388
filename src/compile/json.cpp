#include "compile/json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "base/diagnostics.h"
#include "base/names.h"
#include "base/numbers.h"

namespace shaderx {

static char* newLine(char* to, std::size_t indent) {
    *to++ = '\n';
    return std::fill_n(to, indent, ' ');
}

char* JsonWriter::begin(std::size_t characters) {
    if (keyed_) {
        keyed_ = false;
        return room(characters);
    }
    const std::size_t indent = static_cast<std::size_t>(depth_) * 2;
    const bool lines = lines_ >> depth_ & 1;
    char* to = room(characters + indent + 2);
    if (!first_) *to++ = ',';
    if (lines)
        to = newLine(to, indent);
    else if (!first_)
        *to++ = ' ';
    first_ = false;
    return to;
}

void JsonWriter::open(char bracket, bool lines) {
    char* to = begin(1);
    *to++ = bracket;
    end(to);
    depth_++;
    lines_ = (lines_ & ~(std::uint64_t(1) << depth_)) | std::uint64_t(lines) << depth_;
    first_ = true;
}

void JsonWriter::close(char bracket) {
    const bool lines = lines_ >> depth_ & 1;
    depth_--;
    const std::size_t indent = static_cast<std::size_t>(depth_) * 2;
    char* to = room(indent + 3);
    if (lines && !first_) to = newLine(to, indent);
    *to++ = bracket;
    if (depth_ == 0) *to++ = '\n';
    end(to);
    first_ = false;
}

void JsonWriter::key(std::string_view name) {
    char* to = begin(name.size() + 4);
    *to++ = '"';
    to = std::copy(name.begin(), name.end(), to);
    for (char c : {'"', ':', ' '}) *to++ = c;
    end(to);
    keyed_ = true;
}

void JsonWriter::word(std::string_view text) {
    char* to = begin(text.size());
    end(std::copy(text.begin(), text.end(), to));
}

void JsonWriter::integer(std::int64_t value) {
    constexpr std::size_t kLongest = 24;
    char* to = begin(kLongest);
    end(std::to_chars(to, to + kLongest, value).ptr);
}

void JsonWriter::number(float value) {
    if (!std::isfinite(value)) return null();
    if (std::abs(value) < 1e6f && value == std::trunc(value)) return integer(static_cast<std::int64_t>(value));
    char* to = begin(kFloatText);
    end(writeFloat(to, value));
}

// Bytes of the UTF-8 character at the start of a text, 0 where it is none (RFC 3629, section 4).
static std::size_t characterLength(std::string_view text) {
    auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    auto follows = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xbf) {
        return byte(i) >= low && byte(i) <= high;
    };
    unsigned c = byte(0);
    if (c < 0x80) return 1;
    if (c >= 0xc2 && c <= 0xdf) return follows(1) ? 2 : 0;
    if (c >= 0xe0 && c <= 0xef)
        return follows(1, c == 0xe0 ? 0xa0 : 0x80, c == 0xed ? 0x9f : 0xbf) && follows(2) ? 3 : 0;
    if (c >= 0xf0 && c <= 0xf4)
        return follows(1, c == 0xf0 ? 0x90 : 0x80, c == 0xf4 ? 0x8f : 0xbf) && follows(2) && follows(3) ? 4 : 0;
    return 0;
}

static bool isPlain(char c) { return c >= ' ' && c < 0x7f && c != '"' && c != '\\'; }

// Whether eight characters stand for themselves: a byte of a sum below has its highest bit where one does not (Warren,
// Hacker's Delight, section 6-1). A carry may tell it of a plain one too.
static bool arePlain(std::uint64_t eight) {
    constexpr std::uint64_t kEach = 0x0101010101010101u;
    auto isZero = [](std::uint64_t bytes) { return bytes - kEach; };
    const std::uint64_t low = eight - kEach * ' ', high = eight + kEach, quote = isZero(eight ^ kEach * '"'),
                        slash = isZero(eight ^ kEach * '\\');
    return !((eight | low | high | quote | slash) & kEach << 7);
}

void JsonWriter::text(std::string_view value) {
    constexpr std::size_t kLongest = 6;  // of what stands for one byte
    char* to = begin(kLongest * value.size() + 2);
    *to++ = '"';
    std::size_t i = 0;
    for (; i + 8 <= value.size() && arePlain(loadText<std::uint64_t>(value.data() + i)); i += 8, to += 8)
        std::memcpy(to, value.data() + i, 8);
    if (const std::size_t rest = value.size() - i; i && rest < 8) {
        // The last eight, some of them again.
        const char* last = value.data() + value.size() - 8;
        if (arePlain(loadText<std::uint64_t>(last))) {
            std::memcpy(to + rest - 8, last, 8);
            to += rest;
            i = value.size();
        }
    }
    while (i < value.size()) {
        for (; i < value.size() && isPlain(value[i]); i++) *to++ = value[i];
        if (i == value.size()) break;
        const char c = value[i];
        const std::size_t n = characterLength(value.substr(i));
        if (c == '"' || c == '\\') {
            *to++ = '\\';
            *to++ = c;
        } else if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) {
            to = fmt::format_to(to, "\\u{:04x}", static_cast<unsigned>(c));
        } else if (std::size_t size = 1; n && isControl(characterAt(value.substr(i), size))) {
            to = fmt::format_to(to, "\\u{:04x}", static_cast<unsigned>(characterAt(value.substr(i), size)));
        } else if (n) {
            to = std::copy_n(value.data() + i, n, to);
        } else {
            to = fmt::format_to(to, "\xef\xbf\xbd");
        }
        i += std::max<std::size_t>(n, 1);
    }
    *to++ = '"';
    end(to);
}

}  // namespace shaderx
