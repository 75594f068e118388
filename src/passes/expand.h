// Functions that are not worth a call expand where they are called.
#pragma once

#include "ir/module.h"

namespace shaderx::passes {

// Expands in the module's function `entry` what leads to a function that holds a loop or reads an image, up to that
// function: so all calls of such functions stand in the entry, where equal ones are one and others may be gathered
// (see gather.h).
void expandToLongWork(ir::Module& module, Name entry);

// Expands short functions that one place alone calls, in all that the entry reaches: their text would be longer than
// the work they stand for. All functions that the entry reaches are the module's own.
void expandCalledOnce(ir::Module& module, Name entry);

}  // namespace shaderx::passes
