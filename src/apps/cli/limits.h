// The limits that --limit sets.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "doc/read.h"

namespace shaderx::cli {

struct Limits {
    doc::ReadOptions read;
    std::uint32_t depth = 128;
    std::size_t expressions = 1u << 20;

    // Sets what texts of the form "elements=1000" say; what is wrong with one of them, empty where all are right.
    std::string set(const std::vector<std::string>& texts);
};

}  // namespace shaderx::cli
