// From closures to light: a material becomes a list of weighted lobes, and these the colour of a pixel.
#pragma once

#include "base/diagnostics.h"
#include "ir/module.h"

namespace shaderx::passes {

struct ShadeOptions {
    // What a leaf's function gives counts as needed only where the leaf's weight is not 0, if the function leads to a
    // loop: a select says so, whose condition is called as the leaf is (see gather.h).
    bool skipsUnused = false;
    bool environment = true;    // whether the environment lights what is drawn
    bool transparency = false;  // whether alpha says how much of a surface is there
};

// Rewrites the module's function `entry`, whose one result is a surface shader, a closure or a value, into the function
// of a pixel: its one result is a vector4 named `output`, linear radiance and alpha.
//
// Closure trees are linear, so they flatten: every leaf ends up with one weight, the product of what stands above it,
// summed over all ways to it. mix(bg, fg, t) weighs 1 - t and t; layer(top, base) weighs the base by what the top lets
// through, where a leaf lets through 1 - weight · albedo, layers multiply, mix interpolates, add gives
// max(a + b - 1, 0), and a scale keeps it. Leaves that differ only in weight are one.
//
// A leaf NAME brings functions NAME_environment (BSDFs) and NAME_emission (EDFs), whose parameters are bound by name:
// to the inputs of its node, to N (unit normal on the viewer's side), V (unit, to the viewer) and X (unit tangent).
// Leaves are called with unit weight. The environment's light is multiplied by environment_intensity, all light by
// opacity. A leaf without functions is an error; a volume below a surface is a warning.
//
// Without transparency alpha is 1. With it, alpha is 1 - 0.3333 (t.r + t.g + t.b), t being what a surface lets
// through, and a second result `discarded`, a boolean, says where alpha is below alpha_threshold.
//
// Values become colours: float, integer and boolean (v, v, v, 1), vector2 (v, 0, 1), three components (v, 1), four as
// they are, matrices (0, 0, 0, 1).
bool shade(ir::Module& module, Name entry, Name output, const ShadeOptions& options, Diagnostics& diagnostics);

}  // namespace shaderx::passes
