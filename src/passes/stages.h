// The interface of a shader: which values the host supplies, which travel from the vertex to the pixel.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ir/module.h"

namespace shaderx::passes {

// A value that the vertex stage hands to the pixel stage, interpolated.
struct Varying {
    Name name;  // of the member of the block VertexData
    ir::Type type;
};

// A geometric input of the vertex stage.
struct VertexInput {
    Name name;  // as hosts bind it: i_normal, i_texcoord_0
    ir::Type type;
    std::vector<std::uint32_t> value =
        {};  // what it is where a mesh lacks it, by its bits; empty where nothing says so
};

// What one stage reads from the host. Contexts in the order of context.def; uniforms in that of the module.
struct StageUniforms {
    std::vector<ir::Context> contexts;  // uniforms and textures
    std::vector<Name> uniforms;         // of Module::uniforms
};

struct ShaderInterface {
    Name vertex, pixel;  // the entry functions
    StageUniforms vertexUniforms, pixelUniforms;
    std::vector<VertexInput> inputs;
    std::vector<Varying> varyings;
    // How the host supplies uniforms: one by one, or in the blocks PrivateUniforms (what both stages read of the
    // contexts) and PublicUniforms (values of the document), textures apart.
    bool usesBlocks = false;
    int bindingBase = -1;  // of the blocks in that order and then the textures, numbered on; below 0 without numbers
};

// Collects what the module's entry `pixel` reads and adds the function `vertex`, whose first result is the clip-space
// position and whose others are the varyings in their order. Positions, normals and tangents are in world space, y up;
// normals go by the inverse transpose of the world matrix; the bitangent is cross(N, T). Attributes pass through.
// Whatever a function holds counts as read, so that they are to be compact, as `prune` leaves them.
ShaderInterface makeStages(ir::Module& module, Name pixel, Name vertex);

// Contexts that a uniform block holds: those of either stage, in the order of context.def.
std::vector<ir::Context> blockContexts(const ShaderInterface& interface);
// Uniforms that a block holds, in their order; textures are none.
std::vector<Name> blockUniforms(const ir::Module& module, const ShaderInterface& interface);

// Where a member of a uniform block stands in bytes, by the rules of std140 (OpenGL 4.6, section 7.6.2.2); `end` is
// where the members before it end, and then where this one does.
std::uint32_t placeMember(ir::Type type, std::uint32_t& end);

// The value that the host's variable has until it is set, by its bits; empty for textures.
std::vector<std::uint32_t> defaultOf(ir::Context c);

// Attributes in the IR have a name ("texcoord_0"); the vertex stage reads them as inputs of the name i_texcoord_0.
std::string inputName(std::string_view attribute);

}  // namespace shaderx::passes
