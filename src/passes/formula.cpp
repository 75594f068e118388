#include "passes/formula.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/numbers.h"

namespace shaderx::passes {

using namespace ir;

namespace {

constexpr int kDeepest = 6;
constexpr std::size_t kLongest = 200;

struct Writer {
    const Module& module;
    const Function& f;

    std::string shortName(ExprId e) const {
        Name hint = f.hints[e.index];
        return hint ? std::string(module.names->text(hint)) : "…";
    }

    std::string infix(ExprId e, std::string_view sign, int own, int wanted, int depth) const {
        std::string text =
            of(f.operand(e, 0), own, depth + 1) + std::string(sign) + of(f.operand(e, 1), own + 1, depth + 1);
        return own < wanted ? "(" + text + ")" : text;
    }

    std::string constant(ExprId e) const {
        Type type = f[e].type;
        if (type == Type::String) return fmt::format("\"{}\"", module.names->text(Name(f[e].payload)));
        if (componentCount(type) == 0) return "nothing";
        Value v;
        v.type = type;
        std::copy_n(f.constantWords(e).begin(), componentCount(type), v.words);
        return textOf(v);
    }

    std::string swizzle(ExprId e, int depth) const {
        std::string text = of(f.operand(e, 0), 3, depth) + ".";
        if (isMatrix(f[f.operand(e, 0)].type)) return text + std::to_string(f[e].payload);
        for (int i = 0; i < swizzleCount(f[e].payload); i++) text += "xyzw"[swizzleAt(f[e].payload, i)];
        return text;
    }

    std::string of(ExprId e, int wanted, int depth) const {
        const Expr& x = f[e];
        switch (x.op) {
            case Op::Constant:
                return constant(e);
            case Op::Uniform: {
                const Uniform* u = module.uniform(Name(x.payload));
                return u && !u->path.empty() ? u->path : std::string(module.names->text(Name(x.payload)));
            }
            case Op::Context:
                return std::string(info(static_cast<Context>(x.payload)).name);
            case Op::Attribute:
                return std::string(module.names->text(Name(x.payload)));
            default:
                break;
        }
        if (depth > kDeepest) return shortName(e);
        switch (x.op) {
            case Op::Add:
                return infix(e, " + ", 1, wanted, depth);
            case Op::Sub:
                return infix(e, " - ", 1, wanted, depth);
            case Op::Mul:
                return infix(e, " * ", 2, wanted, depth);
            case Op::Div:
                return infix(e, " / ", 2, wanted, depth);
            case Op::Swizzle:
                return swizzle(e, depth);
            case Op::Retype:
            case Op::Convert:
                return of(f.operand(e, 0), wanted, depth);
            case Op::Make:
                if (x.operandCount == 1) return of(f.operand(e, 0), wanted, depth);
                break;
            case Op::TextureLevel:
            case Op::TextureGrad:
                return "texture(" + of(f.operand(e, 0), 0, depth) + ")";
            case Op::Call:
            case Op::Result:
            case Op::Loop:
            case Op::Lights:
            case Op::LoopArg:
                return shortName(e);
            default:
                break;
        }
        std::string text(info(x.op).name);
        text += "(";
        for (std::size_t k = 0; k < x.operandCount; k++) text += (k ? ", " : "") + of(f.operand(e, k), 0, depth + 1);
        return text + ")";
    }
};

}  // namespace

std::string formula(const Module& module, const Function& f, ExprId e, int precedence) {
    Writer writer{module, f};
    std::string text = writer.of(e, precedence, 0);
    return text.size() > kLongest ? writer.shortName(e) : text;
}

std::string textOf(const Value& value) {
    int n = componentCount(value.type);
    if (n > 1 && std::equal(value.words + 1, value.words + n, value.words)) n = 1;
    std::string text;
    for (int i = 0; i < n; i++) {
        if (i > 0) text += ", ";
        Scalar kind = info(value.type).scalar;
        text += kind == Scalar::Boolean   ? (value.words[i] ? "true" : "false")
                : kind == Scalar::Integer ? std::to_string(value.i(i))
                                          : formatFloat(value.f(i));
    }
    return n > 1 ? "(" + text + ")" : text;
}

}  // namespace shaderx::passes
