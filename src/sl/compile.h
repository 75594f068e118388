// The portable shading language: functions and inline expressions to IR.
//
// The language has the syntax of OSL's functions and the types of MaterialX: `float f(vector a, int n)`, or
// `void f(color a, output color b, output float c)`. All is by value and pure; recursion, arrays, structures and loops
// whose count is not known before they start do not exist. Float and color, vector and matrix arithmetic is
// componentwise, `*` of a matrix with a vector or a matrix is the product, integers become floats and numbers vectors
// where those are wanted, point, normal and vector mix; colors and vectors become each other by name only
// (`color(v)`). What the operations do is written in ir/ops.h.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "ir/module.h"

namespace shaderx::sl {

struct SourceFile {
    std::string name;
    std::string_view text;
};

// What a call needs to know of a function. A call gives `params` and then `outputs` in order. As IR the function has
// the parameters `params` and the results `out` (unless `result` is Void) and `outputs`.
struct Signature {
    Name name;       // in the IR: the plain name, or name__float_color3 where the plain name has several functions
    Name plainName;  // in the source
    ir::Type result = ir::Type::Void;
    std::vector<ir::Param> params, outputs;
};

// Compiles all functions of all files into `module`; each may call every other, and those `known` from libraries (their
// bodies are asked from the module only to learn whether they expand). Constants are visible in all files, one of the
// own file first. Every error of every file is reported, located; false if there was any, and the module is left as it
// was. `made` receives the signatures in the order of the sources.
//
// A function is inline where the source says so, and where its body is one expression of at most eight operations
// without loops and without calls to functions that are not inline.
bool compile(ir::Module& module, std::span<const SourceFile> files, const std::vector<Signature>& known,
             std::vector<Signature>& made, Diagnostics& diagnostics);

// Compiles an expression such as `{{in1}} + {{in2}}` into the inline function `name`. {{x}} is the parameter x,
// whatever its name; a plain x works where it is no word of the language. The value converts to the result as an
// argument would. Where there are several results, as many expressions stand with commas between them. False if there
// was an error.
bool compileInline(ir::Module& module, Name name, std::span<const ir::Param> params, std::span<const ir::Param> results,
                   const SourceFile& text, const std::vector<Signature>& known, Diagnostics& diagnostics);

}  // namespace shaderx::sl
