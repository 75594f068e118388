#include "doc/check.h"

#include <gtest/gtest.h>

#include "doc/test_documents.h"

namespace shaderx::doc {
namespace {

std::string pathsOf(const std::string& body) {
    NameTable names;
    Document d(names);
    readInto(d, wrap(body));
    std::string out;
    for (ElementId e : renderableElements(d)) out += d.path(e) + " ";
    return out;
}

TEST(Renderable, MaterialsElseOutputs) {
    EXPECT_EQ(pathsOf(R"(<plastic name="s" type="surfaceshader"/><surfacematerial name="m" type="material"/>
        <output name="o" type="float"/><nodegraph name="g"><output name="out" type="float"/></nodegraph>)"),
              "m ");
    EXPECT_EQ(pathsOf(R"(<plastic name="s" type="surfaceshader"/><output name="o" type="float"/>
        <nodedef name="ND" node="n"><output name="out" type="float"/></nodedef>
        <nodegraph name="g"><output name="a" type="float"/><output name="b" type="float"/></nodegraph>
        <nodegraph name="f" nodedef="ND"><output name="out" type="float"/></nodegraph>
        <implementation name="i" nodedef="ND" nodegraph="h"/><nodegraph name="h"><output name="out"/></nodegraph>)"),
              "o g/a g/b ");
    EXPECT_EQ(pathsOf(R"(<plastic name="s" type="surfaceshader"/>)"), "");
}

TEST(Validate, AcceptsGoodDocuments) {
    NameTable names;
    Document library(names), d(names);
    readInto(library, kTestLibrary);
    readInto(d, wrap(R"(
        <nodedef name="ND_tint" node="tint"><input name="c" type="color3" value="1, 1, 1"/><output name="out" type="color3"/></nodedef>
        <nodegraph name="NG_tint" nodedef="ND_tint">
          <add name="a" type="color3"><input name="in1" type="color3" interfacename="c"/></add>
          <output name="out" type="color3" nodename="a"/>
        </nodegraph>
        <nodegraph name="g"><input name="x" type="float" value="1"/>
          <tint name="t" type="color3"/><separate3 name="s" type="multioutput"><input name="in" type="color3" nodename="t"/></separate3>
          <add name="a" type="float" odd="kept"><input name="in1" type="float" nodename="s" output="outg"/><input name="in2" type="float" interfacename="x"/></add>
          <output name="one" type="color3" nodename="t"/><output name="two" type="float" nodename="a"/></nodegraph>
        <plastic name="p" type="surfaceshader"><input name="base_color" type="color3" nodegraph="g" output="one"/>
          <input name="base" type="float" nodegraph="g" output="two"/></plastic>
        <surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodename="p"/></surfacematerial>
        <look name="l"><materialassign name="ma" material="m" geom="*"/></look><unknownthing/>)"));
    Definitions definitions;
    definitions.add(d);
    definitions.add(library);
    Diagnostics diagnostics;
    bool good = validate(d, definitions, diagnostics);
    // <unknownthing/> stands where nodes stand, so it is one.
    EXPECT_FALSE(good);
    for (const Diagnostic& x : diagnostics.all()) EXPECT_EQ(d.locate(d[d.root()].firstChild).file, x.where.file);
    EXPECT_EQ(diagnostics.all().size(), 3u) << diagnostics.text();
}

TEST(Validate, ManyWrongNodesStayLinear) {
    NameTable names;
    Document d(names);
    for (int i = 0; i < 50000; i++) {
        ElementId e = d.append(d.root(), "nonsense" + std::to_string(i), "n" + std::to_string(i));
        d.set(e, "type", "float");
        ElementId in = d.append(e, "input", "in");
        d.set(in, "type", "float");
        d.set(in, "nodename", "missing" + std::to_string(i));
    }
    Definitions definitions;
    definitions.add(d);
    Diagnostics diagnostics;
    EXPECT_FALSE(validate(d, definitions, diagnostics));
    EXPECT_EQ(diagnostics.all().size(), 100000u);
}

}  // namespace
}  // namespace shaderx::doc
