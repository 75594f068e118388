#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "base/diagnostics.h"
#include "base/numbers.h"
#include "targets/glsl/names.h"
#include "targets/glsl/printer.h"

namespace shaderx::glsl {

using namespace ir;

static constexpr int kPostfix = 15, kUnary = 14, kTernary = 1;

// Whether the bits of a float are those of a number of few digits without a fraction, other than -0.
static bool isWhole(std::uint32_t word) {
    const float value = std::bit_cast<float>(word);
    return value == std::trunc(value) && std::abs(value) < 1e6f && word != 0x80000000u;
}

static void writeNumber(std::string& to, Scalar scalar, std::uint32_t word) {
    char text[kFloatText];
    switch (scalar) {
        case Scalar::Boolean:
            to += word ? "true" : "false";
            return;
        case Scalar::Integer:
            // The lowest integer has no literal of its own.
            if (word == 0x80000000u)
                to += "(-2147483647 - 1)";
            else
                to.append(text, std::to_chars(text, std::end(text), static_cast<int>(word)).ptr);
            return;
        case Scalar::Float: {
            const float value = std::bit_cast<float>(word);
            if (!std::isfinite(value)) {
                to += std::isnan(value) ? "uintBitsToFloat(0x7fc00000u)"
                      : value > 0       ? "uintBitsToFloat(0x7f800000u)"
                                        : "uintBitsToFloat(0xff800000u)";
                return;
            }
            const bool whole = isWhole(word);
            char* end =
                whole ? std::to_chars(text, std::end(text), static_cast<int>(value)).ptr : writeFloat(text, value);
            to.append(text, end);
            if (whole || std::string_view(text, end).find_first_of(".e") == std::string_view::npos) to += ".0";
            return;
        }
        case Scalar::None:
            break;
    }
    internalError("a constant without components");
}

void writeConstant(std::string& to, Type type, const std::uint32_t* words) {
    const Scalar scalar = info(type).scalar;
    const int n = componentCount(type);
    if (n == 1) return writeNumber(to, scalar, words[0]);
    bool same = !isMatrix(type) && std::all_of(words, words + n, [&](std::uint32_t w) { return w == words[0]; });
    if (isMatrix(type)) {  // a diagonal of one number is written as that number
        const int rows = info(type).rows;
        same = true;
        for (int i = 0; i < n; i++) same = same && words[i] == (i % (rows + 1) ? 0 : words[0]);
    }
    // A constructor converts, so whole numbers need no point.
    const bool areWhole = scalar == Scalar::Float && std::all_of(words, words + n, isWhole);
    to.append(typeName(type)) += '(';
    for (int i = 0; i < (same ? 1 : n); i++) {
        if (i) to += ", ";
        const int whole = areWhole ? static_cast<int>(std::bit_cast<float>(words[i])) : 0;
        writeNumber(to, areWhole ? Scalar::Integer : scalar, areWhole ? static_cast<std::uint32_t>(whole) : words[i]);
    }
    to += ')';
}

std::string FunctionPrinter::textOf(ExprId e, int precedence) {
    std::string out;
    write(out, e, precedence);
    return out;
}

void FunctionPrinter::write(std::string& to, ExprId e, int precedence) {
    if (!names_[e.index].empty()) {
        to += names_[e.index];
        return;
    }
    switch (f_[e].op) {
        case Op::Constant:
        case Op::Param:
        case Op::Context:
        case Op::Attribute:
        case Op::Uniform:
            writeLeaf(to, e);
            return;
        case Op::Retype:
            write(to, f_.operand(e, 0), precedence);
            return;  // a role, which the language has not
        case Op::Swizzle:
            writeSwizzle(to, e);
            return;
        case Op::TextureLevel:
        case Op::TextureGrad:
            writeTexture(to, e);
            return;
        default:
            writeOperation(to, e, precedence);  // computes something
    }
}

void FunctionPrinter::writeLeaf(std::string& to, ExprId e) {
    const Expr& x = f_[e];
    switch (x.op) {
        case Op::Constant: {
            ensure(componentCount(x.type) > 0, "a constant that has no text");
            writeConstant(to, x.type, f_.constantWords(e).data());
            return;
        }
        case Op::Param:
            to += params_[x.payload];
            return;
        case Op::Context: {
            const ContextInfo& c = info(static_cast<Context>(x.payload));
            if (c.source == ContextSource::Vertex) to += "vd.";
            to += c.host;
            return;
        }
        case Op::Attribute: {
            Name name(x.payload);
            if (stage_.isPixel)
                to.append("vd.").append(stage_.members.at(name));
            else
                to += stage_.inputs.at(stage_.module.names->find(passes::inputName(stage_.module.names->text(name))));
            return;
        }
        default:
            to += stage_.globals.at(Name(x.payload));
            return;  // a uniform
    }
}

void FunctionPrinter::writeSwizzle(std::string& to, ExprId e) {
    ExprId of = f_.operand(e, 0);
    const Expr& x = f_[e];
    if (isMatrix(f_[of].type)) {
        write(to, of, kPostfix);
        to.append("[").append(std::to_string(x.payload)).append("]");
        return;
    }
    write(to, of, kPostfix);
    to += '.';
    for (int i = 0; i < swizzleCount(x.payload); i++) to += "xyzw"[swizzleAt(x.payload, i)];
}

// At the outermost level of the entry every pixel of a quad reads, so the language's own derivatives serve.
void FunctionPrinter::writeTexture(std::string& to, ExprId e) {
    auto o = f_.operandsOf(e);
    bool implicit = f_[e].op == Op::TextureGrad && isEntry_ && stage_.isPixel && atEntryLevel_ &&
                    f_[o[2]].op == Op::Ddx && f_.operand(o[2], 0) == o[1] && f_[o[3]].op == Op::Ddy &&
                    f_.operand(o[3], 0) == o[1];
    if (implicit)
        writeCall(to, "texture", o.first(2));
    else
        writeCall(to, functionName(f_[e].op), o);
}

void FunctionPrinter::writeCall(std::string& to, std::string_view function, std::span<const ExprId> arguments) {
    to += function;
    to += '(';
    for (std::size_t i = 0; i < arguments.size(); i++) {
        if (i) to += ", ";
        write(to, arguments[i], kTernary);
    }
    to += ')';
}

// Of one number the language makes a diagonal, the IR a matrix full of it.
void FunctionPrinter::writeMake(std::string& to, ExprId e) {
    Type type = f_[e].type;
    auto o = f_.operandsOf(e);
    if (!isMatrix(type) || o.size() != 1 || !isScalar(f_[o[0]].type)) return writeCall(to, typeName(type), o);
    const std::vector<ExprId> parts(static_cast<std::size_t>(componentCount(type)), o[0]);
    writeCall(to, typeName(type), parts);
}

void FunctionPrinter::writeOperation(std::string& to, ExprId e, int precedence) {
    const Expr& x = f_[e];
    auto o = f_.operandsOf(e);
    bool matrices = x.operandCount == 2 && isMatrix(f_[o[0]].type) && isMatrix(f_[o[1]].type);
    if (x.op == Op::Mul && matrices) return writeCall(to, "matrixCompMult", o);
    if (x.op == Op::Mod && info(x.type).scalar == Scalar::Float) return writeCall(to, "mod", o);
    if (Operator op = operatorOf(x.op); op.precedence) {
        if (op.precedence < precedence) to += '(';
        write(to, o[0], op.precedence);
        to.append(" ").append(op.text).append(" ");
        // Left to right: the right side of a - b or a / b keeps its brackets; sums and products need none.
        bool associative = (x.op == Op::Add && f_[o[1]].op == Op::Add) || x.op == Op::And || x.op == Op::Or;
        write(to, o[1], op.precedence + !associative);
        if (op.precedence < precedence) to += ')';
        return;
    }
    if (std::string_view function = functionName(x.op); !function.empty()) return writeCall(to, function, o);
    switch (x.op) {
        case Op::Neg:
        case Op::Not:
        case Op::BitNot: {
            // -(-x) must not print as --x.
            std::string inner = textOf(o[0], kUnary + 1);
            if (kUnary < precedence) to += '(';
            to += x.op == Op::Neg ? '-' : x.op == Op::Not ? '!' : '~';
            to += inner[0] == '-' ? "(" + inner + ")" : inner;
            if (kUnary < precedence) to += ')';
            return;
        }
        case Op::Select:
            if (kTernary < precedence) to += '(';
            write(to, o[0], kTernary + 1);
            to += " ? ";
            write(to, o[1], kTernary + 1);
            to += " : ";
            write(to, o[2], kTernary);
            if (kTernary < precedence) to += ')';
            return;
        case Op::ShiftRightLogical:
            to += "int(uint(";
            write(to, o[0]);
            to += ") >> ";
            write(to, o[1], 11);
            to += ')';
            return;
        case Op::Make:
            return writeMake(to, e);
        case Op::Convert:
            return writeCall(to, typeName(x.type), o);
        case Op::Index:
            write(to, o[0], kPostfix);
            to += "[" + textOf(o[1]) + "]";
            return;
        case Op::TextureSize:
            to += "vec2(textureSize(" + textOf(o[0]) + ", 0))";
            return;
        case Op::Call:
            return writeCall(to, stage_.globals.at(Name(x.payload)), o);
        default:
            internalError(fmt::format("the printer met '{}', which legalise should have removed", info(x.op).name));
    }
}

std::string FunctionPrinter::variableFor(ExprId e) {
    if (Name hint = f_.hints[e.index] ? f_.hints[e.index] : asked_[e.index])
        return stage_.namer.local(stage_.module.names->text(hint));
    Type t = f_[e].type;
    if (t == Type::Boolean) return stage_.namer.local("test");
    if (t == Type::Integer) return stage_.namer.local("k");
    if (isMatrix(t)) return stage_.namer.local("m");
    constexpr std::string_view kByWidth[] = {"", "x", "p", "v", "q"};
    return stage_.namer.local(kByWidth[std::min(componentCount(t), 4)]);
}

}  // namespace shaderx::glsl
