// The step that our hashes are made of.
#pragma once

#include <cstdint>
#include <span>

namespace shaderx {

// Multiplies by the golden ratio and folds, so that the low bits, which pick a slot, depend on every bit of the word.
constexpr std::uint64_t mixHash(std::uint64_t h, std::uint64_t word) {
    h = (h ^ word) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 32;
}

// Hash of some words, two at a time; the last one of an odd count is a step of its own.
constexpr std::uint64_t hashWords(std::span<const std::uint32_t> words) {
    std::uint64_t h = words.size();
    std::size_t i = 0;
    for (; i + 1 < words.size(); i += 2) h = mixHash(h, words[i] | std::uint64_t(words[i + 1]) << 32);
    return i < words.size() ? mixHash(h, words[i]) : h;
}

}  // namespace shaderx
