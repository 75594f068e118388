#include "graph/graph.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "doc/read.h"
#include "graph/lower.h"
#include "graph/values.h"
#include "ir/builder.h"
#include "ir/text.h"

namespace shaderx::graph {
namespace {

using doc::ElementId;

constexpr const char* kLibrary = R"(<materialx version="1.39">
  <geompropdef name="Nworld" type="vector3" geomprop="normal" space="world"/>
  <geompropdef name="UV0" type="vector2" geomprop="texcoord" index="0"/>
  <nodedef name="ND_normal" node="normal"><input name="space" type="string" value="object"/><output name="out" type="vector3"/></nodedef>
  <nodedef name="ND_texcoord" node="texcoord"><input name="index" type="integer" value="0"/><output name="out" type="vector2"/></nodedef>
  <nodedef name="ND_constant_float" node="constant"><input name="value" type="float" value="0"/><output name="out" type="float"/></nodedef>
  <nodedef name="ND_constant_color3" node="constant"><input name="value" type="color3" value="0, 0, 0"/><output name="out" type="color3"/></nodedef>
  <nodedef name="ND_sin" node="sin"><input name="in" type="float" value="0"/><output name="out" type="float"/></nodedef>
  <nodedef name="ND_add_float" node="add"><input name="in1" type="float" value="0"/><input name="in2" type="float" value="0.5"/><output name="out" type="float"/></nodedef>
  <nodedef name="ND_add_color3" node="add"><input name="in1" type="color3" value="0, 0, 0"/><input name="in2" type="color3" value="0, 0, 0"/><output name="out" type="color3"/></nodedef>
  <nodedef name="ND_facing" node="facing"><input name="normal" type="vector3" defaultgeomprop="Nworld"/><input name="scale" type="float" value="1"/><output name="out" type="float"/></nodedef>
  <nodedef name="ND_lost" node="lost"><input name="in" type="vector3" defaultgeomprop="Nowhere"/><output name="out" type="float"/></nodedef>
  <nodedef name="ND_separate2" node="separate2"><input name="in" type="vector2" value="0, 0"/><output name="outx" type="float"/><output name="outy" type="float"/></nodedef>
  <nodedef name="ND_image" node="image"><input name="file" type="filename" value=""/><input name="texcoord" type="vector2" defaultgeomprop="UV0"/><input name="uaddressmode" type="string" value="periodic"/><output name="out" type="color3"/></nodedef>
  <nodedef name="ND_decode" node="srgb_texture_to_lin_rec709"><input name="in" type="color3" value="0, 0, 0"/><output name="out" type="color3"/></nodedef>
</materialx>)";

// Every node of the library has a function by the name of its nodedef; what it does is of no matter here.
struct NamedBodies final : Bodies {
    NameTable& names;
    const doc::Definitions& definitions;
    const doc::Document& library;
    std::set<Name> taken{};

    NamedBodies(NameTable& n, const doc::Definitions& defs, const doc::Document& l)
        : names(n), definitions(defs), library(l) {}

    Name functionOf(doc::NodeDef def, Diagnostics&) override { return definitions.row(def).name; }
    bool takeName(Name name) override { return taken.insert(name).second; }
    float unitScale(std::string_view, std::string_view) override { return 1; }
    Name instanceOf(doc::NodeDef def, const Instance&, bool& decodes, Diagnostics& diagnostics) override {
        decodes = false;
        return functionOf(def, diagnostics);
    }
    Name setOf(doc::NodeDef def, int, Diagnostics& diagnostics) override { return functionOf(def, diagnostics); }
    ColorConversion toWorkingSpace(Name from, ir::Type type, Diagnostics&) override {
        doc::NodeDef def = nodeFor(std::string(names.text(from)) + "_to_lin_rec709", type);
        return def ? ColorConversion{definitions.row(def).name, true} : ColorConversion{{}, false};
    }
    std::string_view nearestColorSpace(std::string_view) override { return {}; }
    doc::ElementRef geometricProperty(Name name) override {
        return {&library, library.child(library.root(), names.intern("geompropdef"), name)};
    }
    doc::NodeDef nodeFor(std::string_view category, ir::Type type) override {
        for (doc::NodeDef def : definitions.ofCategory(names.intern(category)))
            if (ir::typeNamed(names.text(definitions.row(def).output)) == type) return def;
        return {};
    }
};

struct Sample {
    NameTable names;
    doc::Document library{names}, document{names};
    doc::Definitions definitions;
    Diagnostics diagnostics;
    Graph graph{};
    ir::Module module{names};

    explicit Sample(const std::string& body) {
        read(library, kLibrary, "library.mtlx");
        read(document, "<materialx version=\"1.39\">\n" + body + "\n</materialx>", "test.mtlx");
        definitions.add(document);
        definitions.add(library);
    }
    void read(doc::Document& into, const std::string& text, const char* file) {
        doc::NoIncludes none;
        EXPECT_TRUE(doc::read(into, file, text, none, diagnostics)) << diagnostics.text();
    }
    bool build(std::string_view path) {
        return graph::build(document, document.find(path), definitions, graph, diagnostics);
    }
    bool lower(Interface interface = Interface::Live) {
        NamedBodies bodies(names, definitions, library);
        LowerOptions how;
        how.interface = interface;
        return graph::lower(graph, definitions, bodies, {}, names.intern("f"), how, module, diagnostics);
    }
    // Builds and lowers; the program as text.
    std::string program(std::string_view path, Interface interface = Interface::Live) {
        return build(path) && lower(interface) ? ir::print(module) : "failed: " + diagnostics.text();
    }
    std::string nodes() const {
        std::string out;
        for (const Node& n : graph.nodes) out += document.path(n.element) + " ";
        return out;
    }
    std::string uniforms() const {
        std::string out;
        for (const ir::Uniform& u : module.uniforms) out += std::string(names.text(u.name)) + "=" + u.path + " ";
        return out;
    }
    std::string codes() const {
        std::string out;
        for (const Diagnostic& d : diagnostics.all()) out += d.code + " ";
        return out;
    }
};

std::size_t count(const std::string& text, std::string_view part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) n++;
    return n;
}

// Two nodes read one; another two have nothing to do with them.
constexpr const char* kDiamond = R"(
    <add name="end" type="float"><input name="in1" type="float" nodename="left"/><input name="in2" type="float" nodename="right"/></add>
    <sin name="elsewhere" type="float"><input name="in" type="float" nodename="start"/></sin>
    <sin name="left" type="float"><input name="in" type="float" nodename="start"/></sin>
    <sin name="right" type="float"><input name="in" type="float" nodename="start"/></sin>
    <constant name="start" type="float"><input name="value" type="float" value="0.25"/></constant>
    <unknown name="broken" type="float"/>
    <output name="o" type="float" nodename="end"/>)";

TEST(Build, OnlyWhatIsUpstreamEachOnce) {
    Sample s(kDiamond);
    ASSERT_TRUE(s.build("o")) << s.diagnostics.text();
    EXPECT_EQ(s.nodes(), "start left right end ");
    ASSERT_EQ(s.graph.outputs.size(), 1u);
    EXPECT_EQ(s.graph.outputs[0].source.node, NodeId(3));
    Sample other(kDiamond);
    ASSERT_TRUE(other.build("left"));
    EXPECT_EQ(other.nodes(), "start left ");
}

TEST(Build, NodesComeAfterWhatTheyDependOn) {
    Sample s(kDiamond);
    ASSERT_TRUE(s.build("o"));
    for (std::uint32_t i = 0; i < s.graph.nodes.size(); i++)
        for (const Input& input : s.graph.inputsOf(s.graph.nodes[i])) {
            EXPECT_TRUE(input.source.kind != Source::Kind::Node || input.source.node.index < i);
        }
}

TEST(Build, SourcesOfInputs) {
    Sample s(R"(<texcoord name="uv" type="vector2"/>
        <separate2 name="parts" type="multioutput"><input name="in" type="vector2" nodename="uv"/></separate2>
        <add name="sum" type="float"><input name="in1" type="float" nodename="parts" output="outy"/></add>)");
    ASSERT_TRUE(s.build("sum")) << s.diagnostics.text();
    EXPECT_EQ(print(s.graph, s.definitions),
              "uv = texcoord (ND_texcoord)\n    index: integer = default\n"
              "parts = separate2 (ND_separate2)\n    in: vector2 = uv\n"
              "sum = add (ND_add_float)\n    in1: float = parts.outy\n    in2: float = default\n"
              "output out: float = sum\n");
    Sample all(R"(<separate2 name="parts" type="multioutput"/>)");
    ASSERT_TRUE(all.build("parts"));
    EXPECT_EQ(all.graph.outputs.size(), 2u);
    EXPECT_EQ(all.graph.outputs[1].source.output, 1u);
}

TEST(Build, CyclesAreReportedWithTheirPath) {
    Sample s(R"(<sin name="start" type="float"><input name="in" type="float" nodename="a"/></sin>
        <sin name="a" type="float"><input name="in" type="float" nodename="b"/></sin>
        <sin name="b" type="float"><input name="in" type="float" nodename="c"/></sin>
        <sin name="c" type="float"><input name="in" type="float" nodename="a"/></sin>)");
    EXPECT_FALSE(s.build("start"));
    ASSERT_EQ(s.codes(), "cycle ") << s.diagnostics.text();
    const Diagnostic& d = s.diagnostics.all()[0];
    EXPECT_NE(d.message.find("a -> b -> c -> a"), std::string::npos) << d.message;
    EXPECT_EQ(d.message.find("start"), std::string::npos) << d.message;
    EXPECT_EQ(d.path, "a");
    EXPECT_EQ(d.where.line, 3u);

    Sample self(R"(<sin name="a" type="float"><input name="in" type="float" nodename="a"/></sin>)");
    EXPECT_FALSE(self.build("a"));
    EXPECT_EQ(self.codes(), "cycle ");
    Sample graphs(R"(<nodegraph name="g"><input name="i" type="float" nodegraph="g" output="o"/>
        <output name="o" type="float" interfacename="i"/></nodegraph>)");
    EXPECT_FALSE(graphs.build("g/o"));
    EXPECT_EQ(graphs.codes(), "cycle ");
}

TEST(Build, EveryMistakeUpstreamIsReported) {
    Sample s(R"(<add name="a" type="float"><input name="in1" type="float" nodename="nobody"/>
        <input name="in2" type="float" nodename="u"/></add><unknown name="u" type="float"/>)");
    EXPECT_FALSE(s.build("a"));
    EXPECT_EQ(s.codes(), "dangling-connection unknown-node ") << s.diagnostics.text();
}

constexpr const char* kPorts = R"(
    <nodegraph name="tint">
      <input name="amount" type="float" value="0.25"/><input name="unused" type="float" value="1"/>
      <input name="outer" type="float" nodename="far"/>
      <sin name="s" type="float"><input name="in" type="float" interfacename="amount"/></sin>
      <add name="a" type="float"><input name="in1" type="float" nodename="s"/><input name="in2" type="float" interfacename="amount"/></add>
      <add name="b" type="float"><input name="in1" type="float" nodename="a"/><input name="in2" type="float" interfacename="outer"/></add>
      <output name="out" type="float" nodename="b"/>
    </nodegraph>
    <sin name="far" type="float"><input name="in" type="float" value="0.125"/></sin>
    <output name="o" type="float" nodegraph="tint" output="out"/>)";

TEST(Lower, EachInterfacePortInUseIsOneUniform) {
    Sample s(kPorts);
    std::string text = s.program("o");
    EXPECT_EQ(s.uniforms(), "tint_amount=tint/amount far_in=far/in ") << text;
    EXPECT_EQ(count(text, "= uniform float tint_amount"), 1u) << text;
    ASSERT_EQ(s.module.uniforms.size(), 2u);
    EXPECT_EQ(std::bit_cast<float>(s.module.uniforms[0].values.at(0)), 0.25f);
}

TEST(Lower, BakedProgramsHaveNoUniforms) {
    Sample s(kPorts);
    std::string text = s.program("o", Interface::Baked);
    EXPECT_EQ(s.uniforms(), "") << text;
    EXPECT_NE(text.find("constant float 0.25"), std::string::npos) << text;
}

TEST(Lower, UniformsOfOneNameInTwoGraphsAreTold) {
    Sample s(R"(<nodegraph name="g"><sin name="s" type="float"><input name="in" type="float" value="1"/></sin>
          <output name="out" type="float" nodename="s"/></nodegraph>
        <sin name="s" type="float"><input name="in" type="float" value="2"/></sin>
        <add name="a" type="float"><input name="in1" type="float" nodegraph="g" output="out"/><input name="in2" type="float" nodename="s"/></add>)");
    s.program("a");
    EXPECT_EQ(s.uniforms(), "s_in=g/s/in s_in2=s/in ");
}

TEST(Lower, GeometricPropertiesAreComputedOnce) {
    Sample s(
        R"(<add name="a" type="float"><input name="in1" type="float" nodename="f"/><input name="in2" type="float" nodename="g"/></add>
        <facing name="f" type="float"><input name="scale" type="float" value="2"/></facing><facing name="g" type="float"/>)");
    std::string text = s.program("a");
    EXPECT_EQ(count(text, "call vector3 ND_normal"), 1u) << text;
    // In the space that the property says, not the node's own default.
    EXPECT_NE(text.find("\"world\""), std::string::npos) << text;
    EXPECT_EQ(text.find("\"object\""), std::string::npos) << text;

    Sample lost(R"(<lost name="l" type="float"/>)");
    lost.program("l");
    EXPECT_EQ(lost.codes(), "unknown-geomprop ");
}

TEST(Lower, AGeometricPropertyTakesNoValue) {
    Sample s(
        R"(<facing name="f" type="float"><input name="normal" type="vector3" value="0, 0, 1"/><input name="scale" type="float" value="2"/></facing>)");
    std::string text = s.program("f");
    EXPECT_EQ(count(text, "call vector3 ND_normal"), 1u) << text;
    EXPECT_EQ(s.codes(), "ignored-value ");
    EXPECT_FALSE(s.diagnostics.hasErrors());
    EXPECT_EQ(s.uniforms(), "f_scale=f/scale ");

    // A value of a nodegraph's port is no place or direction of the mesh either.
    Sample port(R"(<nodegraph name="g"><input name="up" type="vector3" value="0, 0, 1"/>
        <facing name="f" type="float"><input name="normal" type="vector3" interfacename="up"/></facing>
        <output name="out" type="float" nodename="f"/></nodegraph>)");
    text = port.program("g");
    EXPECT_EQ(count(text, "call vector3 ND_normal"), 1u) << text;
    EXPECT_EQ(port.codes(), "ignored-value ");
}

TEST(Lower, ValuesInAnotherColourSpaceAreTransformed) {
    Sample s(
        R"(<add name="a" type="color3"><input name="in1" type="color3" value="0.5, 0.5, 0.5" colorspace="srgb_texture"/>
        <input name="in2" type="color3" value="0.25, 0.25, 0.25" colorspace="lin_rec709"/></add>)");
    std::string text = s.program("a");
    EXPECT_EQ(count(text, "call color3 ND_decode"), 1u) << text;
    EXPECT_TRUE(s.diagnostics.all().empty()) << s.diagnostics.text();

    Sample unknown(
        R"(<add name="a" type="color3"><input name="in1" type="color3" value="1, 1, 1" colorspace="moonlight"/></add>)");
    text = unknown.program("a");
    EXPECT_EQ(unknown.codes(), "unknown-colorspace ");
    EXPECT_FALSE(unknown.diagnostics.hasErrors());
}

TEST(Lower, PicturesInAnotherColourSpaceAreTransformedAfterReading) {
    Sample s(
        R"(<image name="i" type="color3"><input name="file" type="filename" value="wood.png" colorspace="srgb_texture"/>
        <input name="uaddressmode" type="string" value="clamp"/></image>)");
    std::string text = s.program("i");
    std::size_t read = text.find("call color3 ND_image"), decode = text.find("call color3 ND_decode");
    ASSERT_NE(decode, std::string::npos) << text;
    EXPECT_LT(read, decode) << text;
    ASSERT_EQ(s.module.uniforms.size(), 1u);
    EXPECT_EQ(s.module.uniforms[0].file, "wood.png");
    EXPECT_EQ(s.module.uniforms[0].uAddress, "clamp");
    EXPECT_EQ(s.module.uniforms[0].colorspace, "srgb_texture");
    // A file stays a uniform where values do not.
    Sample baked(R"(<image name="i" type="color3"><input name="file" type="filename" value="wood.png"/></image>)");
    text = baked.program("i", Interface::Baked);
    EXPECT_EQ(baked.uniforms(), "i_file=i/file ");
    EXPECT_EQ(text.find("ND_decode"), std::string::npos) << text;
}

TEST(Lower, ConnectionsOfOtherTypesAreErrors) {
    Sample s(
        R"(<constant name="c" type="color3"/><sin name="s" type="float"><input name="in" type="float" nodename="c"/></sin>)");
    s.program("s");
    ASSERT_EQ(s.codes(), "type-mismatch ");
    EXPECT_EQ(s.diagnostics.all()[0].path, "s/in");
    EXPECT_EQ(s.diagnostics.all()[0].message, "'in' is float, but 'c' gives color3");
    Sample output(R"(<constant name="c" type="color3"/><output name="o" type="vector2" nodename="c"/>)");
    output.program("o");
    EXPECT_EQ(output.codes(), "type-mismatch ");
    // Types that differ only in how they are read do fit.
    Sample vector(R"(<constant name="c" type="color3"/><output name="o" type="vector3" nodename="c"/>)");
    vector.program("o");
    EXPECT_EQ(vector.codes(), "");
}

TEST(Lower, BadValuesAreErrors) {
    Sample s(
        R"(<add name="a" type="float"><input name="in1" type="float" value="one"/><input name="in2" type="float" value="1, 2"/></add>)");
    s.program("a");
    EXPECT_EQ(s.codes(), "bad-value odd-value ");
}

TEST(Values, MatricesAreTransposed) {
    NameTable names;
    ir::Module module(names);
    ir::Function f;
    ir::Builder b(module, f);
    ir::ExprId m = constantOf(b, ir::Type::Matrix33, "1, 2, 3, 4, 5, 6, 7, 8, 9");
    ASSERT_TRUE(m);
    // Rows of a matrix for row vectors are columns of one for column vectors: the same nine numbers in a row.
    for (std::size_t i = 0; i < 9; i++)
        EXPECT_EQ(std::bit_cast<float>(f.constantWords(m)[i]), static_cast<float>(i + 1));
    std::string problem;
    Words words;
    EXPECT_FALSE(constantOf(b, ir::Type::Color3, "1, 2"));
    EXPECT_FALSE(readWords(ir::Type::Color3, "1, 2", words, &problem));
    EXPECT_EQ(problem, "expected 3 numbers, found 2");
    EXPECT_TRUE(constantOf(b, ir::Type::BSDF, ""));
    EXPECT_TRUE(readWords(ir::Type::Boolean, "true", words));
    EXPECT_EQ(words.bits[0], 1u);
    EXPECT_TRUE(readWords(ir::Type::Integer, "-3", words));
    EXPECT_EQ(words.bits[0], 0xfffffffdu);
    EXPECT_TRUE(readWords(ir::Type::Vector2, "", words));
    EXPECT_EQ(words.all().size(), 2u);
    EXPECT_EQ(words.bits[0], 0u);
    EXPECT_FALSE(readWords(ir::Type::Float, "wide", words));
}

// Nanoseconds a node for a chain of so many nodes, written last node first.
double timeOfChain(int length) {
    std::string body;
    for (int i = length; i-- > 0;) {
        std::string name = "n" + std::to_string(i);
        body += "<sin name=\"" + name + "\" type=\"float\">";
        if (i > 0) body += "<input name=\"in\" type=\"float\" nodename=\"n" + std::to_string(i - 1) + "\"/>";
        body += "</sin>\n";
    }
    Sample s(body);
    auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(s.build("n" + std::to_string(length - 1)) && s.lower()) << s.diagnostics.text();
    std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    EXPECT_EQ(s.graph.nodes.size(), static_cast<std::size_t>(length));
    return taken.count() / length;
}

// Nothing recurses on the length of a chain. The times are told, not judged.
TEST(Lower, LongChains) {
    RecordProperty("ns_per_node_of_20000", static_cast<int>(timeOfChain(20000)));
    RecordProperty("ns_per_node_of_200000", static_cast<int>(timeOfChain(200000)));
}

}  // namespace
}  // namespace shaderx::graph
