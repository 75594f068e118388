// GLSL 4.00 for a rasteriser: a vertex and a pixel stage that hosts bind by the names of the white paper's Figure 7.
#pragma once

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "ir/module.h"
#include "passes/stages.h"
#include "targets/text/function_texts.h"

namespace shaderx::glsl {

// Rewrites a function into what the language can say: scalars are spread over vectors where its built-in functions take
// no scalar, roles of vectors are dropped, `known` is false. To be followed by `place`.
void legalise(ir::Function& function);

struct Sources {
    std::string vertex, pixel;
    // How the texts spell what hosts bind: uniforms and vertex inputs, by their names in the module.
    std::unordered_map<Name, std::string> names;
    std::string output;  // of the pixel stage
    // Parts of the pixel text, first and past the last byte, that are no code: the title, and defaults of live values.
    std::vector<std::pair<std::size_t, std::size_t>> apart;
};

// Prints a legalised and placed module. What it cannot print is an internal error: that is the work of legalise.
// `title` becomes the first comment of the pixel stage. `texts` has what was printed of other programs; it changes no
// byte.
Sources print(const ir::Module& module, const passes::ShaderInterface& interface, std::string_view title,
              text::FunctionTexts* texts = nullptr);

}  // namespace shaderx::glsl
