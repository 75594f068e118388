// The functions of the language itself.
#include <algorithm>

#include "sl/lower_state.h"

namespace shaderx::sl {

// By name.
constexpr Builtin kBuiltins[] = {
    {"Dx", 1, Shape::Derivative, Op::Ddx, "Dx(value)"},
    {"Dy", 1, Shape::Derivative, Op::Ddy, "Dy(value)"},
    {"abs", 1, Shape::Numbers, Op::Abs, "abs(x)"},
    {"acos", 1, Shape::Floats, Op::Acos, "acos(x)"},
    {"asin", 1, Shape::Floats, Op::Asin, "asin(x)"},
    {"atan", 1, Shape::Floats, Op::Atan, "atan(x) or atan(y, x)"},
    {"atan", 2, Shape::Floats, Op::Atan2, "atan(x) or atan(y, x)"},
    {"atan2", 2, Shape::Floats, Op::Atan2, "atan2(y, x)"},
    {"ceil", 1, Shape::Floats, Op::Ceil, "ceil(x)"},
    {"clamp", 3, Shape::Numbers, Op::Clamp, "clamp(x, low, high)"},
    {"cos", 1, Shape::Floats, Op::Cos, "cos(x)"},
    {"cross", 2, Shape::Cross, Op::Cross, "cross(vector, vector)"},
    {"degrees", 1, Shape::Floats, Op::Degrees, "degrees(x)"},
    {"determinant", 1, Shape::Determinant, Op::Determinant, "determinant(matrix)"},
    {"displacement", 2, Shape::Displacement, Op::Displacement, "displacement(float or vector offset, float scale)"},
    {"distance", 2, Shape::Distance, Op::Distance, "distance(a, b) of two vectors of one size"},
    {"dot", 2, Shape::Dot, Op::Dot, "dot(a, b) of two vectors of one kind and size"},
    {"exp", 1, Shape::Floats, Op::Exp, "exp(x)"},
    {"exp2", 1, Shape::Floats, Op::Exp2, "exp2(x)"},
    {"faceforward", 3, Shape::Directions, Op::Faceforward, "faceforward(N, I, Nref)"},
    {"floor", 1, Shape::Floats, Op::Floor, "floor(x)"},
    {"fract", 1, Shape::Floats, Op::Fract, "fract(x)"},
    {"inverse", 1, Shape::Matrix, Op::Inverse, "inverse(matrix)"},
    {"inversesqrt", 1, Shape::Floats, Op::InverseSqrt, "inversesqrt(x)"},
    {"known", 1, Shape::Known, Op::Known, "known(boolean)"},
    {"layer", 2, Shape::Layer, Op::ClosureLayer, "layer(BSDF top, BSDF or VDF base)"},
    {"length", 1, Shape::Length, Op::Length, "length(vector)"},
    {"log", 1, Shape::Floats, Op::Log, "log(x)"},
    {"log2", 1, Shape::Floats, Op::Log2, "log2(x)"},
    {"max", 2, Shape::Numbers, Op::Max, "max(a, b)"},
    {"min", 2, Shape::Numbers, Op::Min, "min(a, b)"},
    {"mix", 3, Shape::Mix, Op::Mix, "mix(a, b, weight of b)"},
    {"mod", 2, Shape::Floats, Op::Mod, "mod(a, b)"},
    {"normalize", 1, Shape::Normalize, Op::Normalize, "normalize(vector)"},
    {"pow", 2, Shape::Floats, Op::Pow, "pow(x, exponent)"},
    {"radians", 1, Shape::Floats, Op::Radians, "radians(x)"},
    {"reflect", 2, Shape::Directions, Op::Reflect, "reflect(I, N)"},
    {"refract", 3, Shape::Directions, Op::Refract, "refract(I, N, float eta)"},
    {"round", 1, Shape::Floats, Op::Round, "round(x)"},
    {"sign", 1, Shape::Numbers, Op::Sign, "sign(x)"},
    {"sin", 1, Shape::Floats, Op::Sin, "sin(x)"},
    {"smoothstep", 3, Shape::Floats, Op::Smoothstep, "smoothstep(low, high, x)"},
    {"sqrt", 1, Shape::Floats, Op::Sqrt, "sqrt(x)"},
    {"step", 2, Shape::Floats, Op::Step, "step(edge, x)"},
    {"surface", 4, Shape::Surface, Op::Surface, "surface(BSDF, EDF, float opacity, boolean thin_walled)"},
    {"surface_unlit", 3, Shape::SurfaceUnlit, Op::SurfaceUnlit,
     "surface_unlit(color emission, color transmission, float opacity)"},
    {"tan", 1, Shape::Floats, Op::Tan, "tan(x)"},
    {"texture", 2, Shape::Texture, Op::TextureGrad, "texture(texture2d, vector2 uv)"},
    {"texture_grad", 4, Shape::TextureGrad, Op::TextureGrad,
     "texture_grad(texture2d, vector2 uv, vector2 dx, vector2 dy)"},
    {"texture_level", 3, Shape::TextureLevel, Op::TextureLevel, "texture_level(texture2d, vector2 uv, float level)"},
    {"texture_size", 1, Shape::TextureSize, Op::TextureSize, "texture_size(texture2d)"},
    {"transpose", 1, Shape::Matrix, Op::Transpose, "transpose(matrix)"},
    {"volume", 2, Shape::Volume, Op::Volume, "volume(VDF, EDF)"},
};

std::span<const Builtin> builtinsCalled(std::string_view name) {
    auto range =
        std::equal_range(std::begin(kBuiltins), std::end(kBuiltins), Builtin{name, 0, Shape::Numbers, Op::Add, {}},
                         [](const Builtin& x, const Builtin& y) { return x.name < y.name; });
    return std::span<const Builtin>(range.first, range.second);
}

std::vector<std::string_view> builtinNames() {
    std::vector<std::string_view> names{"attribute", "geomprop"};
    for (const Builtin& f : kBuiltins) names.push_back(f.name);
    return names;
}

// False, with nothing said, where a value does not convert.
bool Lowering::convertAll(std::span<ExprId> values, std::initializer_list<Type> types) {
    for (std::size_t k = 0; k < types.size(); k++) {
        Type to = types.begin()[k];
        if (conversionRank(b.type(values[k]), to) < 0) return false;
        values[k] = b.convert(values[k], to);
    }
    return true;
}

// None where the arguments, whose number is right, do not fit.
ExprId Lowering::builtin(const Builtin& f, const std::vector<ExprId>& args) {
    switch (f.shape) {
        case Shape::Numbers:
        case Shape::Floats:
        case Shape::Derivative:
            return builtinComponentwise(f, args);
        case Shape::Mix:
            return ir::isClosure(b.type(args[0])) ? builtinClosure(f, args) : builtinComponentwise(f, args);
        case Shape::Dot:
        case Shape::Cross:
        case Shape::Length:
        case Shape::Distance:
        case Shape::Normalize:
        case Shape::Directions:
            return builtinGeometry(f, args);
        case Shape::Matrix:
        case Shape::Determinant:
            return ir::isMatrix(b.type(args[0])) ? b.op(f.op, {args[0]}) : ExprId();
        case Shape::TextureLevel:
        case Shape::TextureGrad:
        case Shape::Texture:
        case Shape::TextureSize:
            return builtinTexture(f, args);
        case Shape::Known:
            return b.type(args[0]) == Type::Boolean ? b.op(Op::Known, {args[0]}) : ExprId();
        case Shape::Layer:
        case Shape::Surface:
        case Shape::SurfaceUnlit:
        case Shape::Volume:
        case Shape::Displacement:
            return builtinClosure(f, args);
    }
    return {};
}

ExprId Lowering::builtinComponentwise(const Builtin& f, const std::vector<ExprId>& args) {
    Type type = b.type(args[0]);
    for (ExprId a : args) {
        if (!ir::isNumeric(b.type(a)) || ir::isMatrix(b.type(a))) return {};
        type = meet(type, b.type(a));
        if (type == Type::Void) return {};
    }
    if (type == Type::Integer && f.shape != Shape::Numbers) type = Type::Float;
    return componentwise(f.op, type, args);
}

ExprId Lowering::builtinGeometry(const Builtin& f, const std::vector<ExprId>& args) {
    bool isRefract = f.op == Op::Refract;
    std::size_t vectors = isRefract ? 2 : args.size();
    Type type = b.type(args[0]);
    ExprId values[3];
    for (std::size_t k = 0; k < args.size(); k++) {
        values[k] = args[k];
        if (k >= vectors) continue;
        if (!ir::isFloatVector(b.type(args[k]))) return {};
        type = meet(type, b.type(args[k]));
        if (type == Type::Void) return {};
    }
    bool isDirection = f.shape == Shape::Cross || f.shape == Shape::Directions;
    if (isDirection && type == Type::Point) type = Type::Vector3;
    if (f.shape == Shape::Cross && !isGeometric(type)) return {};
    if (isDirection && ir::info(type).role == ir::Role::Color) return {};
    for (std::size_t k = 0; k < vectors; k++) values[k] = b.convert(values[k], type);
    if (isRefract && !convertAll(std::span(values + 2, 1), {Type::Float})) return {};
    bool isNumber = f.shape == Shape::Dot || f.shape == Shape::Length || f.shape == Shape::Distance;
    return b.emit(f.op, isNumber ? Type::Float : type, std::span<const ExprId>(values, args.size()));
}

ExprId Lowering::builtinTexture(const Builtin& f, const std::vector<ExprId>& args) {
    std::vector<ExprId> values = args;
    if (f.shape == Shape::TextureSize)
        return convertAll(values, {Type::Texture2D}) ? b.emit(f.op, Type::Vector2, values) : ExprId();
    bool fits = f.shape == Shape::TextureLevel ? convertAll(values, {Type::Texture2D, Type::Vector2, Type::Float})
                : f.shape == Shape::Texture
                    ? convertAll(values, {Type::Texture2D, Type::Vector2})
                    : convertAll(values, {Type::Texture2D, Type::Vector2, Type::Vector2, Type::Vector2});
    if (!fits) return {};
    if (f.shape == Shape::Texture) {
        values.push_back(b.op(Op::Ddx, {values[1]}));
        values.push_back(b.op(Op::Ddy, {values[1]}));
    }
    return b.emit(f.op, Type::Color4, values);
}

ExprId Lowering::builtinClosure(const Builtin& f, const std::vector<ExprId>& args) {
    std::vector<ExprId> values = args;
    Type first = b.type(args[0]);
    if (f.shape == Shape::Mix)
        return convertAll(values, {first, first, Type::Float}) ? b.emit(Op::ClosureMix, first, values) : ExprId();
    if (f.shape == Shape::Layer) {
        Type base = b.type(args[1]) == Type::VDF ? Type::VDF : Type::BSDF;
        return convertAll(values, {Type::BSDF, base}) ? b.emit(f.op, Type::BSDF, values) : ExprId();
    }
    if (f.shape == Shape::Surface)
        return convertAll(values, {Type::BSDF, Type::EDF, Type::Float, Type::Boolean})
                   ? b.emit(f.op, Type::SurfaceShader, values)
                   : ExprId();
    if (f.shape == Shape::SurfaceUnlit) {
        if (!convertAll(values, {Type::Color3, Type::Color3, Type::Float})) return {};
        values.push_back(b.boolean(false));  // the operation has a fourth operand, which means nothing
        return b.emit(f.op, Type::SurfaceShader, values);
    }
    if (f.shape == Shape::Volume)
        return convertAll(values, {Type::VDF, Type::EDF}) ? b.emit(f.op, Type::VolumeShader, values) : ExprId();
    Type offset = first == Type::Float || first == Type::Integer ? Type::Float : Type::Vector3;
    return convertAll(values, {offset, Type::Float}) ? b.emit(f.op, Type::DisplacementShader, values) : ExprId();
}

}  // namespace shaderx::sl
