// Expressions as formulas, for people.
#pragma once

#include <string>
#include <vector>

#include "ir/evaluate.h"
#include "ir/module.h"

namespace shaderx::passes {

// A formula over the paths of the document's values: "SR_gold/base * (1 - SR_gold/metalness)". What would be long is
// called by its name, or "…" where it has none. Binds at least as tightly as `precedence`: 1 sums, 2 products, 3 names.
std::string formula(const ir::Module& module, const ir::Function& f, ir::ExprId e, int precedence = 0);

// A known value: "0.5", "(1, 0, 0)", "true"; one number where all components are it.
std::string textOf(const ir::Value& value);

}  // namespace shaderx::passes
