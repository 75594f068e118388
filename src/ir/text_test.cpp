#include "ir/text.h"

#include <bit>

#include <gtest/gtest.h>

#include "ir/builder.h"
#include "ir/testing.h"

namespace shaderx::ir {
namespace {

// Every form there is, as it is printed.
constexpr std::string_view kEverything = R"(struct light { intensity: float, color: color3 }
uniform roughness: float = 0.2 "SR_gold/specular_roughness"
uniform tint: color3 = 1, 0.5, 1e-08
uniform twisted: boolean = true
uniform "odd name\"\\\n\x01": integer = -3
uniform wood: texture2d "image1/file" file "a\\b.png" uaddress "clamp" default 0, 0.5, 1 colorspace "srgb_texture"
leaf diffuse_bsdf(weight: float, color: color3)
leaf nothing()
extern target node "text of\nit"

function helper(a: float) -> (x: float, y: float) {
    %0 = param float a
    %1 = neg float %0
    return %0, %1
}

# What it does.
#
# In two parts.
inline function everything(nv: float, t: texture2d, l: light) -> (out: float, "the bsdf": BSDF) loops 3 {
    %0 = param float nv
    %1 = param texture2d t
    %2 = param light l
    %3 "twice" = constant float 2
    %4 = constant color3 0.1, -0, 1e+30
    %5 = constant string "a \"text\""
    %6 = constant BSDF
    %7 = constant integer -5
    %8 = constant boolean true
    %9 = context point view_position
    %10 = attribute vector2 texcoord_0
    %11 = uniform float roughness
    %12 = uniform integer "odd name\"\\\n\x01"
    %13 = add float %0, %3
    %14 = swizzle vector2 %4, zx
    %15 = constant matrix33 1, 0, 0, 0, 1, 0, 0, 0, 1
    %16 = swizzle vector3 %15, column 2
    %17 = member float %2, 0
    %18 = texture_level color3 %1, %10, %3
    %19 = call tuple helper %13
    %20 = result float %19, 1
    %21 = loop_arg integer loop 0, 0
    %22 = loop_arg float loop 0, 1
    %23 = add float %22, %20
    %24 = loop tuple loop 0, %7 | %3 | %23
    %25 = result float %24, 0
    %26 = less boolean %0, %25
    %27 = mul float %0, %0
    %28 = select float %26, %27, %17
    %29 = leaf BSDF diffuse_bsdf %28, %18
    %30 = closure_scale BSDF %29, %3
    %31 = loop_arg float loop 1, 1
    %32 = lights tuple loop 1 | %3 | %31
    %33 = extern_text float 0 %28
    %34 = leaf BSDF nothing
    %35 = make color3 %0
    return %28, %30
    body {
        let %19
        loop %24 {
            let %23
        }
        if %26 {
            let %27
        } else {
        } -> %28
        if %26 {
        }
    }
}
)";

TEST(Text, NamesThatATerminalWouldObeyComeBackFromEscapes) {
    NameTable names;
    Module m{names};
    const std::string_view odd = "\x1b[31m\u009b\u202e\xff ä";
    Uniform& u = m.uniforms.emplace_back();
    u.name = names.intern(odd);
    u.type = Type::Float;
    u.values = {0};
    const std::string text = print(m);
    EXPECT_NE(text.find("\"\\x1b[31m\\xc2\\x9b\\xe2\\x80\\xae\\xff ä\""), std::string::npos) << text;
    Module again{names};
    Diagnostics diagnostics;
    ASSERT_TRUE(parse(again, "odd.ir", text, diagnostics)) << diagnostics.text();
    EXPECT_EQ(names.text(again.uniforms[0].name), odd);
}

TEST(Text, EveryFormRoundTrips) {
    TestModule m = parseModule(kEverything, false);
    const std::string text = print(*m.module);
    EXPECT_EQ(text, kEverything);
    TestModule again = parseModule(text, false);
    EXPECT_EQ(print(*again.module), text);
}

TEST(Text, ParsesWhatItSays) {
    TestModule m = parseModule(kEverything, false);
    Function& f = m["everything"];
    EXPECT_TRUE(f.isInline);
    EXPECT_EQ(f.comment, "What it does.\n\nIn two parts.");
    EXPECT_EQ(f.loops, 3u);
    EXPECT_EQ(f.results[1].value, ExprId(30));
    EXPECT_EQ(f.results[1].type, Type::BSDF);
    EXPECT_EQ(f.exprs[14].payload, swizzleMask(2, 2, 0));
    EXPECT_EQ(f.exprs[22].payload, 1u);
    EXPECT_EQ(f.exprs[31].payload, 0x101u);
    EXPECT_EQ(m.names->text(f.hints[3]), "twice");
    EXPECT_EQ(f.constantWords(ExprId(4))[1], 0x80000000u);
    ASSERT_EQ(f.body.blocks.size(), 5u);
    EXPECT_EQ(f.body.blocks[0].size(), 4u);
    const Stmt& s = f.body.blocks[0][2];
    EXPECT_EQ(s.kind, StmtKind::If);
    EXPECT_EQ(f.body.phis[s.firstPhi], ExprId(28));
    EXPECT_TRUE(f.body.blocks[s.orElse.index].empty());
    EXPECT_FALSE(f.body.blocks[0][3].orElse);
    ASSERT_EQ(m.module->uniforms.size(), 5u);
    EXPECT_EQ(m.module->uniforms[4].uAddress, "clamp");
    EXPECT_EQ(m.module->uniforms[4].vAddress, "periodic");
    EXPECT_EQ(m.module->uniforms[4].file, "a\\b.png");
    EXPECT_EQ(m.module->uniforms[4].defaultColor.size(), 3u);
    EXPECT_EQ(m.names->text(m.module->uniforms[3].name), "odd name\"\\\n\x01");
}

TEST(Text, FloatsKeepTheirBits) {
    NameTable names;
    Module module(names);
    Function& f = module.add(names.intern("f"));
    const std::uint32_t words[] = {0x00000001u, 0x7f7fffffu, 0x7f800000u, 0xff800000u, 0x7fc00000u,
                                   0xffc00001u, 0x80000000u, 0x3dcccccdu, 0x4b800001u};
    for (std::uint32_t w : words) {
        f.exprs.push_back({Op::Constant, 0, 0, Type::Float, 0, 0, static_cast<std::uint32_t>(f.words.size())});
        f.words.push_back(w);
        f.hints.emplace_back();
    }
    const std::string text = print(module);
    TestModule again = parseModule(text);
    for (std::uint32_t i = 0; i < std::size(words); i++)
        EXPECT_EQ(again["f"].constantWords(ExprId(i))[0], words[i]) << text;
}

TEST(Text, ExpressionsMayHaveNamesAndCommentsStandAnywhere) {
    TestModule m = parseModule(
        "function f(a: float) -> (r: float) { # behind\n"
        "  %a = param float a\n"
        "  # between\n"
        "  %double = add float %a, %a  # two of them\n"
        "  return %double }");
    EXPECT_EQ(print(*m.module, m["f"]),
              "function f(a: float) -> (r: float) {\n    %0 = param float a\n"
              "    %1 = add float %0, %0\n    return %1\n}\n");
}

TEST(Text, BrokenFunctionsPrint) {
    NameTable names;
    Module module(names);
    Function& f = module.add(Name());
    f.params.push_back({Name(77), static_cast<Type>(60)});
    f.exprs.push_back({Op::Swizzle, 0, 3, Type::Float, 0, 99, 12345});
    f.exprs.push_back({static_cast<Op>(255), 0, 0, Type::Float, 0, 0, 0});
    f.exprs.push_back({Op::Constant, 0, 0, Type::Matrix44, 0, 0, 0xfffffff0u});
    f.exprs.push_back({Op::Call, 0, 0, Type::Tuple, 0, 0, 1000});
    f.exprs.push_back({Op::Swizzle, 0, 1, Type::Float, 0, 0, 0});
    f.exprs.push_back({Op::Context, 0, 0, Type::Float, 0, 0, 1000});
    f.operands.push_back(ExprId());
    f.results.push_back({Name(), Type::Float, ExprId(50)});
    f.body.blocks.resize(1);
    f.body.blocks[0].push_back({StmtKind::If, ExprId(9), BlockId(0), BlockId(4), 7, 7});
    const std::string text = print(module);
    EXPECT_NE(text.find("no_such_op_255"), std::string::npos) << text;
    EXPECT_NE(text.find("swizzle float %?"), std::string::npos) << text;
}

std::string errorsOf(std::string_view text) {
    NameTable names;
    Module module(names);
    Diagnostics diagnostics;
    EXPECT_FALSE(parse(module, "t", text, diagnostics)) << text;
    return diagnostics.text();
}

TEST(Text, ErrorsAreLocated) {
    EXPECT_EQ(errorsOf("function f() -> (r: float) {\n    %0 = constant float 1\n    %1 = mull float %0, %0\n"
                       "    %2 = add float %0, %7\n    %3 = add flot %0, %1\n    return %3\n}\n"),
              "t:3:10: error: unknown operation 'mull' [unknown-operation]\n"
              "  hint: did you mean 'mul'?\n"
              "t:4:24: error: %7 is not defined before this line [undefined-expression]\n"
              "t:5:14: error: unknown type 'flot' [unknown-type]\n"
              "  hint: did you mean 'float'?\n");
    EXPECT_EQ(errorsOf("function f(alpha: float) -> () {\n    %0 = param float alpa\n"
                       "    %0 = context point view_postion\n}\n"),
              "t:2:22: error: the function has no parameter 'alpa' [unknown-parameter]\n"
              "  hint: did you mean 'alpha'?\n"
              "t:3:24: error: unknown context 'view_postion' [unknown-context]\n"
              "  hint: did you mean 'view_position'?\n"
              "t:3:5: error: %0 is defined already [redefinition]\n");
    EXPECT_EQ(errorsOf("uniform a: float = x\nuniform a: float\nuniform a: float\nfoo\n"),
              "t:1:20: error: expected a number of the type, found 'x' [syntax]\n"
              "t:3:9: error: a uniform 'a' is there already [redefinition]\n"
              "t:4:1: error: expected uniform, leaf, struct, extern, inline or function, found 'foo' [syntax]\n");
    EXPECT_EQ(errorsOf("function f() -> (r: float) {\n}\n"),
              "t:2:1: error: the function returns nothing [result-count]\n");
    EXPECT_EQ(errorsOf("function f() -> () {\n    %0 = constant float 1 2\n    return\n    body {\n    let %0\n"),
              "t:2:27: error: expected the end of the line, found '2' [syntax]\n"
              "t:6:1: error: expected let, if, loop or '}', found the end [syntax]\n"
              "t:6:1: error: expected '}' at the end of the function, found the end [syntax]\n");
}

// No prefix, and no text with a byte changed, makes the parser or the printer fail otherwise than by a message.
TEST(Text, SurvivesAnyText) {
    std::uint32_t random = 1;
    for (std::size_t i = 0; i < kEverything.size(); i += 3) {
        for (int way = 0; way < 2; way++) {
            std::string text(kEverything.substr(0, way ? kEverything.size() : i));
            random = random * 1664525u + 1013904223u;
            if (way) text[i] = "%{}(),|\"\\0 \nx:=-"[random >> 28];
            NameTable names;
            Module module(names);
            Diagnostics diagnostics;
            if (!parse(module, "t", text, diagnostics)) {
                EXPECT_TRUE(diagnostics.hasErrors()) << text;
                continue;
            }
            const std::string printed = print(module);
            validate(module, diagnostics);
            NameTable names2;
            Module module2(names2);
            Diagnostics diagnostics2;
            ASSERT_TRUE(parse(module2, "t", printed, diagnostics2)) << printed << diagnostics2.text();
            EXPECT_EQ(print(module2), printed);
        }
    }
}

TEST(Text, DeepBodiesNeedNoStack) {
    std::string text = "function f() -> () {\n%0 = constant boolean true\nreturn\nbody {\n";
    const int depth = 20000;
    for (int i = 0; i < depth; i++) text += "if %0 {\n";
    for (int i = 0; i < depth; i++) text += "}\n";
    text += "}\n}\n";
    TestModule m = parseModule(text);
    const std::string printed = print(*m.module);
    EXPECT_EQ(print(*parseModule(printed).module), printed);
}

}  // namespace
}  // namespace shaderx::ir
