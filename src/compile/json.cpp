#include "compile/json.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "base/numbers.h"

namespace shaderx {

void JsonWriter::begin() {
    if (keyed_) {
        keyed_ = false;
        return;
    }
    const bool lines = lines_ >> depth_ & 1;
    if (!first_) lines ? put(',') : put(", ");
    if (lines) newLine();
    first_ = false;
}

void JsonWriter::newLine() {
    const std::size_t indent = static_cast<std::size_t>(depth_) * 2;
    char* to = room(indent + 1);
    *to = '\n';
    std::fill_n(to + 1, indent, ' ');
    size_ += indent + 1;
}

void JsonWriter::open(char bracket, bool lines) {
    begin();
    put(bracket);
    depth_++;
    lines_ = (lines_ & ~(std::uint64_t(1) << depth_)) | std::uint64_t(lines) << depth_;
    first_ = true;
}

void JsonWriter::close(char bracket) {
    const bool lines = lines_ >> depth_ & 1;
    depth_--;
    if (lines && !first_) newLine();
    put(bracket);
    if (depth_ == 0) put('\n');
    first_ = false;
}

void JsonWriter::key(std::string_view name) {
    begin();
    put('"');
    put(name);
    put("\": ");
    keyed_ = true;
}

void JsonWriter::text(std::string_view value) {
    begin();
    quoted(value);
}

void JsonWriter::integer(std::int64_t value) {
    begin();
    constexpr std::size_t kLongest = 24;
    char* to = room(kLongest);
    size_ += static_cast<std::size_t>(std::to_chars(to, to + kLongest, value).ptr - to);
}

void JsonWriter::number(float value) {
    if (!std::isfinite(value)) return null();
    if (std::abs(value) < 1e6f && value == std::trunc(value)) return integer(static_cast<std::int64_t>(value));
    begin();
    put(formatFloat(value));
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

void JsonWriter::quoted(std::string_view text) {
    put('"');
    for (std::size_t i = 0; i < text.size();) {
        auto isPlain = [](char c) { return c >= ' ' && c < 0x7f && c != '"' && c != '\\'; };
        char* to = room(text.size() - i);
        const std::size_t plain = i;
        for (; i < text.size() && isPlain(text[i]); i++) *to++ = text[i];
        size_ += i - plain;
        if (i == text.size()) break;
        char c = text[i];
        if (c == '"' || c == '\\') {
            put('\\');
            put(c);
            i++;
        } else if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) {
            put(fmt::format("\\u{:04x}", static_cast<unsigned>(c)));
            i++;
        } else if (std::size_t n = characterLength(text.substr(i))) {
            put(text.substr(i, n));
            i += n;
        } else {
            put("\xef\xbf\xbd");
            i++;
        }
    }
    put('"');
}

}  // namespace shaderx
