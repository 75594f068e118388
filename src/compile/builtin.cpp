#include "compile/compile.h"

extern "C" const std::uint8_t shaderx_builtin_library[];
extern "C" const std::uint8_t shaderx_builtin_library_end[];

namespace shaderx {

std::span<const std::uint8_t> builtinLibrary() { return {shaderx_builtin_library, shaderx_builtin_library_end}; }

}  // namespace shaderx
