// Runs functions of the IR for 64 pixels at once: what makes the oracle fast enough to draw pictures.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>

#include "base/diagnostics.h"
#include "base/result.h"
#include "ir/interpret.h"

namespace shaderx::ir {

// Pixels of one run. Each four in a row are a quad: (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1).
constexpr std::size_t kLanes = 64;

// Bit i is lane i.
using LaneMask = std::uint64_t;

// One component of a value in all lanes: bits of floats and integers, booleans 0 or 1. Of a value with several
// components the first comes first, in all lanes, then the second, and so on.
struct alignas(64) LaneWords {
    std::uint32_t lane[kLanes] = {};

    float f(std::size_t i) const { return std::bit_cast<float>(lane[i]); }
    void set(std::size_t i, float v) { lane[i] = std::bit_cast<std::uint32_t>(v); }
};

// Reads of one image at many places. What lanes that are not asked for hold is not defined.
struct WideTextureRead {
    TextureRef texture;
    LaneMask lanes = 0;
    const LaneWords* uv = nullptr;  // 2
    bool hasGradients = false;
    const LaneWords* level = nullptr;                // without gradients
    const LaneWords *ddx = nullptr, *ddy = nullptr;  // 2 each, with gradients
};

// What a program asks of the world, as Environment; one answer serves all lanes where the host supplies the value.
struct WideEnvironment {
    virtual ~WideEnvironment() = default;
    // Of contexts whose source is Uniform.
    virtual bool context(Context, Value&) { return false; }
    virtual bool uniform(Name, Value&) { return false; }
    // Of all other contexts; `words` has one entry a component.
    virtual bool varying(Context, Type, std::span<LaneWords>) { return false; }
    virtual bool attribute(Name, Type, std::span<LaneWords>) { return false; }
    // Fills as many channels, red first, as `channels` has entries.
    virtual bool texture(const WideTextureRead&, std::span<LaneWords>) { return false; }
    virtual bool textureSize(const TextureRef&, Value&) { return false; }
};

struct WideCode;

// A function ready to run, its calls expanded. Any number of threads may run it at a time.
//
// Values that are the same in all lanes, being made of constants and what the host supplies, are computed once, by
// `execute`. All others are computed component by component. Every result is bit for bit that of Interpreter.
class WideProgram {
  public:
    // Errors: what Interpreter reports of functions that it does not run, and program-too-large where the calls expand
    // to more than 2^18 instructions. The module must outlive the program and not change.
    static Result<WideProgram> prepare(const Module& module, const Function& function, Diagnostics& diagnostics);

    // Whether it takes derivatives; then quads are to be run whole.
    bool takesDerivatives() const;
    const WideCode& code() const { return *code_; }

  private:
    explicit WideProgram(std::shared_ptr<const WideCode> code) : code_(std::move(code)) {}
    std::shared_ptr<const WideCode> code_;
};

// The registers of one thread.
class WideInterpreter {
  public:
    explicit WideInterpreter(const WideProgram& program, InterpreterOptions options = {});
    ~WideInterpreter();
    WideInterpreter(const WideInterpreter&) = delete;
    WideInterpreter& operator=(const WideInterpreter&) = delete;

    // Runs the lanes of the mask. `arguments` holds the components of the parameters one after the other, `results`
    // has room for those of the results. False after an error, which the diagnostics tell: no-value, step-limit (steps
    // count once for all lanes), needs-quad, non-uniform.
    bool run(LaneMask lanes, std::span<const LaneWords> arguments, std::span<LaneWords> results,
             WideEnvironment& environment, Diagnostics& diagnostics);

    // Instructions of the last run.
    std::uint64_t steps() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shaderx::ir
