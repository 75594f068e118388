#include "ir/interpret.h"

#include <array>
#include <bit>
#include <random>

#include <gtest/gtest.h>

#include "ir/builder.h"
#include "ir/testing.h"

namespace shaderx::ir {
namespace {

Value number(float v) {
    Value out;
    out.type = Type::Float;
    out.set(0, v);
    return out;
}
Value integer(int v) {
    Value out;
    out.type = Type::Integer;
    out.words[0] = static_cast<std::uint32_t>(v);
    return out;
}
Value boolean(bool v) {
    Value out;
    out.type = Type::Boolean;
    out.words[0] = v;
    return out;
}

// Counts what is asked of it.
struct World : Environment {
    const NameTable* names = nullptr;
    float x = 0;
    int lights = 0, reads = 0;
    TextureRead last;

    bool context(Context c, Value& v) override {
        if (c == Context::Time) v.set(0, 2.5f);
        if (c == Context::ActiveLights) v.words[0] = static_cast<std::uint32_t>(lights);
        return c == Context::Time || c == Context::ActiveLights;
    }
    bool attribute(Name, Value& v) override {
        for (int i = 0; i < componentCount(v.type); i++) v.set(i, x + static_cast<float>(i));
        return true;
    }
    bool uniform(Name name, Value& v) override {
        if (names->text(name) != "supplied") return false;
        v.set(0, 8);
        return true;
    }
    bool texture(const TextureRead& r, Value& v) override {
        reads++;
        last = r;
        for (int i = 0; i < componentCount(v.type); i++) v.set(i, r.uv[0] + r.level);
        return true;
    }
    bool textureSize(const TextureRef&, Value& v) override {
        v.set(0, 640);
        v.set(1, 480);
        return true;
    }
};

struct Trial {
    TestModule m;
    Diagnostics diagnostics;
    InterpreterOptions options;
    World world;
    std::uint64_t steps = 0;

    explicit Trial(std::string_view text) : m(parseModule(text)) { world.names = m.names.get(); }

    // The first result of `f`.
    Value operator()(std::initializer_list<Value> arguments) {
        std::vector<Value> results(m["f"].results.size());
        EXPECT_TRUE(run(arguments, results)) << diagnostics.text();
        return results.empty() ? Value() : results[0];
    }
    bool run(std::initializer_list<Value> arguments, std::span<Value> results) {
        Interpreter interpreter(*m.module, diagnostics, options);
        const bool fine = interpreter.run(m["f"], std::span(arguments.begin(), arguments.size()), results, world);
        steps = interpreter.steps();
        return fine;
    }
    // What a run that must fail says.
    std::string failure(std::initializer_list<Value> arguments) {
        std::vector<Value> results(m["f"].results.size());
        EXPECT_FALSE(run(arguments, results));
        return diagnostics.text();
    }
};

void expectPart(const std::string& text, std::string_view part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(Interpret, Arithmetic) {
    Trial f(R"(function f(a: float, b: color3) -> (r: color3, s: float) {
        %a = param float a
        %b = param color3 b
        %two = constant float 2
        %c = mul color3 %a, %b
        %d = add color3 %c, %two
        %x = swizzle float %d, z
        return %d, %x
    })");
    Value b;
    b.type = Type::Color3;
    for (int i = 0; i < 3; i++) b.set(i, static_cast<float>(i + 1));
    const Value r = f({number(10), b});
    EXPECT_EQ(r.type, Type::Color3);
    EXPECT_EQ(r.f(0), 12);
    EXPECT_EQ(r.f(2), 32);
}

TEST(Interpret, ResultsMayBeArgumentsAndConstants) {
    Trial f(
        "function f(a: float) -> (r: float, s: float, t: boolean, u: boolean) {\n%a = param float a\n"
        "%c = constant float 7\n%z = less boolean %a, %c\n%k = known boolean %z\n%y = constant boolean true\n"
        "%l = known boolean %y\nreturn %a, %c, %k, %l\n}");
    Value r[4];
    ASSERT_TRUE(f.run({number(1)}, r)) << f.diagnostics.text();
    EXPECT_EQ(r[0].f(0), 1);
    EXPECT_EQ(r[1].f(0), 7);
    EXPECT_FALSE(r[2].b());  // not provable
    EXPECT_TRUE(r[3].b());
}

constexpr std::string_view kTriangle = R"(function f(n: integer) -> (sum: integer) {
        %n = param integer n
        %zero = constant integer 0
        %one = constant integer 1
        %i = loop_arg integer loop 0, 0
        %s = loop_arg integer loop 0, 1
        %i1 = add integer %i, %one
        %t = add integer %s, %i1
        %l = loop tuple loop 0, %n | %zero | %t
        %r = result integer %l, 0
        return %r
    })";

TEST(Interpret, LoopsCount) {
    Trial f(kTriangle);
    for (int n : {0, 1, 2, 10, 1000}) EXPECT_EQ(f({integer(n)}).i(0), n * (n + 1) / 2);
    EXPECT_EQ(f({integer(-5)}).i(0), 0);
}

TEST(Interpret, CarriedValuesChangeAtOnce) {
    Trial f(R"(function f(n: integer) -> (a: integer, b: integer) {
        %n = param integer n
        %zero = constant integer 0
        %one = constant integer 1
        %a = loop_arg integer loop 0, 1
        %b = loop_arg integer loop 0, 2
        %s = add integer %a, %b
        %l = loop tuple loop 0, %n | %zero, %one | %b, %s
        %x = result integer %l, 0
        %y = result integer %l, 1
        return %x, %y
    })");
    int a = 0, b = 1;
    for (int n = 0; n < 20; n++) {
        Value r[2];
        ASSERT_TRUE(f.run({integer(n)}, r)) << f.diagnostics.text();
        EXPECT_EQ(r[0].i(0), a);
        EXPECT_EQ(r[1].i(0), b);
        const int c = a + b;
        a = b;
        b = c;
    }
}

TEST(Interpret, SwapsInALoop) {
    Trial f(R"(function f(n: integer) -> (a: integer) {
        %n = param integer n
        %p = constant integer 10
        %q = constant integer 20
        %a = loop_arg integer loop 0, 1
        %b = loop_arg integer loop 0, 2
        %l = loop tuple loop 0, %n | %p, %q | %b, %a
        %x = result integer %l, 0
        return %x
    })");
    EXPECT_EQ(f({integer(0)}).i(0), 10);
    EXPECT_EQ(f({integer(1)}).i(0), 20);
    EXPECT_EQ(f({integer(2)}).i(0), 10);
}

// The sum over i < n of the sum over j < i of (i j + n), where the inner loop starts anew for each i; and in it a third
// loop whose body takes what the second one gives.
constexpr std::string_view kNested = R"(function f(n: integer) -> (sum: integer) {
        %n = param integer n
        %zero = constant integer 0
        %i = loop_arg integer loop 0, 0
        %s = loop_arg integer loop 0, 1
        %j = loop_arg integer loop 1, 0
        %t = loop_arg integer loop 1, 1
        %ij = mul integer %i, %j
        %ijn = add integer %ij, %n
        %t1 = add integer %t, %ijn
        %inner = loop integer loop 1, %i | %zero | %t1
        %three = constant integer 3
        %k = loop_arg integer loop 2, 0
        %u = loop_arg integer loop 2, 1
        %ki = mul integer %k, %inner
        %u1 = add integer %u, %ki
        %third = loop integer loop 2, %three | %zero | %u1
        %s1 = add integer %s, %third
        %outer = loop integer loop 0, %n | %zero | %s1
        return %outer
    })";

int nested(int n) {
    int sum = 0;
    for (int i = 0; i < n; i++) {
        int inner = 0, third = 0;
        for (int j = 0; j < i; j++) inner += i * j + n;
        for (int k = 0; k < 3; k++) third += k * inner;
        sum += third;
    }
    return sum;
}

TEST(Interpret, LoopsNest) {
    Trial f(kNested);
    for (int n : {0, 1, 2, 7, 20}) EXPECT_EQ(f({integer(n)}).i(0), nested(n)) << n;
}

// The third loop stands in the first only because its body takes what the second gives.
TEST(Interpret, LoopsOfKnowsTheNest) {
    TestModule m = parseModule(kNested);
    const std::vector<std::uint32_t> loops = loopsOf(m["f"]);
    EXPECT_EQ(loops[9], 0u);   // inner
    EXPECT_EQ(loops[13], 2u);  // ki
    EXPECT_EQ(loops[15], 0u);  // third
    EXPECT_EQ(loops[17], kNoLoop);
    EXPECT_EQ(loops[0], kNoLoop);
}

TEST(Interpret, WhatALoopDoesNotChangeIsComputedOnce) {
    Trial f(R"(function f(n: integer) -> (sum: float) {
        %n = param integer n
        %zero = constant float 0
        %uv = attribute vector2 uv
        %tex = uniform texture2d t
        %read = texture_level float %tex, %uv, %zero
        %s = loop_arg float loop 0, 1
        %t = add float %s, %read
        %l = loop float loop 0, %n | %zero | %t
        return %l
    }
    uniform t: texture2d)");
    f.world.x = 3;
    EXPECT_EQ(f({integer(50)}).f(0), 150);
    EXPECT_EQ(f.world.reads, 1);
}

constexpr std::string_view kCalls = R"(function two(x: float, t: texture2d) -> (p: float, q: vector2, r: float) {
        %x = param float x
        %one = constant float 1
        %a = add float %x, %one
        %t = param texture2d t
        %s = texture_size vector2 %t
        return %a, %s, %x
    }
    function f(a: float) -> (r: float) {
        %a = param float a
        %tex = uniform texture2d t
        %c = call tuple two %a, %tex
        %d = result float %c, 0
        %v = result vector2 %c, 1
        %e = result float %c, 2
        %de = mul float %d, %e
        %c2 = call tuple two %de, %tex
        %d2 = result float %c2, 0
        %w = swizzle float %v, y
        %r = add float %d2, %w
        %g = call float g %r
        return %g
    }
    function g(z: float) -> (r: float) {
        %z = param float z
        %n = neg float %z
        return %n
    }
    uniform t: texture2d)";

TEST(Interpret, CallsGiveSeveralResults) {
    Trial f(kCalls);
    EXPECT_EQ(f({number(3)}).f(0), -(4 * 3 + 1 + 480));
}

TEST(Interpret, SelectRunsOnlyTheSideTaken) {
    const std::string text = std::string(kTriangle).replace(std::string(kTriangle).find("f("), 2, "triangle(") + R"(
    function f(c: boolean, d: boolean, a: float) -> (r: float) {
        %c = param boolean c
        %d = param boolean d
        %a = param float a
        %uv = make vector2 %a
        %tex = uniform texture2d t
        %read = texture_level float %tex, %uv, %a
        %big = constant integer 100000
        %sum = call integer triangle %big
        %x = convert float %sum
        %y = add float %x, %read
        %inner = select float %d, %y, %read
        %r = select float %c, %inner, %a
        return %r
    }
    uniform t: texture2d)";
    Trial f(text);
    f.options.maxSteps = 1000;
    EXPECT_EQ(f({boolean(false), boolean(true), number(4)}).f(0), 4);
    EXPECT_EQ(f.world.reads, 0);
    EXPECT_EQ(f({boolean(true), boolean(false), number(4)}).f(0), 8);
    EXPECT_EQ(f.world.reads, 1);
    expectPart(f.failure({boolean(true), boolean(true), number(4)}), "[step-limit]");
}

TEST(Interpret, SelectInALoopRunsOnlyTheSideTaken) {
    Trial f(R"(function f(n: integer) -> (sum: float) {
        %n = param integer n
        %zero = constant float 0
        %i = loop_arg integer loop 0, 0
        %s = loop_arg float loop 0, 1
        %three = constant integer 3
        %c = less boolean %i, %three
        %x = convert float %i
        %uv = make vector2 %x
        %tex = uniform texture2d t
        %read = texture_level float %tex, %uv, %zero
        %add = select float %c, %read, %zero
        %t = add float %s, %add
        %l = loop float loop 0, %n | %zero | %t
        return %l
    }
    uniform t: texture2d)");
    EXPECT_EQ(f({integer(50)}).f(0), 0 + 1 + 2);
    EXPECT_EQ(f.world.reads, 3);
}

TEST(Interpret, AsksTheWorld) {
    Trial f(R"(uniform supplied: float = 1
    uniform usual: float = 16
    function f() -> (r: float) {
        %t = context float time
        %s = uniform float supplied
        %u = uniform float usual
        %a = attribute float a
        %x = add float %t, %s
        %y = add float %x, %u
        %z = add float %y, %a
        return %z
    })");
    f.world.x = 100;
    EXPECT_EQ(f({}).f(0), 126.5f);
}

TEST(Interpret, ReadsImages) {
    Trial f(R"(function f() -> (r: color4) {
        %t = context texture2d environment_radiance
        %uv = constant vector2 1, 2
        %dx = constant vector2 3, 4
        %dy = constant vector2 5, 6
        %r = texture_grad color4 %t, %uv, %dx, %dy
        return %r
    })");
    EXPECT_EQ(f({}).type, Type::Color4);
    const TextureRead& r = f.world.last;
    EXPECT_EQ(r.texture.kind, TextureRef::Kind::Context);
    EXPECT_EQ(r.texture.context, Context::EnvironmentRadiance);
    EXPECT_TRUE(r.hasGradients);
    EXPECT_EQ(r.uv[1], 2);
    EXPECT_EQ(r.ddx[0], 3);
    EXPECT_EQ(r.ddy[1], 6);
}

TEST(Interpret, RunsOverTheLights) {
    Trial f(R"(function f() -> (r: integer) {
        %zero = constant integer 0
        %i = loop_arg integer loop 0, 0
        %s = loop_arg integer loop 0, 1
        %t = add integer %s, %i
        %l = lights tuple loop 0 | %zero | %t
        %r = result integer %l, 0
        return %r
    })");
    f.world.lights = 5;
    EXPECT_EQ(f({}).i(0), 0 + 1 + 2 + 3 + 4);
}

TEST(Interpret, GoesOnWhereNumbersEnd) {
    Trial f(
        "function f(a: float) -> (r: float) {\n%a = param float a\n%z = constant float 0\n%i = div float %a, %z\n"
        "%m = constant float 5\n%r = min float %i, %m\nreturn %r\n}");
    EXPECT_EQ(f({number(1)}).f(0), 5);
}

TEST(Interpret, LimitsStepsAndDepth) {
    Trial f(kTriangle);
    f.options.maxSteps = 10000;
    EXPECT_EQ(f.failure({integer(2000000000)}),
              "error: the program runs for more than 10000 steps [step-limit]\n  note: in f:\n"
              "    %7 = loop tuple loop 0, %0 | %1 | %6\n");
    Trial g("function f(a: float) -> (r: float) {\n%a = param float a\n%r = call float f %a\nreturn %r\n}");
    expectPart(g.failure({number(1)}), "error: more than 200 calls within calls [depth-limit]");
}

TEST(Interpret, RefusesByName) {
    Trial s("function f() -> (r: boolean) {\n%s = constant string \"s\"\n%r = equal boolean %s, %s\nreturn %r\n}");
    expectPart(s.failure({}), "the interpreter does not run 'constant' of string [cannot-interpret]");
    Trial c(
        "leaf d(w: float)\nfunction f(a: float) -> (r: BSDF) {\n%a = param float a\n%r = leaf BSDF d %a\nreturn %r\n}");
    expectPart(c.failure({number(1)}), "the interpreter does not run 'leaf' of BSDF");
    Trial e("extern x n \"\"\nfunction f() -> (r: float) {\n%r = extern_text float 0\nreturn %r\n}");
    expectPart(e.failure({}), "'extern_text'");
    Trial unused("function f() -> (r: float) {\n%s = constant string \"s\"\n%r = constant float 1\nreturn %r\n}");
    EXPECT_EQ(unused({}).f(0), 1);
    Trial args("function f(a: float) -> (r: float) {\n%a = param float a\nreturn %a\n}");
    expectPart(args.failure({integer(1)}), "argument 1 of 'f' is integer, not float [argument-type]");
    expectPart(args.failure({}), "[argument-count]");
    Trial unknown("function f() -> (r: float) {\n%a = context float frame\nreturn %a\n}");
    expectPart(unknown.failure({}), "[no-value]");
}

TEST(Interpret, RefusesWhatIsNotValid) {
    TestModule m = parseModule(
        "function f(n: integer) -> (r: float) {\n%n = param integer n\n%i = loop_arg float loop 3, 1\n"
        "return %i\n}",
        false);
    Diagnostics diagnostics;
    Interpreter interpreter(*m.module, diagnostics);
    World world;
    const Value n = integer(1);
    Value r;
    EXPECT_FALSE(interpreter.run(m["f"], std::span(&n, 1), std::span(&r, 1), world));
    EXPECT_TRUE(diagnostics.hasInternal());
}

TEST(Interpret, QuadsHaveDerivatives) {
    TestModule m = parseModule(R"(function slope(v: float) -> (r: float) {
        %v = param float v
        %s = mul float %v, %v
        %r = ddx float %s
        return %r
    }
    function f(c: boolean) -> (x: float, y: vector2, s: float) {
        %c = param boolean c
        %a = attribute vector2 uv
        %dx = swizzle float %a, x
        %x = ddx float %dx
        %y = ddy vector2 %a
        %s = call float slope %dx
        %zero = constant float 0
        %r = select float %c, %s, %zero
        return %x, %y, %r
    })");
    Diagnostics diagnostics;
    Interpreter interpreter(*m.module, diagnostics);
    std::array<World, 4> worlds;
    std::array<Environment*, 4> environments;
    const float at[] = {1, 3, 10, 40};
    for (std::size_t i = 0; i < 4; i++) {
        worlds[i].x = at[i];
        environments[i] = &worlds[i];
    }
    // A derivative under a condition that differs between the pixels is still taken by all.
    const Value c[] = {boolean(true), boolean(false), boolean(false), boolean(true)};
    Value r[12];
    ASSERT_TRUE(interpreter.runQuad(m["f"], c, r, environments)) << diagnostics.text();
    EXPECT_EQ(r[0].f(0), 2);
    EXPECT_EQ(r[3].f(0), 2);
    EXPECT_EQ(r[6].f(0), 30);
    EXPECT_EQ(r[1].f(0), 9);
    EXPECT_EQ(r[4].f(1), 37);
    EXPECT_EQ(r[2].f(0), 8);
    EXPECT_EQ(r[5].f(0), 0);
    EXPECT_EQ(r[11].f(0), 1500);
    World alone;
    EXPECT_FALSE(interpreter.run(m["f"], std::span(c, 1), std::span(r, 3), alone));
    expectPart(diagnostics.text(), "a derivative needs a quad of pixels [needs-quad]");
}

// Random programs of all that varies: what the interpreter gives is what evaluating every expression gives.
TEST(Interpret, RandomGraphsMatchPlainEvaluation) {
    std::mt19937 random(7);
    const Op ops[] = {Op::Add, Op::Sub, Op::Mul, Op::Min, Op::Max};
    for (int turn = 0; turn < 300; turn++) {
        NameTable names;
        Module module(names);
        Function& f = module.add(names.intern("f"));
        f.params.push_back({names.intern("a"), Type::Float});
        std::vector<float> values;
        const auto add = [&](Op op, Type type, std::vector<std::uint32_t> operands, float value) {
            f.exprs.push_back({op, 0, static_cast<std::uint16_t>(operands.size()), type, 0,
                               static_cast<std::uint32_t>(f.operands.size()), 0});
            for (std::uint32_t o : operands) f.operands.emplace_back(o);
            f.hints.emplace_back();
            values.push_back(value);
        };
        add(Op::Param, Type::Float, {}, 0.5f);
        while (f.exprs.size() < 60) {
            const auto any = [&] {
                std::uint32_t k = 0;
                do k = static_cast<std::uint32_t>(random() % f.exprs.size());
                while (f.exprs[k].type != Type::Float);
                return k;
            };
            const std::uint32_t a = any(), b = any(), c = any(), d = any();
            if (random() % 3) {
                const Op op = ops[random() % std::size(ops)];
                Value v[] = {number(values[a]), number(values[b])}, r;
                if (!evaluate(op, Type::Float, v, 0, r)) continue;
                add(op, Type::Float, {a, b}, r.f(0));
            } else {
                const bool less = values[a] < values[b];
                add(Op::Less, Type::Boolean, {a, b}, less);
                add(Op::Select, Type::Float, {static_cast<std::uint32_t>(f.exprs.size() - 1), c, d},
                    less ? values[c] : values[d]);
            }
        }
        std::uint32_t last = static_cast<std::uint32_t>(f.exprs.size() - 1);
        f.results.push_back({names.intern("r"), Type::Float, ExprId(last)});
        Diagnostics diagnostics;
        Interpreter interpreter(module, diagnostics);
        World world;
        const Value a = number(0.5f);
        Value r;
        ASSERT_TRUE(interpreter.run(f, std::span(&a, 1), std::span(&r, 1), world)) << diagnostics.text();
        EXPECT_EQ(r.words[0], std::bit_cast<std::uint32_t>(values.back())) << print(module);
    }
}

}  // namespace
}  // namespace shaderx::ir
