// Texts of functions, kept from one program to the next.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/names.h"

namespace shaderx::text {

// Programs that have functions in common print them alike, unless one of their local names is a global one elsewhere.
struct FunctionTexts {
    struct Text {
        std::string text;
        std::vector<std::string> locals;
    };
    std::unordered_map<std::string, Text> known;  // by all that decides the text
    // Of the functions of the program to print: equal numbers for equal content.
    const std::unordered_map<Name, std::uint32_t>* numbers = nullptr;
};

}  // namespace shaderx::text
