// Numbers to text and back, independent of the locale.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace shaderx {

// The shortest decimal text that reads back as the same float; `1`, `0.2`, `1e-08`, `nan`, `-inf`.
std::string formatFloat(float value);
// The same where there is room for kFloatText characters; returns where it ends.
constexpr std::size_t kFloatText = 32;
char* writeFloat(char* to, float value);

// Reads a whole text, blanks around it allowed; none if anything else is left. Values too large for a float are none.
std::optional<float> parseFloat(std::string_view text);
std::optional<double> parseDouble(std::string_view text);
// Reads the number at the start of a text, not blanks before it, and returns what follows; null where there is none.
const char* readFloat(const char* at, const char* end, float& value);
std::optional<int> parseInt(std::string_view text);

// The text without blanks (space, tab, line ends) at both ends.
std::string_view trim(std::string_view text);

}  // namespace shaderx
