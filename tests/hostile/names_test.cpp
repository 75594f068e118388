// Names and values that try to be code, or are words of a shading language.
#include <fmt/format.h>

#include "hostile.h"

namespace shaderx::tests {
namespace {

std::string escaped(std::string_view text) {
    std::string out;
    for (char c : text) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '"')
            out += "&quot;";
        else if (c == '\n' || c == '\r' || c == '\t')
            out += fmt::format("&#{};", static_cast<int>(c));
        else
            out += c;
    }
    return out;
}

// The name wherever a name may be: graph, port, nodes, output.
std::string everywhere(std::string_view name) {
    return wrapped(fmt::format(
        "<nodegraph name=\"{0}\"><input name=\"{0}\" type=\"float\" value=\"0.5\"/><sin name=\"{0}1\" type=\"float\">"
        "<input name=\"in\" type=\"float\" interfacename=\"{0}\"/></sin><noise2d name=\"{0}2\" type=\"float\"/>"
        "<image name=\"{0}3\" type=\"float\"><input name=\"file\" type=\"filename\" value=\"{0}\"/></image><add "
        "name=\"{0}4\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"{0}1\"/><input name=\"in2\" "
        "type=\"float\" nodename=\"{0}2\"/></add><add name=\"{0}5\" type=\"float\"><input name=\"in1\" type=\"float\" "
        "nodename=\"{0}4\"/><input name=\"in2\" type=\"float\" nodename=\"{0}3\"/></add><output name=\"{0}6\" "
        "type=\"float\" nodename=\"{0}5\"/></nodegraph>",
        escaped(name)));
}

// The name in places of a definition too.
std::string defined(std::string_view name) {
    return wrapped(fmt::format(
        "<nodedef name=\"ND_{0}\" node=\"a_user_node\"><input name=\"{0}\" type=\"float\" value=\"0.5\"/><output "
        "name=\"{0}_\" type=\"float\"/></nodedef><nodegraph name=\"NG_{0}\" nodedef=\"ND_{0}\"><sin name=\"{0}\" "
        "type=\"float\"><input name=\"in\" type=\"float\" interfacename=\"{0}\"/></sin><output name=\"{0}_\" "
        "type=\"float\" nodename=\"{0}\"/></nodegraph><a_user_node name=\"{0}\" type=\"float\"/><output "
        "name=\"{0}_o\" type=\"float\" nodename=\"{0}\"/>",
        escaped(name)));
}

void expectHarmless(std::string_view name, bool mustCompile) {
    std::vector<Shader> all;
    for (const std::string& text : {everywhere(name), defined(name)})
        for (Interface interface : {Interface::Live, Interface::Baked}) {
            How how;
            how.interface = interface;
            Outcome out = compile(text, how);
            expectOrderly(out, name);
            if (mustCompile) {
                EXPECT_EQ(out.shaders.size(), 1u) << name << "\n" << out.errors;
            }
            for (Shader& s : out.shaders) all.push_back(std::move(s));
        }
    expectCompiles(all, name);
}

using Words = std::vector<const char*>;
class Keywords : public testing::TestWithParam<Words> {};

TEST_P(Keywords, AreNames) {
    std::vector<Shader> all;
    for (std::string_view name : GetParam())
        for (const std::string& text : {everywhere(name), defined(name)}) {
            Outcome out = compile(text);
            expectOrderly(out, name);
            EXPECT_EQ(out.shaders.size(), 1u) << name << "\n" << out.errors;
            for (Shader& s : out.shaders) all.push_back(std::move(s));
        }
    expectCompiles(all, "keywords");
}

// A choice of each language's words, with names that the shaders themselves use.
INSTANTIATE_TEST_SUITE_P(
    Of, Keywords,
    testing::Values(
        std::vector<const char*>{
            "main",        "void",         "float",   "int",       "uint",        "bool",       "vec2",      "vec3",
            "vec4",        "mat3",         "mat4",    "sampler2D", "uniform",     "in",         "out",       "inout",
            "discard",     "sample",       "precise", "half",      "filter",      "common",     "partition", "active",
            "asm",         "input",        "output",  "texture",   "texture2D",   "sin",        "dFdx",      "mix",
            "gl_Position", "gl_FragCoord", "gl_",     "layout",    "atomic_uint", "subroutine", "patch",     "shared",
            "buffer",      "image2D",      "resource"},
        std::vector<const char*>{
            "cbuffer",   "float3",   "float4x4", "register", "SV_Position", "Texture2D",     "lerp",    "frac",
            "mul",       "saturate", "ddx",      "clip",     "groupshared", "technique",     "pass",    "vertex",
            "fragment",  "kernel",   "constant", "device",   "thread",      "threadgroup",   "metal",   "using",
            "constexpr", "template", "class",    "auto",     "nullptr",     "packed_float3", "float2x2"},
        Words{"fn",
              "var",
              "let",
              "override",
              "loop",
              "continuing",
              "array",
              "f32",
              "vec3f",
              "textureSample",
              "select",
              "ptr",
              "color",
              "point",
              "normal",
              "vector",
              "matrix",
              "closure",
              "shader",
              "surface",
              "displacement",
              "P",
              "N",
              "I",
              "u",
              "v",
              "Ci",
              "illuminance",
              "emit",
              "global",
              "public",
              "string",
              "_Bool",
              "true",
              "false",
              "null",
              "NULL"},
        Words{"out1", "vd", "VertexData", "u_viewPosition", "u_envMatrix", "u_envRadiance", "i_position", "i_normal",
              "u_worldMatrix", "texcoord_0", "positionWorld", "n0", "n1", "v", "x", "PublicUniforms", "PrivateUniforms",
              "LightData", "u_numActiveLightSources"}),
    [](const testing::TestParamInfo<Words>& part) { return "Part" + std::to_string(part.index); });

TEST(Names, ThatHoldCodeOrPaths) {
    for (std::string_view name : {"../../x",
                                  "/etc/passwd",
                                  "a; discard;",
                                  "a\n#error x",
                                  "a\r\n#error x",
                                  "*/ discard; /*",
                                  "//",
                                  "/*",
                                  "*/",
                                  "\\",
                                  "a\\\n",
                                  "#version 100",
                                  "%s%n",
                                  "{}",
                                  "{0}",
                                  "${x}",
                                  "$(x)",
                                  "`x`",
                                  "a b",
                                  "a\tb",
                                  "'",
                                  "\"",
                                  "<x>",
                                  "&",
                                  "é",
                                  "\xE2\x80\xA8",
                                  "\xF0\x9F\x98\x80",
                                  "\xC2\x85",
                                  ".",
                                  "..",
                                  "a/b",
                                  "a.b",
                                  "a:b",
                                  ":",
                                  "-",
                                  "1",
                                  "9z",
                                  "_",
                                  "__",
                                  "a__b",
                                  "___",
                                  "@",
                                  "@pixel",
                                  "@vertex",
                                  "c@0",
                                  "a@1"})
        expectHarmless(name, false);
    expectHarmless(std::string(100000, 'n'), true);
}

// A nodedef of the document that is called as one of the library, and a node that is one too, but different.
TEST(Names, OfTheLibrary) {
    for (std::string_view name : {"ND_surface", "ND_add_float", "ND_standard_surface_surfaceshader", "ND_mix_bsdf"}) {
        Outcome out = compile(wrapped(fmt::format(
            "<nodedef name=\"{0}\" node=\"mine\"><input name=\"a\" type=\"float\" value=\"0.5\"/><output "
            "name=\"out\" type=\"float\"/></nodedef><nodegraph name=\"NG_mine\" nodedef=\"{0}\"><sin name=\"s\" "
            "type=\"float\"><input name=\"in\" type=\"float\" interfacename=\"a\"/></sin><output name=\"out\" "
            "type=\"float\" nodename=\"s\"/></nodegraph><mine name=\"m\" type=\"float\"/><standard_surface name=\"s\" "
            "type=\"surfaceshader\"><input name=\"base\" type=\"float\" nodename=\"m\"/></standard_surface>"
            "<surfacematerial name=\"mm\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" "
            "nodename=\"s\"/></surfacematerial>",
            name)));
        expectOrderly(out, name);
        EXPECT_EQ(out.shaders.size(), 1u) << out.errors;
        expectCompiles(out.shaders, name);
    }
}

TEST(Names, EmptyOrMissing) {
    Outcome out = compile(everywhere(""));
    expectOrderly(out, "empty");
    out =
        compile(wrapped("<constant type=\"float\"/><nodegraph><constant/><output/></nodegraph><output type=\"float\"/>"
                        "<output name=\"\" type=\"float\" nodename=\"\"/><nodedef/><nodedef node=\"\" name=\"\"/>"
                        "<implementation/><input/><nodegraph nodedef=\"\"/><surfacematerial/><look/>"));
    expectOrderly(out, "missing");
    EXPECT_FALSE(out.isValid);
}

TEST(Names, UsedTwice) {
    Outcome out = compile(
        wrapped("<constant name=\"a\" type=\"float\"/><constant name=\"a\" type=\"color3\"/><add name=\"b\" "
                "type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"a\"/><input name=\"in1\" type=\"float\" "
                "value=\"1\"/></add><output name=\"o\" type=\"float\" nodename=\"b\"/>"));
    expectOrderly(out, "twice");
    EXPECT_FALSE(out.isValid);
    expectCompiles(out.shaders, "twice");
}

TEST(Names, ThatBecomeOneWhenCleaned) {
    std::string text;
    std::vector<std::string> names{"a b", "a_b", "a__b", "a.b", "a-b", "a;b", "a b ", "_a_b", "aéb"};
    std::string last = "0";
    for (const std::string& n : names) {
        text += fmt::format(
            "<noise2d name=\"{}\" type=\"float\"><input name=\"amplitude\" type=\"float\" "
            "value=\"0.3\"/></noise2d>",
            n);
        text += fmt::format(
            "<add name=\"sum {0}\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"{0}\"/>"
            "<input name=\"in2\" type=\"float\" {1}/></add>",
            n, last == "0" ? "value=\"0\"" : "nodename=\"" + last + "\"");
        last = "sum " + n;
    }
    Outcome out = compile(wrapped(text + "<output name=\"o\" type=\"float\" nodename=\"" + last + "\"/>"));
    expectOrderly(out, "collisions");
    ASSERT_EQ(out.shaders.size(), 1u) << out.errors;
    expectCompiles(out.shaders, "collisions");
}

TEST(Values, ThatAreNone) {
    for (std::string_view type : {"float", "integer", "boolean", "color3", "vector4", "matrix33", "filename", "string"})
        for (std::string_view value : {"",
                                       " ",
                                       "1e400",
                                       "-1e400",
                                       "1e-400",
                                       "nan",
                                       "NaN",
                                       "inf",
                                       "-inf",
                                       "infinity",
                                       "0x10",
                                       "1;discard;",
                                       "1.0); discard; (",
                                       "*/ discard; /*",
                                       "0.5\\",
                                       "0.5\n#define float int",
                                       "1,2",
                                       ",",
                                       ",,,",
                                       "1,",
                                       "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17",
                                       "--1",
                                       "+-1",
                                       "1e",
                                       "e1",
                                       ".",
                                       "1.",
                                       ".5",
                                       "1f",
                                       "1.0.0",
                                       "99999999999999999999",
                                       "-2147483648",
                                       "2147483648",
                                       "3.4028235e38",
                                       "3.5e38",
                                       "1e-50",
                                       "true",
                                       "TRUE",
                                       "one",
                                       "{}",
                                       "%s",
                                       "\xEF\xBC\x91"}) {
            std::string text = wrapped(fmt::format(
                "<nodegraph name=\"g\"><input name=\"p\" type=\"{0}\" value=\"{1}\"/><constant name=\"c\" type=\"{0}\">"
                "<input name=\"value\" type=\"{0}\" interfacename=\"p\"/></constant><output name=\"o\" type=\"{0}\" "
                "nodename=\"c\"/></nodegraph><constant name=\"d\" type=\"{0}\"><input name=\"value\" type=\"{0}\" "
                "value=\"{1}\"/></constant><output name=\"e\" type=\"{0}\" nodename=\"d\"/>",
                type, escaped(value)));
            for (Interface interface : {Interface::Live, Interface::Baked}) {
                How how;
                how.interface = interface;
                Outcome out = compile(text, how);
                expectOrderly(out, fmt::format("{} '{}'", type, value));
                for (const Shader& s : out.shaders)
                    EXPECT_EQ(s.pixel.find("discard"), std::string::npos) << type << " " << value;
            }
        }
}

// One value for each kind that is a number at the edge: the text must read back.
TEST(Values, AtTheEdge) {
    std::vector<Shader> all;
    for (std::string_view value : {"3.4028235e38", "-3.4028235e38", "1e-45", "1e-50", "-0", "16777217", "0.1", "1e10"})
        for (Interface interface : {Interface::Live, Interface::Baked}) {
            How how;
            how.interface = interface;
            Outcome out = compile(
                wrapped(fmt::format("<constant name=\"d\" type=\"float\"><input name=\"value\" type=\"float\" "
                                    "value=\"{0}\"/></constant><texcoord name=\"t\" type=\"vector2\"/><multiply "
                                    "name=\"m\" type=\"vector2\"><input name=\"in1\" type=\"vector2\" nodename=\"t\"/>"
                                    "<input name=\"in2\" type=\"float\" nodename=\"d\"/></multiply><output name=\"e\" "
                                    "type=\"vector2\" nodename=\"m\"/>",
                                    value)),
                how);
            expectOrderly(out, value);
            EXPECT_EQ(out.shaders.size(), 1u) << out.errors;
            for (Shader& s : out.shaders) all.push_back(std::move(s));
        }
    expectCompiles(all, "values at the edge");
}

// Inline code of the document's own.
TEST(Values, InlineCode) {
    auto node = [](std::string_view code) {
        return wrapped(fmt::format(
            "<nodedef name=\"ND_a\" node=\"ua\"><input name=\"in\" type=\"float\" value=\"1\"/><output name=\"out\" "
            "type=\"float\"/></nodedef><implementation name=\"I\" nodedef=\"ND_a\" sourcecode=\"{}\"/><ua name=\"y\" "
            "type=\"float\"/><output name=\"o\" type=\"float\" nodename=\"y\"/>",
            escaped(code)));
    };
    EXPECT_EQ(compile(node("{{in}} * 2.0")).shaders.size(), 1u) << compile(node("{{in}} * 2.0")).errors;
    for (std::string_view code :
         {"", "{{in", "{{}}", "{{nothing}}", "{{in}}; discard", "{{in}}) + (1.0", "/*", "//", "1.0 /* {{in}}",
          "ua(1.0)", "\"", "{{in}}\n#error", "while (true) {}", "return 1.0;"}) {
        Outcome out = compile(node(code));
        expectOrderly(out, code);
        EXPECT_TRUE(out.shaders.empty()) << code;
    }
    std::string deep(100000, '('), long_ = "1.0";
    expectOrderly(compile(node(deep)), "100,000 parentheses");
    expectOrderly(compile(node(deep + "1.0" + std::string(100000, ')'))), "100,000 parentheses, closed");
    expectOrderly(compile(node(std::string(100000, '-') + "1.0")), "100,000 signs");
    for (int i = 0; i < 100000; i++) long_ += "+{{in}}";
    expectOrderly(compile(node(long_)), "100,000 terms");
}

}  // namespace
}  // namespace shaderx::tests
