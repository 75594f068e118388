#include "compile/json.h"

#include <charconv>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "base/numbers.h"

namespace shaderx {

void JsonWriter::begin() {
    if (keyed_) {
        keyed_ = false;
        return;
    }
    bool lines = lines_ >> depth_ & 1;
    if (!first_) out_ += lines ? "," : ", ";
    if (lines) out_.append(1, '\n').append(static_cast<std::size_t>(depth_) * 2, ' ');
    first_ = false;
}

void JsonWriter::open(char bracket, bool lines) {
    begin();
    out_ += bracket;
    depth_++;
    lines_ = (lines_ & ~(std::uint64_t(1) << depth_)) | std::uint64_t(lines) << depth_;
    first_ = true;
}

void JsonWriter::close(char bracket) {
    bool lines = lines_ >> depth_ & 1;
    depth_--;
    if (lines && !first_) out_.append(1, '\n').append(static_cast<std::size_t>(depth_) * 2, ' ');
    out_ += bracket;
    if (depth_ == 0) out_ += '\n';
    first_ = false;
}

void JsonWriter::key(std::string_view name) {
    begin();
    out_.append(1, '"').append(name).append("\": ");
    keyed_ = true;
}

void JsonWriter::text(std::string_view value) {
    begin();
    quoted(value);
}

void JsonWriter::integer(std::int64_t value) {
    begin();
    char digits[24];
    out_.append(digits, std::to_chars(digits, std::end(digits), value).ptr);
}

void JsonWriter::number(float value) {
    if (!std::isfinite(value)) return null();
    if (std::abs(value) < 1e6f && value == std::trunc(value)) return integer(static_cast<std::int64_t>(value));
    begin();
    out_ += formatFloat(value);
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
    out_ += '"';
    for (std::size_t i = 0; i < text.size();) {
        std::size_t plain = i;
        auto isPlain = [](char c) { return c >= ' ' && c < 0x7f && c != '"' && c != '\\'; };
        while (i < text.size() && isPlain(text[i])) i++;
        out_.append(text.substr(plain, i - plain));
        if (i == text.size()) break;
        char c = text[i];
        if (c == '"' || c == '\\') {
            out_.append(1, '\\').append(1, c);
            i++;
        } else if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) {
            fmt::format_to(std::back_inserter(out_), "\\u{:04x}", static_cast<unsigned>(c));
            i++;
        } else if (std::size_t n = characterLength(text.substr(i))) {
            out_.append(text.substr(i, n));
            i += n;
        } else {
            out_ += "\xef\xbf\xbd";
            i++;
        }
    }
    out_ += '"';
}

}  // namespace shaderx
