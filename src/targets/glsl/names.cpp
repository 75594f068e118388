#include "targets/glsl/names.h"

#include <array>

namespace shaderx::glsl {

using ir::Op;
using ir::Type;

// Keywords and built-in functions of GLSL 1.00 to 4.60 and ESSL (The OpenGL Shading Language 4.60, sections 3.6, 8),
// and what hosts bind.
// clang-format off
static constexpr std::array kWords = std::to_array<std::string_view>({
    "active", "asm", "atomic_uint", "attribute", "bool", "break", "buffer", "bvec2", "bvec3", "bvec4", "case",
    "cast", "centroid", "class", "coherent", "common", "const", "continue", "default", "discard", "dmat2",
    "dmat2x2", "dmat2x3", "dmat2x4", "dmat3", "dmat3x2", "dmat3x3", "dmat3x4", "dmat4", "dmat4x2", "dmat4x3",
    "dmat4x4", "do", "double", "dvec2", "dvec3", "dvec4", "else", "enum", "extern", "external", "false",
    "filter", "fixed", "flat", "float", "for", "fvec2", "fvec3", "fvec4", "goto", "half", "highp", "hvec2",
    "hvec3", "hvec4", "if", "iimage1D", "iimage2D", "iimage3D", "iimageCube", "image1D", "image2D", "image3D",
    "imageBuffer", "imageCube", "in", "inline", "inout", "input", "int", "interface", "invariant", "isampler1D",
    "isampler2D", "isampler3D", "isamplerBuffer", "isamplerCube", "ivec2", "ivec3", "ivec4", "layout", "long",
    "lowp", "mat2", "mat2x2", "mat2x3", "mat2x4", "mat3", "mat3x2", "mat3x3", "mat3x4", "mat4", "mat4x2",
    "mat4x3", "mat4x4", "mediump", "namespace", "noinline", "noperspective", "out", "output", "packed", "partition",
    "patch", "precise", "precision", "public", "readonly", "resource", "restrict", "return", "sample",
    "sampler1D", "sampler2D", "sampler2DArray", "sampler2DRect", "sampler2DShadow", "sampler3D",
    "sampler3DRect", "samplerBuffer", "samplerCube", "shared", "short", "sizeof", "smooth", "static", "struct",
    "subroutine", "superp", "switch", "template", "this", "true", "typedef", "uint", "uniform", "union",
    "unsigned", "usampler1D", "usampler2D", "usampler3D", "using", "uvec2", "uvec3", "uvec4", "varying", "vec2",
    "vec3", "vec4", "void", "volatile", "while", "writeonly", "main", "vd", "VertexData", "PrivateUniforms",
    "PublicUniforms",
    // built-in functions
    "abs", "acos", "acosh", "all", "any", "asin", "asinh", "atan", "atanh", "barrier", "bitCount",
    "bitfieldExtract", "bitfieldInsert", "bitfieldReverse", "ceil", "clamp", "cos", "cosh", "cross", "dFdx",
    "dFdxCoarse", "dFdxFine", "dFdy", "dFdyCoarse", "dFdyFine", "degrees", "determinant", "distance", "dot",
    "equal", "exp", "exp2", "faceforward", "findLSB", "findMSB", "floatBitsToInt", "floatBitsToUint", "floor",
    "fma", "fract", "frexp", "fwidth", "fwidthCoarse", "fwidthFine", "greaterThan", "greaterThanEqual",
    "imageLoad", "imageSize", "imageStore", "imulExtended", "intBitsToFloat", "interpolateAtCentroid",
    "interpolateAtOffset", "interpolateAtSample", "inverse", "inversesqrt", "isinf", "isnan", "ldexp", "length",
    "lessThan", "lessThanEqual", "log", "log2", "matrixCompMult", "max", "min", "mix", "mod", "modf", "noise1",
    "noise2", "noise3", "noise4", "normalize", "not", "notEqual", "outerProduct", "packHalf2x16", "pow",
    "radians", "reflect", "refract", "round", "roundEven", "sign", "sin", "sinh", "smoothstep", "sqrt", "step",
    "tan", "tanh", "texelFetch", "texture", "texture1D", "texture2D", "texture3D", "textureCube",
    "textureGather", "textureGrad", "textureLod", "textureProj", "textureSize", "transpose", "trunc",
    "uintBitsToFloat", "umulExtended", "unpackHalf2x16"});
// clang-format on
static constexpr auto kSlots = text::reservedSlots(kWords);

text::ReservedWords reservedWords() { return {kWords, kSlots}; }

std::string_view typeName(Type type) {
    switch (type) {
        case Type::Void:
            return "void";
        case Type::Boolean:
            return "bool";
        case Type::Integer:
            return "int";
        case Type::Float:
            return "float";
        case Type::Vector2:
            return "vec2";
        case Type::Color3:
        case Type::Vector3:
        case Type::Point:
        case Type::Normal:
            return "vec3";
        case Type::Color4:
        case Type::Vector4:
            return "vec4";
        case Type::Matrix33:
            return "mat3";
        case Type::Matrix44:
            return "mat4";
        case Type::Texture2D:
            return "sampler2D";
        case Type::String:
        case Type::Tuple:
        case Type::BSDF:
        case Type::EDF:
        case Type::VDF:
        case Type::SurfaceShader:
        case Type::DisplacementShader:
        case Type::VolumeShader:
        case Type::LightShader:
        case Type::Material:
        case Type::FirstStruct:
            return {};
    }
    return {};
}

std::string_view functionName(Op op) {
    switch (op) {
        case Op::Atan2:
            return "atan";
        case Op::Ddx:
            return "dFdx";
        case Op::Ddy:
            return "dFdy";
        case Op::TextureLevel:
            return "textureLod";
        case Op::TextureGrad:
            return "textureGrad";
        case Op::Min:
        case Op::Max:
        case Op::Pow:
        case Op::Step:
        case Op::Clamp:
        case Op::Mix:
        case Op::Smoothstep:
        case Op::Abs:
        case Op::Sign:
        case Op::Floor:
        case Op::Ceil:
        case Op::Round:
        case Op::Fract:
        case Op::Exp:
        case Op::Exp2:
        case Op::Log:
        case Op::Log2:
        case Op::Sqrt:
        case Op::InverseSqrt:
        case Op::Sin:
        case Op::Cos:
        case Op::Tan:
        case Op::Asin:
        case Op::Acos:
        case Op::Atan:
        case Op::Radians:
        case Op::Degrees:
        case Op::Dot:
        case Op::Cross:
        case Op::Length:
        case Op::Distance:
        case Op::Normalize:
        case Op::Reflect:
        case Op::Refract:
        case Op::Faceforward:
        case Op::Transpose:
        case Op::Inverse:
        case Op::Determinant:
            return info(op).name;
        default:
            return {};  // operators, composition and what legalise removes
    }
}

Operator operatorOf(Op op) {
    switch (op) {
        case Op::Mul:
        case Op::MulMatrix:
            return {"*", 12};
        case Op::Div:
            return {"/", 12};
        case Op::Mod:
            return {"%", 12};
        case Op::Add:
            return {"+", 11};
        case Op::Sub:
            return {"-", 11};
        case Op::ShiftLeft:
            return {"<<", 10};
        case Op::ShiftRight:
            return {">>", 10};
        case Op::Less:
            return {"<", 9};
        case Op::LessEqual:
            return {"<=", 9};
        case Op::Equal:
            return {"==", 8};
        case Op::NotEqual:
            return {"!=", 8};
        case Op::BitAnd:
            return {"&", 7};
        case Op::BitXor:
            return {"^", 6};
        case Op::BitOr:
            return {"|", 5};
        case Op::And:
            return {"&&", 4};
        case Op::Or:
            return {"||", 3};
        default:
            return {};  // everything that is no operator
    }
}

}  // namespace shaderx::glsl
