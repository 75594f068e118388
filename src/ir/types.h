// The types of the IR. A type is one number; the built-in ones are named here, structures follow them
// (Module::structs).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace shaderx::ir {

// MaterialX's types, and point and normal of the shading languages. Three floats are not one type: the role (color,
// vector, point, normal) is kept until a target erases it.
enum class Type : std::uint16_t {
    Void,
    Boolean,
    Integer,
    Float,
    Color3,
    Color4,
    Vector2,
    Vector3,
    Vector4,
    Point,
    Normal,
    Matrix33,
    Matrix44,
    String,     // only ever a constant; gone after `specialise`
    Texture2D,  // an image and how it is read; a MaterialX `filename` input becomes one
    Tuple,      // the results of a call or loop with several; only `result` reads it
    BSDF,       // closures: values until the shade stage
    EDF,
    VDF,
    SurfaceShader,
    DisplacementShader,
    VolumeShader,
    LightShader,
    Material,
    FirstStruct,  // FirstStruct + i is Module::structs[i]
};
constexpr int kBuiltinTypes = static_cast<int>(Type::FirstStruct);

enum class Scalar : std::uint8_t { None, Boolean, Integer, Float };
enum class Role : std::uint8_t { None, Color, Vector, Point, Normal };

struct TypeInfo {
    std::string_view name;  // as MaterialX and the shading language spell it
    Scalar scalar;          // of each component, None for what has none
    std::uint8_t rows;      // components of a column
    std::uint8_t columns;   // above 1 for matrices
    Role role;
};

// clang-format off
inline constexpr TypeInfo kTypes[kBuiltinTypes + 1] = {
    {"void", Scalar::None, 0, 0, Role::None},          {"boolean", Scalar::Boolean, 1, 1, Role::None},
    {"integer", Scalar::Integer, 1, 1, Role::None},    {"float", Scalar::Float, 1, 1, Role::None},
    {"color3", Scalar::Float, 3, 1, Role::Color},      {"color4", Scalar::Float, 4, 1, Role::Color},
    {"vector2", Scalar::Float, 2, 1, Role::Vector},    {"vector3", Scalar::Float, 3, 1, Role::Vector},
    {"vector4", Scalar::Float, 4, 1, Role::Vector},    {"point", Scalar::Float, 3, 1, Role::Point},
    {"normal", Scalar::Float, 3, 1, Role::Normal},     {"matrix33", Scalar::Float, 3, 3, Role::None},
    {"matrix44", Scalar::Float, 4, 4, Role::None},     {"string", Scalar::None, 0, 0, Role::None},
    {"texture2d", Scalar::None, 0, 0, Role::None},     {"tuple", Scalar::None, 0, 0, Role::None},
    {"BSDF", Scalar::None, 0, 0, Role::None},          {"EDF", Scalar::None, 0, 0, Role::None},
    {"VDF", Scalar::None, 0, 0, Role::None},           {"surfaceshader", Scalar::None, 0, 0, Role::None},
    {"displacementshader", Scalar::None, 0, 0, Role::None}, {"volumeshader", Scalar::None, 0, 0, Role::None},
    {"lightshader", Scalar::None, 0, 0, Role::None},   {"material", Scalar::None, 0, 0, Role::None},
    {"struct", Scalar::None, 0, 0, Role::None},
};
// clang-format on

// Structures read as a type without components.
constexpr const TypeInfo& info(Type type) {
    return kTypes[type < Type::FirstStruct ? static_cast<int>(type) : kBuiltinTypes];
}

// The built-in type of a name, or Void where there is none; "color" is color3, "vector" vector3, "int" integer.
Type typeNamed(std::string_view name);

// Numbers in a value of the type: 3 of a color3, 9 of a matrix33, 0 of a closure.
inline constexpr std::array<std::uint8_t, kBuiltinTypes + 1> kComponents = [] {
    std::array<std::uint8_t, kBuiltinTypes + 1> counts{};
    for (std::size_t i = 0; i < counts.size(); i++)
        counts[i] = static_cast<std::uint8_t>(kTypes[i].rows * kTypes[i].columns);
    return counts;
}();
constexpr int componentCount(Type t) { return t < Type::FirstStruct ? kComponents[static_cast<std::size_t>(t)] : 0; }
constexpr bool isStruct(Type t) { return t >= Type::FirstStruct; }
constexpr std::size_t structIndex(Type t) {
    return static_cast<std::size_t>(t) - static_cast<std::size_t>(Type::FirstStruct);
}
constexpr Type structType(std::size_t index) {
    return static_cast<Type>(static_cast<std::size_t>(Type::FirstStruct) + index);
}
inline bool isClosure(Type t) { return t >= Type::BSDF && t <= Type::Material; }
inline bool isShader(Type t) { return t >= Type::SurfaceShader && t <= Type::LightShader; }
inline bool isScalar(Type t) { return componentCount(t) == 1; }
inline bool isMatrix(Type t) { return t == Type::Matrix33 || t == Type::Matrix44; }
inline bool isVector(Type t) { return componentCount(t) > 1 && !isMatrix(t); }
inline bool isFloatVector(Type t) { return isVector(t) && info(t).scalar == Scalar::Float; }
inline bool isNumeric(Type t) { return info(t).scalar == Scalar::Float || info(t).scalar == Scalar::Integer; }

// The vector type of n floats (1 gives Float); the role Color where asked for and n allows it.
Type floatVector(int n, Role role = Role::Vector);

}  // namespace shaderx::ir
