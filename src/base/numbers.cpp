#include "base/numbers.h"

#include <charconv>
#include <cmath>
#include <cstdint>

#include <fast_float/fast_float.h>
#include <fmt/compile.h>

namespace shaderx {

// Most numbers are a few digits around a point. No two texts of up to six digits read as one float, so a text of six
// that reads back, less the zeros at its end, is the shortest. Null where there is none.
static char* writeShortDecimal(char* to, float value) {
    const double size = std::abs(static_cast<double>(value));
    if (!(size >= 1e-4 && size < 1000)) return nullptr;
    const std::uint32_t places = size < 1 ? 6 : 3, scale = size < 1 ? 1000000 : 1000;
    const std::uint32_t digits = static_cast<std::uint32_t>(size * scale + 0.5);
    if (digits >= 1000000 || static_cast<float>(static_cast<double>(digits) / scale) != std::abs(value)) return nullptr;
    if (value < 0) *to++ = '-';
    to = std::to_chars(to, to + kFloatText, digits / scale).ptr;
    std::uint32_t rest = digits % scale;
    if (!rest) return to;
    *to++ = '.';
    for (std::uint32_t k = places; k-- > 0; rest /= 10) to[k] = static_cast<char>('0' + rest % 10);
    char* end = to + places;
    while (end[-1] == '0') end--;
    return end;
}

char* writeFloat(char* to, float value) {
    if (char* end = writeShortDecimal(to, value)) return end;
    return fmt::format_to(to, FMT_COMPILE("{}"), value);
}

std::string formatFloat(float value) {
    char text[kFloatText];
    return std::string(text, writeFloat(text, value));
}

static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
static bool isDigit(char c) { return c >= '0' && c <= '9'; }

std::string_view trim(std::string_view text) {
    while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
    while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
    return text;
}

// Most numbers are a few digits around a point. Where the digits as one integer and the power of ten are both exact
// floats, their quotient is the nearest float, since a division rounds once.
static const char* readShortDecimal(const char* at, const char* end, float& value) {
    constexpr float kPowers[] = {1, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f, 1e7f};
    constexpr std::ptrdiff_t kMostDigits = 7;  // below 2^24
    std::uint32_t digits = 0;
    const char *first = at, *stop = end - at > kMostDigits + 1 ? at + kMostDigits + 1 : end;
    for (; at != stop && isDigit(*at); at++) digits = digits * 10 + static_cast<std::uint32_t>(*at - '0');
    std::ptrdiff_t whole = at - first, places = 0;
    if (whole == 0) return nullptr;
    if (at != stop && *at == '.') {
        const char* point = at++;
        for (; at != stop && isDigit(*at); at++) digits = digits * 10 + static_cast<std::uint32_t>(*at - '0');
        places = at - point - 1;
        if (places == 0) return nullptr;
    }
    if (whole + places > kMostDigits) return nullptr;
    if (at != end && (isDigit(*at) || *at == '.' || *at == 'e' || *at == 'E')) return nullptr;
    value = static_cast<float>(digits) / kPowers[places];
    return at;
}

const char* readFloat(const char* at, const char* end, float& value) {
    if (at != end && *at == '+') at++;
    const bool negative = at != end && *at == '-';
    if (const char* rest = readShortDecimal(at + negative, end, value)) {
        if (negative) value = -value;
        return rest;
    }
    auto r = fast_float::from_chars(at, end, value);
    return r.ec == std::errc() && std::isfinite(value) ? r.ptr : nullptr;
}

std::optional<float> parseFloat(std::string_view text) {
    text = trim(text);
    const char* end = text.data() + text.size();
    float value = 0;
    if (text.empty() || readFloat(text.data(), end, value) != end) return {};
    return value;
}

std::optional<double> parseDouble(std::string_view text) {
    text = trim(text);
    const char* end = text.data() + text.size();
    double value = 0;
    auto r = fast_float::from_chars(text.data(), end, value);
    if (r.ec != std::errc() || r.ptr != end || !std::isfinite(value)) return {};
    return value;
}

std::optional<int> parseInt(std::string_view text) {
    text = trim(text);
    if (!text.empty() && text[0] == '+') text.remove_prefix(1);
    int value = 0;
    auto r = std::from_chars(text.data(), text.data() + text.size(), value);
    if (r.ec != std::errc() || r.ptr != text.data() + text.size()) return {};
    return value;
}

}  // namespace shaderx
