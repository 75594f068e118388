// Tokens to a syntax tree. What one dialect writes differently from another ends here.
#pragma once

#include <string_view>

#include "base/names.h"
#include "sl/ast.h"
#include "sl/report.h"

namespace shaderx::sl {

// Parses functions and constants in OSL's syntax. Errors are reported, the rest is parsed on; a function whose body has
// errors stays in the tree, marked. Nesting is limited to 256 levels.
Tree parseFunctions(std::string_view text, NameTable& names, Reporter& report);

// Parses `count` expressions with commas between them, in which {{name}} names a parameter.
Tree parseInlineText(std::string_view text, std::size_t count, NameTable& names, Reporter& report);

// The type that the shading language calls so, else Void.
Type typeCalled(std::string_view name);

}  // namespace shaderx::sl
