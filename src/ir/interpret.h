// Runs functions of the IR: the oracle that says what every target's code must compute.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "base/diagnostics.h"
#include "ir/evaluate.h"
#include "ir/module.h"

namespace shaderx::ir {

// Which image; None where the document names no file.
struct TextureRef {
    enum class Kind : std::uint8_t { Uniform, Context, None };
    Kind kind = Kind::None;
    Name uniform;
    Context context = {};
};
// As an argument of a function.
Value textureValue(const TextureRef& texture);

// A read at a place, with an explicit level of detail (0 is the largest) or with the change of the place by pixel.
struct TextureRead {
    TextureRef texture;
    float uv[2] = {};
    bool hasGradients = false;
    float level = 0;
    float ddx[2] = {}, ddy[2] = {};
};

// What a program asks of the world. `value` comes with its type set and takes the words. False where there is no
// answer, which ends the run with an error; a uniform without one has its value in the module.
struct Environment {
    virtual ~Environment() = default;
    virtual bool context(Context, Value&) { return false; }
    virtual bool attribute(Name, Value&) { return false; }
    virtual bool uniform(Name, Value&) { return false; }
    virtual bool texture(const TextureRead&, Value&) { return false; }
    // Width and height of level 0, in pixels.
    virtual bool textureSize(const TextureRef&, Value&) { return false; }
};

struct InterpreterOptions {
    std::uint64_t maxSteps = 100'000'000;  // instructions of one run of one pixel
    std::uint32_t maxDepth = 200;          // calls within calls
};

// Each function is translated once, to instructions over a frame of registers: what only one side of a select needs
// stands in that side's branch, what does not change in a loop stands before it (even where the loop's body needs it
// under a condition only). The module must not change while an interpreter of it lives. Not thread-safe.
//
// Values follow ops.h, with NaN and infinities as IEEE has them. `known` is false unless its operand is a constant.
// Strings, closures, structures and texts in a target's language are refused.
class Interpreter {
  public:
    Interpreter(const Module& module, Diagnostics& diagnostics, InterpreterOptions options = {});
    ~Interpreter();
    Interpreter(const Interpreter&) = delete;
    Interpreter& operator=(const Interpreter&) = delete;

    // Runs a function of the module (or of its sources) for one value of each parameter and gives each of its results.
    // False after an error, which the diagnostics tell. Derivatives need a quad.
    bool run(const Function& function, std::span<const Value> arguments, std::span<Value> results,
             Environment& environment);

    // Runs it for the four pixels (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1). Arguments and results of pixel i
    // start at i times their count. A derivative is the difference within its row or column of the quad; all four
    // pixels must reach it by the same way.
    bool runQuad(const Function& function, std::span<const Value> arguments, std::span<Value> results,
                 std::span<Environment* const> environments);

    // Instructions of the last run, of all its pixels.
    std::uint64_t steps() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shaderx::ir
