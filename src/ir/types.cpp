#include "ir/types.h"

namespace shaderx::ir {

// clang-format off
static constexpr TypeInfo kTypes[kBuiltinTypes] = {
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
};
// clang-format on
static constexpr TypeInfo kStruct = {"struct", Scalar::None, 0, 0, Role::None};

const TypeInfo& info(Type type) { return type < Type::FirstStruct ? kTypes[static_cast<int>(type)] : kStruct; }

Type typeNamed(std::string_view name) {
    for (int i = 1; i < kBuiltinTypes; i++)
        if (kTypes[i].name == name) return static_cast<Type>(i);
    if (name == "color") return Type::Color3;
    if (name == "vector") return Type::Vector3;
    if (name == "int") return Type::Integer;
    if (name == "bool") return Type::Boolean;
    if (name == "filename") return Type::Texture2D;
    return Type::Void;
}

Type floatVector(int n, Role role) {
    if (n == 2) return Type::Vector2;
    if (n == 3) {
        switch (role) {
            case Role::Color:
                return Type::Color3;
            case Role::Point:
                return Type::Point;
            case Role::Normal:
                return Type::Normal;
            case Role::None:
            case Role::Vector:
                return Type::Vector3;
        }
    }
    if (n == 4) return role == Role::Color ? Type::Color4 : Type::Vector4;
    return Type::Float;
}

}  // namespace shaderx::ir
