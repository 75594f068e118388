// A program whose rounding is random: what it gives in several runs bounds what any right driver may give.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/module.h"

namespace shaderx::fuzz {

// A copy of a program in which every operation that rounds is off by a random factor of a few units in the last place,
// operations that a driver approximates by more, and in which whatever the semantics leave undefined (ir/ops.h) gives
// any number at all. Where a step is crossed by that, or something undefined shows, results of different shakes lie far
// apart; everywhere else they lie close together, and a driver's value close to them.
class Wobbly {
  public:
    explicit Wobbly(const ir::Module& program);

    // New factors. The first shake, 0, is that of the program itself.
    void shake(std::uint32_t seed);
    const ir::Module& module() const { return module_; }

  private:
    enum class Kind : std::uint8_t { Factor, Approximate, Absolute, Coarse, Any };
    struct Knob {
        std::size_t uniform;  // in module_.uniforms
        Kind kind;
    };
    struct Copier;

    ir::Module module_;
    std::vector<Knob> knobs_;
};

}  // namespace shaderx::fuzz
