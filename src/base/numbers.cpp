#include "base/numbers.h"

#include <charconv>
#include <cmath>

#include <fast_float/fast_float.h>
#include <fmt/compile.h>

namespace shaderx {

std::string formatFloat(float value) {
    char text[32];
    return std::string(text, fmt::format_to(text, FMT_COMPILE("{}"), value));
}

std::string_view trim(std::string_view text) {
    std::size_t a = text.find_first_not_of(" \t\r\n");
    if (a == std::string_view::npos) return {};
    return text.substr(a, text.find_last_not_of(" \t\r\n") - a + 1);
}

std::optional<float> parseFloat(std::string_view text) {
    text = trim(text);
    if (!text.empty() && text[0] == '+') text.remove_prefix(1);
    float value = 0;
    auto r = fast_float::from_chars(text.data(), text.data() + text.size(), value);
    if (r.ec != std::errc() || r.ptr != text.data() + text.size() || !std::isfinite(value)) return {};
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
