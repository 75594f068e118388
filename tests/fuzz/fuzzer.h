// What the fuzz targets share: a failure shows what is wrong and ends the program, as the fuzzer expects it.
#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "passes/random_trial.h"

namespace shaderx::fuzz {

inline void expect(bool holds, const std::string& what) {
    if (holds) return;
    std::fputs(what.c_str(), stderr);
    std::fputc('\n', stderr);
    std::abort();
}
inline void expectNothing(const std::string& problem) { expect(problem.empty(), problem); }

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

// A valid program made by the fuzzer's bytes, about as long as these.
struct Program : passes::RandomTrial {
    Program(const std::uint8_t* data, std::size_t size, ir::Type result = ir::Type::Void, bool hasParams = true)
        : RandomTrial(passes::Dice(std::span(data, size)), 2 + size / 16 % 40, result, hasParams) {
        expectNothing(start());
    }
};

}  // namespace shaderx::fuzz
