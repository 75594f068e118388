// The text form of programs: what the dumps show, and what tests of passes are written in.
//
//     uniform roughness: float = 0.2 "SR_gold/specular_roughness"
//     uniform wood: texture2d "image1/file" file "wood.png" uaddress "clamp" default 0, 0, 0 colorspace "srgb_texture"
//     leaf diffuse_bsdf(weight: float, color: color3)
//     struct light { intensity: float, color: color3 }
//     extern target node "text"
//     # The comment of the function.
//     inline function ramp(nv: float) -> (out: float) {
//         %0 = param float nv
//         %1 = constant float 2
//         %2 "twice" = mul float %0, %1
//         %3 = constant integer 10
//         %4 = loop_arg float loop 0, 1
//         %5 = add float %4, %2
//         %6 = loop tuple loop 0, %3 | %1 | %5
//         %7 = result float %6, 0
//         return %7
//         body {
//             let %2
//             loop %6 {
//                 let %5
//             }
//         }
//     }
//
// An expression is `%number "hint" = operation type` and then, by its operation: of constants the numbers; of params,
// contexts, attributes, uniforms, calls and leaves the name; of swizzles the operand and its components or `column i`;
// of results and members the operand and a number; of loops `loop n`, the count, and after bars the first and the next
// values of what it carries; of all others the operands. A payload that the form of an operation has no words for
// follows as `payload n`. Names stand bare where they read as identifiers, else quoted. Floats are the shortest text
// that reads back the same, or their bits: `0x7fc00001`. A body has `let %e`, `loop %e { }`, and
// `if %c { } else { } -> %s, %t` with the selects that it decides. A line from # on is a comment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "ir/module.h"

namespace shaderx::ir {

// What is printed parses back to the same arenas and prints the same again. Broken functions print too.
std::string print(const Module& module, const Function& function);
// All the module owns, in order; not the functions of its sources.
std::string print(const Module& module);

// One expression as its line, without indent and line end. `operandColumns`, where given, gets the column of each
// operand in it, from 0.
std::string printExpr(const Module& module, const Function& function, ExprId e,
                      std::vector<std::size_t>* operandColumns = nullptr);

// Adds what the text declares to the module and returns its functions in order. Expressions may have any names
// (`%nv`); they are numbered in order. `file` is only named in messages. A function that has errors is not added.
Result<std::vector<Function*>> parse(Module& module, std::string_view file, std::string_view text,
                                     Diagnostics& diagnostics);

}  // namespace shaderx::ir
