// What is printed, and that the language's own compiler takes it.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "ir/testing.h"
#include "passes/place.h"
#include "passes/prune.h"
#include "passes/random_programs.h"
#include "passes/specialise.h"
#include "passes/stages.h"
#include "targets/glsl/glsl.h"
#include "targets/glsl/names.h"

namespace shaderx::glsl {
namespace {

using namespace ir;

bool haveCompiler() { return std::system("command -v glslangValidator >/dev/null 2>&1") == 0; }

// All functions of a module.
void legaliseAll(Module& module) {
    for (auto& f : module.functions) legalise(*f);
}

// What the compiler says against a text, empty where it takes it.
std::string complaints(const std::string& text, std::string_view stage) {
    static int number = 0;
    auto file = std::filesystem::temp_directory_path() / ("shaderx_print_" + std::to_string(::getpid()) + "_" +
                                                          std::to_string(number++) + "." + std::string(stage));
    std::ofstream(file, std::ios::binary) << text;
    std::FILE* pipe = ::popen(("glslangValidator " + file.string() + " 2>&1").c_str(), "r");
    std::string said;
    for (int c; pipe && (c = std::fgetc(pipe)) != EOF;) said += static_cast<char>(c);
    bool good = pipe && ::pclose(pipe) == 0;
    std::filesystem::remove(file);
    return good ? "" : said + "\n" + text;
}

void expectCompiles(const Sources& s) {
    if (!haveCompiler()) return;
    EXPECT_EQ(complaints(s.pixel, "frag"), "");
    EXPECT_EQ(complaints(s.vertex, "vert"), "");
}

struct Print {
    TestModule m;
    Sources sources;

    // Prints the program of a text, whose entry is `main`. Legalising simplifies; without it the expressions print as
    // they are.
    explicit Print(std::string_view text, bool legalised = true) : m(parseModule(text)) {
        Name entry = m.names->intern("main");
        auto interface = passes::makeStages(*m.module, entry, m.names->intern("vertex"));
        if (legalised) legaliseAll(*m.module);
        for (auto& f : m.module->functions) {
            passes::PlaceOptions how;
            how.isEntry = f->name == entry;
            passes::place(*f, how);
        }
        Diagnostics broken;
        EXPECT_TRUE(validate(*m.module, *m.module->findOwn(entry), broken)) << broken.text();
        sources = print(*m.module, interface, "title");
        expectCompiles(sources);
    }
    void expect(std::string_view part) const {
        EXPECT_NE(sources.pixel.find(part), std::string::npos) << "no\n    " << part << "\nin\n" << sources.pixel;
    }
    void expectNot(std::string_view part) const {
        EXPECT_EQ(sources.pixel.find(part), std::string::npos) << part << "\nin\n" << sources.pixel;
    }
};

// One expression of uniforms: floats a, b, c; integers i, j, k; truth values p, q, r; vectors u, v; a matrix m.
std::string expression(std::string_view lines, std::string_view type) {
    std::string text;
    auto declare = [&](std::string_view t, std::string_view names, std::string_view values) {
        for (char n : names) text += fmt::format("uniform {}: {} = {}\n", n, t, values);
    };
    declare("float", "abc", "0.5");
    declare("integer", "ijk", "3");
    declare("boolean", "pqr", "true");
    declare("vector3", "uv", "1, 2, 3");
    declare("matrix33", "mn", "1, 0, 0, 0, 1, 0, 0, 0, 1");
    text += "\nfunction main() -> (out1: vector4) {\n";
    auto take = [&](std::string_view t, std::string_view names) {
        for (char n : names) text += fmt::format("    %{} = uniform {} {}\n", n, t, n);
    };
    take("float", "abc");
    take("integer", "ijk");
    take("boolean", "pqr");
    take("vector3", "uv");
    take("matrix33", "mn");
    text += lines;
    text += "\n    %zero = constant float 0\n    %one = constant float 1\n";
    if (type == "float") text += "    %value = add float %x, %zero\n";
    if (type == "integer" || type == "boolean") text += "    %value = convert float %x\n";
    if (type == "vector3") text += "    %value = swizzle float %x, x\n";
    if (type == "matrix33") text += "    %col = swizzle vector3 %x, column 0\n    %value = swizzle float %col, x\n";
    text += "    %out = make vector4 %value, %value, %value, %one\n    return %out\n}\n";
    return text;
}

struct Form {
    std::string_view type, lines, printed;
};

class Expressions : public testing::TestWithParam<Form> {};

TEST_P(Expressions, KeepTheirMeaning) {
    Print(expression(GetParam().lines, GetParam().type), false).expect(GetParam().printed);
}

INSTANTIATE_TEST_SUITE_P(
    Print, Expressions,
    testing::Values(
        Form{"float", "%y = sub float %b, %c\n%x = sub float %a, %y", "a - (b - c)"},
        Form{"float", "%y = sub float %a, %b\n%x = sub float %y, %c", "a - b - c"},
        Form{"float", "%y = add float %b, %c\n%x = sub float %a, %y", "a - (b + c)"},
        Form{"float", "%y = mul float %b, %c\n%x = div float %a, %y", "a / (b * c)"},
        Form{"float", "%y = div float %b, %c\n%x = mul float %a, %y", "a * (b / c)"},
        Form{"float", "%y = div float %a, %b\n%x = div float %y, %c", "a / b / c"},
        Form{"float", "%y = add float %a, %b\n%x = mul float %y, %c", "(a + b) * c"},
        Form{"float", "%y = mul float %a, %b\n%x = add float %y, %c", "a * b + c"},
        Form{"float", "%y = neg float %a\n%x = neg float %y", "-(-a)"},
        Form{"float", "%y = neg float %b\n%x = sub float %a, %y", "a - -b"},
        Form{"float", "%y = constant float -2\n%x = neg float %y", "-(-2.0)"},
        Form{"float", "%y = constant float -2\n%x = sub float %a, %y", "a - -2.0"},
        Form{"float", "%y = add float %a, %b\n%x = neg float %y", "-(a + b)"},
        Form{"float", "%y = mod float %a, %b\n%x = mul float %y, %c", "mod(a, b) * c"},
        Form{"float", "%y = select float %p, %a, %b\n%x = mul float %y, %c", "(p ? a : b) * c"},
        Form{"float", "%y = select float %q, %b, %c\n%x = select float %p, %a, %y", "p ? a : q ? b : c"},
        Form{"float", "%y = select boolean %p, %q, %r\n%x = select float %y, %a, %b", "(p ? q : r) ? a : b"},
        Form{"float", "%y = select float %q, %a, %b\n%x = select float %p, %y, %c", "p ? (q ? a : b) : c"},
        Form{"float", "%y = index float %u, %i\n%x = mul float %y, %c", "u[i] * c"},
        Form{"float", "%w = add vector3 %u, %v\n%y = swizzle float %w, y\n%x = mul float %y, %c", "(u + v).y * c"},
        Form{"float", "%y = atan2 float %a, %b\n%x = pow float %y, %c", "pow(atan(a, b), c)"},
        Form{"integer", "%x = constant integer -2147483648", "(-2147483647 - 1)"},
        Form{"integer", "%y = constant integer -5\n%x = sub integer %i, %y", "i - -5"},
        Form{"integer", "%y = bit_or integer %i, %j\n%x = bit_and integer %y, %k", "(i | j) & k"},
        Form{"integer", "%y = bit_and integer %i, %j\n%x = bit_xor integer %y, %k", "i & j ^ k"},
        Form{"integer", "%y = add integer %i, %j\n%x = shift_left integer %k, %y", "k << i + j"},
        Form{"integer", "%y = shift_left integer %i, %j\n%x = add integer %y, %k", "(i << j) + k"},
        Form{"integer", "%y = bit_not integer %i\n%x = mul integer %y, %j", "~i * j"},
        Form{"integer", "%y = mod integer %i, %j\n%x = mul integer %k, %y", "k * (i % j)"},
        Form{"integer", "%y = shift_right_logical integer %i, %j\n%x = mul integer %y, %k", "int(uint(i) >> j) * k"},
        Form{"boolean", "%y = less boolean %a, %b\n%z = less boolean %b, %c\n%x = and boolean %y, %z",
             "a < b && b < c"},
        Form{"boolean", "%y = or boolean %p, %q\n%x = and boolean %y, %r", "(p || q) && r"},
        Form{"boolean", "%y = and boolean %p, %q\n%x = or boolean %y, %r", "p && q || r"},
        Form{"boolean", "%y = less boolean %a, %b\n%x = not boolean %y", "!(a < b)"},
        Form{"boolean", "%y = equal boolean %q, %r\n%x = equal boolean %p, %y", "p == (q == r)"},
        Form{"boolean", "%y = bit_and integer %i, %j\n%x = equal boolean %y, %k", "(i & j) == k"},
        Form{"vector3", "%y = mul_matrix vector3 %n, %u\n%x = mul_matrix vector3 %m, %y", "m * (n * u)"},
        Form{"vector3", "%y = mul_matrix matrix33 %m, %n\n%x = mul_matrix vector3 %y, %u", "m * n * u"},
        Form{"matrix33", "%y = mul matrix33 %m, %n\n%x = add matrix33 %y, %m", "matrixCompMult(m, n) + m"}));

TEST(Print, SpreadsScalars) {
    Print p(expression("%y = max vector3 %a, %u\n%x = pow vector3 %y, %b", "vector3"));
    p.expect("pow(max(vec3(a), u), vec3(b))");
}

// A loop over `n` that carries what the lines say.
std::string loop(std::string_view lines) {
    return fmt::format(R"(
uniform n: integer = 3
uniform a: float = 1
uniform b: float = 2
uniform c: float = 3

function main() -> (out1: vector4) {{
    %n = uniform integer n
    %a = uniform float a
    %b = uniform float b
    %c = uniform float c
    %x "x" = loop_arg float loop 0, 1
    %y "y" = loop_arg float loop 0, 2
    %z "z" = loop_arg float loop 0, 3
{}
    %rx = result float %loop, 0
    %ry = result float %loop, 1
    %rz = result float %loop, 2
    %one = constant float 1
    %out = make vector4 %rx, %ry, %rz, %one
    return %out
}}
)",
                       lines);
}

TEST(Print, SumsUpInPlace) {
    Print p(loop(R"(
    %u = add float %x, %a
    %v = sub float %y, %b
    %w = mul float %c, %z
    %loop = loop tuple loop 0, %n | %a, %b, %c | %u, %v, %w)"));
    p.expect("for (int i = 0; i < n; i++)");
    p.expect("\t\tx += a;\n\t\ty -= b;\n\t\tz *= c;\n");
}

// y -= (a - b) would be another value as y = y - a - b.
TEST(Print, KeepsTheRightSideOfInPlaceTogether) {
    Print p(loop(R"(
    %d = sub float %a, %b
    %u = sub float %x, %d
    %v = sub float %d, %y
    %loop = loop tuple loop 0, %n | %a, %b, %c | %u, %v, %z)"),
            false);
    p.expect("y = ");
    p.expectNot("y -=");
    p.expectNot("z =;");
}

TEST(Print, AssignsInAnOrderThatKeepsWhatIsStillRead) {
    Print p(loop(R"(
    %u = mul float %x, %y
    %v = add float %z, %b
    %w = sin float %z
    %loop = loop tuple loop 0, %n | %a, %b, %c | %u, %v, %w)"));
    std::string_view text = p.sources.pixel;
    std::size_t x = text.find("\t\tx *= y"), y = text.find("\t\ty = "), z = text.find("\t\tz = ");
    EXPECT_NE(z, text.npos) << text;
    EXPECT_LT(x, y) << text;
    EXPECT_LT(y, z) << text;
}

TEST(Print, SwapsThroughAVariable) {
    Print p(loop("    %loop = loop tuple loop 0, %n | %a, %b, %c | %y, %x, %z"));
    p.expect("\t\tfloat next = y;\n\t\ty = x;\n\t\tx = next;\n");
    p.expectNot("z = z");
}

TEST(Print, TurnsRings) {
    Print p(loop("    %loop = loop tuple loop 0, %n | %a, %b, %c | %y, %z, %x"));
    p.expect("\t\tfloat next = y;\n\t\ty = z;\n\t\tz = x;\n\t\tx = next;\n");
}

// Matrices multiply by their components in the IR, by rows and columns in *=.
TEST(Print, MatricesMultiplyComponentwiseInPlace) {
    Print p(R"(
uniform n: integer = 3
uniform m: matrix33 = 1, 2, 3, 4, 5, 6, 7, 8, 9

function main() -> (out1: vector4) {
    %n = uniform integer n
    %m = uniform matrix33 m
    %x "x" = loop_arg matrix33 loop 0, 1
    %u = mul matrix33 %x, %m
    %loop = loop tuple loop 0, %n | %m | %u
    %r = result matrix33 %loop, 0
    %v = swizzle vector3 %r, column 1
    %one = constant float 1
    %out = make vector4 %v, %one
    return %out
}
)");
    p.expectNot("*=");
    p.expect("x = matrixCompMult(x, m);");
}

TEST(Print, ReturnsSeveralResults) {
    Print p(R"(
uniform a: float = 1

# Halves. And more.
function split(x: float) -> (low: float, high: float, "": float) {
    %x = param float x
    %two = constant float 2
    %l = div float %x, %two
    %h = sin float %l
    %k = cos float %l
    return %l, %h, %k
}

function main() -> (out1: vector4) {
    %a = uniform float a
    %t = call tuple split %a
    %l = result float %t, 0
    %k = result float %t, 2
    %u = call tuple split %k
    %m = result float %u, 1
    %one = constant float 1
    %out = make vector4 %l, %k, %m, %one
    return %out
}
)");
    p.expect("// Halves.\nfloat split(float x, out float high, out float v)");
    p.expectNot("And more");
    p.expect("float low = split(a, ");
}

// Every name that a document may give, in every place where one may stand.
std::string named(std::string_view first, std::string_view second) {
    return fmt::format(R"(
uniform "{0}": float = 1
uniform "{1}": float = 1

function "{0} f"("{0}": float, "{1}": float) -> ("{0}": float, "{1}": float) {{
    %x = param float "{0}"
    %y = param float "{1}"
    %s "{0}" = sin float %x
    %c "{1}" = cos float %y
    %t = mul float %s, %c
    %u = add float %t, %s
    %v = add float %t, %c
    return %u, %v
}}

function "{1} f"("{0}": float) -> ("{1}": float) {{
    %x = param float "{0}"
    %s "{1}" = sin float %x
    %t = mul float %s, %s
    return %t
}}

function main() -> (out1: vector4) {{
    %a = uniform float "{0}"
    %b = uniform float "{1}"
    %t = call tuple "{0} f" %a, %b
    %x = result float %t, 0
    %y = result float %t, 1
    %z = call float "{1} f" %b
    %one = constant float 1
    %out = make vector4 %x, %y, %z, %one
    return %out
}}
)",
                       first, second);
}

TEST(Print, AnyNameWillDo) {
    std::string longest(3000, 'x');
    const std::pair<std::string, std::string> kNames[] = {{"texture", "sampler2D"},
                                                          {"a b", "a/b"},
                                                          {"a__b", "a_b"},
                                                          {"2d", "n2d"},
                                                          {"main", "vd"},
                                                          {"out", "x"},
                                                          {longest + "1", longest + "2"},
                                                          {"\xc3\xa4", "\xc3\xb6"},
                                                          {"_", "__"},
                                                          {"sin", "cos"},
                                                          {"next", "i"},
                                                          {"u_time", "i_position"},
                                                          {"VertexData", "u_viewProjectionMatrix"}};
    for (const auto& [first, second] : kNames) {
        SCOPED_TRACE(first.substr(0, 20) + ", " + second.substr(0, 20));
        Print p(named(first, second));
        EXPECT_EQ(p.sources.pixel.find("__"), std::string::npos);
    }
}

TEST(Print, AvoidsThePrefixOfBuiltInVariables) {
    Print p(named("gl_Position", "gl_FragCoord"));
    p.expectNot("gl_");
}

TEST(Print, OutputsGiveWayToUniforms) { Print p(named("out1", "vertex")); }

TEST(Print, AnyNameOfAnAttributeOrOutputWillDo) {
    for (std::string_view name : {"my prop", "output", "float", "2nd", "a__b"}) {
        SCOPED_TRACE(name);
        Print p(fmt::format(R"(
function main() -> ("{0}": vector4) {{
    %a = attribute vector3 "{0}"
    %b = attribute float "{0}2"
    %out = make vector4 %a, %b
    return %out
}}
)",
                            name));
    }
}

TEST(Print, ConstantsReadBack) {
    EXPECT_EQ(Print(expression("%x = constant float 1e-20", "float"), false).sources.pixel.find("1e-20.0"),
              std::string::npos);
    Print(expression("%x = constant float 1e30", "float"), false).expect("1e+30");
    Print(expression("%x = constant float 0x7f800000", "float"), false).expect("uintBitsToFloat(0x7f800000u)");
    Print(expression("%x = constant vector3 2, 2, 2\n%y = add vector3 %u, %x", "vector3"), false).expect("vec3(2)");
}

// Random programs: what is printed compiles.
TEST(Print, RandomProgramsCompile) {
    if (!haveCompiler()) GTEST_SKIP() << "glslangValidator is not installed";
    for (std::uint32_t seed = 0; seed < 60 && !testing::Test::HasFailure(); seed++) {
        NameTable names;
        Module module(names);
        passes::RandomProgram random(module, passes::Dice(seed));
        for (int k = 0; k < 3; k++) random.function("f" + std::to_string(k), 4 + seed);
        random.function("main", 4 + seed, Type::Vector4, false);
        Name entry = names.intern("main");
        Diagnostics diagnostics;
        EXPECT_TRUE(seed % 3 == 0 || passes::specialise(module, entry, {}, diagnostics));
        passes::prune(module, std::array{entry});
        auto interface = passes::makeStages(module, entry, names.intern("vertex"));
        legaliseAll(module);
        for (auto& f : module.functions) passes::place(*f, {f->name == entry, seed % 2 ? 90 : 40});
        EXPECT_TRUE(validate(module, *module.findOwn(entry), diagnostics)) << "seed " << seed << "\n"
                                                                           << diagnostics.text();
        Sources sources = print(module, interface, "random");
        EXPECT_EQ(complaints(sources.pixel, "frag"), "") << "seed " << seed;
    }
}

// Legalising keeps the values.
TEST(Legalise, KeepsValues) {
    for (std::uint32_t seed = 0; seed < 300 && !testing::Test::HasFailure(); seed++) {
        NameTable names;
        Module module(names);
        passes::RandomProgram random(module, passes::Dice(seed));
        for (int k = 0; k < 2; k++) random.function("f" + std::to_string(k), 3 + seed / 8);
        Function& f = random.function("main", 3 + seed / 8);
        std::vector<Value> arguments;
        for (const Param& p : f.params) arguments.push_back(random.argument(p.type));
        auto run = [&] {
            Diagnostics diagnostics;
            passes::RandomWorld world;
            Interpreter interpreter(module, diagnostics);
            std::vector<Value> results(f.results.size());
            for (std::size_t i = 0; i < arguments.size(); i++) arguments[i].type = f.params[i].type;
            EXPECT_TRUE(validate(module, diagnostics) && interpreter.run(f, arguments, results, world))
                << diagnostics.text();
            return results;
        };
        std::vector<Value> wanted = run();
        std::string before = print(module);
        legaliseAll(module);
        std::vector<Value> found = run();
        const auto& samples = random.resultsOf(f.name);
        for (std::size_t k = 0; k < wanted.size(); k++)
            for (int i = 0; i < componentCount(wanted[k].type); i++) {
                if (info(wanted[k].type).scalar == Scalar::Float)
                    EXPECT_NEAR(wanted[k].f(i), found[k].f(i), 8 * samples[k].error) << "seed " << seed << "\n"
                                                                                     << before;
                else
                    EXPECT_EQ(wanted[k].words[i], found[k].words[i]) << "seed " << seed << "\n" << before;
            }
    }
}

}  // namespace
}  // namespace shaderx::glsl
