#include "ir/evaluate.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace shaderx::ir {

float Value::f(int i) const { return std::bit_cast<float>(words[i]); }
void Value::set(int i, float v) { words[i] = std::bit_cast<std::uint32_t>(v); }

namespace {

using Word = std::uint32_t;  // also an integer of the IR, whose arithmetic wraps

constexpr double kPi = 3.14159265358979323846;

float asFloat(Word w) { return std::bit_cast<float>(w); }
Word asWord(float v) { return std::bit_cast<Word>(v); }
std::int32_t asSigned(Word w) { return static_cast<std::int32_t>(w); }
Word asWord(std::int64_t v) { return static_cast<Word>(static_cast<std::uint64_t>(v)); }

// Functions go through doubles, so that every machine's library gives the same float (all but a few in a billion).
float rounded(double v) { return static_cast<float>(v); }

// One operation under way. The families below return false where the types do not fit them.
struct Work {
    Type type;
    std::span<const Operand> operands;
    Word* result;

    int components() const { return componentCount(type); }
    Scalar scalar() const { return info(type).scalar; }
    int components(std::size_t k) const { return componentCount(operands[k].type); }
    Scalar scalar(std::size_t k) const { return info(operands[k].type).scalar; }
    Word word(std::size_t k, int i) const { return operands[k].words[i]; }
    float number(std::size_t k, int i) const { return asFloat(word(k, i)); }
    void put(int i, float v) const { result[i] = asWord(v); }

    // Whether all operands have the result's kind of components, each as many or one.
    bool componentwise() const {
        const Scalar kind = scalar();
        const int n = components();
        for (const Operand& o : operands) {
            if (o.type == type) continue;
            const int m = componentCount(o.type);
            if (info(o.type).scalar != kind || (m != n && m != 1)) return false;
        }
        return n > 0;
    }
    // What the number of a component is multiplied by in operand k: a scalar meets every component of the others.
    int stride(std::size_t k) const { return components(k) == 1 ? 0 : 1; }
    // Whether operand k is a vector (or scalar) of n floats.
    bool floats(std::size_t k, int n) const {
        return scalar(k) == Scalar::Float && components(k) == n && !isMatrix(operands[k].type);
    }
    // Dot product of two operands of n components.
    float dot(std::size_t a, std::size_t b, int n) const {
        float sum = number(a, 0) * number(b, 0);
        for (int i = 1; i < n; i++) sum += number(a, i) * number(b, i);
        return sum;
    }
};

// ---- Componentwise ----

struct NotForIntegers {};

template <class Float, class Int>
bool one(const Work& w, Float f, Int g) {
    if (!w.componentwise()) return false;
    if (w.scalar() == Scalar::Float) {
        const int n = w.components(), a = w.stride(0);
        for (int i = 0; i < n; i++) w.put(i, f(w.number(0, a * i)));
        return true;
    }
    if constexpr (!std::is_same_v<Int, NotForIntegers>) {
        if (w.scalar() == Scalar::Integer) {
            w.result[0] = g(w.word(0, 0));
            return true;
        }
    }
    return false;
}

template <class Float, class Int>
bool two(const Work& w, Float f, Int g) {
    if (!w.componentwise()) return false;
    if (w.scalar() == Scalar::Float) {
        const int n = w.components(), a = w.stride(0), b = w.stride(1);
        for (int i = 0; i < n; i++) w.put(i, f(w.number(0, a * i), w.number(1, b * i)));
        return true;
    }
    if constexpr (!std::is_same_v<Int, NotForIntegers>) {
        if (w.scalar() == Scalar::Integer) {
            w.result[0] = g(w.word(0, 0), w.word(1, 0));
            return true;
        }
    }
    return false;
}

template <class Float>
bool three(const Work& w, Float f) {
    if (!w.componentwise() || w.scalar() != Scalar::Float) return false;
    const int n = w.components(), a = w.stride(0), b = w.stride(1), c = w.stride(2);
    for (int i = 0; i < n; i++) w.put(i, f(w.number(0, a * i), w.number(1, b * i), w.number(2, c * i)));
    return true;
}

template <class Function>
bool function(const Work& w, Function f) {
    return one(w, [f](float a) { return rounded(f(static_cast<double>(a))); }, NotForIntegers());
}

bool clamp(const Work& w) {
    if (w.scalar() == Scalar::Integer) {
        if (!w.componentwise()) return false;
        const std::int32_t x = asSigned(w.word(0, 0)), low = asSigned(w.word(1, 0)), high = asSigned(w.word(2, 0));
        w.result[0] = static_cast<Word>(std::min(std::max(x, low), high));
        return true;
    }
    return three(w, [](float x, float low, float high) { return std::min(std::max(x, low), high); });
}

float smoothstep(float low, float high, float x) {
    if (!(low < high)) return x >= high ? 1.0f : 0.0f;
    const float t = std::min(std::max((x - low) / (high - low), 0.0f), 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

Word quotient(Word a, Word b) {
    return b == 0 ? 0 : asWord(static_cast<std::int64_t>(asSigned(a)) / static_cast<std::int64_t>(asSigned(b)));
}
Word remainder(Word a, Word b) {
    return b == 0 ? 0 : asWord(static_cast<std::int64_t>(asSigned(a)) % static_cast<std::int64_t>(asSigned(b)));
}

// ---- Geometry ----

bool dot(const Work& w) {
    const int n = w.components(0);
    if (n == 0 || !w.floats(0, n) || !w.floats(1, n) || w.type != Type::Float) return false;
    w.put(0, w.dot(0, 1, n));
    return true;
}

bool cross(const Work& w) {
    if (!w.floats(0, 3) || !w.floats(1, 3) || w.components() != 3) return false;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        w.put(i, w.number(0, j) * w.number(1, k) - w.number(0, k) * w.number(1, j));
    }
    return true;
}

bool length(const Work& w) {
    const int n = w.components(0);
    if (n == 0 || !w.floats(0, n) || w.type != Type::Float) return false;
    w.put(0, std::sqrt(w.dot(0, 0, n)));
    return true;
}

bool distance(const Work& w) {
    const int n = w.components(0);
    if (n == 0 || !w.floats(0, n) || !w.floats(1, n) || w.type != Type::Float) return false;
    float sum = 0;
    for (int i = 0; i < n; i++) {
        const float d = w.number(0, i) - w.number(1, i);
        sum += d * d;
    }
    w.put(0, std::sqrt(sum));
    return true;
}

bool normalize(const Work& w) {
    const int n = w.components();
    if (n == 0 || !w.floats(0, n)) return false;
    const float l = std::sqrt(w.dot(0, 0, n));
    for (int i = 0; i < n; i++) w.put(i, w.number(0, i) / l);
    return true;
}

bool reflect(const Work& w) {
    const int n = w.components();
    if (n == 0 || !w.floats(0, n) || !w.floats(1, n)) return false;
    const float twice = 2.0f * w.dot(1, 0, n);
    for (int i = 0; i < n; i++) w.put(i, w.number(0, i) - twice * w.number(1, i));
    return true;
}

bool refract(const Work& w) {
    const int n = w.components();
    if (n == 0 || !w.floats(0, n) || !w.floats(1, n) || !w.floats(2, 1)) return false;
    const float eta = w.number(2, 0), d = w.dot(1, 0, n), k = 1.0f - eta * eta * (1.0f - d * d);
    for (int i = 0; i < n; i++)
        w.put(i, k < 0 ? 0.0f : eta * w.number(0, i) - (eta * d + std::sqrt(k)) * w.number(1, i));
    return true;
}

bool faceforward(const Work& w) {
    const int n = w.components();
    if (n == 0 || !w.floats(0, n) || !w.floats(1, n) || !w.floats(2, n)) return false;
    const bool keep = w.dot(2, 1, n) < 0;
    for (int i = 0; i < n; i++) w.put(i, keep ? w.number(0, i) : -w.number(0, i));
    return true;
}

// ---- Matrices: component (row, column) is number column * rows + row ----

bool multiplyMatrix(const Work& w) {
    const TypeInfo &a = info(w.operands[0].type), &b = info(w.operands[1].type);
    if (!isMatrix(w.operands[0].type) || b.scalar != Scalar::Float || b.rows != a.columns) return false;
    if (w.components() != a.rows * b.columns) return false;
    for (int column = 0; column < b.columns; column++)
        for (int row = 0; row < a.rows; row++) {
            float sum = 0;
            for (int i = 0; i < a.columns; i++) sum += w.number(0, i * a.rows + row) * w.number(1, column * b.rows + i);
            w.put(column * a.rows + row, sum);
        }
    return true;
}

bool isSquare(const Work& w) { return isMatrix(w.operands[0].type) && w.scalar(0) == Scalar::Float; }

bool transpose(const Work& w) {
    if (!isSquare(w) || w.type != w.operands[0].type) return false;
    const int n = info(w.type).rows;
    for (int column = 0; column < n; column++)
        for (int row = 0; row < n; row++) w.put(column * n + row, w.number(0, row * n + column));
    return true;
}

// Determinant of the 3x3 matrix that is left of an n x n one without a row and a column; without the fourth of both of
// a 3x3 one, itself. In doubles, because cofactors cancel.
double minor3(const Work& w, int n, int withoutRow, int withoutColumn) {
    double m[3][3];
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) m[c][r] = w.number(0, (c + (c >= withoutColumn)) * n + r + (r >= withoutRow));
    return m[0][0] * (m[1][1] * m[2][2] - m[2][1] * m[1][2]) - m[1][0] * (m[0][1] * m[2][2] - m[2][1] * m[0][2]) +
           m[2][0] * (m[0][1] * m[1][2] - m[1][1] * m[0][2]);
}

// Signed determinant without a row and a column.
double cofactor(const Work& w, int n, int row, int column) {
    const double sign = (row + column) % 2 == 0 ? 1 : -1;
    if (n == 4) return sign * minor3(w, 4, row, column);
    const int r0 = row == 0 ? 1 : 0, r1 = row == 2 ? 1 : 2, c0 = column == 0 ? 1 : 0, c1 = column == 2 ? 1 : 2;
    const auto at = [&w](int r, int c) { return static_cast<double>(w.number(0, c * 3 + r)); };
    return sign * (at(r0, c0) * at(r1, c1) - at(r0, c1) * at(r1, c0));
}

double determinantOf(const Work& w, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++) sum += static_cast<double>(w.number(0, i)) * cofactor(w, n, i, 0);
    return sum;
}

bool determinant(const Work& w) {
    if (!isSquare(w) || w.type != Type::Float) return false;
    w.put(0, rounded(determinantOf(w, info(w.operands[0].type).rows)));
    return true;
}

bool inverse(const Work& w) {
    if (!isSquare(w) || w.type != w.operands[0].type) return false;
    const int n = info(w.type).rows;
    const double d = determinantOf(w, n);
    for (int column = 0; column < n; column++)
        for (int row = 0; row < n; row++) w.put(column * n + row, rounded(cofactor(w, n, column, row) / d));
    return true;
}

// ---- Bits, comparison, logic ----

template <class Function>
bool bits(const Work& w, Function f) {
    if (w.type != Type::Integer) return false;
    for (const Operand& o : w.operands)
        if (o.type != Type::Integer) return false;
    w.result[0] = f(w.word(0, 0), w.operands.size() > 1 ? w.word(1, 0) : 0u);
    return true;
}

template <class Float, class Int>
bool compare(const Work& w, Float f, Int g) {
    if (w.type != Type::Boolean || w.components(0) != 1 || w.components(1) != 1 || w.scalar(0) != w.scalar(1))
        return false;
    if (w.scalar(0) == Scalar::Float)
        w.result[0] = f(w.number(0, 0), w.number(1, 0));
    else
        w.result[0] = g(asSigned(w.word(0, 0)), asSigned(w.word(1, 0)));
    return true;
}

template <class Function>
bool logic(const Work& w, Function f) {
    if (w.type != Type::Boolean) return false;
    for (const Operand& o : w.operands)
        if (o.type != Type::Boolean) return false;
    w.result[0] = f(w.word(0, 0) != 0, w.operands.size() > 1 && w.word(1, 0) != 0);
    return true;
}

// ---- Composition ----

bool copy(const Work& w, std::size_t k, int first) {
    if (w.scalar(k) != w.scalar() || first + w.components() > w.components(k)) return false;
    std::copy_n(w.operands[k].words + first, w.components(), w.result);
    return true;
}

bool select(const Work& w) {
    if (w.operands[0].type != Type::Boolean || w.components() == 0) return false;
    const std::size_t k = w.word(0, 0) != 0 ? 1 : 2;
    return w.components(k) == w.components() && copy(w, k, 0);
}

// The upper left part of a larger matrix.
bool part(const Work& w) {
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) w.result[3 * c + r] = w.operands[0].words[4 * c + r];
    return true;
}

bool make(const Work& w) {
    const int n = w.components();
    int at = 0;
    if (w.operands.size() == 1 && n == 9 && w.operands[0].type == Type::Matrix44) return part(w);
    for (std::size_t k = 0; k < w.operands.size(); k++) {
        if (w.scalar(k) != w.scalar() || at + w.components(k) > n) return false;
        std::copy_n(w.operands[k].words, w.components(k), w.result + at);
        at += w.components(k);
    }
    if (w.operands.size() == 1 && at == 1) std::fill_n(w.result, n, w.word(0, 0));
    return n > 0 && (at == n || (w.operands.size() == 1 && at == 1));
}

bool swizzle(const Work& w, Word payload) {
    const Type from = w.operands[0].type;
    if (w.scalar(0) != w.scalar()) return false;
    if (isMatrix(from)) {
        const int rows = info(from).rows;
        if (payload >= info(from).columns || w.components() != rows) return false;
        return copy(w, 0, static_cast<int>(payload) * rows);
    }
    const int n = swizzleCount(payload);
    if (n == 0 || n > 4 || n != w.components()) return false;
    for (int i = 0; i < n; i++) {
        if (swizzleAt(payload, i) >= w.components(0)) return false;
        w.result[i] = w.operands[0].words[swizzleAt(payload, i)];
    }
    return true;
}

// The nearest integer towards zero; the nearest there is for what no integer holds, 0 for NaN.
Word truncated(float v) {
    if (!(v == v)) return 0;
    if (v >= 2147483648.0f) return 0x7fffffffu;
    if (v <= -2147483648.0f) return 0x80000000u;
    return static_cast<Word>(static_cast<std::int32_t>(v));
}

bool convert(const Work& w) {
    if (w.components() != 1 || w.components(0) != 1) return false;
    const Scalar from = w.scalar(0), to = w.scalar();
    const Word x = w.word(0, 0);
    if (from == to)
        w.result[0] = x;
    else if (to == Scalar::Boolean)
        w.result[0] = from == Scalar::Float ? asFloat(x) != 0 : x != 0;
    else if (to == Scalar::Integer)
        w.result[0] = from == Scalar::Float ? truncated(asFloat(x)) : x != 0;
    else
        w.put(0, from == Scalar::Integer ? static_cast<float>(asSigned(x)) : x != 0 ? 1.0f : 0.0f);
    return true;
}

// Component or column number operand 1, the nearest one where it is out of range.
bool index(const Work& w) {
    const TypeInfo& from = info(w.operands[0].type);
    if (w.operands[1].type != Type::Integer || w.components(0) < 2) return false;
    const int size = from.columns > 1 ? from.columns : from.rows, step = from.columns > 1 ? from.rows : 1;
    return w.components() == step && copy(w, 0, std::clamp(asSigned(w.word(1, 0)), 0, size - 1) * step);
}

bool dispatch(Op op, const Work& w, Word payload) {
    constexpr NotForIntegers no;
    using I = std::int32_t;
    switch (op) {
        case Op::Neg:
            return one(w, [](float a) { return -a; }, [](Word a) { return 0u - a; });
        case Op::Add:
            return two(w, [](float a, float b) { return a + b; }, [](Word a, Word b) { return a + b; });
        case Op::Sub:
            return two(w, [](float a, float b) { return a - b; }, [](Word a, Word b) { return a - b; });
        case Op::Mul:
            return two(w, [](float a, float b) { return a * b; }, [](Word a, Word b) { return a * b; });
        case Op::Div:
            return two(w, [](float a, float b) { return a / b; }, quotient);
        case Op::Mod:
            return two(w, [](float a, float b) { return a - b * std::floor(a / b); }, remainder);
        case Op::Min:
            return two(
                w, [](float a, float b) { return std::min(a, b); },
                [](Word a, Word b) { return asSigned(a) < asSigned(b) ? a : b; });
        case Op::Max:
            return two(
                w, [](float a, float b) { return std::max(a, b); },
                [](Word a, Word b) { return asSigned(a) < asSigned(b) ? b : a; });
        case Op::Pow:
            return two(w, [](float a, float b) { return rounded(std::pow(static_cast<double>(a), b)); }, no);
        case Op::Atan2:
            return two(w, [](float a, float b) { return rounded(std::atan2(static_cast<double>(a), b)); }, no);
        case Op::Step:
            return two(w, [](float edge, float x) { return x < edge ? 0.0f : 1.0f; }, no);
        case Op::Clamp:
            return clamp(w);
        case Op::Mix:
            return three(w, [](float a, float b, float t) { return a + t * (b - a); });
        case Op::Smoothstep:
            return three(w, smoothstep);

        case Op::Abs:
            return one(w, [](float a) { return std::fabs(a); }, [](Word a) { return asSigned(a) < 0 ? 0u - a : a; });
        case Op::Sign:
            return one(
                w, [](float a) { return a > 0   ? 1.0f
                                        : a < 0 ? -1.0f
                                                : 0.0f; },
                [](Word a) { return static_cast<Word>((asSigned(a) > 0) - (asSigned(a) < 0)); });
        case Op::Floor:
            return one(w, [](float a) { return std::floor(a); }, no);
        case Op::Ceil:
            return one(w, [](float a) { return std::ceil(a); }, no);
        case Op::Round:
            return one(w, [](float a) { return std::round(a); }, no);
        case Op::Fract:
            return one(w, [](float a) { return a - std::floor(a); }, no);
        case Op::Exp:
            return function(w, [](double a) { return std::exp(a); });
        case Op::Exp2:
            return function(w, [](double a) { return std::exp2(a); });
        case Op::Log:
            return function(w, [](double a) { return std::log(a); });
        case Op::Log2:
            return function(w, [](double a) { return std::log2(a); });
        case Op::Sqrt:
            return function(w, [](double a) { return std::sqrt(a); });
        case Op::InverseSqrt:
            return function(w, [](double a) { return 1.0 / std::sqrt(a); });
        case Op::Sin:
            return function(w, [](double a) { return std::sin(a); });
        case Op::Cos:
            return function(w, [](double a) { return std::cos(a); });
        case Op::Tan:
            return function(w, [](double a) { return std::tan(a); });
        case Op::Asin:
            return function(w, [](double a) { return std::asin(a); });
        case Op::Acos:
            return function(w, [](double a) { return std::acos(a); });
        case Op::Atan:
            return function(w, [](double a) { return std::atan(a); });
        case Op::Radians:
            return function(w, [](double a) { return a * (kPi / 180.0); });
        case Op::Degrees:
            return function(w, [](double a) { return a * (180.0 / kPi); });

        case Op::Dot:
            return dot(w);
        case Op::Cross:
            return cross(w);
        case Op::Length:
            return length(w);
        case Op::Distance:
            return distance(w);
        case Op::Normalize:
            return normalize(w);
        case Op::Reflect:
            return reflect(w);
        case Op::Refract:
            return refract(w);
        case Op::Faceforward:
            return faceforward(w);
        case Op::MulMatrix:
            return multiplyMatrix(w);
        case Op::Transpose:
            return transpose(w);
        case Op::Inverse:
            return inverse(w);
        case Op::Determinant:
            return determinant(w);

        case Op::BitAnd:
            return bits(w, [](Word a, Word b) { return a & b; });
        case Op::BitOr:
            return bits(w, [](Word a, Word b) { return a | b; });
        case Op::BitXor:
            return bits(w, [](Word a, Word b) { return a ^ b; });
        case Op::BitNot:
            return bits(w, [](Word a, Word) { return ~a; });
        case Op::ShiftLeft:
            return bits(w, [](Word a, Word b) { return a << (b & 31); });
        case Op::ShiftRight:
            return bits(w, [](Word a, Word b) { return static_cast<Word>(asSigned(a) >> (b & 31)); });
        case Op::ShiftRightLogical:
            return bits(w, [](Word a, Word b) { return a >> (b & 31); });

        case Op::Equal:
            return compare(w, [](float a, float b) { return a == b; }, [](I a, I b) { return a == b; });
        case Op::NotEqual:
            return compare(w, [](float a, float b) { return a != b; }, [](I a, I b) { return a != b; });
        case Op::Less:
            return compare(w, [](float a, float b) { return a < b; }, [](I a, I b) { return a < b; });
        case Op::LessEqual:
            return compare(w, [](float a, float b) { return a <= b; }, [](I a, I b) { return a <= b; });
        case Op::And:
            return logic(w, [](bool a, bool b) { return a && b; });
        case Op::Or:
            return logic(w, [](bool a, bool b) { return a || b; });
        case Op::Not:
            return logic(w, [](bool a, bool) { return !a; });
        case Op::Known:
            return logic(w, [](bool a, bool) { return a; });

        case Op::Select:
            return select(w);
        case Op::Make:
            return make(w);
        case Op::Swizzle:
            return swizzle(w, payload);
        case Op::Convert:
            return convert(w);
        case Op::Retype:
            return w.components() > 0 && w.components() == w.components(0) && copy(w, 0, 0);
        case Op::Index:
            return index(w);

        case Op::Constant:
        case Op::Param:
        case Op::Context:
        case Op::Attribute:
        case Op::Uniform:
        case Op::GeomProp:
        case Op::Member:
        case Op::TextureLevel:
        case Op::TextureGrad:
        case Op::TextureSize:
        case Op::Ddx:
        case Op::Ddy:
        case Op::Call:
        case Op::Result:
        case Op::LoopArg:
        case Op::Loop:
        case Op::Lights:
        case Op::ExternText:
        case Op::Leaf:
        case Op::ClosureMix:
        case Op::ClosureAdd:
        case Op::ClosureScale:
        case Op::ClosureLayer:
        case Op::Surface:
        case Op::SurfaceUnlit:
        case Op::Volume:
        case Op::Displacement:
            return false;
    }
    return false;
}

// Whether the result is not defined although the words that `execute` gives are finite.
bool isUndefined(Op op, Type type, std::span<const Operand> operands) {
    if ((op == Op::Div || op == Op::Mod) && operands[1].type == Type::Integer) return operands[1].words[0] == 0;
    if (op == Op::Convert && type == Type::Integer && operands[0].type == Type::Float) {
        const float v = asFloat(operands[0].words[0]);
        return !(v > -2147483904.0f && v < 2147483648.0f);
    }
    return false;
}

}  // namespace

bool execute(Op op, Type type, std::span<const Operand> operands, std::uint32_t payload, std::uint32_t* result) {
    if (info(op).operands >= 0 && operands.size() != static_cast<std::size_t>(info(op).operands)) return false;
    return dispatch(op, Work{type, operands, result}, payload);
}

bool evaluate(Op op, Type type, std::span<const Value> operands, std::uint32_t payload, Value& result) {
    constexpr std::size_t kMost = 16;  // a matrix from its numbers
    Operand views[kMost];
    if (operands.size() > kMost) return false;
    for (std::size_t k = 0; k < operands.size(); k++) views[k] = {operands[k].type, operands[k].words};
    return evaluate(op, type, std::span<const Operand>(views, operands.size()), payload, result);
}

bool evaluate(Op op, Type type, std::span<const Operand> operands, std::uint32_t payload, Value& result) {
    Value v;
    v.type = type;
    if (!execute(op, type, operands, payload, v.words) || isUndefined(op, type, operands)) return false;
    if (info(type).scalar == Scalar::Float)
        for (int i = 0; i < componentCount(type); i++)
            if (!std::isfinite(v.f(i))) return false;
    result = v;
    return true;
}

}  // namespace shaderx::ir
