// How the text form writes what an operation says beside its operands; shared by its printer and its parser.
#pragma once

#include "ir/ops.h"

namespace shaderx::ir {

enum class TextForm : std::uint8_t {
    Constant,  // numbers or a string
    Param,     // name
    Context,   // name
    Named,     // name, then the operands
    Swizzle,   // operand, components
    Numbered,  // operand, number
    LoopArg,   // loop n, number
    Loop,      // loop n, operands with bars
    Extern,    // number, then the operands
    Plain,     // operands
};

inline TextForm textForm(Op op) {
    switch (op) {
        case Op::Constant:
            return TextForm::Constant;
        case Op::Param:
            return TextForm::Param;
        case Op::Context:
            return TextForm::Context;
        case Op::Attribute:
        case Op::Uniform:
        case Op::Call:
        case Op::Leaf:
            return TextForm::Named;
        case Op::Swizzle:
            return TextForm::Swizzle;
        case Op::Member:
        case Op::Result:
            return TextForm::Numbered;
        case Op::LoopArg:
            return TextForm::LoopArg;
        case Op::Loop:
        case Op::Lights:
            return TextForm::Loop;
        case Op::ExternText:
            return TextForm::Extern;
        case Op::GeomProp:
        case Op::Neg:
        case Op::Add:
        case Op::Sub:
        case Op::Mul:
        case Op::Div:
        case Op::Mod:
        case Op::Min:
        case Op::Max:
        case Op::Pow:
        case Op::Atan2:
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
        case Op::MulMatrix:
        case Op::Transpose:
        case Op::Inverse:
        case Op::Determinant:
        case Op::BitAnd:
        case Op::BitOr:
        case Op::BitXor:
        case Op::BitNot:
        case Op::ShiftLeft:
        case Op::ShiftRight:
        case Op::ShiftRightLogical:
        case Op::Equal:
        case Op::NotEqual:
        case Op::Less:
        case Op::LessEqual:
        case Op::And:
        case Op::Or:
        case Op::Not:
        case Op::Known:
        case Op::Select:
        case Op::Make:
        case Op::Convert:
        case Op::Retype:
        case Op::Index:
        case Op::TextureLevel:
        case Op::TextureGrad:
        case Op::TextureSize:
        case Op::Ddx:
        case Op::Ddy:
        case Op::ClosureMix:
        case Op::ClosureAdd:
        case Op::ClosureScale:
        case Op::ClosureLayer:
        case Op::Surface:
        case Op::SurfaceUnlit:
        case Op::Volume:
        case Op::Displacement:
            return TextForm::Plain;
    }
    return TextForm::Plain;
}

}  // namespace shaderx::ir
