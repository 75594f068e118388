#include "doc/document.h"

#include <gtest/gtest.h>

#include "base/numbers.h"
#include "doc/connect.h"
#include "doc/test_documents.h"

namespace shaderx::doc {
namespace {

TEST(Document, IsBuiltWithoutXml) {
    NameTable names;
    Document d(names);
    ElementId graph = d.append(d.root(), "nodegraph", "NG");
    ElementId mix = d.append(graph, "mix", "mix1");
    d.set(mix, "type", "color3");
    ElementId in = d.append(mix, "input", "fg");
    d.set(mix, "uiname", "Mix");  // the input's attributes follow: these move
    EXPECT_EQ(d.path(in), "NG/mix1/fg");
    EXPECT_EQ(d.find("NG/mix1"), mix);
    EXPECT_FALSE(d.find("NG/mix2"));
    EXPECT_FALSE(d.find(""));
    EXPECT_EQ(d.attributeText(mix, d.known().type), "color3");
    EXPECT_EQ(d.attributes(mix).size(), 3u);
    EXPECT_EQ(d.locate(mix).line, 0u);
    d.rename(mix, "mix2");
    EXPECT_EQ(d.find("NG/mix2/fg"), in);
    d.unset(mix, d.known().type);
    EXPECT_FALSE(d.attribute(mix, d.known().type));
    d.remove(mix);
    EXPECT_FALSE(d.find("NG/mix2"));
    EXPECT_FALSE(d[in].category);
    ElementId again = d.append(graph, "mix", "again");
    EXPECT_EQ(d[graph].firstChild, again);
}

TEST(Document, FindsChildrenAmongManyAfterEdits) {
    NameTable names;
    Document d(names);
    std::vector<ElementId> all;
    for (int i = 0; i < 1000; i++) all.push_back(d.append(d.root(), "add", "n" + std::to_string(i)));
    EXPECT_EQ(d.find("n999"), all[999]);
    d.rename(all[500], "other");
    EXPECT_FALSE(d.find("n500"));
    EXPECT_EQ(d.find("other"), all[500]);
    d.remove(all[3]);
    EXPECT_FALSE(d.find("n3"));
    ElementId late = d.append(d.root(), "add", "late");
    EXPECT_EQ(d.find("late"), late);
    EXPECT_EQ(d.find("n4"), all[4]);
    for (int i = 0; i < 5000; i++) d.rename(all[7], i % 2 ? "odd" : "even");
    EXPECT_EQ(d.find("odd"), all[7]);
    EXPECT_FALSE(d.find("even"));
    EXPECT_EQ(d.find("n998"), all[998]);
}

TEST(Document, ReadsAnImageInPlace) {
    NameTable names;
    Document built(names);
    ElementId node = built.append(built.root(), "add", "a");
    Document view(names, built.elements(), built.allAttributes());
    EXPECT_EQ(view.find("a"), node);
    EXPECT_THROW(view.append(view.root(), "add", "b"), InternalError);
    EXPECT_THROW(view.set(node, "name", "b"), InternalError);
}

TEST(Document, InheritsFromAncestors) {
    NameTable names;
    Document d(names);
    readInto(d,
             "<materialx version='1.39' colorspace='lin_rec709'><nodegraph name='g' fileprefix='a/'><image "
             "name='i' colorspace='none'/></nodegraph></materialx>");
    ElementId image = d.find("g/i");
    EXPECT_EQ(d.text(d.inherited(image, d.known().fileprefix)), "a/");
    EXPECT_EQ(d.text(d.inherited(image, d.known().colorspace)), "none");
    EXPECT_EQ(d.text(d.inherited(d.find("g"), d.known().colorspace)), "lin_rec709");
    EXPECT_FALSE(d.inherited(image, d.known().namespaceName));
}

TEST(Document, LocatesElementsAndAttributes) {
    NameTable names;
    Document d(names);
    readInto(d,
             "\xEF\xBB\xBF<materialx version=\"1.39\">\n  <add name=\"a\"\n       type=\"float\" x = 'type=\"1\"'/>\n"
             "</materialx>\n");
    ElementId a = d.find("a");
    Location at = d.locate(a);
    EXPECT_EQ(at.file, "test.mtlx");
    EXPECT_EQ(at.line, 2u);
    EXPECT_EQ(at.column, 3u);
    at = d.locate(a, d.known().type);
    EXPECT_EQ(at.line, 3u);
    EXPECT_EQ(at.column, 8u);
    EXPECT_EQ(d.locate(a, d.names().intern("x")).column, 21u);
    EXPECT_EQ(d.locate(a, d.known().value).line, 2u);  // not there: the tag
}

TEST(Connect, ResolvesEachKind) {
    NameTable names;
    Document d(names);
    readInto(d, wrap(R"(<constant name="c"/><output name="o" nodename="c"/>
        <nodegraph name="g"><input name="i" nodename="c"/><add name="a"><input name="in1" interfacename="i"/>
        <input name="in2" nodename="b"/><input name="in3" nodename="c"/></add><add name="b"/>
        <output name="out" nodename="a"/><output name="out2" nodename="b" output="x"/></nodegraph>
        <add name="u"><input name="in1" nodegraph="g"/><input name="in2" nodegraph="g" output="out2"/>
        <input name="in3" output="o"/><input name="in4" nodegraph="g" output="no"/><input name="in5" value="1"/></add>)"));
    using Kind = Connection::Kind;
    auto at = [&](const char* path) { return connection(d, d.find(path)); };
    EXPECT_EQ(at("o").target, d.find("c"));
    EXPECT_EQ(at("g/i").target, d.find("c"));
    EXPECT_EQ(at("g/a/in1").kind, Kind::Interface);
    EXPECT_EQ(at("g/a/in1").target, d.find("g/i"));
    EXPECT_EQ(at("g/a/in2").target, d.find("g/b"));
    EXPECT_EQ(at("g/a/in3").kind, Kind::Dangling);
    EXPECT_EQ(at("g/out").target, d.find("g/a"));
    EXPECT_EQ(d.text(at("g/out2").output), "x");
    EXPECT_EQ(at("u/in1").target, d.find("g/out"));
    EXPECT_EQ(at("u/in2").target, d.find("g/out2"));
    EXPECT_EQ(at("u/in3").target, d.find("o"));
    EXPECT_EQ(at("u/in4").kind, Kind::Dangling);
    EXPECT_EQ(at("u/in4").attribute, d.known().output);
    EXPECT_EQ(at("u/in5").kind, Kind::None);
    EXPECT_EQ(scopeOf(d, d.find("g/a/in1")), d.find("g"));
    EXPECT_EQ(scopeOf(d, d.find("u")), d.root());
}

}  // namespace
}  // namespace shaderx::doc
