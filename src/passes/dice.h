// For tests: where random things get their numbers from.
#pragma once

#include <cstdint>
#include <random>
#include <span>

namespace shaderx::passes {

// Throws that follow from a seed, or from bytes: a fuzzer's, that change a throw by changing a byte. Behind the last
// byte all throws are 0.
class Dice {
  public:
    explicit Dice(std::uint32_t seed) : rng_(seed) {}
    explicit Dice(std::span<const std::uint8_t> bytes) : bytes_(bytes), hasBytes_(true) {}

    // 0 … n - 1.
    std::uint32_t roll(std::uint32_t n) {
        if (!hasBytes_) return static_cast<std::uint32_t>(rng_() % n);
        std::uint32_t v = byte();
        if (n > 256) v = v << 8 | byte();
        if (n > 65536) v = v << 8 | byte();
        return v % n;
    }
    bool isEmpty() const { return hasBytes_ && bytes_.empty(); }

  private:
    std::uint32_t byte() {
        if (bytes_.empty()) return 0;
        const std::uint32_t v = bytes_[0];
        bytes_ = bytes_.subspan(1);
        return v;
    }

    std::mt19937 rng_;
    std::span<const std::uint8_t> bytes_;
    bool hasBytes_ = false;
};

}  // namespace shaderx::passes
