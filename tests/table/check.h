// Compares functions between the interpreter and the driver.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "ir/interpret.h"
#include "table/float_pass.h"

namespace shaderx::table {

constexpr int kWidth = 32, kHeight = 2;  // pixels: each has inputs of its own, every 2 x 2 of them are a quad
constexpr int kPixels = kWidth * kHeight;

// Where a parameter's numbers come from: a range, and values of special interest within or outside of it.
struct Domain {
    float low = -2, high = 2;
    std::vector<float> edges = {0, -0.0f, 1};
    float cone = 0;             // a direction: this far from z at most (1 is 45 degrees)
    bool isAnyInteger = false;  // an integer of 32 random bits
};

// By their bits: NaN is an edge like any other.
bool isSame(const Domain& a, const Domain& b);

// A function under test. Its parameters are numbers and textures, its results numbers.
struct Subject {
    std::string name;    // for messages
    std::string covers;  // the operation or function that it tests
    Name function;
    std::vector<Domain> domains;  // by parameter
    // Whether the semantics define a component of the result for these arguments; null: wherever the interpreter's is
    // finite.
    std::function<bool(std::span<const ir::Value>, int component)> isDefined = {};
    // Results may be NaN where an argument is (the result of `min` of a NaN is either operand): NaN always passes.
    bool mayGiveNan = false;
    double tolerance = 0;  // relative, absolute below 1; 0: by the operations that it has
};

struct Outcome {
    std::size_t compared = 0, undefined = 0;  // results of pixels
    std::string failure;                      // the first one, empty where all agree
};

class Checker {
  public:
    // The subjects' functions, and all that they call, are found in `program`.
    Checker(ir::Module& program, FloatPass& pass);
    ~Checker();

    // An outcome for each subject, in their order.
    std::vector<Outcome> check(const std::vector<Subject>& subjects);

    std::size_t shaders() const;   // that the driver has compiled
    double driverSeconds() const;  // compiling and drawing
    double interpreterSeconds() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// Whether a function, or one that it calls, has an operation that the test accepts.
bool anyOperation(const ir::Module& module, const ir::Function& f,
                  const std::function<bool(const ir::Function&, const ir::Expr&)>& test);

}  // namespace shaderx::table
