#include "ir/interpret_wide.h"

#include <bit>
#include <cmath>
#include <map>
#include <random>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "ir/testing.h"

namespace shaderx::ir {
namespace {

// What both interpreters see: a picture that tells where it was read, and values that differ from lane to lane.
float pixelValue(const TextureRef& image, float u, float v, float level, int channel) {
    const float number = image.kind == TextureRef::Kind::Uniform ? static_cast<float>(image.uniform.index) : 0.5f;
    return u + 2 * v + 4 * level + number + static_cast<float>(channel);
}

float attributeValue(std::size_t lane, int component) {
    return static_cast<float>(lane) * 0.37f - 7 + static_cast<float>(component);
}

struct OneWorld : Environment {
    std::size_t lane = 0;
    bool context(Context c, Value& v) override {
        if (c == Context::NormalWorld)
            for (int i = 0; i < 3; i++) v.set(i, attributeValue(lane, i) * 0.1f);
        if (c == Context::Time) v.set(0, 2.5f);
        if (c == Context::ActiveLights) v.words[0] = 3;
        return c == Context::NormalWorld || c == Context::Time || c == Context::ActiveLights;
    }
    bool attribute(Name, Value& v) override {
        for (int i = 0; i < componentCount(v.type); i++) v.set(i, attributeValue(lane, i));
        return true;
    }
    bool texture(const TextureRead& r, Value& v) override {
        const float level = r.hasGradients ? r.ddx[0] + r.ddx[1] - r.ddy[0] + r.ddy[1] : r.level;
        for (int i = 0; i < componentCount(v.type); i++) v.set(i, pixelValue(r.texture, r.uv[0], r.uv[1], level, i));
        return true;
    }
    bool textureSize(const TextureRef&, Value& v) override {
        v.set(0, 640);
        v.set(1, 480);
        return true;
    }
};

struct AllWorlds : WideEnvironment {
    OneWorld one;
    bool context(Context c, Value& v) override { return one.context(c, v); }
    bool varying(Context c, Type type, std::span<LaneWords> words) override {
        for (one.lane = 0; one.lane < kLanes; one.lane++) {
            Value v;
            v.type = type;
            if (!one.context(c, v)) return false;
            for (std::size_t i = 0; i < words.size(); i++) words[i].lane[one.lane] = v.words[i];
        }
        return true;
    }
    bool attribute(Name, Type, std::span<LaneWords> words) override {
        for (std::size_t lane = 0; lane < kLanes; lane++)
            for (std::size_t i = 0; i < words.size(); i++)
                words[i].set(lane, attributeValue(lane, static_cast<int>(i)));
        return true;
    }
    bool texture(const WideTextureRead& r, std::span<LaneWords> channels) override {
        for (std::size_t lane = 0; lane < kLanes; lane++) {
            if (!(r.lanes >> lane & 1)) continue;
            const float level = r.hasGradients
                                    ? r.ddx[0].f(lane) + r.ddx[1].f(lane) - r.ddy[0].f(lane) + r.ddy[1].f(lane)
                                    : r.level->f(lane);
            for (std::size_t c = 0; c < channels.size(); c++)
                channels[c].set(lane,
                                pixelValue(r.texture, r.uv[0].f(lane), r.uv[1].f(lane), level, static_cast<int>(c)));
        }
        return true;
    }
    bool textureSize(const TextureRef& t, Value& v) override { return one.textureSize(t, v); }
};

Value valueOf(Type type, std::span<const LaneWords> words, std::size_t lane) {
    Value v;
    v.type = type;
    for (std::size_t i = 0; i < words.size(); i++) v.words[i] = words[i].lane[lane];
    return v;
}

bool isSame(Type type, std::uint32_t a, std::uint32_t b) {
    if (a == b) return true;
    return info(type).scalar == Scalar::Float && std::isnan(std::bit_cast<float>(a)) &&
           std::isnan(std::bit_cast<float>(b));
}

// Runs `f` both ways on arguments of all kinds and compares every lane of the mask. With quads, so that there are
// derivatives.
void compareBoth(const std::string& text, LaneMask mask, unsigned seed) {
    TestModule m = parseModule(text);
    if (testing::Test::HasFailure()) FAIL() << text;
    const Function& f = m["f"];
    std::mt19937 random(seed);
    std::vector<LaneWords> arguments;
    for (const Param& p : f.params)
        for (int i = 0; i < componentCount(p.type); i++) {
            LaneWords& w = arguments.emplace_back();
            for (std::size_t lane = 0; lane < kLanes; lane++) {
                if (info(p.type).scalar == Scalar::Float)
                    w.set(lane, std::uniform_real_distribution<float>(-3, 3)(random));
                else
                    w.lane[lane] = random() % (p.type == Type::Boolean ? 2u : 6u);
            }
        }
    Diagnostics diagnostics;
    const Result<WideProgram> program = WideProgram::prepare(*m.module, f, diagnostics);
    ASSERT_TRUE(program) << diagnostics.text() << text;
    WideInterpreter wide(*program);
    std::size_t count = 0;
    for (const ResultValue& r : f.results) count += static_cast<std::size_t>(componentCount(r.type));
    std::vector<LaneWords> results(count);
    AllWorlds worlds;
    for (int turn = 0; turn < 2; turn++)  // a second run starts afresh
        ASSERT_TRUE(wide.run(mask, arguments, results, worlds, diagnostics)) << diagnostics.text() << text;

    Interpreter scalar(*m.module, diagnostics);
    for (std::size_t quad = 0; quad < kLanes; quad += 4) {
        if ((mask >> quad & 15) != 15) continue;
        OneWorld four[4];
        Environment* environments[4];
        std::vector<Value> in, out(4 * f.results.size());
        for (std::size_t i = 0; i < 4; i++) {
            four[i].lane = quad + i;
            environments[i] = &four[i];
            std::size_t at = 0;
            for (const Param& p : f.params) {
                const std::size_t n = static_cast<std::size_t>(componentCount(p.type));
                in.push_back(valueOf(p.type, std::span(arguments).subspan(at, n), quad + i));
                at += n;
            }
        }
        ASSERT_TRUE(scalar.runQuad(f, in, out, environments)) << diagnostics.text() << text;
        for (std::size_t i = 0; i < 4; i++)
            for (std::size_t k = 0, at = 0; k < f.results.size(); k++)
                for (int c = 0; c < componentCount(f.results[k].type); c++, at++)
                    ASSERT_TRUE(
                        isSame(f.results[k].type, out[i * f.results.size() + k].words[c], results[at].lane[quad + i]))
                        << "result " << k << ", component " << c << ", lane " << quad + i << ": "
                        << out[i * f.results.size() + k].f(c) << " and " << results[at].f(quad + i) << "\n"
                        << text;
    }
}

// A random function in text form.
struct Maker {
    std::mt19937 random;
    std::string text = {};
    int next = 0, loops = 0;
    std::map<std::string, std::vector<std::string>> pool = {};

    std::size_t pick(std::size_t n) { return random() % n; }
    const std::string& any(const std::string& type) { return pool[type][pick(pool[type].size())]; }
    std::string put(const std::string& type, const std::string& value) {
        const std::string name = fmt::format("%e{}", next++);
        text += fmt::format("    {} = {}\n", name, value);
        pool[type].push_back(name);
        return name;
    }
    std::string op(const std::string& name, const std::string& type, std::initializer_list<const char*> operands) {
        std::string line = name + " " + type;
        const char* comma = " ";
        for (const char* o : operands) {
            line += comma + any(o);
            comma = ", ";
        }
        return put(type, line);
    }

    void leaves() {
        for (const char* v : {"0", "1", "-2.5", "0.3"}) put("float", std::string("constant float ") + v);
        put("integer", "constant integer 2");
        put("integer", "constant integer -7");
        put("boolean", "constant boolean true");
        put("vector3", "constant vector3 0.5, -1, 2");
        put("matrix33", "constant matrix33 1, 2, 3, 0.5, -1, 2, 0, 3, 0.25");
        put("matrix44", "uniform matrix44 um");
        put("float", "uniform float uf");
        put("integer", "uniform integer ui");
        put("boolean", "uniform boolean ub");
        put("vector3", "context vector3 normal_world");
        put("vector2", "attribute vector2 uv");
        put("vector2", "constant vector2 3, 4");
        put("float", "context float time");
        put("texture2d", "uniform texture2d t0");
        put("texture2d", "uniform texture2d t1");
    }

    void expression() {
        static constexpr const char* kUnary[] = {"neg", "abs",  "sign", "floor", "ceil",    "round",   "fract",
                                                 "exp", "exp2", "log",  "log2",  "sqrt",    "sin",     "cos",
                                                 "tan", "asin", "acos", "atan",  "radians", "degrees", "inversesqrt"};
        static constexpr const char* kBinary[] = {"add", "sub", "mul", "div",   "mod",
                                                  "min", "max", "pow", "atan2", "step"};
        static constexpr const char* kBits[] = {"add",
                                                "sub",
                                                "mul",
                                                "min",
                                                "max",
                                                "bit_and",
                                                "bit_or",
                                                "bit_xor",
                                                "shift_left",
                                                "shift_right",
                                                "shift_right_logical",
                                                "div",
                                                "mod"};
        const bool isVector = pick(2) == 0;
        const std::string type = isVector ? "vector3" : "float";
        switch (pick(24)) {
            case 0:
            case 1:
                op(kUnary[pick(std::size(kUnary))], type, {type.c_str()});
                break;
            case 2:
            case 3:
            case 4:
                op(kBinary[pick(std::size(kBinary))], type, {type.c_str(), pick(2) ? "float" : type.c_str()});
                break;
            case 5:
                op(pick(2) ? "mix" : "clamp", type, {type.c_str(), type.c_str(), "float"});
                break;
            case 6:
                op("smoothstep", "float", {"float", "float", "float"});
                break;
            case 7:
                op(kBits[pick(std::size(kBits))], "integer", {"integer", "integer"});
                break;
            case 8:
                op(pick(2) ? "less" : "equal", "boolean", {"float", "float"});
                break;
            case 9:
                op(pick(2) ? "less_equal" : "not_equal", "boolean", {"integer", "integer"});
                break;
            case 10:
                op(pick(2) ? "and" : "or", "boolean", {"boolean", "boolean"});
                break;
            case 11:
            case 12:
            case 13:
                op("select", type, {"boolean", type.c_str(), type.c_str()});
                break;
            case 14:
                op("dot", "float", {"vector3", "vector3"});
                op("length", "float", {"vector3"});
                break;
            case 15:
                op("normalize", "vector3", {"vector3"});
                op("cross", "vector3", {"vector3", "vector3"});
                break;
            case 16:
                op("reflect", "vector3", {"vector3", "vector3"});
                op("refract", "vector3", {"vector3", "vector3", "float"});
                break;
            case 17:
                op("faceforward", "vector3", {"vector3", "vector3", "vector3"});
                op("distance", "float", {"vector3", "vector3"});
                break;
            case 18:
                op("make", "vector3", {"float", "float", "float"});
                op("make", "vector2", {"float", "float"});
                break;
            case 19:
                put("vector3", "swizzle vector3 " + any("vector3") + ", zxx");
                put("float", "swizzle float " + any("vector2") + ", y");
                break;
            case 20:
                op("convert", "integer", {"float"});
                op("convert", "float", {"integer"});
                op("convert", "boolean", {"float"});
                op("convert", "float", {"boolean"});
                break;
            case 21:
                op("make", "matrix33", {"vector3", "vector3", "vector3"});
                op("mul_matrix", "vector3", {"matrix33", "vector3"});
                op(pick(2) ? "transpose" : "inverse", "matrix33", {"matrix33"});
                op("determinant", "float", {"matrix33"});
                op("make", "matrix33", {"matrix44"});
                break;
            case 22:
                put("vector3", "swizzle vector3 " + any("matrix33") + ", column 1");
                op("index", "float", {"vector3", "integer"});
                op("not", "boolean", {"boolean"});
                break;
            case 23:
                if (pick(3) == 0) op("select", "texture2d", {"boolean", "texture2d", "texture2d"});
                op("texture_level", "vector3", {"texture2d", "vector2", "float"});
                op("texture_grad", "vector3", {"texture2d", "vector2", "vector2", "vector2"});
                op("texture_size", "vector2", {"texture2d"});
                break;
        }
    }

    void loop(int depth) {
        const int number = loops++;
        const std::string count =
            put("integer", "bit_and integer " + any("integer") + ", " + put("integer", "constant integer 3"));
        const std::string first = any("float"), firstVector = any("vector3"), firstInteger = any("integer");
        const auto outside = pool;
        put("integer", fmt::format("loop_arg integer loop {}, 0", number));
        put("float", fmt::format("loop_arg float loop {}, 1", number));
        put("vector3", fmt::format("loop_arg vector3 loop {}, 2", number));
        put("integer", fmt::format("loop_arg integer loop {}, 3", number));
        some(6, depth + 1);
        const std::string line = fmt::format("loop tuple loop {}, {} | {}, {}, {} | {}, {}, {}", number, count, first,
                                             firstVector, firstInteger, any("float"), any("vector3"), any("integer"));
        pool = outside;
        const std::string loop = fmt::format("%e{}", next++);
        text += fmt::format("    {} = {}\n", loop, line);
        put("float", "result float " + loop + ", 0");
        put("vector3", "result vector3 " + loop + ", 1");
        put("integer", "result integer " + loop + ", 2");
    }

    void some(int n, int depth, bool calls = false) {
        for (int i = 0; i < n; i++) {
            expression();
            if (depth < 2 && pick(8) == 0) loop(depth);
            if (!calls || pick(6)) continue;
            const std::string call = fmt::format("%e{}", next++);
            text +=
                fmt::format("    {} = call tuple g {}, {}, {}\n", call, any("float"), any("vector3"), any("integer"));
            put("float", "result float " + call + ", 0");
            put("vector3", "result vector3 " + call + ", 1");
        }
    }

    std::string function(const std::string& head, bool calls) {
        text = head;
        pool.clear();
        loops = 0;
        put("float", "param float a");
        put("vector3", "param vector3 b");
        put("integer", "param integer c");
        leaves();
        if (calls) {  // the entry
            put("boolean", "param boolean d");
            put("vector3", "ddx vector3 " + any("vector3"));
            put("float", "ddy float " + any("float"));
        }
        some(12, 0, calls);
        text += fmt::format("    return {}, {}", pool["float"].back(), pool["vector3"].back());
        if (calls) {
            text += fmt::format(", {}, {}", any("integer"), any("boolean"));
            for (int i = 0; i < 8; i++) text += ", " + any("float") + ", " + any("vector3");
        }
        return text + "\n}\n";
    }
};

TEST(WideInterpret, GivesWhatTheScalarOneGives) {
    std::string head =
        "function f(a: float, b: vector3, c: integer, d: boolean) -> (p: float, q: vector3, r: integer, s: boolean";
    for (int i = 0; i < 8; i++) head += fmt::format(", x{0}: float, y{0}: vector3", i);
    head += ") {\n";
    for (unsigned seed = 0; seed < 400; seed++) {
        Maker maker{std::mt19937(seed)};
        std::string text =
            "uniform uf: float = 0.75\nuniform ui: integer = 3\nuniform ub: boolean = false\n"
            "uniform um: matrix44 = 1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 2, 3, 4, 5, 6, 7\n"
            "uniform t0: texture2d\nuniform t1: texture2d\n";
        text += maker.function("function g(a: float, b: vector3, c: integer) -> (p: float, q: vector3) {\n", false);
        text += maker.function(head, true);
        const LaneMask mask = seed % 3 == 0 ? ~LaneMask{0} : seed % 3 == 1 ? 0x0f00f0000000000full : 0xf0ull;
        compareBoth(text, mask, seed);
        if (HasFailure()) return;
    }
}

TEST(WideInterpret, LanesOfALoopStopOneByOne) {
    compareBoth(R"(function f(n: integer, x: float) -> (sum: float, m: integer) {
        %n = param integer n
        %x = param float x
        %zero = constant integer 0
        %i = loop_arg integer loop 0, 0
        %s = loop_arg float loop 0, 1
        %k = loop_arg integer loop 0, 2
        %t = add float %s, %x
        %k1 = add integer %k, %i
        %l = loop tuple loop 0, %n | %x, %zero | %t, %k1
        %r = result float %l, 0
        %q = result integer %l, 1
        return %r, %q
    })",
                ~LaneMask{0}, 1);
}

struct WideTrial {
    TestModule m;
    Diagnostics diagnostics;
    explicit WideTrial(std::string_view text) : m(parseModule(text)) {}

    std::string run(LaneMask mask, InterpreterOptions options = {}) {
        const Result<WideProgram> program = WideProgram::prepare(*m.module, m["f"], diagnostics);
        if (!program) return diagnostics.text();
        WideInterpreter wide(*program, options);
        std::vector<LaneWords> results(1);
        AllWorlds worlds;
        EXPECT_FALSE(wide.run(mask, {}, results, worlds, diagnostics));
        return diagnostics.text();
    }
};

TEST(WideInterpret, DerivativesNeedWholeQuads) {
    WideTrial f(R"(function f() -> (r: float) {
        %a = attribute float s
        %d = ddx float %a
        return %d
    })");
    EXPECT_NE(f.run(0x7).find("needs-quad"), std::string::npos);
}

TEST(WideInterpret, StopsAtTheStepLimit) {
    WideTrial f(R"(function f() -> (r: float) {
        %n = constant integer 1000000
        %a = attribute float s
        %s = loop_arg float loop 0, 1
        %t = add float %s, %a
        %l = loop float loop 0, %n | %a | %t
        return %l
    })");
    EXPECT_NE(f.run(~LaneMask{0}, {.maxSteps = 1000}).find("step-limit"), std::string::npos);
}

TEST(WideInterpret, RefusesWhatGrowsWithoutBounds) {
    std::string text = "function f0(x: float) -> (r: float) {\n%x = param float x\n%y = sin float %x\nreturn %y\n}\n";
    for (int i = 1; i <= 30; i++)
        text += fmt::format(
            "function f{0}(x: float) -> (r: float) {{\n%x = param float x\n%a = call float f{1} %x\n"
            "%b = call float f{1} %a\nreturn %b\n}}\n",
            i, i - 1);
    text += "function f() -> (r: float) {\n%x = attribute float s\n%a = call float f30 %x\nreturn %a\n}\n";
    WideTrial f(text);
    EXPECT_NE(f.run(1).find("program-too-large"), std::string::npos);
}

}  // namespace
}  // namespace shaderx::ir
