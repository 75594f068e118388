#include "sl/report.h"

namespace shaderx::sl {

static constexpr std::size_t kToldErrors = 100;

Diagnostic& Reporter::error(std::uint32_t offset, std::string_view code, std::string message) {
    if (++errors_ > kToldErrors) return dropped_ = {};
    Diagnostic& d = errors_ == kToldErrors
                        ? diagnostics_.error("too-many-errors", "too many errors, the rest is not told")
                        : diagnostics_.error(code, std::move(message));
    d.where = at(offset);
    return d;
}

Diagnostic& Reporter::warning(std::uint32_t offset, std::string_view code, std::string message) {
    if (++warnings_ > kToldErrors) return dropped_ = {};
    Diagnostic& d = diagnostics_.warning(code, std::move(message));
    d.where = at(offset);
    return d;
}

std::string quoted(std::string_view word) {
    constexpr std::size_t kShown = 60;
    std::string text = "'";
    for (char c : word.substr(0, kShown)) text += c >= ' ' && c < 127 ? c : '?';
    return text += word.size() > kShown ? "...'" : "'";
}

}  // namespace shaderx::sl
