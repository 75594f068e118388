// Everything that must hold of a valid document.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "graph/lower.h"

namespace shaderx::fuzz {

using graph::Interface;

// The interfaces take turns.
inline Interface interfaceFor(std::uint32_t seed) {
    return seed % 4 == 3 ? Interface::Complete : seed % 2 ? Interface::Baked : Interface::Live;
}

struct Verdict {
    std::string failure;  // the first one, empty where all is well
    // Components of pixels that were compared with the driver's, and those where what is undefined shows or a step is
    // crossed by rounding, so that any value is right.
    std::size_t compared = 0, excused = 0;
};

// Has a document generate every element, live and baked, and checks that its texts pass the reference compiler and
// link, that the driver draws one of them, as `drawBaked` says, as the interpreter says it must look, and that both
// interfaces look alike.
//
// How pictures are compared: the interpreter runs a program several times with random rounding (wobble.h). Where the
// runs lie within 2 % of each other they must enclose the driver's value, with as much again on both sides and 2e-5
// more (1e-3 where reflections are sampled: which level of detail a sample has depends on functions that drivers
// approximate); else the component is excused, and counted. Before a value counts as wrong, 60 more runs are made. The
// two interfaces are compared likewise, with 5 % where reflections are sampled: their few samples need not be the same,
// and only many have to agree.
class DocumentChecker {
  public:
    // Draws with the machine's driver where there is one.
    DocumentChecker();
    ~DocumentChecker();
    bool hasDriver() const;
    // Files that documents may name.
    const std::vector<std::string>& pictures() const;

    Verdict check(const std::string& text, Interface drawn);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace shaderx::fuzz
