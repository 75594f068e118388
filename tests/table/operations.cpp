#include "table/operations.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "ir/builder.h"

namespace shaderx::table {

using namespace ir;

std::string_view exemption(Op op) {
    switch (op) {
        case Op::Constant:
        case Op::Param:
        case Op::Context:
        case Op::Attribute:
        case Op::Uniform:
            return "a leaf of the graph: every function has them";
        case Op::GeomProp:
            return "an attribute before the shader is printed; node bodies have it";
        case Op::Known:
            return "false once the program is specialised";
        case Op::Member:
            return "there are no structures in the node library";
        case Op::Call:
        case Op::Result:
            return "every subject is called";
        case Op::LoopArg:
        case Op::Loop:
            return "functions of the library have loops";
        case Op::Lights:
            return "needs a rig of lights";
        case Op::ExternText:
            return "text in a target's own language: the interpreter refuses it";
        case Op::Leaf:
        case Op::ClosureMix:
        case Op::ClosureAdd:
        case Op::ClosureScale:
        case Op::ClosureLayer:
        case Op::Surface:
        case Op::SurfaceUnlit:
        case Op::Volume:
        case Op::Displacement:
            return "a closure: gone after the shade stage";
        default:
            return {};  // computes
    }
}

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr Type kNumbers[] = {Type::Boolean, Type::Integer, Type::Float, Type::Color3, Type::Color4,   Type::Vector2,
                             Type::Vector3, Type::Vector4, Type::Point, Type::Normal, Type::Matrix33, Type::Matrix44};

bool hasIntegers(std::span<const Value> v) { return info(v[0].type).scalar == Scalar::Integer; }

using Values = std::span<const Value>;

// A component of an operand; a scalar meets every component.
float at(Values v, std::size_t k, int i) { return v[k].f(componentCount(v[k].type) == 1 ? 0 : i); }

// Where an operation is not defined although the interpreter gives a number: see ops.h.
std::function<bool(Values, int)> definedness(Op op) {
    switch (op) {
        case Op::Pow:
            return [](Values v, int i) { return at(v, 0, i) > 0 || (at(v, 0, i) == 0 && at(v, 1, i) > 0); };
        case Op::Atan2:
            return [](Values v, int i) { return at(v, 0, i) != 0 || at(v, 1, i) != 0; };
        case Op::Div:
        case Op::Mod:
            return [](Values v, int i) { return hasIntegers(v) ? v[1].i(0) != 0 : at(v, 1, i) != 0; };
        default:
            return {};  // wherever its result is finite
    }
}

// Where the numbers of an operand come from.
Domain domainOf(Op op, std::size_t k, Type type) {
    Domain d;
    d.low = -4;
    d.high = 4;
    d.edges = {0, -0.0f, 1, -1, 0.5f, 2.5f, 1e-10f, -1e-10f, 1e10f, -1e10f};
    if (info(type).scalar == Scalar::Integer) {
        d.edges = {0, 1, -1, 31, 32};
        d.isAnyInteger = op != Op::Index;
    }
    switch (op) {
        case Op::Min:
        case Op::Max:
        case Op::Select:
            d.edges.push_back(kNan);
            return d;
        case Op::Clamp:
            d.edges = {0, 1, -1, kNan};
            return d;
        case Op::Smoothstep:
            d.edges = {0, 1, -1};  // often the same for both edges and the number
            if (k == 2) d.edges.insert(d.edges.end(), {1e10f, -1e10f});
            return d;
        case Op::Index:
            d.low = -2, d.high = 5;
            return d;
        case Op::Pow:
            d.low = k ? -4 : 0;
            d.edges = k ? std::vector<float>{0, 1, 0.5f, 2, -1} : std::vector<float>{0, 1, 1e-10f, 1e4f};
            return d;
        case Op::Sin:
        case Op::Cos:
        case Op::Tan:
            d.low = -20, d.high = 20, d.edges = {0, -0.0f, 1, 1e-10f, 100, -100};
            return d;
        case Op::Asin:
        case Op::Acos:
            d.low = -1, d.high = 1, d.edges = {0, -0.0f, 1, -1, 1e-10f};
            return d;
        case Op::Mix:
            d.edges = {0, -0.0f, 1, -1, 0.5f, 1e-10f};
            return d;
        case Op::Inverse:
        case Op::Determinant:
            d.edges = {0, -0.0f, 1, -1};
            return d;
        case Op::Convert:
            d.edges = {0, -0.0f, 1, -1, 0.99f, -0.99f, 1e9f, -1e9f};
            return d;
        case Op::TextureLevel:
        case Op::TextureGrad:
            d.low = -2, d.high = 2, d.edges = {0, 1, 0.5f};
            return d;
        default:
            return d;  // the whole range
    }
}

struct Maker {
    Module& program;
    std::vector<Subject> made = {};

    void add(Op op, Type type, std::span<const Type> operands, std::uint32_t payload = 0) {
        Function f;
        std::string name = fmt::format("{} {}", info(type).name, info(op).name);
        Subject s;
        for (std::size_t k = 0; k < operands.size(); k++) {
            name += fmt::format(" {}", info(operands[k]).name);
            f.params.push_back({program.names->intern(fmt::format("x{}", k)), operands[k]});
            s.domains.push_back(domainOf(op, k, operands[k]));
        }
        if (op == Op::Swizzle) name += fmt::format(" {}", payload);
        f.name = program.names->intern(name);
        f.isInline = true;
        Builder b(program, f);
        std::vector<ExprId> values;
        for (std::uint32_t k = 0; k < operands.size(); k++) values.push_back(b.param(k));
        b.addResult(program.names->intern("out"), b.emitRaw(op, type, values, payload));
        s.name = name;
        s.covers = info(op).name;
        s.function = f.name;
        s.isDefined = definedness(op);
        s.mayGiveNan = op == Op::Min || op == Op::Max || op == Op::Clamp;
        program.put(std::move(f));
        made.push_back(std::move(s));
    }

    // Whether the interpreter executes an operation on these types.
    static bool executes(Op op, Type type, std::span<const Type> operands) {
        static constexpr std::uint32_t kZeros[16] = {};
        std::uint32_t out[16];
        std::vector<Operand> views;
        for (Type t : operands) views.push_back({t, kZeros});
        return execute(op, type, views, 0, out);
    }

    // Every combination of types that gives a type.
    void combinations(Op op) {
        const std::size_t n = static_cast<std::size_t>(info(op).operands), types = std::size(kNumbers);
        std::size_t count = 1;
        for (std::size_t k = 0; k < n; k++) count *= types;
        for (std::size_t code = 0; code < count; code++) {
            std::vector<Type> operands;
            for (std::size_t k = 0, rest = code; k < n; k++, rest /= types) operands.push_back(kNumbers[rest % types]);
            const Type type = resultType(op, operands);
            const bool derivative = (op == Op::Ddx || op == Op::Ddy) && info(type).scalar == Scalar::Float;
            if (type != Type::Void && (derivative || executes(op, type, operands))) add(op, type, operands);
        }
    }

    // From parts of every size, in every order; matrices from columns, from numbers, and from one number.
    void makes() {
        for (Type type : kNumbers) {
            const TypeInfo& t = info(type);
            if (t.scalar != Scalar::Float || t.rows < 2) continue;
            add(Op::Make, type, std::array{Type::Float});
            if (t.columns > 1) {
                add(Op::Make, type, std::vector<Type>(t.columns, floatVector(t.rows)));
                add(Op::Make, type, std::vector<Type>(static_cast<std::size_t>(componentCount(type)), Type::Float));
                continue;
            }
            // The gaps between components that part them, as bits.
            for (unsigned gaps = 1; gaps < 1u << (t.rows - 1); gaps++) {
                std::vector<Type> parts;
                int size = 1;
                for (int i = 0; i < t.rows - 1; i++, size++)
                    if (gaps >> i & 1) parts.push_back(floatVector(size)), size = 0;
                parts.push_back(floatVector(size));
                add(Op::Make, type, parts);
            }
        }
        add(Op::Make, Type::Matrix33, std::array{Type::Matrix44});
    }

    void swizzles() {
        for (Type from : kNumbers) {
            const TypeInfo& t = info(from);
            if (t.scalar != Scalar::Float || t.rows < 2) continue;
            for (std::uint32_t c = 0; t.columns > 1 && c < t.columns; c++)
                add(Op::Swizzle, floatVector(t.rows), std::array{from}, c);
            for (int n = 1; t.columns == 1 && n <= 4; n++)
                for (int first = 0; first < t.rows; first++) {  // forward, then backward from each component
                    const int r = t.rows, a = first;
                    const Type to = floatVector(n, t.role);
                    add(Op::Swizzle, to, std::array{from},
                        swizzleMask(n, a, n > 1 ? (a + 1) % r : 0, n > 2 ? (a + 2) % r : 0, n > 3 ? (a + 3) % r : 0));
                    if (n > 1)
                        add(Op::Swizzle, to, std::array{from},
                            swizzleMask(n, a, (a + r - 1) % r, n > 2 ? a : 0, n > 3 ? (a + r - 1) % r : 0));
                }
        }
    }

    void given(Op op) {
        switch (op) {
            case Op::Select:
                for (Type t : kNumbers) add(op, t, std::array{Type::Boolean, t, t});
                return;
            case Op::Make:
                return makes();
            case Op::Swizzle:
                return swizzles();
            case Op::Convert:
            case Op::Retype:
                for (Type from : kNumbers)
                    for (Type to : kNumbers)
                        if (from != to && isScalar(from) == (op == Op::Convert) && executes(op, to, std::array{from}))
                            add(op, to, std::array{from});
                return;
            case Op::Index:
                for (Type t : kNumbers)
                    if (info(t).rows > 1)
                        add(op, isMatrix(t) ? floatVector(info(t).rows) : Type::Float, std::array{t, Type::Integer});
                return;
            case Op::TextureLevel:
                for (Type t : kNumbers)
                    if (info(t).scalar == Scalar::Float && !isMatrix(t))
                        add(op, t, std::array{Type::Texture2D, Type::Vector2, Type::Float});
                return;
            case Op::TextureGrad:
                for (Type t : kNumbers)
                    if (info(t).scalar == Scalar::Float && !isMatrix(t))
                        add(op, t, std::array{Type::Texture2D, Type::Vector2, Type::Vector2, Type::Vector2});
                return;
            case Op::TextureSize:
                return add(op, Type::Vector2, std::array{Type::Texture2D});
            default:
                return;  // a new one: the test says that nothing covers it
        }
    }
};

}  // namespace

std::vector<Subject> operations(Module& program) {
    Maker m{program};
    for (int i = 0; i < kOps; i++) {
        const Op op = static_cast<Op>(i);
        if (!exemption(op).empty()) continue;
        if (info(op).rule == TypeRule::Given)
            m.given(op);
        else
            m.combinations(op);
    }
    return std::move(m.made);
}

}  // namespace shaderx::table
