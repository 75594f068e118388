// Documents whose structure is a trap: cycles, explosions, depth, size.
#include <fmt/format.h>

#include "hostile.h"

namespace shaderx::tests {
namespace {

const char* const kUseA = "<ua name=\"y\" type=\"float\"/><output name=\"o\" type=\"float\" nodename=\"y\"/>";

std::string nodedef(std::string_view name, std::string_view node, std::string_view more = "") {
    return fmt::format("<nodedef name=\"{}\" node=\"{}\" {}><output name=\"out\" type=\"float\"/></nodedef>\n", name,
                       node, more);
}

std::string graphOf(std::string_view name, std::string_view attributes, std::string_view node) {
    return fmt::format(
        "<nodegraph name=\"{}\" {}><{} name=\"x\" type=\"float\"/><output name=\"out\" type=\"float\" "
        "nodename=\"x\"/></nodegraph>\n",
        name, attributes, node);
}

TEST(Cycles, OfNodes) {
    auto add = [](std::string_view name, std::string_view from) {
        return fmt::format("<add name=\"{}\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"{}\"/></add>",
                           name, from);
    };
    const std::string output = "<output name=\"o\" type=\"float\" nodename=\"a\"/>";
    expectRefused(compile(wrapped(add("a", "a") + output)), "cycle", "a node of itself");
    expectRefused(compile(wrapped(add("a", "b") + add("b", "a") + output)), "cycle", "two nodes");
    std::string ring;
    for (int i = 0; i < 10000; i++) ring += add(fmt::format("n{}", i), fmt::format("n{}", (i + 1) % 10000));
    ring += "<output name=\"o\" type=\"float\" nodename=\"n0\"/>";
    expectRefused(compile(wrapped(ring)), "cycle", "10,000 nodes");
    expectRefused(
        compile(wrapped("<mix name=\"m\" type=\"BSDF\"><input name=\"fg\" type=\"BSDF\" nodename=\"m\"/></mix>"
                        "<surface name=\"s\" type=\"surfaceshader\"><input name=\"bsdf\" type=\"BSDF\" nodename=\"m\"/>"
                        "</surface><surfacematerial name=\"mm\" type=\"material\"><input name=\"surfaceshader\" "
                        "type=\"surfaceshader\" nodename=\"s\"/></surfacematerial>")),
        "cycle", "closures");
}

TEST(Cycles, OfGraphsThroughTheirInterfaces) {
    auto graph = [](std::string_view name, std::string_view from, bool passes) {
        return fmt::format(
            "<nodegraph name=\"{}\"><input name=\"p\" type=\"float\" nodegraph=\"{}\"/>{}<output name=\"o\" "
            "type=\"float\" {}/></nodegraph>",
            name, from,
            passes ? ""
                   : "<sin name=\"s\" type=\"float\"><input name=\"in\" type=\"float\" interfacename=\"p\"/></sin>",
            passes ? "interfacename=\"p\"" : "nodename=\"s\"");
    };
    const std::string output = "<output name=\"o\" type=\"float\" nodegraph=\"g\"/>";
    for (bool passes : {false, true}) {
        expectRefused(compile(wrapped(graph("g", "g", passes) + output)), "cycle", "a graph of itself");
        expectRefused(compile(wrapped(graph("g", "h", passes) + graph("h", "g", passes) + output)), "cycle", "two");
    }
    std::string outputs =
        "<nodegraph name=\"g\"><output name=\"a\" type=\"float\" output=\"b\"/><output name=\"b\" type=\"float\" "
        "output=\"a\"/></nodegraph>";
    expectRefused(compile(wrapped(outputs)), "cycle", "outputs");
    // Nothing is around the graph whose input that could be: told, and the default is taken.
    const Outcome open =
        compile(wrapped("<nodegraph name=\"g\"><input name=\"p\" type=\"float\" interfacename=\"p\"/><sin "
                        "name=\"s\" type=\"float\"><input name=\"in\" type=\"float\" interfacename=\"p\"/>"
                        "</sin><output name=\"o\" type=\"float\" nodename=\"s\"/></nodegraph>"));
    expectOrderly(open, "an interface of itself");
    EXPECT_EQ(open.shaders.size(), 1u);
    EXPECT_NE(open.errors.find("[dangling-interfacename]"), std::string::npos) << open.errors;
    // Many that read what leads in a circle: found once.
    for (int i = 0; i < 5000; i++)
        outputs += fmt::format(
            "<add name=\"n{}\" type=\"float\"><input name=\"in1\" type=\"float\" nodegraph=\"g\" output=\"a\"/>"
            "<input name=\"in2\" type=\"float\" nodename=\"n{}\"/></add>",
            i, i + 1);
    How how;
    how.element = "n0";
    expectRefused(compile(wrapped(outputs + "<add name=\"n5000\" type=\"float\"/>"), how), "cycle", "5,000 readers");
}

TEST(Cycles, OfDefinitions) {
    expectRefused(compile(wrapped(nodedef("ND_a", "ua") + graphOf("G", "nodedef=\"ND_a\"", "ua") + kUseA)), "cycle",
                  "a node of itself");
    expectRefused(compile(wrapped(nodedef("ND_a", "ua") + graphOf("G", "nodedef=\"ND_a\"", "ub") +
                                  nodedef("ND_b", "ub") + graphOf("H", "nodedef=\"ND_b\"", "ua") + kUseA)),
                  "cycle", "two nodes");
    expectRefused(
        compile(wrapped(nodedef("ND_a", "ua") + "<implementation name=\"I\" nodedef=\"ND_a\" nodegraph=\"G\"/>" +
                        graphOf("G", "", "ua") + kUseA)),
        "cycle", "by an implementation");
    expectRefused(
        compile(wrapped("<geompropdef name=\"gp\" type=\"float\" geomprop=\"ua\"/><nodedef name=\"ND_a\" node=\"ua\">"
                        "<input name=\"i\" type=\"float\" defaultgeomprop=\"gp\"/><output name=\"out\" type=\"float\"/>"
                        "</nodedef>" +
                        graphOf("G", "nodedef=\"ND_a\"", "ua") + kUseA)),
        "cycle", "by a geometric property");
}

TEST(Cycles, OfInheritance) {
    std::string graph = graphOf("G", "nodedef=\"ND_a\"", "constant");
    expectRefused(compile(wrapped(nodedef("ND_a", "ua", "inherit=\"ND_a\"") + graph + kUseA)), "inherit-cycle", "one");
    expectRefused(compile(wrapped(nodedef("ND_a", "ua", "inherit=\"ND_b\"") +
                                  nodedef("ND_b", "ub", "inherit=\"ND_a\"") + graph + kUseA)),
                  "inherit-cycle", "two");
    expectRefused(
        compile(wrapped(nodedef("ND_a", "ua", "inherit=\"ND_b\"") + nodedef("ND_b", "ub", "inherit=\"ND_c\"") +
                        nodedef("ND_c", "uc", "inherit=\"ND_b\"") + graph + kUseA)),
        "inherit-cycle", "a tail and two");
}

TEST(Cycles, OfIncludes) {
    auto including = [](std::string_view file) { return wrapped(fmt::format("<xi:include href=\"{}\"/>", file)); };
    Texts texts;
    How how;
    how.resolver = &texts;
    texts.texts["t.mtlx"] = including("t.mtlx");
    expectRefused(compile(texts.texts["t.mtlx"], how), "include-cycle", "itself");
    texts.texts["a"] = including("b");
    texts.texts["b"] = including("c");
    texts.texts["c"] = including("a");
    expectRefused(compile(including("a"), how), "include-cycle", "a ring");
    // Each includes all that follow: 2^30 ways, each file once.
    for (int i = 0; i < 30; i++) {
        std::string all = fmt::format("<constant name=\"c{}\" type=\"float\"/>", i);
        for (int k = i + 1; k < 30; k++) all += fmt::format("<xi:include href=\"f{}\"/>", k);
        texts.texts[fmt::format("f{}", i)] = wrapped(all);
    }
    Outcome out = compile(including("f0"), how);
    expectOrderly(out, "2^30 ways");
    EXPECT_TRUE(out.isRead) << out.errors;
    for (int i = 0; i < 100; i++) texts.texts[fmt::format("d{}", i)] = including(fmt::format("d{}", i + 1));
    expectRefused(compile(including("d0"), how), "limit", "100 deep");
    how.read.maxIncludeDepth = 2;
    texts.texts["d2"] = wrapped("");
    expectRefused(compile(including("d0"), how), "limit", "three deep of two");
}

// A chain: every node reads the one before it `reads` times.
std::string tower(std::string_view category, int levels, std::initializer_list<std::string_view> inputs) {
    std::string text =
        "<texcoord name=\"t\" type=\"vector2\"/><extract name=\"n0\" type=\"float\"><input name=\"in\" "
        "type=\"vector2\" nodename=\"t\"/></extract>\n";
    for (int i = 1; i <= levels; i++) {
        text += fmt::format("<{} name=\"n{}\" type=\"float\">", category, i);
        for (std::string_view in : inputs)
            text += fmt::format("<input name=\"{}\" type=\"float\" nodename=\"n{}\"/>", in, i - 1);
        text += fmt::format("</{}>\n", category);
    }
    return wrapped(text + fmt::format("<output name=\"o\" type=\"float\" nodename=\"n{}\"/>", levels));
}

TEST(Explosions, DiamondsOfNodes) {
    for (std::string_view category : {"add", "multiply", "power"})
        for (Interface interface : {Interface::Live, Interface::Baked}) {
            How how;
            how.interface = interface;
            Outcome out = compile(tower(category, 30, {"in1", "in2"}), how);
            expectOrderly(out, category);
            ASSERT_EQ(out.shaders.size(), 1u) << out.errors;
            EXPECT_LT(out.shaders[0].pixel.size(), 20000u);
            expectCompiles(out.shaders, category);
        }
}

// Nodes made of graphs, each of which uses the one below twice, with different arguments.
std::string nestedGraphs(int levels, int uses) {
    auto define = [](int i, std::string_view inside, std::string_view last) {
        return fmt::format(
            "<nodedef name=\"ND_{0}\" node=\"u{0}\"><input name=\"a\" type=\"float\" value=\"0.5\"/><output "
            "name=\"out\" type=\"float\"/></nodedef><nodegraph name=\"NG_{0}\" nodedef=\"ND_{0}\">{1}<output "
            "name=\"out\" type=\"float\" nodename=\"{2}\"/></nodegraph>\n",
            i, inside, last);
    };
    std::string text =
        define(0, "<sin name=\"x\" type=\"float\"><input name=\"in\" type=\"float\" interfacename=\"a\"/></sin>", "x");
    for (int i = 1; i <= levels; i++) {
        std::string inside;
        for (int k = 0; k < uses; k++) {
            std::string source = k ? fmt::format("nodename=\"m{}\"", k) : "interfacename=\"a\"";
            if (k)
                inside += fmt::format(
                    "<add name=\"m{0}\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"x{1}\"/><input "
                    "name=\"in2\" type=\"float\" value=\"0.{0}\"/></add>",
                    k, k - 1);
            inside += fmt::format("<u{} name=\"x{}\" type=\"float\"><input name=\"a\" type=\"float\" {}/></u{}>", i - 1,
                                  k, source, i - 1);
        }
        text += define(i, inside, fmt::format("x{}", uses - 1));
    }
    return wrapped(text +
                   fmt::format("<texcoord name=\"t\" type=\"vector2\"/><extract name=\"e\" type=\"float\"><input "
                               "name=\"in\" type=\"vector2\" nodename=\"t\"/></extract><u{0} name=\"top\" "
                               "type=\"float\"><input name=\"a\" type=\"float\" nodename=\"e\"/></u{0}><output "
                               "name=\"o\" type=\"float\" nodename=\"top\"/>",
                               levels));
}

TEST(Explosions, DiamondsOfGraphs) {
    expectRefused(compile(nestedGraphs(30, 2)), "limit", "30 levels");
    expectRefused(compile(nestedGraphs(12, 9)), "limit", "9^12");
    Outcome few = compile(nestedGraphs(6, 2));
    expectOrderly(few, "6 levels");
    EXPECT_EQ(few.shaders.size(), 1u) << few.errors;
    expectCompiles(few.shaders, "6 levels");
    How how;
    how.generate.maxExpressions = 10;
    expectRefused(compile(nestedGraphs(12, 2), how), "limit", "12 levels, 10 expressions");
}

TEST(Explosions, DeepGraphs) {
    Outcome deep = compile(nestedGraphs(100, 1));
    expectOrderly(deep, "100 levels");
    EXPECT_EQ(deep.shaders.size(), 1u) << deep.errors;
    expectRefused(compile(nestedGraphs(5000, 1)), "limit", "5,000 levels");
    How how;
    how.generate.maxDepth = 5;
    expectRefused(compile(nestedGraphs(10, 1), how), "limit", "10 levels of 5");
    EXPECT_EQ(compile(nestedGraphs(3, 1), how).shaders.size(), 1u);
}

std::string material(std::string_view closures, std::string_view last) {
    return wrapped(
        fmt::format("<texcoord name=\"t\" type=\"vector2\"/><extract name=\"e\" type=\"float\"><input "
                    "name=\"in\" type=\"vector2\" nodename=\"t\"/></extract>{}<surface name=\"s\" "
                    "type=\"surfaceshader\"><input name=\"bsdf\" type=\"BSDF\" nodename=\"{}\"/></surface>"
                    "<surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" "
                    "type=\"surfaceshader\" nodename=\"s\"/></surfacematerial>",
                    closures, last));
}

TEST(Explosions, DiamondsOfClosures) {
    std::string mixes = "<oren_nayar_diffuse_bsdf name=\"b0\" type=\"BSDF\"/>";
    std::string cross =
        "<oren_nayar_diffuse_bsdf name=\"a0\" type=\"BSDF\"/><dielectric_bsdf name=\"b0\" type=\"BSDF\"/>";
    for (int i = 1; i <= 30; i++) {
        mixes += fmt::format(
            "<mix name=\"b{0}\" type=\"BSDF\"><input name=\"fg\" type=\"BSDF\" nodename=\"b{1}\"/><input name=\"bg\" "
            "type=\"BSDF\" nodename=\"b{1}\"/><input name=\"mix\" type=\"float\" nodename=\"e\"/></mix>",
            i, i - 1);
        cross += fmt::format(
            "<layer name=\"a{0}\" type=\"BSDF\"><input name=\"top\" type=\"BSDF\" nodename=\"b{1}\"/><input "
            "name=\"base\" "
            "type=\"BSDF\" nodename=\"a{1}\"/></layer><mix name=\"b{0}\" type=\"BSDF\"><input name=\"fg\" "
            "type=\"BSDF\" "
            "nodename=\"a{1}\"/><input name=\"bg\" type=\"BSDF\" nodename=\"b{1}\"/><input name=\"mix\" type=\"float\" "
            "nodename=\"e\"/></mix>",
            i, i - 1);
    }
    for (const std::string& text : {material(mixes, "b30"), material(cross, "a30")}) {
        Outcome out = compile(text);
        expectOrderly(out, "closures");
        EXPECT_TRUE(out.shaders.size() == 1 || out.errors.find("[limit]") != std::string::npos) << out.errors;
        expectCompiles(out.shaders, "closures");
    }
}

TEST(Explosions, ManyLobes) {
    std::string lobes = "<oren_nayar_diffuse_bsdf name=\"s0\" type=\"BSDF\"/>";
    for (int i = 1; i <= 200; i++)
        lobes += fmt::format(
            "<oren_nayar_diffuse_bsdf name=\"b{0}\" type=\"BSDF\"><input name=\"roughness\" type=\"float\" "
            "value=\"0.{0}1\"/></oren_nayar_diffuse_bsdf><add name=\"s{0}\" type=\"BSDF\"><input name=\"in1\" "
            "type=\"BSDF\" nodename=\"s{1}\"/><input name=\"in2\" type=\"BSDF\" nodename=\"b{0}\"/></add>",
            i, i - 1);
    for (Interface interface : {Interface::Live, Interface::Baked}) {
        How how;
        how.interface = interface;
        Outcome out = compile(material(lobes, "s200"), how);
        expectOrderly(out, "200 lobes");
        EXPECT_EQ(out.shaders.size(), 1u) << out.errors;
        expectCompiles(out.shaders, "200 lobes");
    }
}

TEST(Size, LongRowsOfPorts) {
    std::string rows =
        "<nodegraph name=\"g\"><constant name=\"c\" type=\"float\"/><output name=\"o0\" type=\"float\" "
        "nodename=\"c\"/>";
    for (int i = 1; i < 5000; i++)
        rows += fmt::format("<output name=\"o{}\" type=\"float\" output=\"o{}\"/>", i, i - 1);
    rows += "</nodegraph><add name=\"n0\" type=\"float\"/>";
    for (int i = 1; i < 5000; i++)
        rows += fmt::format(
            "<add name=\"n{}\" type=\"float\"><input name=\"in1\" type=\"float\" nodegraph=\"g\" output=\"o4999\"/>"
            "<input name=\"in2\" type=\"float\" nodename=\"n{}\"/></add>",
            i, i - 1);
    How how;
    how.element = "n4999";
    Outcome out = compile(wrapped(rows), how);
    expectOrderly(out, "rows of outputs");
    EXPECT_EQ(out.shaders.size(), 1u) << out.errors;
}

TEST(Size, ManyOfOneName) {
    std::string body;
    for (int i = 0; i < 100000; i++) body += "<constant name=\"c\" type=\"float\"/>";
    expectRefused(compile(wrapped(body + "<output name=\"o\" type=\"float\" nodename=\"c\"/>")), "duplicate-name",
                  "100,000 nodes of one name");
}

TEST(Size, DefinitionsWithinEachOther) {
    std::string body;
    constexpr int kMany = 20000;
    for (int i = 0; i < kMany; i++)
        body += nodedef(fmt::format("ND_u{}", i), fmt::format("u{}", i)) +
                graphOf(fmt::format("NG_u{}", i), fmt::format("nodedef=\"ND_u{}\"", i),
                        i + 1 < kMany ? fmt::format("u{}", i + 1) : "constant");
    expectRefused(compile(wrapped(body + "<u0 name=\"y\" type=\"float\"/><output name=\"o\" type=\"float\" "
                                         "nodename=\"y\"/>")),
                  "limit", "20,000 definitions");
}

TEST(Size, LongInheritance) {
    std::string text;
    for (int i = 0; i < 3000; i++)
        text += fmt::format(
            "<nodedef name=\"ND_{0}\" node=\"u{0}\" inherit=\"ND_{1}\"><input name=\"a{0}\" type=\"float\" "
            "value=\"1\"/></nodedef>",
            i, i + 1);
    text += nodedef("ND_3000", "z") + graphOf("G", "nodedef=\"ND_3000\"", "constant");
    auto with = [&](int i) {
        return wrapped(text + fmt::format("<u{} name=\"x\" type=\"float\"/><output name=\"o\" type=\"float\" "
                                          "nodename=\"x\"/>",
                                          i));
    };
    expectRefused(compile(with(0)), "limit", "3,000 levels are 4.5 million inputs");
    Outcome out = compile(with(2990));
    expectOrderly(out, "the last ten levels");
    EXPECT_EQ(out.shaders.size(), 1u) << out.errors;
}

TEST(Size, ManyInputs) {
    std::string inputs;
    for (int i = 0; i < 20000; i++) inputs += fmt::format("<input name=\"i{}\" type=\"float\" value=\"1\"/>", i);
    std::string all = "<nodedef name=\"ND_a\" node=\"ua\">" + inputs +
                      "<output name=\"out\" type=\"float\"/></nodedef>" + graphOf("G", "nodedef=\"ND_a\"", "constant") +
                      "<ua name=\"y\" type=\"float\">" + inputs +
                      "</ua><output name=\"o\" type=\"float\" nodename=\"y\"/>";
    Outcome many = compile(wrapped(all));
    expectOrderly(many, "20,000 inputs");
    EXPECT_FALSE(many.isValid);
    EXPECT_TRUE(many.shaders.empty());
    // Inherited by many: the document is small, the interfaces together are not.
    std::string bomb = "<nodedef name=\"ND_b\" node=\"ub\">";
    for (int i = 0; i < 4000; i++) bomb += fmt::format("<input name=\"i{}\" type=\"float\" value=\"1\"/>", i);
    bomb += "<output name=\"out\" type=\"float\"/></nodedef>";
    for (int i = 0; i < 3000; i++) bomb += fmt::format("<nodedef name=\"ND_{0}\" node=\"u{0}\" inherit=\"ND_b\"/>", i);
    Outcome out = compile(wrapped(bomb + "<constant name=\"c\" type=\"float\"/><output name=\"o\" type=\"float\" "
                                         "nodename=\"c\"/>"));
    expectOrderly(out, "12 million inherited inputs");
    EXPECT_FALSE(out.isValid);
    EXPECT_EQ(out.shaders.size(), 1u) << out.errors;
}

TEST(Size, MillionNodes) {
#ifdef NDEBUG
    std::string text =
        "<texcoord name=\"t\" type=\"vector2\"/><extract name=\"n0\" type=\"float\"><input name=\"in\" "
        "type=\"vector2\" nodename=\"t\"/></extract>\n";
    for (int i = 1; i < 1000000; i++)
        text += fmt::format(
            "<sin name=\"n{}\" type=\"float\"><input name=\"in\" type=\"float\" nodename=\"n{}\"/></sin>\n", i, i - 1);
    How how;
    how.interface = Interface::Baked;
    Outcome out = compile(wrapped(text + "<output name=\"o\" type=\"float\" nodename=\"n999999\"/>"), how);
    expectOrderly(out, "a million nodes");
    EXPECT_EQ(out.shaders.size(), 1u) << out.errors;
#else
    GTEST_SKIP() << "in the release build alone";
#endif
}

}  // namespace
}  // namespace shaderx::tests
