#include "ir/types.h"

namespace shaderx::ir {

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
