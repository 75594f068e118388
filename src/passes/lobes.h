// Why a material has the lobes that it has.
#pragma once

#include <string>
#include <vector>

#include "ir/module.h"

namespace shaderx::passes {

// A value of the document that decides something.
struct Decision {
    std::string path;  // as Uniform::path
    std::string value;
};

// What takes a lobe away: an expression that by the values of the document is 0, or 1, or a truth.
struct Removal {
    enum class Kind : std::uint8_t {
        Weight,     // it multiplies the lobe, and is 0
        Mix,        // it gives everything to the other side
        Condition,  // it chooses the other side
        Volume,     // nothing decides: a volume is not drawn on rasters
    };
    Kind kind = Kind::Weight;
    std::string expression, value;
    std::vector<Decision> inputs;  // why it has that value; the expression itself where that is one of them
};

struct Lobe {
    std::string node;  // of the document, by its path
    std::string name;  // of the closure in there
    std::string leaf;  // what kind of closure it is: "dielectric_bsdf"
    bool remains = false;
    // How much of it the material has: a formula over values of the document and what passes through layers above,
    // "passed(coat)"; and its value where values of the document alone decide it.
    std::string weight, value;
    std::vector<Removal> removals;  // where it does not remain
};

// The lobes of the module's function `entry`, whose one result is a closure, from the outermost inwards. All values of
// the document are uniforms of it, so that nothing is removed yet, and its origins are told.
std::vector<Lobe> lobesOf(const ir::Module& module, Name entry);

}  // namespace shaderx::passes
