#include "doc/definitions.h"

#include <gtest/gtest.h>

#include "doc/test_documents.h"

namespace shaderx::doc {
namespace {

struct DefinitionsTest : ::testing::Test {
    NameTable names;
    Document library{names}, user{names};
    Definitions definitions;

    void load(const std::string& userBody) {
        readInto(library, kTestLibrary, "library.mtlx");
        readInto(user, wrap(userBody));
        definitions.add(user);
        definitions.add(library);
    }
    std::string_view matched(const char* path) {
        Match m = definitions.match(user, user.find(path));
        return m ? names.text(definitions.row(m.def).name) : std::string_view("none");
    }
    bool exact(const char* path) { return definitions.match(user, user.find(path)).exact; }
    NodeDef def(const char* name) { return definitions.byName(names.find(name)); }
    Name name(std::string_view text) { return names.intern(text); }
};

TEST_F(DefinitionsTest, MatchesSignatures) {
    load(R"(<add name="a" type="float"><input name="in1" type="float"/></add>
            <add name="b" type="color3"/>
            <add name="c" type="color3"><input name="in2" type="float" value="1"/></add>
            <add name="d" type="color3"><input name="in2" type="vector2"/></add>
            <add name="e" type="vector9"/><nothing name="f" type="float"/>
            <separate3 name="g" type="multioutput"/>
            <add name="h" type="color3" nodedef="ND_add_color3FA"/>)");
    EXPECT_EQ(matched("a"), "ND_add_float");
    EXPECT_EQ(matched("b"), "ND_add_color3");
    EXPECT_EQ(matched("c"), "ND_add_color3FA");
    EXPECT_EQ(matched("d"), "ND_add_color3");
    EXPECT_FALSE(exact("d"));
    EXPECT_EQ(matched("e"), "none");
    EXPECT_EQ(matched("f"), "none");
    EXPECT_EQ(matched("g"), "ND_separate3_color3");
    EXPECT_EQ(matched("h"), "ND_add_color3FA");
    EXPECT_TRUE(exact("h"));
    EXPECT_EQ(definitions.ofCategory(name("add")).size(), 3u);
}

TEST_F(DefinitionsTest, KnowsVersionsAndInheritance) {
    load(R"(<plastic name="a" type="surfaceshader"/><plastic name="b" type="surfaceshader" version="1.0.0"/>
            <plastic name="c" type="surfaceshader" version="3"/>
            <nodedef name="ND_mine" node="mine" inherit="ND_plastic"><input name="extra" type="float"/></nodedef>
            <mine name="d" type="surfaceshader"><input name="roughness" type="float"/><input name="extra" type="float"/></mine>
            <nodedef name="ND_r1" node="r" inherit="ND_r2"/><nodedef name="ND_r2" node="r" inherit="ND_r1"/>)");
    EXPECT_EQ(matched("a"), "ND_plastic");
    EXPECT_EQ(matched("b"), "ND_plastic_100");
    EXPECT_EQ(matched("c"), "none");
    EXPECT_EQ(matched("d"), "ND_mine");
    EXPECT_TRUE(exact("d"));
    NodeDef plastic = def("ND_plastic");
    auto inputs = definitions.inputs(plastic);
    ASSERT_EQ(inputs.size(), 4u);
    EXPECT_EQ(names.text(inputs[0].name), "base");
    EXPECT_EQ(definitions.element(plastic, inputs[0]).attributeText(library.known().value), "1");
    EXPECT_EQ(names.text(inputs[3].name), "sheen");
    ASSERT_EQ(definitions.outputs(plastic).size(), 1u);
    auto mine = definitions.inputs(def("ND_mine"));  // across documents
    ASSERT_EQ(mine.size(), 5u);
    EXPECT_EQ(definitions.element(def("ND_mine"), mine[1]).document, &library);
    EXPECT_EQ(definitions.element(def("ND_mine"), mine[4]).document, &user);
    EXPECT_TRUE(definitions.input(plastic, name("sheen")));
    EXPECT_FALSE(definitions.output(plastic, name("sheen")));
}

TEST_F(DefinitionsTest, FindsImplementations) {
    load(R"(<nodedef name="ND_g" node="g"><output name="out" type="float"/></nodedef>
            <nodegraph name="NG_g" nodedef="ND_g"/>)");
    using Kind = Implementation::Kind;
    Implementation add = definitions.implementation(def("ND_add_color3FA"));
    EXPECT_EQ(add.kind, Kind::Source);
    EXPECT_EQ(add.element.attributeText(library.known().sourcecode), "{{in1}} + {{in2}}");
    Implementation mix = definitions.implementation(def("ND_mix_color3"));
    EXPECT_FALSE(mix.target);
    Name targets[] = {name("other"), name("special")};
    mix = definitions.implementation(def("ND_mix_color3"), targets);
    EXPECT_EQ(names.text(mix.target), "special");
    Implementation graph = definitions.implementation(def("ND_g"));
    EXPECT_EQ(graph.kind, Kind::Graph);
    EXPECT_EQ(graph.graph.id, user.find("NG_g"));
    Implementation linked = definitions.implementation(def("ND_plastic"));  // what it inherits has one
    EXPECT_EQ(linked.graph.id, library.find("NG_plastic"));
    EXPECT_FALSE(definitions.implementation(def("ND_image_color3")));
    EXPECT_EQ(definitions.implementedBy(user, user.find("NG_g")), def("ND_g"));
    EXPECT_EQ(definitions.implementedBy(library, library.find("NG_plastic")), def("ND_plastic_100"));
}

TEST_F(DefinitionsTest, KnowsNamespaces) {
    load(R"(<nodedef name="ND_toon" node="toon" namespace="npr"><output name="out" type="color3"/></nodedef>
            <nodegraph name="NG_toon" nodedef="ND_toon" namespace="npr"/><npr:toon name="t" type="color3"/>
            <toon name="u" type="color3"/><toon name="v" type="color3" namespace="npr"/>)");
    EXPECT_EQ(matched("t"), "npr:ND_toon");
    EXPECT_EQ(matched("u"), "none");
    EXPECT_EQ(matched("v"), "npr:ND_toon");
    EXPECT_EQ(definitions.implementation(def("npr:ND_toon")).graph.id, user.find("NG_toon"));
}

TEST_F(DefinitionsTest, UsersGoBeforeTheLibraryAndIndexesCanBeStored) {
    readInto(library, kTestLibrary);
    readInto(user, wrap(R"(<implementation name="I" nodedef="ND_mix_color3" sourcecode="mine"/>)"));
    DefinitionsTables stored = buildIndex(library);
    definitions.add(user);
    definitions.add(library, stored.index());
    EXPECT_EQ(definitions.implementation(def("ND_mix_color3")).element.document, &user);
    EXPECT_TRUE(definitions.hasCategory(name("mix")));
}

}  // namespace
}  // namespace shaderx::doc
