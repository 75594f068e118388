// What nodes give at their edges and in places where published formulas say it: every values/*.mtlx has the values of
// its nodegraphs' outputs beside it, in values/*.expected.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "doc/read.h"
#include "graph/graph.h"
#include "graph/lower.h"
#include "passes/specialise.h"
#include "support.h"
#include "table/functions.h"
#include "table/world.h"

namespace shaderx::table {
namespace {

class Values : public testing::TestWithParam<tests::fs::path> {};

std::string textOf(const ir::Value& v) {
    std::string text;
    for (int i = 0; i < ir::componentCount(v.type); i++)
        text += ir::info(v.type).scalar == ir::Scalar::Float ? fmt::format(" {:.5g}", v.f(i) == 0 ? 0.0f : v.f(i))
                                                             : fmt::format(" {}", v.i(i));
    return text;
}

// The outputs of a nodegraph, computed by the interpreter; or what went wrong.
std::string valuesOf(const doc::Document& document, doc::ElementId nodegraph, NodeLibrary& nodes, NameTable& names) {
    const std::string name(names.text(document[nodegraph].name));
    Diagnostics diagnostics;
    ir::Module program(names);
    program.sources = {nodes.bodies.get(), nodes.library.get()};
    graph::Graph g;
    const Name entry = names.intern(name + " values");
    World world(names);
    if (!graph::build(document, nodegraph, nodes.definitions, g, diagnostics) ||
        !graph::lower(g, nodes.definitions, *nodes.bodies, {}, entry, {}, program, diagnostics) ||
        !passes::specialise(program, entry, {}, diagnostics))
        return diagnostics.text();
    const ir::Function& f = *program.find(entry);
    std::vector<ir::Value> results(f.results.size() * 4);
    ir::Environment* worlds[] = {&world, &world, &world, &world};
    if (!ir::Interpreter(program, diagnostics).runQuad(f, {}, results, worlds)) return diagnostics.text();
    std::string text;
    for (std::size_t k = 0; k < f.results.size(); k++)
        text += fmt::format("{}/{}:{}\n", name, names.text(f.results[k].name), textOf(results[k]));
    return text;
}

TEST_P(Values, Are) {
    NameTable names;
    NodeLibrary nodes(names);
    ASSERT_TRUE(nodes.library) << nodes.diagnostics.text();
    doc::Document document(names);
    doc::NoIncludes none;
    Diagnostics diagnostics;
    const auto root =
        doc::read(document, GetParam().filename().string(), tests::fileText(GetParam()), none, diagnostics);
    ASSERT_TRUE(root) << diagnostics.text();
    nodes.definitions.add(document);
    std::string found;
    for (doc::ElementId e : doc::children(document, document.root()))
        if (document[e].category == document.known().nodegraph) found += valuesOf(document, e, nodes, names);
    tests::fs::path expected = GetParam();
    tests::expectFile(expected.replace_extension(".expected"), found);
}

INSTANTIATE_TEST_SUITE_P(Node, Values,
                         testing::ValuesIn(tests::filesOf(tests::testFolder("table") / "values", ".mtlx")),
                         tests::testName);

}  // namespace
}  // namespace shaderx::table
