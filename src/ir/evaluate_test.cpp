#include "ir/evaluate.h"

#include <bit>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace shaderx::ir {
namespace {

using Numbers = std::vector<double>;
using Inputs = std::vector<Numbers>;

// What one operation must give, in doubles, componentwise or as a whole.
struct Case {
    Op op;
    std::vector<Type> operands;
    Type result;
    std::function<Numbers(const Inputs&)> formula;
    double low = -3, high = 3;  // of random operands
    double tolerance = 2e-6;    // relative to the largest of 1, the operands and the result
    std::uint32_t payload = 0;
};

Numbers componentwise(const Inputs& in, std::size_t n, const std::function<double(const Numbers&)>& f) {
    Numbers out;
    for (std::size_t i = 0; i < n; i++) {
        Numbers each;
        for (const Numbers& x : in) each.push_back(x.size() == 1 ? x[0] : x[i]);
        out.push_back(f(each));
    }
    return out;
}

// Three cases of a componentwise operation of floats: scalar, vector, and with a scalar that meets a vector.
void addFloats(std::vector<Case>& cases, Op op, int n, std::function<double(const Numbers&)> f, double low = -3,
               double high = 3, double tolerance = 2e-6) {
    for (Type type : {Type::Float, Type::Color3, Type::Vector4, Type::Matrix33}) {
        std::vector<Type> types(static_cast<std::size_t>(n), type);
        const auto size = static_cast<std::size_t>(componentCount(type));
        const auto whole = [f, size](const Inputs& in) { return componentwise(in, size, f); };
        cases.push_back({op, types, type, whole, low, high, tolerance});
        for (std::size_t k = 0; n > 1 && k < types.size(); k++) {
            auto mixed = types;
            mixed[k] = Type::Float;
            cases.push_back({op, mixed, type, whole, low, high, tolerance});
        }
    }
}

void addIntegers(std::vector<Case>& cases, Op op, int n, std::function<double(const Numbers&)> f, double low = -50,
                 double high = 50) {
    cases.push_back({op, std::vector<Type>(static_cast<std::size_t>(n), Type::Integer), Type::Integer,
                     [f](const Inputs& in) { return componentwise(in, 1, f); }, low, high, 0});
}

double dot(const Numbers& a, const Numbers& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); i++) sum += a[i] * b[i];
    return sum;
}

Numbers scaled(const Numbers& a, double s) {
    Numbers out;
    for (double x : a) out.push_back(x * s);
    return out;
}

Numbers sum(const Numbers& a, const Numbers& b) {
    Numbers out;
    for (std::size_t i = 0; i < a.size(); i++) out.push_back(a[i] + b[i]);
    return out;
}

Numbers product(const Numbers& a, const Numbers& b, std::size_t n) {
    Numbers out(b.size());
    for (std::size_t c = 0; c < b.size() / n; c++)
        for (std::size_t r = 0; r < n; r++)
            for (std::size_t i = 0; i < n; i++) out[c * n + r] += a[i * n + r] * b[c * n + i];
    return out;
}

// Determinant by elimination, and the solution of m x = b beside it.
double eliminate(Numbers m, std::size_t n, Numbers* b = nullptr) {
    double det = 1;
    for (std::size_t k = 0; k < n; k++) {
        std::size_t pivot = k;
        for (std::size_t r = k; r < n; r++)
            if (std::fabs(m[k * n + r]) > std::fabs(m[k * n + pivot])) pivot = r;
        if (pivot != k) {
            det = -det;
            for (std::size_t c = 0; c < n; c++) std::swap(m[c * n + k], m[c * n + pivot]);
            if (b) std::swap((*b)[k], (*b)[pivot]);
        }
        det *= m[k * n + k];
        if (m[k * n + k] == 0) return 0;
        for (std::size_t r = 0; r < n; r++) {
            if (r == k) continue;
            const double factor = m[k * n + r] / m[k * n + k];
            for (std::size_t c = 0; c < n; c++) m[c * n + r] -= factor * m[c * n + k];
            if (b) (*b)[r] -= factor * (*b)[k];
        }
    }
    if (b)
        for (std::size_t k = 0; k < n; k++) (*b)[k] /= m[k * n + k];
    return det;
}

double wrap(double v) { return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(v))); }
std::uint32_t bitsOf(double v) { return static_cast<std::uint32_t>(static_cast<std::int64_t>(v)); }
double fromBits(std::uint32_t w) { return static_cast<std::int32_t>(w); }

void addArithmetic(std::vector<Case>& c) {
    addFloats(c, Op::Neg, 1, [](const Numbers& x) { return -x[0]; });
    addFloats(c, Op::Add, 2, [](const Numbers& x) { return x[0] + x[1]; });
    addFloats(c, Op::Sub, 2, [](const Numbers& x) { return x[0] - x[1]; });
    addFloats(c, Op::Mul, 2, [](const Numbers& x) { return x[0] * x[1]; });
    addFloats(c, Op::Div, 2, [](const Numbers& x) { return x[0] / x[1]; }, 0.1);
    addFloats(c, Op::Mod, 2, [](const Numbers& x) { return x[0] - x[1] * std::floor(x[0] / x[1]); }, 0.5);
    addFloats(c, Op::Min, 2, [](const Numbers& x) { return x[0] < x[1] ? x[0] : x[1]; });
    addFloats(c, Op::Max, 2, [](const Numbers& x) { return x[0] > x[1] ? x[0] : x[1]; });
    addFloats(c, Op::Pow, 2, [](const Numbers& x) { return std::exp(x[1] * std::log(x[0])); }, 0.1);
    addFloats(c, Op::Atan2, 2, [](const Numbers& x) { return std::arg(std::complex<double>(x[1], x[0])); });
    addFloats(c, Op::Step, 2, [](const Numbers& x) { return x[1] >= x[0] ? 1.0 : 0.0; });
    addFloats(c, Op::Clamp, 3, [](const Numbers& x) { return std::fmin(std::fmax(x[0], x[1]), x[2]); });
    addFloats(c, Op::Mix, 3, [](const Numbers& x) { return x[0] * (1 - x[2]) + x[1] * x[2]; });
    addFloats(
        c, Op::Smoothstep, 3,
        [](const Numbers& x) {
            if (x[0] >= x[1]) return x[2] >= x[1] ? 1.0 : 0.0;
            double t = (x[2] - x[0]) / (x[1] - x[0]);
            t = t < 0 ? 0 : t > 1 ? 1 : t;
            return 3 * t * t - 2 * t * t * t;
        },
        -3, 3, 1e-4);
    addIntegers(c, Op::Neg, 1, [](const Numbers& x) { return -x[0]; });
    addIntegers(c, Op::Add, 2, [](const Numbers& x) { return wrap(x[0] + x[1]); }, -2147483647.0, 2147483647.0);
    addIntegers(c, Op::Sub, 2, [](const Numbers& x) { return wrap(x[0] - x[1]); }, -2147483647.0, 2147483647.0);
    addIntegers(c, Op::Mul, 2, [](const Numbers& x) { return wrap(x[0] * x[1]); }, -1e6, 1e6);
    addIntegers(c, Op::Div, 2, [](const Numbers& x) { return std::trunc(x[0] / x[1]); }, 1);
    addIntegers(c, Op::Mod, 2, [](const Numbers& x) { return std::fmod(x[0], x[1]); }, 1);
    addIntegers(c, Op::Min, 2, [](const Numbers& x) { return std::fmin(x[0], x[1]); });
    addIntegers(c, Op::Max, 2, [](const Numbers& x) { return std::fmax(x[0], x[1]); });
    addIntegers(c, Op::Clamp, 3, [](const Numbers& x) { return std::fmin(std::fmax(x[0], x[1]), x[2]); });
    addIntegers(c, Op::Abs, 1, [](const Numbers& x) { return std::fabs(x[0]); });
    addIntegers(c, Op::Sign, 1, [](const Numbers& x) { return x[0] > 0 ? 1.0 : x[0] < 0 ? -1.0 : 0.0; });
}

void addFunctions(std::vector<Case>& c) {
    const double pi = std::acos(-1.0);
    addFloats(c, Op::Abs, 1, [](const Numbers& x) { return x[0] < 0 ? -x[0] : x[0]; });
    addFloats(c, Op::Sign, 1, [](const Numbers& x) { return x[0] > 0 ? 1.0 : x[0] < 0 ? -1.0 : 0.0; });
    addFloats(c, Op::Floor, 1, [](const Numbers& x) { return std::floor(x[0]); });
    addFloats(c, Op::Ceil, 1, [](const Numbers& x) { return -std::floor(-x[0]); });
    addFloats(c, Op::Round, 1, [](const Numbers& x) { return std::floor(x[0] + 0.5); });
    addFloats(c, Op::Fract, 1, [](const Numbers& x) { return x[0] - std::floor(x[0]); });
    addFloats(c, Op::Exp, 1, [](const Numbers& x) { return std::pow(std::exp(1.0), x[0]); });
    addFloats(c, Op::Exp2, 1, [](const Numbers& x) { return std::pow(2.0, x[0]); });
    addFloats(c, Op::Log, 1, [](const Numbers& x) { return 2 * std::atanh((x[0] - 1) / (x[0] + 1)); }, 0.01);
    addFloats(c, Op::Log2, 1, [](const Numbers& x) { return std::log(x[0]) / std::log(2.0); }, 0.01);
    addFloats(c, Op::Sqrt, 1, [](const Numbers& x) { return std::pow(x[0], 0.5); }, 0.01);
    addFloats(c, Op::InverseSqrt, 1, [](const Numbers& x) { return std::pow(x[0], -0.5); }, 0.01);
    addFloats(c, Op::Sin, 1, [pi](const Numbers& x) { return std::cos(x[0] - pi / 2); });
    addFloats(c, Op::Cos, 1, [pi](const Numbers& x) { return std::sin(x[0] + pi / 2); });
    addFloats(c, Op::Tan, 1, [](const Numbers& x) { return std::sin(x[0]) / std::cos(x[0]); }, -1.4, 1.4);
    addFloats(c, Op::Asin, 1, [](const Numbers& x) { return std::atan2(x[0], std::sqrt(1 - x[0] * x[0])); }, -1, 1);
    addFloats(c, Op::Acos, 1, [](const Numbers& x) { return std::atan2(std::sqrt(1 - x[0] * x[0]), x[0]); }, -1, 1);
    addFloats(c, Op::Atan, 1, [](const Numbers& x) { return std::atan2(x[0], 1.0); });
    addFloats(c, Op::Radians, 1, [pi](const Numbers& x) { return x[0] * pi / 180; }, -720, 720);
    addFloats(c, Op::Degrees, 1, [pi](const Numbers& x) { return x[0] * 180 / pi; });
}

void addGeometry(std::vector<Case>& c) {
    for (Type t : {Type::Vector2, Type::Vector3, Type::Normal, Type::Vector4}) {
        c.push_back({Op::Dot, {t, t}, Type::Float, [](const Inputs& x) { return Numbers{dot(x[0], x[1])}; }});
        c.push_back(
            {Op::Length, {t}, Type::Float, [](const Inputs& x) { return Numbers{std::sqrt(dot(x[0], x[0]))}; }});
        c.push_back({Op::Distance, {t, t}, Type::Float, [](const Inputs& x) {
                         const Numbers d = sum(x[0], scaled(x[1], -1));
                         return Numbers{std::sqrt(dot(d, d))};
                     }});
        c.push_back(
            {Op::Normalize, {t}, t, [](const Inputs& x) { return scaled(x[0], 1 / std::sqrt(dot(x[0], x[0]))); }});
        c.push_back({Op::Reflect,
                     {t, t},
                     t,
                     [](const Inputs& x) { return sum(x[0], scaled(x[1], -2 * dot(x[1], x[0]))); },
                     -3,
                     3,
                     2e-5});
        c.push_back({Op::Refract,
                     {t, t, Type::Float},
                     t,
                     [](const Inputs& x) {
                         const double eta = x[2][0], d = dot(x[1], x[0]), k = 1 - eta * eta * (1 - d * d);
                         if (k < 0) return Numbers(x[0].size());
                         return sum(scaled(x[0], eta), scaled(x[1], -(eta * d + std::sqrt(k))));
                     },
                     -1,
                     1,
                     2e-4});
        c.push_back({Op::Faceforward, {t, t, t}, t, [](const Inputs& x) {
                         return scaled(x[0], dot(x[2], x[1]) < 0 ? 1 : -1);
                     }});
    }
    c.push_back({Op::Cross, {Type::Vector3, Type::Vector3}, Type::Vector3, [](const Inputs& x) {
                     const Numbers &a = x[0], &b = x[1];
                     return Numbers{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
                 }});
    for (std::size_t n : {3, 4}) {
        const Type m = n == 3 ? Type::Matrix33 : Type::Matrix44, v = n == 3 ? Type::Vector3 : Type::Vector4;
        const auto multiply = [n](const Inputs& x) { return product(x[0], x[1], n); };
        c.push_back({Op::MulMatrix, {m, v}, v, multiply, -3, 3, 1e-5});
        c.push_back({Op::MulMatrix, {m, m}, m, multiply, -3, 3, 1e-5});
        c.push_back({Op::Transpose, {m}, m, [n](const Inputs& x) {
                         Numbers out(n * n);
                         for (std::size_t i = 0; i < n * n; i++) out[i] = x[0][i % n * n + i / n];
                         return out;
                     }});
        c.push_back({Op::Determinant,
                     {m},
                     Type::Float,
                     [n](const Inputs& x) { return Numbers{eliminate(x[0], n)}; },
                     -3,
                     3,
                     1e-5});
        c.push_back({Op::Inverse,
                     {m},
                     m,
                     [n](const Inputs& x) {
                         Numbers out;
                         for (std::size_t column = 0; column < n; column++) {
                             Numbers b(n);
                             b[column] = 1;
                             eliminate(x[0], n, &b);
                             out.insert(out.end(), b.begin(), b.end());
                         }
                         return out;
                     },
                     -3,
                     3,
                     1e-5});
    }
}

void addBits(std::vector<Case>& c) {
    const double low = -2147483648.0, high = 2147483647.0;
    addIntegers(c, Op::BitAnd, 2, [](const Numbers& x) { return fromBits(bitsOf(x[0]) & bitsOf(x[1])); }, low, high);
    addIntegers(c, Op::BitOr, 2, [](const Numbers& x) { return fromBits(bitsOf(x[0]) | bitsOf(x[1])); }, low, high);
    addIntegers(c, Op::BitXor, 2, [](const Numbers& x) { return fromBits(bitsOf(x[0]) ^ bitsOf(x[1])); }, low, high);
    addIntegers(c, Op::BitNot, 1, [](const Numbers& x) { return -x[0] - 1; }, low, high);
    const auto count = [](double v) { return bitsOf(v) % 32; };
    addIntegers(
        c, Op::ShiftLeft, 2, [count](const Numbers& x) { return fromBits(bitsOf(x[0] * std::exp2(count(x[1])))); },
        -1000, 1000);
    addIntegers(
        c, Op::ShiftRight, 2, [count](const Numbers& x) { return std::floor(x[0] / std::exp2(count(x[1]))); }, low,
        high);
    addIntegers(
        c, Op::ShiftRightLogical, 2,
        [count](const Numbers& x) {
            return fromBits(static_cast<std::uint32_t>(std::floor(bitsOf(x[0]) / std::exp2(count(x[1])))));
        },
        low, high);
}

void addLogic(std::vector<Case>& c) {
    const auto add = [&c](Op op, Type t, int n, std::function<bool(const Numbers&)> f) {
        const auto whole = [f](const Inputs& in) {
            Numbers x;
            for (const Numbers& each : in) x.push_back(each[0]);
            return Numbers{f(x) ? 1.0 : 0.0};
        };
        c.push_back({op, std::vector<Type>(static_cast<std::size_t>(n), t), Type::Boolean, whole, -2, 2, 0});
    };
    for (Type t : {Type::Float, Type::Integer, Type::Boolean}) {
        add(Op::Equal, t, 2, [](const Numbers& x) { return !(x[0] < x[1]) && !(x[0] > x[1]); });
        add(Op::NotEqual, t, 2, [](const Numbers& x) { return x[0] < x[1] || x[0] > x[1]; });
        add(Op::Less, t, 2, [](const Numbers& x) { return x[1] - x[0] > 0; });
        add(Op::LessEqual, t, 2, [](const Numbers& x) { return x[1] - x[0] >= 0; });
    }
    add(Op::And, Type::Boolean, 2, [](const Numbers& x) { return x[0] * x[1] != 0; });
    add(Op::Or, Type::Boolean, 2, [](const Numbers& x) { return x[0] + x[1] != 0; });
    add(Op::Not, Type::Boolean, 1, [](const Numbers& x) { return x[0] == 0; });
    add(Op::Known, Type::Boolean, 1, [](const Numbers& x) { return x[0] != 0; });
    for (Type t : {Type::Float, Type::Integer, Type::Color4, Type::Matrix44})
        c.push_back({Op::Select, {Type::Boolean, t, t}, t, [](const Inputs& x) { return x[0][0] != 0 ? x[1] : x[2]; }});
}

Numbers joined(const Inputs& in) {
    Numbers out;
    for (const Numbers& x : in) out.insert(out.end(), x.begin(), x.end());
    return out;
}

void addComposition(std::vector<Case>& c) {
    c.push_back({Op::Make, {Type::Float, Type::Float, Type::Float}, Type::Color3, joined});
    c.push_back({Op::Make, {Type::Vector2, Type::Float}, Type::Vector3, joined});
    c.push_back({Op::Make, {Type::Float, Type::Color3}, Type::Color4, joined});
    c.push_back({Op::Make, {Type::Vector3, Type::Vector3, Type::Vector3}, Type::Matrix33, joined});
    c.push_back({Op::Make, std::vector<Type>(16, Type::Float), Type::Matrix44, joined});
    c.push_back({Op::Make, {Type::Float}, Type::Vector4, [](const Inputs& x) { return Numbers(4, x[0][0]); }});
    c.push_back({Op::Make, {Type::Vector2}, Type::Vector2, joined});
    c.push_back({Op::Swizzle,
                 {Type::Vector4},
                 Type::Vector3,
                 [](const Inputs& x) { return Numbers{x[0][3], x[0][0], x[0][0]}; },
                 -3,
                 3,
                 0,
                 swizzleMask(3, 3, 0, 0)});
    c.push_back({Op::Swizzle,
                 {Type::Color3},
                 Type::Float,
                 [](const Inputs& x) { return Numbers{x[0][1]}; },
                 -3,
                 3,
                 0,
                 swizzleMask(1, 1)});
    c.push_back({Op::Swizzle,
                 {Type::Float},
                 Type::Vector2,
                 [](const Inputs& x) { return Numbers(2, x[0][0]); },
                 -3,
                 3,
                 0,
                 swizzleMask(2, 0, 0)});
    c.push_back({Op::Swizzle,
                 {Type::Matrix33},
                 Type::Vector3,
                 [](const Inputs& x) { return Numbers{x[0][6], x[0][7], x[0][8]}; },
                 -3,
                 3,
                 0,
                 2});
    const auto convert = [&c](Type from, Type to, std::function<double(double)> f) {
        c.push_back({Op::Convert, {from}, to, [f](const Inputs& x) { return Numbers{f(x[0][0])}; }, -9, 9, 0});
    };
    for (Type t : {Type::Boolean, Type::Integer, Type::Float}) convert(t, t, [](double v) { return v; });
    convert(Type::Boolean, Type::Integer, [](double v) { return v; });
    convert(Type::Boolean, Type::Float, [](double v) { return v; });
    convert(Type::Integer, Type::Boolean, [](double v) { return v != 0; });
    convert(Type::Integer, Type::Float, [](double v) { return v; });
    convert(Type::Float, Type::Boolean, [](double v) { return v != 0; });
    convert(Type::Float, Type::Integer, [](double v) { return v < 0 ? std::ceil(v) : std::floor(v); });
    c.push_back({Op::Retype, {Type::Color3}, Type::Normal, [](const Inputs& x) { return x[0]; }});
    c.push_back({Op::Retype, {Type::Vector4}, Type::Color4, [](const Inputs& x) { return x[0]; }});
    const auto at = [](const Numbers& x, double i, std::size_t n) {
        const auto first = x.begin() + static_cast<std::ptrdiff_t>(i) * static_cast<std::ptrdiff_t>(n);
        return Numbers(first, first + static_cast<std::ptrdiff_t>(n));
    };
    c.push_back({Op::Index,
                 {Type::Vector4, Type::Integer},
                 Type::Float,
                 [at](const Inputs& x) { return at(x[0], x[1][0], 1); },
                 0,
                 3.99});
    c.push_back({Op::Index,
                 {Type::Matrix44, Type::Integer},
                 Type::Vector4,
                 [at](const Inputs& x) { return at(x[0], x[1][0], 4); },
                 0,
                 3.99});
}

const std::vector<Case>& cases() {
    static const std::vector<Case> all = [] {
        std::vector<Case> c;
        addArithmetic(c);
        addFunctions(c);
        addGeometry(c);
        addBits(c);
        addLogic(c);
        addComposition(c);
        return c;
    }();
    return all;
}

// What needs more than its operands' values.
const std::set<Op> kNotEvaluated = {
    Op::Constant,     Op::Param,        Op::Context,     Op::Attribute,    Op::Uniform, Op::GeomProp,    Op::Member,
    Op::TextureLevel, Op::TextureGrad,  Op::TextureSize, Op::Ddx,          Op::Ddy,     Op::Call,        Op::Result,
    Op::LoopArg,      Op::Loop,         Op::Lights,      Op::ExternText,   Op::Leaf,    Op::ClosureMix,  Op::ClosureAdd,
    Op::ClosureScale, Op::ClosureLayer, Op::Surface,     Op::SurfaceUnlit, Op::Volume,  Op::Displacement};

Value valueOf(Type type, const Numbers& numbers) {
    Value v;
    v.type = type;
    for (std::size_t i = 0; i < numbers.size(); i++) {
        if (info(type).scalar == Scalar::Float)
            v.set(static_cast<int>(i), static_cast<float>(numbers[i]));
        else
            v.words[i] = bitsOf(numbers[i]);
    }
    return v;
}

Numbers numbersOf(const Value& v) {
    Numbers out;
    for (int i = 0; i < componentCount(v.type); i++)
        out.push_back(info(v.type).scalar == Scalar::Float ? static_cast<double>(v.f(i)) : v.i(i));
    return out;
}

double randomNumber(std::mt19937& random, Type type, double low, double high) {
    const double v = std::uniform_real_distribution<double>(low, high)(random);
    switch (info(type).scalar) {
        case Scalar::Float:
            return static_cast<float>(v);
        case Scalar::Integer:
            return std::floor(v);
        case Scalar::Boolean:
            return static_cast<double>(random() & 1);
        case Scalar::None:
            break;
    }
    return 0;
}

void check(const Case& c, const Inputs& in) {
    std::vector<Value> operands;
    double scale = 1;
    for (std::size_t k = 0; k < in.size(); k++) {
        operands.push_back(valueOf(c.operands[k], in[k]));
        for (double x : in[k]) scale = std::max(scale, std::fabs(x));
    }
    const Numbers wanted = c.formula(in);
    Value result;
    ASSERT_TRUE(evaluate(c.op, c.result, operands, c.payload, result)) << info(c.op).name;
    ASSERT_EQ(result.type, c.result);
    const Numbers is = numbersOf(result);
    ASSERT_EQ(is.size(), wanted.size()) << info(c.op).name;
    for (double x : wanted) scale = std::max(scale, std::fabs(x));
    for (std::size_t i = 0; i < is.size(); i++)
        ASSERT_NEAR(is[i], wanted[i], c.tolerance * scale)
            << info(c.op).name << " to " << info(c.result).name << ", component " << i;
}

TEST(Evaluate, EveryOperationHasACase) {
    std::set<Op> seen = kNotEvaluated;
    for (const Case& c : cases()) {
        EXPECT_FALSE(kNotEvaluated.count(c.op)) << info(c.op).name;
        seen.insert(c.op);
    }
    for (int i = 0; i < kOps; i++)
        EXPECT_TRUE(seen.count(static_cast<Op>(i))) << "no case of " << info(static_cast<Op>(i)).name;
}

TEST(Evaluate, RandomOperandsMatchTheFormulas) {
    std::mt19937 random(20240501);
    for (const Case& c : cases())
        for (int turn = 0; turn < 100; turn++) {
            Inputs in;
            for (Type t : c.operands) {
                Numbers numbers(static_cast<std::size_t>(componentCount(t)));
                for (double& x : numbers) x = randomNumber(random, t, c.low, c.high);
                in.push_back(numbers);
            }
            if (c.op == Op::Inverse && std::fabs(eliminate(in[0], c.result == Type::Matrix33 ? 3 : 4)) < 1) continue;
            check(c, in);
            if (HasFatalFailure()) return;
        }
}

float one(Op op, float x) {
    Value v = valueOf(Type::Float, {x}), r;
    return evaluate(op, Type::Float, std::span(&v, 1), 0, r) ? r.f(0) : std::numeric_limits<float>::quiet_NaN();
}
float two(Op op, float x, float y) {
    const Value v[] = {valueOf(Type::Float, {x}), valueOf(Type::Float, {y})};
    Value r;
    return evaluate(op, Type::Float, v, 0, r) ? r.f(0) : std::numeric_limits<float>::quiet_NaN();
}

TEST(Evaluate, EdgesOfFloats) {
    const float huge = std::numeric_limits<float>::max(), tiny = std::numeric_limits<float>::denorm_min();
    EXPECT_TRUE(std::signbit(one(Op::Neg, 0.0f)));
    EXPECT_TRUE(std::signbit(one(Op::Sqrt, -0.0f)));
    EXPECT_EQ(one(Op::Sign, -0.0f), 0.0f);
    EXPECT_EQ(one(Op::Sign, tiny), 1.0f);
    EXPECT_EQ(one(Op::Floor, -tiny), -1.0f);
    EXPECT_EQ(one(Op::Ceil, tiny), 1.0f);
    EXPECT_EQ(one(Op::Floor, huge), huge);
    EXPECT_EQ(one(Op::Fract, huge), 0.0f);
    EXPECT_EQ(one(Op::Exp2, -149.0f), tiny);
    EXPECT_EQ(one(Op::Exp, 0.0f), 1.0f);
    EXPECT_EQ(one(Op::Log, 1.0f), 0.0f);
    EXPECT_EQ(one(Op::Log2, 8.0f), 3.0f);
    EXPECT_EQ(one(Op::Sqrt, 1.0f), 1.0f);
    EXPECT_EQ(one(Op::Cos, 0.0f), 1.0f);
    EXPECT_EQ(one(Op::Acos, 1.0f), 0.0f);
    EXPECT_EQ(two(Op::Add, huge, -huge), 0.0f);
    EXPECT_EQ(two(Op::Mul, tiny, 0.25f), 0.0f);
    EXPECT_EQ(two(Op::Pow, 0.0f, 2.0f), 0.0f);
    EXPECT_EQ(two(Op::Pow, 3.0f, 0.0f), 1.0f);
    EXPECT_EQ(two(Op::Step, 1.0f, 1.0f), 1.0f);
    EXPECT_EQ(two(Op::Atan2, 0.0f, 1.0f), 0.0f);
    EXPECT_EQ(two(Op::Mod, -1.0f, 3.0f), 2.0f);
}

// 1 + 2^-24 is not a float: each step rounds.
TEST(Evaluate, RoundsAtEveryStep) {
    const float ulp = std::numeric_limits<float>::epsilon();
    EXPECT_EQ(two(Op::Add, 1.0f, ulp / 2), 1.0f);
    const Value v[] = {valueOf(Type::Vector2, {1 + ulp, 1}), valueOf(Type::Vector2, {1 + ulp, -1})};
    Value r;
    ASSERT_TRUE(evaluate(Op::Dot, Type::Float, v, 0, r));
    EXPECT_EQ(r.f(0), 2 * ulp);
}

TEST(Evaluate, RefusesWhatIsNotFinite) {
    const float huge = std::numeric_limits<float>::max();
    for (Op op : {Op::Log, Op::Log2, Op::InverseSqrt}) EXPECT_TRUE(std::isnan(one(op, 0.0f))) << info(op).name;
    for (Op op : {Op::Sqrt, Op::Log, Op::Asin, Op::Acos}) EXPECT_TRUE(std::isnan(one(op, -2.0f))) << info(op).name;
    EXPECT_TRUE(std::isnan(one(Op::Exp, 1000.0f)));
    EXPECT_TRUE(std::isnan(two(Op::Div, 1.0f, 0.0f)));
    EXPECT_TRUE(std::isnan(two(Op::Div, 0.0f, 0.0f)));
    EXPECT_TRUE(std::isnan(two(Op::Mod, 1.0f, 0.0f)));
    EXPECT_TRUE(std::isnan(two(Op::Mul, huge, 2.0f)));
    EXPECT_TRUE(std::isnan(two(Op::Pow, -2.0f, 0.5f)));
    Value zero = valueOf(Type::Vector3, {0, 0, 0}), r;
    EXPECT_FALSE(evaluate(Op::Normalize, Type::Vector3, std::span(&zero, 1), 0, r));
    Value singular = valueOf(Type::Matrix33, {1, 2, 3, 2, 4, 6, 0, 0, 1});
    EXPECT_FALSE(evaluate(Op::Inverse, Type::Matrix33, std::span(&singular, 1), 0, r));
}

bool integers(Op op, std::int64_t a, std::int64_t b, std::int32_t& result) {
    const Value v[] = {valueOf(Type::Integer, {static_cast<double>(a)}),
                       valueOf(Type::Integer, {static_cast<double>(b)})};
    Value r;
    if (!evaluate(op, Type::Integer, v, 0, r)) return false;
    result = r.i(0);
    return true;
}

TEST(Evaluate, EdgesOfIntegers) {
    const std::int64_t least = std::numeric_limits<std::int32_t>::min();
    std::int32_t r = 7;
    EXPECT_FALSE(integers(Op::Div, 1, 0, r));
    EXPECT_FALSE(integers(Op::Mod, 1, 0, r));
    ASSERT_TRUE(integers(Op::Div, least, -1, r));
    EXPECT_EQ(r, least);
    ASSERT_TRUE(integers(Op::Mod, least, -1, r));
    EXPECT_EQ(r, 0);
    ASSERT_TRUE(integers(Op::Mod, -7, 3, r));
    EXPECT_EQ(r, -1);
    ASSERT_TRUE(integers(Op::ShiftRight, -8, 33, r));
    EXPECT_EQ(r, -4);
    ASSERT_TRUE(integers(Op::ShiftRightLogical, -1, 31, r));
    EXPECT_EQ(r, 1);
    for (float v : {2147483648.0f, -2147483904.0f, 1e30f}) {
        Value x = valueOf(Type::Float, {v}), out;
        EXPECT_FALSE(evaluate(Op::Convert, Type::Integer, std::span(&x, 1), 0, out)) << v;
    }
    Value x = valueOf(Type::Float, {-2147483648.0f}), out;
    ASSERT_TRUE(evaluate(Op::Convert, Type::Integer, std::span(&x, 1), 0, out));
    EXPECT_EQ(out.i(0), least);
}

TEST(Evaluate, ExecuteGoesOnWhereFoldingStops) {
    const Value v[] = {valueOf(Type::Float, {1}), valueOf(Type::Float, {0})};
    const Operand floats[] = {{Type::Float, v[0].words}, {Type::Float, v[1].words}};
    std::uint32_t out = 7;
    ASSERT_TRUE(execute(Op::Div, Type::Float, floats, 0, &out));
    EXPECT_EQ(out, 0x7f800000u);
    const std::uint32_t words[4] = {5, 0, 9, 0x80000000u};
    const Operand numbers[] = {{Type::Integer, words}, {Type::Integer, words + 1}};
    ASSERT_TRUE(execute(Op::Div, Type::Integer, numbers, 0, &out));
    EXPECT_EQ(out, 0u);
    const Value big = valueOf(Type::Float, {-1e30});
    const Operand tooBig[] = {{Type::Float, big.words}};
    ASSERT_TRUE(execute(Op::Convert, Type::Integer, tooBig, 0, &out));
    EXPECT_EQ(out, 0x80000000u);
    const Value vec = valueOf(Type::Vector3, {1, 2, 3});
    for (const auto& [at, wanted] : {std::pair(2, 3.0f), std::pair(3, 1.0f)}) {  // 9 and the least integer
        const Operand beyond[] = {{Type::Vector3, vec.words}, {Type::Integer, words + at}};
        ASSERT_TRUE(execute(Op::Index, Type::Float, beyond, 0, &out));
        EXPECT_EQ(std::bit_cast<float>(out), wanted);
    }
}

TEST(Evaluate, RefusesTypesThatDoNotFit) {
    const Value number = valueOf(Type::Float, {1}), whole = valueOf(Type::Integer, {1}),
                truth = valueOf(Type::Boolean, {1}), two3 = valueOf(Type::Vector3, {1, 2, 3}),
                two2 = valueOf(Type::Vector2, {1, 2});
    Value string, r;
    string.type = Type::String;
    const auto refused = [&r](Op op, Type type, std::vector<Value> operands, std::uint32_t payload = 0) {
        EXPECT_FALSE(evaluate(op, type, operands, payload, r)) << info(op).name;
    };
    refused(Op::Add, Type::Float, {number, whole});
    refused(Op::Add, Type::Vector3, {two3, two2});
    refused(Op::Add, Type::Boolean, {truth, truth});
    refused(Op::Add, Type::Float, {number});
    refused(Op::Pow, Type::Integer, {whole, whole});
    refused(Op::Dot, Type::Float, {two3, two2});
    refused(Op::Cross, Type::Vector2, {two2, two2});
    refused(Op::MulMatrix, Type::Vector3, {two3, two3});
    refused(Op::BitAnd, Type::Float, {number, number});
    refused(Op::Equal, Type::Boolean, {string, string});
    refused(Op::Equal, Type::Boolean, {two3, two3});
    refused(Op::And, Type::Boolean, {truth, whole});
    refused(Op::Make, Type::Vector3, {two2});
    refused(Op::Make, Type::Vector2, {two2, number});
    refused(Op::Make, Type::Vector2, {});
    refused(Op::Swizzle, Type::Float, {two2}, swizzleMask(1, 2));
    refused(Op::Swizzle, Type::Float, {two2}, swizzleMask(2, 0, 1));
    refused(Op::Convert, Type::Float, {two2});
    refused(Op::Retype, Type::Integer, {number});
    refused(Op::Index, Type::Float, {two3, number});
    refused(Op::Select, Type::Float, {number, number, number});
    for (Op op : kNotEvaluated) refused(op, Type::Float, {number, number, number});
}

}  // namespace
}  // namespace shaderx::ir
