#include <cmath>
#include <functional>

#include "sl/testing.h"

namespace shaderx::sl {

using ir::Type;

// ---- expressions ----

struct Expected {
    const char* text;
    float value;
};

static std::string inlineText(std::string_view text, Type result, std::vector<float>& values) {
    NameTable names;
    ir::Module module(names);
    Diagnostics diagnostics;
    ir::Param out{names.intern("out"), result};
    ir::Param params[] = {{names.intern("a"), Type::Float},    {names.intern("i"), Type::Integer},
                          {names.intern("v"), Type::Vector3},  {names.intern("c"), Type::Color3},
                          {names.intern("m"), Type::Matrix33}, {names.intern("if"), Type::Float}};
    if (!compileInline(module, names.intern("f"), params, std::span(&out, 1), {"inline", text}, {}, diagnostics))
        return diagnostics.text();
    EXPECT_TRUE(ir::validate(module, diagnostics)) << diagnostics.text();
    ir::Value args[6], got;
    for (int k = 0; k < 6; k++) args[k].type = params[k].type;
    args[0].set(0, 0.5f);
    args[1].words[0] = 7;
    for (int k = 0; k < 3; k++) args[2].set(k, static_cast<float>(k + 1));
    for (int k = 0; k < 3; k++) args[3].set(k, 0.25f * static_cast<float>(k));
    for (int k = 0; k < 9; k++) args[4].set(k, static_cast<float>(k == 0 ? 2 : k % 4 == 0 ? 1 : k == 3 ? 5 : 0));
    args[5].set(0, 9);
    ir::Interpreter interpreter(module, diagnostics);
    ir::Environment nothing;
    if (!interpreter.run(*module.findOwn(names.intern("f")), args, std::span(&got, 1), nothing))
        return diagnostics.text();
    for (int k = 0; k < ir::componentCount(result); k++)
        values.push_back(ir::info(result).scalar == ir::Scalar::Float ? got.f(k) : static_cast<float>(got.i(k)));
    return "";
}

TEST(Expressions, Numbers) {
    const Expected cases[] = {
        {"1 + 2 * 3", 7},
        {"(1 + 2) * 3", 9},
        {"10 - 4 - 3", 3},
        {"7 / 2", 3},
        {"7.0 / 2", 3.5f},
        {"-7 % 4", -3},
        {"1 << 4 | 3 & 2 ^ 1", 16 | ((3 & 2) ^ 1)},
        {"0xff >> 4", 15},
        {"int(0xffffffff >>> 28)", 15},
        {"~0 + 2", 1},
        {"- - 3", 3},
        {"+a", 0.5f},
        {".5 + 1. + 1e1 + 1.5e-1", 11.65f},
        {"true ? 1 : 2.5", 1},
        {"1 < 2 && !(2 <= 1) || false ? 4 : 5", 4},
        {"1 > 2 ? 1 : 2 >= 2 ? 7 : 8", 7},
        {"1 == 1.0 ? 3 : 4", 3},
        {"true != false ? 3 : 4", 3},
        {"\"a\\n\" == \"a\\n\" ? 1 : 0", 1},
        {"\"a\" == \"b\" ? 1 : 0", 0},
        {"{{if}} + {{ a }}", 9.5f},
        {"i", 7},
        {"i * a", 3.5f},
        {"float(i) / 2", 3.5f},
        {"int(3.9) + 0.0", 3},
        {"float(true) + int(false)", 1},
        {"bool(2) ? 1 : 0", 1},
        {"v.y + v[2] + v.zyx.x", 8},
        {"v[i - 5]", 3},
        {"c.g + c.rgb.b", 0.75f},
        {"vector2(1, 2).y", 2},
        {"vector4(v, 4).w + vector4(v.xy, vector2(8, 9)).z", 12},
        {"color4(c, 1).a", 1},
        {"dot(v, vector(1))", 6},
        {"length(vector2(3, 4))", 5},
        {"distance(v, vector(1, 2, 5))", 2},
        {"cross(vector(1, 0, 0), vector(0, 1, 0)).z", 1},
        {"atan(1, 1) * 4 / M_PI", 1},
        {"atan2(1, 1) - atan(1)", 0},
        {"mod(-1, 4) + mod(5.5, 2)", 4.5f},
        {"min(3, 2) / 4", 0},
        {"max(3, 2.0) / 4", 0.75f},
        {"clamp(i, 0, 5)", 5},
        {"mix(1, 3, a)", 2},
        {"step(1, a) + smoothstep(0, 1, a)", 0.5f},
        {"pow(2, 10)", 1024},
        {"(m * v).x", 12},
        {"(m * m)[1].x", 15},
        {"(m * 2)[0][0] + (2 * m)[1][1]", 6},
        {"determinant(m)", 2},
        {"(inverse(m) * (m * v)).y", 2},
        {"transpose(m)[0].y", 5},
        {"matrix33(vector(1), vector(2), v)[2].z", 3},
        {"matrix33(1, 2, 3, 4, 5, 6, 7, 8, 9)[1].x", 4},
        {"matrix33(3)[1][1] + matrix33(3)[1][0]", 3},
        {"matrix33(matrix44(m))[1].x + matrix44(m)[3].w", 6},
        {"(point(v) - point(1)).z", 2},
        {"(normal(v) + vector(1)).z", 4},
        {"dot(point(v), normal(1, 0, 0))", 1},
        {"refract(vector(0, 0, -1), vector(0, 0, 1), 1).z", -1},
        {"known(1 < 2) ? 1 : 0", 1},
        {"known(a < 2) ? 1 : 0", 0},
        {"abs(-3) + sign(-2.0) + floor(1.5) + ceil(1.5) + fract(1.25) + round(1.8)", 7.25f},
    };
    for (const Expected& e : cases) {
        std::vector<float> values;
        EXPECT_EQ(inlineText(e.text, Type::Float, values), "") << e.text;
        ASSERT_EQ(values.size(), 1u) << e.text;
        EXPECT_NEAR(values[0], e.value, 1e-5f) << e.text;
    }
}

TEST(Expressions, ConvertToTheResult) {
    std::vector<float> values;
    EXPECT_EQ(inlineText("2", Type::Color3, values), "");
    EXPECT_EQ(values, (std::vector<float>{2, 2, 2}));
    values.clear();
    EXPECT_EQ(inlineText("normal(v)", Type::Vector3, values), "");
    EXPECT_EQ(values, (std::vector<float>{1, 2, 3}));
    values.clear();
    EXPECT_EQ(inlineText("c * 4 + i", Type::Color3, values), "");
    EXPECT_EQ(values, (std::vector<float>{7, 8, 9}));
    values.clear();
    EXPECT_EQ(inlineText("i == 7", Type::Boolean, values), "");
    EXPECT_EQ(values, (std::vector<float>{1}));
}

TEST(Expressions, Refused) {
    const char* cases[] = {
        "c + v",
        "v + vector2(1)",
        "v == v",
        "c < 1",
        "i ? 1 : 2",
        "!a",
        "~a",
        "a % 2",
        "a & 1",
        "-true",
        "true + 1",
        "v * m",
        "m + v",
        "vector2(1, 2, 3)",
        "vector(c, 1)",
        "vector2(v)",
        "float(v)",
        "matrix33(1, 2)",
        "v.w",
        "v.xg",
        "v.xyzxy",
        "a.x",
        "v[3]",
        "v[-1]",
        "m[3]",
        "a[0]",
        "v[0.5]",
        "dot(v, c)",
        "dot(a, a)",
        "cross(c, c)",
        "normalize(a)",
        "sin(true)",
        "nothing",
        "nothing(1)",
        "sin(1, 2)",
        "known(1)",
        "\"a\" + \"b\"",
        "{{b}}",
        "v",
        "c",
        "1 2",
        "",
        "(1",
        "1 +",
        "f(",
        "v.",
        "true ? c : v",
        "a = 1",
        "1.0f",
        "0x",
        "99999999999",
        "1e99",
        "\"open",
        "`",
        "{{a",
        "attribute(a, float)",
        "BSDF() * v",
        "BSDF() + EDF()",
        "int(\"1\")",
        "vector",
    };
    for (const char* text : cases) {
        std::vector<float> values;
        std::string message = inlineText(text, Type::Float, values);
        EXPECT_NE(message, "") << text;
        EXPECT_EQ(message.find("internal"), std::string::npos) << text << message;
    }
}

TEST(Expressions, SeveralResults) {
    NameTable names;
    ir::Module module(names);
    Diagnostics diagnostics;
    ir::Param in{names.intern("in"), Type::Color4};
    ir::Param out[] = {{names.intern("rgb"), Type::Color3}, {names.intern("a"), Type::Float}};
    ASSERT_TRUE(compileInline(module, names.intern("split"), std::span(&in, 1), out, {"inline", "{{in}}.rgb, {{in}}.a"},
                              {}, diagnostics));
    const ir::Function& f = *module.findOwn(names.intern("split"));
    ASSERT_EQ(f.results.size(), 2u);
    EXPECT_EQ(f.results[1].type, Type::Float);
    EXPECT_TRUE(f.isInline);
}

// ---- functions of one number, against the same in C++ ----

struct Case {
    const char* source;
    std::function<float(float)> expected;
};

static void check(const Case& c) {
    TestProgram p{c.source};
    ASSERT_TRUE(p.good) << c.source << "\n" << p.diagnostics.text();
    for (float x : {-2.0f, -1.0f, -0.5f, 0.0f, 0.5f, 1.0f, 2.0f, 3.0f, 7.0f})
        EXPECT_NEAR(p.number("f", {x}), c.expected(x), 1e-4f) << c.source << "\nx = " << x << "\n"
                                                              << ir::print(p.module);
}

TEST(Statements, Branches) {
    check({"float f(float x) { float y = 1; if (x > 0) y = x; else y = -x; return y + 1; }",
           [](float x) { return std::abs(x) + 1; }});
    check({"float f(float x) { float y = 1; if (x > 0) { y = 2; if (x > 1) y = 3; } return y; }", [](float x) {
               return x > 1 ? 3.0f : x > 0 ? 2.0f : 1.0f;
           }});
    check(
        {"float f(float x) { float y; if (x < 0) y = 1; else if (x < 1) y = 2; else if (x < 2) y = 3; else y = 4;"
         " return y; }",
         [](float x) {
             return x < 0 ? 1.0f : x < 1 ? 2.0f : x < 2 ? 3.0f : 4.0f;
         }});
    check(
        {"float f(float x) { float y = 0; if (x < 0) { float y2 = 5; y = y2; } { float x = 9; x += 1; y += x; }"
         " return y + x; }",
         [](float x) { return (x < 0 ? 5.0f : 0.0f) + 10 + x; }});
    check({"float f(float x) { x *= 2; x -= 1; x /= 4; x += 3; return x; }",
           [](float x) { return (x * 2 - 1) / 4 + 3; }});
    check({"float f(float x) { int n = 6; n++; --n; n <<= 2; n |= 1; n ^= 3; n %= 16; return n + x; }",
           [](float x) { return static_cast<float>(((6 << 2 | 1) ^ 3) % 16) + x; }});
}

TEST(Statements, Returns) {
    check({"float f(float x) { if (x < 0) return 1; return 2; }", [](float x) { return x < 0 ? 1.0f : 2.0f; }});
    check({"float f(float x) { if (x < 0) return 1; else return 2; }", [](float x) { return x < 0 ? 1.0f : 2.0f; }});
    check({"float f(float x) { float y = x; if (x < 1) { if (x < 0) return 10; y = 20; } y += 1; return y; }",
           [](float x) { return x < 0   ? 10
                                : x < 1 ? 21
                                        : x + 1; }});
    check(
        {"float f(float x) { float y = 1; if (x < 1) { if (x < 0) return 10; y = 20; } else { if (x > 2) return 30; y "
         "= 5; }"
         " return y; }",
         [](float x) {
             return x < 0 ? 10.0f : x < 1 ? 20.0f : x > 2 ? 30.0f : 5.0f;
         }});
    check(
        {"float f(float x) { if (x < 0) return 1; if (x < 1) return 2; if (x < 2) return 3; return 4; }", [](float x) {
             return x < 0 ? 1.0f : x < 1 ? 2.0f : x < 2 ? 3.0f : 4.0f;
         }});
    check({"float f(float x) { float y; if (x < 0) return 1; else y = 2; if (x > 1) { y = 3; return y; } return y; }",
           [](float x) { return x < 0   ? 1.0f
                                : x > 1 ? 3.0f
                                        : 2.0f; }});
    check(
        {"float f(float x) { float y = 0; if (x > 5) { y = 1; } else if (x > 1) { if (x > 2) return 7; y = 2; }"
         " else if (x < 0) return 8; return y; }",
         [](float x) {
             return x > 5 ? 1.0f : x > 2 ? 7.0f : x > 1 ? 2.0f : x < 0 ? 8.0f : 0.0f;
         }});
    check({"float f(float x) { { if (x < 0) { return 1; } } { return 2; } }",
           [](float x) { return x < 0 ? 1.0f : 2.0f; }});
}

TEST(Statements, Loops) {
    check({"float f(float x) { float s = x; for (int i = 0; i < 4; i++) s += i; return s; }",
           [](float x) { return x + 6; }});
    check({"float f(float x) { int s = 0; for (int i = 2; i <= 10; i += 3) { s = s * 10 + i; } return s + x; }",
           [](float x) { return 258 + x; }});
    check({"float f(float x) { int s = 0; for (int i = 2; i < 10; i += 4) { s = s * 10 + i; } return s + x; }",
           [](float x) { return 26 + x; }});
    check(
        {"float f(float x) { int n = int(x); int s = 0; for (int i = 0; i < n; i++) for (int j = i; j < n; ++j) s += j;"
         " return s; }",
         [](float x) {
             float s = 0;
             for (int i = 0; i < static_cast<int>(x); i++)
                 for (int j = i; j < static_cast<int>(x); j++) s += static_cast<float>(j);
             return s;
         }});
    check(
        {"float f(float x) { float a = 0; float b = 1; for (int i = 0; i < 10; i++) { float t = a; a = b; b = t + b; }"
         " return a + x; }",
         [](float x) { return 55 + x; }});
    check(
        {"float f(float x) { float s = 0; float t; for (int i = 0; i < int(x); i += 1) { t = i; if (t > 2) s += t; "
         "else s -= x; }"
         " return s; }",
         [](float x) {
             float s = 0;
             for (int i = 0; i < static_cast<int>(x); i++) s += i > 2 ? static_cast<float>(i) : -x;
             return s;
         }});
    check({"float f(float x) { float s = x; for (int i = 5; i < 2; i++) s = 100; return s; }",
           [](float x) { return x; }});
    check(
        {"float f(float x) { float s = 0; if (x > 0) { for (int i = 0; i < 3; i++) { s += x; } } else s = 9; return s; "
         "}",
         [](float x) { return x > 0 ? 3 * x : 9; }});
    check({"float f(float x) { vector v = vector(x); for (int i = 0; i < 3; i++) v.y += i; return v.x + v.y; }",
           [](float x) { return 2 * x + 3; }});
}

TEST(Statements, Components) {
    check(
        {"float f(float x) { vector v; v.x = x; v.zy = vector2(2, 3); v.y *= 2; v[0] += 1; return dot(v, vector(1, 10, "
         "100)); }",
         [](float x) { return x + 1 + 60 + 200; }});
    check({"float f(float x) { color4 c = color4(1, 2, 3, 4); c.rgb *= x; c.a = c.r; return c.a + c.g + c.b; }",
           [](float x) { return x * 6; }});
    check({"float f(float x) { matrix33 m = matrix33(1.0); m[1] = vector(x, 2, 3); return (m * vector(1)).x; }",
           [](float x) { return 1 + x; }});
    check(
        {"float f(float x) { vector2 v; if (x < 0) { v.x = 1; v.y = 2; } else v = vector2(3, x); v.x += 1; return v.x "
         "* 10 + v.y; }",
         [](float x) { return x < 0 ? 22 : 40 + x; }});
}

TEST(Functions, CallsAndOutputs) {
    check(
        {"void pair(float a, output float twice, output float square) { twice = a * 2; square = a * a; }\n"
         "float f(float x) { float t; float s = 0; pair(x, t, s); return t + s; }",
         [](float x) { return 2 * x + x * x; }});
    check(
        {"float both(float a, output float b) { b = a + 1; return a * 2; }\n"
         "float f(float x) { float y = 0; float z = both(x, y) + y; return z; }",
         [](float x) { return 2 * x + x + 1; }});
    check(
        {"bool ask(float a, output float b) { b = a + 1; return a > 1; }\n"
         "float f(float x) { float y = 50; if (x > 0 && ask(x, y)) return y; return y + 100; }",
         [](float x) { return x > 1   ? x + 1
                              : x > 0 ? x + 101
                                      : 150; }});
    check(
        {"bool ask(float a, output float b) { b = a + 1; return a > 1; }\n"
         "float f(float x) { float y = 50; bool t = x > 0 || ask(x, y); return t ? y : -y; }",
         [](float x) { return x > 0 ? 50 : -(x + 1); }});
    check(
        {"float both(float a, output float b) { b = a + 1; return a * 2; }\n"
         "float f(float x) { float y = 5; float z = x > 0 ? both(x, y) : 3; return z * 100 + y; }",
         [](float x) { return x > 0 ? 200 * x + x + 1 : 305; }});
    check(
        {"void split(vector v, output float a, output vector2 b) { a = v.x; b = v.yz; }\n"
         "float f(float x) { vector4 r = vector4(0); split(vector(x, 2, 3), r.w, r.xy); return r.x * 10 + r.y + r.w; }",
         [](float x) { return 23 + x; }});
    check(
        {"void step_(float a, output float b) { b = a + 2; }\n"
         "float f(float x) { float s = x; for (int i = 0; i < 3; i++) { float t; step_(s, t); s = t; step_(s, s); } "
         "return s; }",
         [](float x) { return x + 12; }});
    check(
        {"void early(float a, output float b, output float c) { b = 1; c = 2; if (a < 0) return; b = 3; if (a > 1) { c "
         "= 4; return; } c = 5; }\n"
         "float f(float x) { float b; float c; early(x, b, c); return b * 10 + c; }",
         [](float x) { return x < 0   ? 12.0f
                              : x > 1 ? 34.0f
                                      : 35.0f; }});
    check(
        {"color color_(color color) { return color * 2; } float f(float x) { color color = color_(color(x)); return "
         "color.r; }",
         [](float x) { return 2 * x; }});
}

TEST(Functions, Overloads) {
    TestProgram p{
        "float g(float a) { return 1; }\nfloat g(color a) { return 2; }\nfloat g(float a, float b) { return 3; }\n"
        "float h(int i) { return g(i); }\nfloat k(vector v) { return g(v.x, 1); }\nfloat l() { return g(color(1)); }",
        "void n(float a, output float r) { r = 1; } void n(float a, output color r) { r = color(2); }\n"
        "void m(output float x, output float y) { n(0, x); color c; n(0, c); y = c.r; }"};
    ASSERT_TRUE(p.good) << p.diagnostics.text();
    EXPECT_EQ(p.number("h", {3}), 1);
    EXPECT_EQ(p.number("k", {1, 2, 3}), 3);
    EXPECT_EQ(p.number("l", {}), 2);
    EXPECT_EQ(p.run("m", {}), (std::vector<float>{1, 2}));
    EXPECT_EQ(p.names.text(p.made[0].name), "g__float");
    EXPECT_EQ(p.names.text(p.made[1].name), "g__color3");
    EXPECT_EQ(p.names.text(p.made[2].name), "g__float_float");
    EXPECT_EQ(p.names.text(p.made[3].name), "h");
    EXPECT_NE(p.made[6].name, p.made[7].name);
    EXPECT_EQ(p.made[1].params[0].type, Type::Color3);
    EXPECT_EQ(p.made[1].result, Type::Float);
}

TEST(Functions, OfALibrary) {
    TestProgram library{
        "float g(float a) { return a * 3; }\nvoid two(float a, output float b, output float c) { b = a; c = -a; }"};
    NameTable& names = library.names;
    std::vector<Signature> made;
    SourceFile user{"user.sl",
                    "float f(float x) { float b; float c; two(x, b, c); return g(b) - c; }\n"
                    "float g(color c) { return c.r; }"};
    ASSERT_TRUE(compile(library.module, std::span(&user, 1), library.made, made, library.diagnostics))
        << library.diagnostics.text();
    EXPECT_EQ(library.number("f", {2}), 8);
    EXPECT_EQ(names.text(made[1].name), "g__color3");
    SourceFile again{"again.sl", "float g(float other) { return other; }"};
    EXPECT_FALSE(compile(library.module, std::span(&again, 1), library.made, made, library.diagnostics));
}

TEST(Functions, Inline) {
    TestProgram p{
        "float a(float x) { return x * 2 + 1; }\n"
        "float b(float x) { return a(x) + a(x + 1); }\n"
        "float c(float x) { float y = x; return y; }\n"
        "float d(float x) { return c(x); }\n"
        "inline float e(float x) { float y = x; return y; }\n"
        "float g(float x) { return sin(x) + cos(x) + tan(x) + asin(x) + acos(x) + atan(x); }\n"
        "void h(float x, output float r) { r = x; }\n"};
    ASSERT_TRUE(p.good);
    EXPECT_TRUE(p["a"].isInline);
    EXPECT_TRUE(p["b"].isInline);
    EXPECT_FALSE(p["c"].isInline);
    EXPECT_FALSE(p["d"].isInline);
    EXPECT_TRUE(p["e"].isInline);
    EXPECT_FALSE(p["g"].isInline);
    EXPECT_TRUE(p["h"].isInline);
}

TEST(Functions, CommentsAndHints) {
    TestProgram p{
        "// A file of functions.\n\n// What f does,\n//   on two lines.\nfloat f(float x) { float twice = x * 2; "
        "return twice + 1; }\n"
        "float g(float x) { return x; } // not of h\nfloat h(float x) { return x; }\n"
        "/* One.\n * Two.\n */\ninline float k(float x) { return x; }"};
    ASSERT_TRUE(p.good);
    EXPECT_EQ(p["f"].comment, "What f does,\non two lines.");
    EXPECT_EQ(p["h"].comment, "");
    EXPECT_EQ(p["k"].comment, "One.\nTwo.");
    EXPECT_NE(ir::print(p.module, p["f"]).find("\"twice\""), std::string::npos) << ir::print(p.module, p["f"]);
    EXPECT_EQ(p.names.text(p["f"].results[0].name), "out");
}

TEST(Functions, Constants) {
    TestProgram p{
        "const float TWO_PI = 2 * PI;\nconst float PI = 3.0;\nfloat f(float x) { return TWO_PI + x; }",
        "const float PI = 4.0; const color GREY = color(HALF); const string MODE = \"a\"; const float HALF = 0.5;\n"
        "float g() { return PI + GREY.g; } float h(string m) { return m == MODE ? 1 : 0; } float k() { return TWO_PI; "
        "}"};
    ASSERT_TRUE(p.good) << p.diagnostics.text();
    EXPECT_EQ(p.number("f", {1}), 7);
    EXPECT_EQ(p.number("g", {}), 4.5f);
    EXPECT_EQ(p.number("k", {}), 6);
}

TEST(Functions, ConstantsOfOtherFilesMustAgree) {
    EXPECT_TRUE((TestProgram{"const float K = 1;", "const float K = 1;", "float f() { return K; }"}.good));
    EXPECT_FALSE((TestProgram{"const float K = 1;", "const float K = 2;", "float f() { return K; }"}.good));
    EXPECT_TRUE((TestProgram{"const float K = 1;", "const float K = 2; float f() { return K; }"}.good));
}

TEST(Functions, ContextAndAttributes) {
    struct World : ir::Environment {
        bool context(ir::Context c, ir::Value& v) override {
            v.set(0, c == ir::Context::Time ? 5.0f : 1.0f);
            return true;
        }
        bool attribute(Name, ir::Value& v) override {
            v.set(1, 3.0f);
            return true;
        }
    } world;
    TestProgram p{
        "float f(float x) { return time + x + attribute(\"texcoord_0\", vector2).y; }\nfloat g(float time) { return "
        "time; }"};
    ASSERT_TRUE(p.good) << p.diagnostics.text();
    EXPECT_EQ(p.run("f", {2}, world), std::vector<float>{10});
    EXPECT_EQ(p.run("g", {2}, world), std::vector<float>{2});
}

TEST(Functions, Closures) {
    TestProgram p{
        "BSDF f(BSDF a, BSDF b, float w, color c) { return layer(mix(a, b, w) * c, 2 * a + b * w); }\n"
        "surfaceshader s(BSDF a, EDF e) { return mix(surface(a, e * 0.5, 1, false), surface(BSDF(), EDF(), 0.5, true), "
        "0.25); }\n"
        "surfaceshader u() { return surface_unlit(color(1), color(0), 1); }\n"
        "volumeshader v(VDF a, EDF e) { return volume(a + a, e); }\n"
        "displacementshader d(float h) { return mix(displacement(h, 1), displacement(vector(h), 2), 0.5); }\n"
        "color4 t(texture2d m, vector2 uv) { return texture(m, uv) + texture_level(m, uv, 2)"
        " + texture_grad(m, uv, Dx(uv), Dy(uv)) + texture_size(m).x; }"};
    ASSERT_TRUE(p.good) << p.diagnostics.text();
    std::string text = ir::print(p.module);
    for (const char* op : {"closure_mix BSDF", "closure_scale BSDF", "closure_add BSDF", "closure_layer BSDF",
                           "closure_mix surfaceshader", "surface surfaceshader", "surface_unlit", "volume volumeshader",
                           "displacement displacementshader", "texture_grad color4", "ddx vector2", "texture_level",
                           "texture_size vector2"})
        EXPECT_NE(text.find(op), std::string::npos) << op << "\n" << text;
}

// ---- what must not be a matter of luck ----

static const char* const kSample = R"(// Comment.
const float PI = 3.14159;
inline float sq(float x) { return x * x; }
/* block */
void node(color c, vector2 uv, string mode, output color r, output float g)
{
    float s = 0.5e-1 * PI;
    r = color(0);
    for (int i = 0; i <= 3; i += 2) { s += sq(float(i)) - uv.x; if (s > 1 && mode == "a\n") s = -s; }
    r.rg = uv * s;
    if (c[0] < 0x10) { g = 1; return; } else if (true) g = c.r > .5 ? s : 2.; else g = 0;
    r = mix(r, c, g);
}
)";

TEST(Robust, EveryTruncation) {
    std::string_view whole = kSample;
    for (std::size_t n = 0; n <= whole.size(); n++) {
        std::string cut(whole.substr(0, n));
        TestProgram p{cut};
        EXPECT_FALSE(p.diagnostics.hasInternal());
    }
    EXPECT_TRUE(TestProgram{whole}.good);
}

TEST(Robust, EveryByteLeftOutOrReplaced) {
    std::string_view whole = kSample;
    for (std::size_t n = 0; n < whole.size(); n++)
        for (const char* with : {"", "(", "}", "\"", "9", ";", "\xff"}) {
            std::string text = std::string(whole.substr(0, n)) + with + std::string(whole.substr(n + 1));
            TestProgram p{text};
            EXPECT_FALSE(p.diagnostics.hasInternal());
        }
}

TEST(Robust, RandomTokens) {
    const char* words[] = {"float",  "color", "x",  "f",    "(",   ")",      "{", "}",   ";",  ",",     "=",    "+",
                           "-",      "*",     "if", "else", "for", "return", "1", "2.5", "<",  "int",   "i",    "++",
                           "output", "void",  ".",  "xy",   "[",   "]",      "?", ":",   "&&", "const", "BSDF", "mix"};
    std::uint32_t seed = 1;
    for (int round = 0; round < 2000; round++) {
        std::string text = round % 2 ? "float f(float x) { float y = x; " : "";
        for (int k = 0; k < 60; k++) {
            seed = seed * 1664525u + 1013904223u;
            text += words[(seed >> 8) % std::size(words)];
            text += ' ';
        }
        TestProgram p{text};
        EXPECT_FALSE(p.diagnostics.hasInternal());
    }
}

TEST(Robust, RandomBytes) {
    std::uint32_t seed = 7;
    for (int round = 0; round < 200; round++) {
        std::string text;
        for (int k = 0; k < 300; k++) {
            seed = seed * 1664525u + 1013904223u;
            text += static_cast<char>(seed >> 16);
        }
        TestProgram p{text};
        EXPECT_FALSE(p.good);
    }
}

static std::string repeat(std::string_view what, int n) {
    std::string all;
    for (int k = 0; k < n; k++) all += what;
    return all;
}

TEST(Robust, DeepAndLong) {
    const int n = 30000;
    for (std::string_view open : {"(", "-", "!", "f(", "x[", "x ? ", "1 + (", "~"}) {
        TestProgram p{"float f(float x) { return " + repeat(open, n) + "x; }"};
        EXPECT_FALSE(p.good);
        EXPECT_LE(p.diagnostics.all().size(), 3u) << p.diagnostics.text();
    }
    for (std::string_view open :
         {"{", "if (true) ", "if (true) {", "for (int i = 0; i < 2; i++) ", "if (true) ; else "}) {
        TestProgram p{"void f(output float x) { x = 1; " + repeat(open, n)};
        EXPECT_FALSE(p.good);
        EXPECT_LE(p.diagnostics.all().size(), 3u) << p.diagnostics.text();
    }
    EXPECT_FALSE(TestProgram{"float f(vector v) { return v" + repeat(".xyz", n) + ".x; }"}.good);
    EXPECT_FALSE(TestProgram{std::string("float f(float x) { return ") + std::string(1 << 20, 'a') + "; }"}.good);
    EXPECT_FALSE(TestProgram{std::string("float f(float x) { return ") + std::string(1 << 20, '1') + "; }"}.good);
    EXPECT_FALSE(TestProgram{repeat("}", n)}.good);
    EXPECT_FALSE(TestProgram{repeat("@ a ", n)}.good);
    // Long is not deep.
    TestProgram sum{"float f(float x) { return x" + repeat(" + sin(x)", 5000) + "; }"};
    EXPECT_TRUE(sum.good) << sum.diagnostics.text();
    TestProgram chain{"float f(float x) { float y = 0; if (x < 0) y = 1;" + repeat(" else if (x < 1) y = 2;", 2000) +
                      " return y; }"};
    EXPECT_TRUE(chain.good) << chain.diagnostics.text();
    TestProgram returns{"float f(float x) { " + repeat("if (x < 1) return x + 1; ", 2000) + " return 0; }"};
    EXPECT_TRUE(returns.good) << returns.diagnostics.text();
    std::string calls = "float f0(float x) { return x; }";
    for (int k = 1; k < 5000; k++)
        calls += "float f" + std::to_string(k) + "(float x) { return f" + std::to_string(k - 1) + "(x); }\n";
    TestProgram functions{calls};
    EXPECT_TRUE(functions.good);
    EXPECT_TRUE(functions["f4999"].isInline);
}

}  // namespace shaderx::sl
