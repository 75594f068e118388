#include "ir/validate.h"

#include <gtest/gtest.h>

#include "ir/testing.h"

namespace shaderx::ir {
namespace {

// What the validator says about a function `f` of this text.
std::string said(std::string_view body, std::string_view before = {},
                 std::string_view head = "function f(a: float, v: color3) -> (r: float)") {
    std::string text(before);
    text +=
        "function two(x: float) -> (p: float, q: color3) {\n%0 = param float x\n%1 = make color3 %0\n"
        "return %0, %1\n}\nfunction one(x: float) -> (p: float) {\n%0 = param float x\nreturn %0\n}\n";
    text += std::string(head) + " {\n%a = param float a\n%v = param color3 v\n" + std::string(body) + "\n}\n";
    TestModule m = parseModule(text, false);
    Diagnostics diagnostics;
    const bool valid = validate(*m.module, diagnostics);
    EXPECT_EQ(valid, diagnostics.all().empty());
    for (const Diagnostic& d : diagnostics.all()) EXPECT_EQ(d.severity, Severity::Internal);
    return diagnostics.text();
}

void expectSaid(std::string_view body, std::string_view part, std::string_view before = {}) {
    const std::string text = said(body, before);
    EXPECT_NE(text.find(part), std::string::npos) << body << "\nsays: " << text;
}

TEST(Validate, QuotesTheLineWithCarets) {
    EXPECT_EQ(said("%2 = constant integer 1\n%3 \"sum\" = add float %a, %2\nreturn %3"),
              "internal error: add to float does not take float, integer [invalid-ir]\n"
              "  note: in f:\n"
              "    %3 \"sum\" = add float %0, %2\n"
              "                             ^^\n");
    EXPECT_EQ(said("%2 = context float view_position\nreturn %2"),
              "internal error: the type is point, not float [invalid-ir]\n"
              "  note: in f:\n"
              "    %2 = context float view_position\n"
              "    ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^\n");
}

TEST(Validate, AcceptsWhatIsRight) {
    EXPECT_EQ(said("%2 = constant integer 3\n%i = loop_arg integer loop 0, 0\n%c = loop_arg float loop 0, 1\n"
                   "%j = loop_arg float loop 1, 1\n%n = mul float %j, %c\n%inner = loop tuple loop 1, %i | %c | %n\n"
                   "%x = result float %inner, 0\n%o = loop tuple loop 0, %2 | %a | %x\n%r = result float %o, 0\n"
                   "return %r\nbody {\nloop %o {\nloop %inner {\nlet %n\n}\nlet %x\n}\n}"),
              "");
    EXPECT_EQ(
        said("%t = call tuple two %a\n%q = result color3 %t, 1\n%l = call float one %a\n"
             "%s = constant string \"x\"\n%e = equal boolean %s, %s\n%x = swizzle float %q, x\n"
             "%r = select float %e, %x, %l\nreturn %r\nbody {\nlet %t\nif %e {\nlet %x\n} else {\nlet %l\n} -> %r\n}"),
        "");
}

// ---- Arenas ----

struct Raw {
    NameTable names;
    Module module{names};
    Function* f = nullptr;

    Raw() {
        f = &module.add(names.intern("f"));
        f->words = {0};
        add(Op::Constant, Type::Float, {});
        f->results.push_back({names.intern("r"), Type::Float, ExprId(0)});
    }
    void add(Op op, Type type, std::initializer_list<std::uint32_t> operands, std::uint32_t payload = 0) {
        f->exprs.push_back({op, 0, static_cast<std::uint16_t>(operands.size()), type, 0,
                            static_cast<std::uint32_t>(f->operands.size()), payload});
        for (std::uint32_t o : operands) f->operands.emplace_back(o);
        f->hints.emplace_back();
    }
    std::string said() {
        Diagnostics diagnostics;
        validate(module, diagnostics);
        return diagnostics.text();
    }
    void expect(std::string_view part) {
        const std::string text = said();
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
};

TEST(Validate, OperandsStandBeforeUsers) {
    Raw raw;
    EXPECT_EQ(raw.said(), "");
    raw.add(Op::Add, Type::Float, {0, 1});
    raw.expect("    %1 = add float %0, %1\n                       ^^\n");
    Raw missing;
    missing.add(Op::Neg, Type::Float, {Handle<int>::kNone});
    missing.expect("operand 1 does not stand before its user");
}

TEST(Validate, HandlesLieInTheArenas) {
    Raw operands;
    operands.add(Op::Neg, Type::Float, {0});
    operands.f->operands.clear();
    operands.expect("the operands lie outside the arena");
    Raw words;
    words.f->words.clear();
    words.expect("the words lie outside the arena");
    Raw op;
    op.add(static_cast<Op>(250), Type::Float, {});
    op.expect("no such operation");
    Raw type;
    type.add(Op::Neg, static_cast<Type>(999), {0});
    type.expect("no such type");
    Raw result;
    result.f->results[0].value = ExprId(9);
    result.expect("a result has no name or no value");
    Raw hints;
    hints.f->hints.clear();
    hints.expect("not one hint for each expression");
    Raw loop;
    loop.add(Op::LoopArg, Type::Integer, {}, 5 << 8);
    loop.expect("no such loop");
    Raw count;
    count.add(Op::Add, Type::Float, {0, 0, 0});
    count.expect("add takes 2 operands, not 3");
    Raw truth;
    truth.f->words.push_back(3);
    truth.add(Op::Constant, Type::Boolean, {}, 1);
    truth.expect("a truth value is 0 or 1");
    Raw uniform;
    Uniform& u = uniform.module.uniforms.emplace_back();
    u.name = uniform.names.intern("u");
    u.type = Type::Color3;
    u.values = {1, 2};
    uniform.expect("uniform 'u' has 2 values, not 3");
}

// ---- Types and payloads ----

TEST(Validate, Types) {
    expectSaid("%2 = add color3 %a, %a\nreturn %a", "the type that follows is float, not color3");
    expectSaid("%2 = cross color3 %v, %a\nreturn %a", "cross to color3 does not take color3, float");
    expectSaid("%2 = less boolean %a, %v\nreturn %a", "less to boolean does not take float, color3");
    expectSaid("%2 = bit_and integer %a, %a\nreturn %a", "does not take float, float");
    expectSaid("%2 = constant string \"s\"\n%3 = equal boolean %2, %a\nreturn %a", "operand 2 is float, not string");
    expectSaid("%2 = select float %a, %a, %a\nreturn %a", "operand 1 is float, not boolean");
    expectSaid("%2 = constant boolean true\n%3 = select float %2, %a, %v\nreturn %a", "operand 3 is color3, not float");
    expectSaid("%2 = make color3 %a, %a\nreturn %a", "make to color3 does not take float, float");
    expectSaid("%2 = param color3 a\nreturn %a", "the type is float, not color3");
    expectSaid("return %v", "the result is declared as float");
    expectSaid("%2 = constant boolean true\n%3 = ddx boolean %2\nreturn %a", "only floats have derivatives");
}

TEST(Validate, Payloads) {
    expectSaid("%2 = param float 7\nreturn %a", "no such parameter");
    expectSaid("%2 = context float payload 99\nreturn %a", "no such context");
    expectSaid("%2 = uniform float nothing\nreturn %a", "no such uniform");
    expectSaid("%2 = geomprop float %a\nreturn %a", "operand 1 is float, not string");
    expectSaid("%2 = uniform float u\nreturn %a", "the type is integer, not float", "uniform u: integer = 1\n");
    expectSaid("%2 = swizzle float %v, w\nreturn %a", "swizzle to float does not take color3");
    expectSaid("%2 = swizzle vector2 %v, x\nreturn %a", "swizzle to vector2 does not take color3");
    expectSaid("%2 = extern_text float 3\nreturn %a", "no such text");
    expectSaid("%2 = member float %a, 0\nreturn %a", "only structures have members");
    const std::string_view light = "struct light { i: float }\nuniform l: light\n";
    expectSaid("%2 = uniform light l\n%3 = member float %2, 1\nreturn %a", "no such member", light);
    expectSaid("%2 = uniform light l\n%3 = member color3 %2, 0\nreturn %a", "the type is float, not color3", light);
}

TEST(Validate, Images) {
    const std::string_view t = "uniform t: texture2d\n";
    expectSaid("%2 = attribute vector2 uv\n%3 = texture_level float %a, %2, %a\nreturn %a",
               "operand 1 is float, not texture2d");
    expectSaid("%2 = uniform texture2d t\n%3 = texture_level float %2, %v, %a\nreturn %a",
               "operand 2 is color3, not vector2", t);
    expectSaid("%2 = uniform texture2d t\n%3 = attribute vector2 uv\n%4 = texture_grad float %2, %3, %3, %a\nreturn %a",
               "operand 4 is float, not vector2", t);
    expectSaid("%2 = uniform texture2d t\n%3 = attribute vector2 uv\n%4 = texture_level integer %2, %3, %a\nreturn %a",
               "an image has no integer", t);
    expectSaid("%2 = uniform texture2d t\n%3 = texture_size float %2\nreturn %a", "the type is vector2, not float", t);
}

TEST(Validate, Calls) {
    expectSaid("%2 = call float nobody %a\nreturn %a", "no such function");
    expectSaid("%2 = call float one\nreturn %a", "the function takes 1 values, not 0");
    expectSaid("%2 = call float one %v\nreturn %a", "operand 1 is color3, not float");
    expectSaid("%2 = call color3 one %a\nreturn %a", "the type is float, not color3");
    expectSaid("%2 = call float two %a\nreturn %a", "the function does not have one result");
    expectSaid("%2 = call tuple two %a\n%3 = result float %2, 2\nreturn %a", "the function has no such result");
    expectSaid("%2 = call tuple two %a\n%3 = result float %2, 1\nreturn %a", "the type is color3, not float");
    expectSaid("%2 = result float %a, 0\nreturn %a", "not the results of a call or loop");
    expectSaid("%2 = call tuple two %a\n%3 = retype float %2\nreturn %a", "only result reads the results");
}

TEST(Validate, Closures) {
    const std::string_view leaf = "leaf d(weight: float)\n";
    expectSaid("%2 = leaf BSDF nobody %a\nreturn %a", "no such leaf");
    expectSaid("%2 = leaf BSDF d\nreturn %a", "the leaf takes 1 values, not 0", leaf);
    expectSaid("%2 = leaf BSDF d %v\nreturn %a", "operand 1 is color3, not float", leaf);
    expectSaid("%2 = leaf float d %a\nreturn %a", "a leaf is a closure", leaf);
    expectSaid("%2 = leaf BSDF d %a\n%3 = closure_mix BSDF %2, %2, %v\nreturn %a", "operand 3 is color3, not float",
               leaf);
    expectSaid("%2 = leaf BSDF d %a\n%3 = constant EDF\n%4 = closure_add BSDF %2, %3\nreturn %a",
               "operand 2 is EDF, not BSDF", leaf);
    expectSaid("%2 = closure_scale float %a, %a\nreturn %a", "not a closure");
    expectSaid("%2 = constant BSDF\n%3 = constant EDF\n%4 = surface surfaceshader %2, %2, %a, %a\nreturn %a",
               "operand 2 is BSDF, not EDF");
    expectSaid("%2 = constant VDF\n%3 = constant EDF\n%4 = volume material %2, %3\nreturn %a",
               "the type is volumeshader, not material");
    expectSaid("%2 = displacement displacementshader %v, %a\nreturn %a", "operand 1 is color3, not vector3");
}

// ---- Loops ----

TEST(Validate, Loops) {
    const std::string_view n = "%n = constant integer 3\n";
    const auto loop = [n](std::string_view body, std::string_view part) {
        expectSaid(std::string(n) + std::string(body), part);
    };
    loop("%c = loop_arg float loop 0, 1\n%l = loop tuple loop 0, %a | %a | %c\nreturn %a",
         "operand 1 is float, not integer");
    loop("%c = loop_arg float loop 0, 1\n%l = loop tuple loop 0, %n | %a | %v\nreturn %a",
         "operand 3 is color3, not float");
    loop("%l = loop tuple loop 0, %n | %a\nreturn %a", "as many next values as first values");
    loop(
        "%c = loop_arg float loop 0, 1\n%d = loop_arg float loop 0, 2\n%l = loop tuple loop 0, %n | %a, %v | %c, %v\n"
        "%r = result float %l, 2\nreturn %r",
        "the loop has no such result");
    loop("%d = loop_arg float loop 0, 3\n%l = loop tuple loop 0, %n | %a | %d\n%r = result float %l, 0\nreturn %r",
         "loop 0 carries 1 values");
    loop(
        "%d = loop_arg color3 loop 0, 1\n%x = swizzle float %d, x\n%l = loop tuple loop 0, %n | %a | %x\n"
        "%r = result float %l, 0\nreturn %r",
        "the type is float, not color3");
    loop("%i = loop_arg float loop 0, 0\n%l = loop tuple loop 0, %n | %a | %i\n%r = result float %l, 0\nreturn %r",
         "the type is integer, not float");
    loop("%c = loop_arg float loop 0, 1\nreturn %c", "loop 0, which is never closed");
    loop(
        "%c = loop_arg float loop 0, 1\n%l = loop tuple loop 0, %n | %a | %c\n%r = result float %l, 0\n"
        "%s = add float %r, %c\nreturn %s",
        "a result depends on an argument of loop 0 outside it");
    loop("%i = loop_arg integer loop 0, 0\n%l = loop tuple loop 0, %i | %a | %a\n%r = result float %l, 0\nreturn %r",
         "operand 1 depends on an argument of loop 0 outside it");
    loop(
        "%c = loop_arg float loop 1, 1\n%d = loop_arg float loop 0, 1\n%e = add float %c, %d\n"
        "%l = loop float loop 0, %n | %c | %e\n%o = loop float loop 1, %n | %a | %l\nreturn %o",
        "depends on an argument of loop 1 outside it");
    loop(
        "%c = loop_arg float loop 0, 1\n%l = loop float loop 0, %n | %a | %c\n%d = neg float %c\n"
        "%m = loop float loop 0, %n | %a | %d\n%s = add float %l, %m\nreturn %s",
        "loop 0 is closed twice");
    loop("%c = loop_arg float loop 0, 1\n%d = ddx float %c\n%l = loop float loop 0, %n | %a | %d\nreturn %l",
         "a derivative inside a loop");
    loop("%l = loop float loop 0, %n | %a, %a | %a, %a\nreturn %l", "has several results");
}

// ---- Bodies ----

TEST(Validate, Bodies) {
    const std::string_view start =
        "%n = constant integer 3\n%x = mul float %a, %a\n%y = exp float %a\n%c = less boolean %a, %x\n"
        "%s = select float %c, %x, %y\n%i = loop_arg float loop 0, 1\n%j = mul float %i, %x\n"
        "%l = loop float loop 0, %n | %a | %j\n%r = add float %s, %l\nreturn %r\nbody {\n";
    const auto body = [start](std::string_view text, std::string_view part) {
        const std::string is = said(std::string(start) + std::string(text) + "\n}");
        if (part.empty())
            EXPECT_EQ(is, "") << text;
        else
            EXPECT_NE(is.find(part), std::string::npos) << text << "\nsays: " << is;
    };
    body("let %x\nif %c {\n} else {\nlet %y\n} -> %s\nloop %l {\nlet %j\n}\nlet %r", "");
    body("loop %l {\n}", "");
    body("let %x\n", "the loop has not run where %10 needs it");
    body("let %j\nloop %l {\n}", "%8 needs an argument of a loop outside it");
    body("let %c\nlet %x\nloop %l {\n}", "%3 is not computed where %5 needs it");
    body("if %c {\nlet %x\n} else {\n} -> %s\nloop %l {\n}", "is not computed where");
    body("let %x\nlet %x\nloop %l {\n}", "computed twice");
    body("loop %l {\n}\nloop %l {\n}", "computed twice");
    body("loop %l {\nlet %x\n}\n", "%3 is not computed where %10 needs it");
    body("let %r\nloop %l {\n}", "the loop has not run");
    body("let %l", "a loop is run, not named");
    body("loop %x {\n}", "not a loop");
    body("if %x {\n}", "a condition is boolean");
    body("if %c {\n} -> %x\nloop %l {\n}", "not a select by %5");
}

TEST(Validate, BlocksAreATree) {
    for (std::uint32_t block : {0u, 7u}) {
        Raw raw;
        raw.f->words.push_back(1);
        raw.add(Op::Constant, Type::Boolean, {}, 1);
        raw.f->body.blocks.resize(2);
        raw.f->body.blocks[0].push_back({StmtKind::If, ExprId(1), BlockId(1), BlockId()});
        EXPECT_EQ(raw.said(), "");
        raw.f->body.blocks[0][0].body = BlockId(block);
        raw.expect("a block that is not there or stands elsewhere too");
    }
    Raw phis;
    phis.f->words.push_back(1);
    phis.add(Op::Constant, Type::Boolean, {}, 1);
    phis.f->body.blocks.resize(2);
    phis.f->body.blocks[0].push_back({StmtKind::If, ExprId(1), BlockId(1), BlockId(), 0, 3});
    phis.expect("lie outside the arena");
}

}  // namespace
}  // namespace shaderx::ir
