// Callers that mix up what does not belong together get a diagnostic.
#include <random>

#include <gtest/gtest.h>

#include "compile/compile.h"

namespace shaderx {
namespace {

using doc::ElementId;

struct Misuse : testing::Test {
    Compiler compiler{builtinLibrary()};
    std::unique_ptr<doc::Document> document = compiler.newDocument();
    ElementId gold = document->append(document->root(), "standard_surface", "gold");
    Misuse() { document->set(gold, "type", "surfaceshader"); }

    void expectRefused(const doc::Document& d, ElementId element, std::string_view code, Compiler& by) {
        Diagnostics diagnostics;
        EXPECT_FALSE(by.generate(d, element, {}, diagnostics));
        ASSERT_EQ(diagnostics.errorCount(), 1u) << diagnostics.text();
        EXPECT_EQ(diagnostics.all()[0].code, code);
        EXPECT_FALSE(diagnostics.hasInternal());
    }
};

TEST_F(Misuse, ElementsOfNoDocument) {
    expectRefused(*document, {}, "foreign-element", compiler);
    expectRefused(*document, ElementId(1000000), "foreign-element", compiler);
    ElementId gone = document->append(document->root(), "constant", "c");
    document->remove(gone);
    expectRefused(*document, gone, "foreign-element", compiler);
    auto other = compiler.newDocument();
    ElementId far;
    for (int i = 0; i < 100; i++) far = other->append(other->root(), "constant", "c");
    expectRefused(*document, far, "foreign-element", compiler);
    Diagnostics diagnostics;
    EXPECT_TRUE(compiler.generate(*document, gold, {}, diagnostics)) << diagnostics.text();
}

TEST_F(Misuse, ElementsThatAreNothingToCompile) {
    ElementId input = document->append(gold, "input", "base"), look = document->append(document->root(), "look", "l");
    ElementId note = document->append(document->root(), "#comment");
    ElementId unnamed = document->append(document->root(), "", "");
    ElementId graph = document->append(document->root(), "nodegraph", "g");
    for (ElementId e : {document->root(), input, look, note, unnamed, graph}) {
        Diagnostics diagnostics;
        EXPECT_FALSE(compiler.generate(*document, e, {}, diagnostics));
        EXPECT_TRUE(diagnostics.hasErrors());
        EXPECT_FALSE(diagnostics.hasInternal()) << diagnostics.text();
    }
}

TEST_F(Misuse, DocumentsOfAnotherCompiler) {
    Compiler other(builtinLibrary());
    expectRefused(*document, gold, "foreign-document", other);
    Diagnostics diagnostics;
    EXPECT_FALSE(other.validate(*document, diagnostics));
    EXPECT_EQ(diagnostics.all()[0].code, "foreign-document");
    EXPECT_EQ(other.renderableElements(*document).size(), 0u);
    NameTable names;
    doc::Document loose(names);
    expectRefused(loose, loose.root(), "foreign-document", compiler);
}

TEST_F(Misuse, EditsOfElementsThatAreNotThere) {
    ElementId none = document->find("no/such/node"), far(123456);
    for (ElementId e : {none, far}) {
        EXPECT_FALSE(document->append(e, "input", "base"));
        document->set(e, "type", "float");
        document->unset(e, document->known().type);
        document->setCategory(e, "mix");
        document->rename(e, "x");
        document->setOrigin(gold, e);
        document->setOrigin(e, gold);
        document->remove(e);
        EXPECT_EQ(document->path(e), "");
        EXPECT_EQ(document->locate(e).line, 0u);
    }
    document->remove(document->root());
    EXPECT_EQ(document->badEdits(), 17u);
    expectRefused(*document, gold, "foreign-element", compiler);
    Diagnostics diagnostics;
    EXPECT_FALSE(compiler.validate(*document, diagnostics));
}

TEST_F(Misuse, LibrariesThatAreNone) {
    Diagnostics diagnostics;
    std::span<const std::uint8_t> image = builtinLibrary();
    std::vector<std::uint8_t> noise(5000);
    std::mt19937 dice(1);
    for (std::uint8_t& b : noise) b = static_cast<std::uint8_t>(dice());
    std::vector<std::span<const std::uint8_t>> images{{}, image.first(1), image.first(100), noise};
    for (std::size_t i = 1; i < 50; i++) images.push_back(image.first(image.size() * i / 50));
    images.push_back(image.first(image.size() - 1));
    for (auto part : images) {
        Compiler empty(part);
        auto own = empty.newDocument();
        ElementId shader = own->append(own->root(), "standard_surface", "s");
        own->set(shader, "type", "surfaceshader");
        expectRefused(*own, shader, "unknown-node", empty);
    }
    EXPECT_TRUE(packLibrary({{"a.mtlx", "<materialx"}}, diagnostics).empty());
    EXPECT_TRUE(packLibrary({{"a.sl", "float f("}}, diagnostics).empty());
    EXPECT_FALSE(diagnostics.hasInternal()) << diagnostics.text();
    EXPECT_FALSE(packLibrary({}, diagnostics).empty());
}

TEST_F(Misuse, AfterErrorsAllGoesOn) {
    Diagnostics diagnostics;
    doc::NoIncludes none;
    EXPECT_FALSE(compiler.read("t.mtlx", "<materialx", none, diagnostics));
    EXPECT_FALSE(compiler.addLibrary({{"a.sl", "float f("}}, diagnostics));
    EXPECT_FALSE(compiler.addLibrary({{"a.mtlx", "<materialx"}}, diagnostics));
    ElementId bad = document->append(document->root(), "nonsense", "b");
    EXPECT_FALSE(compiler.generate(*document, bad, {}, diagnostics));
    Diagnostics clean;
    EXPECT_TRUE(compiler.generate(*document, gold, {}, clean));
    EXPECT_EQ(clean.text(), "");
}

TEST_F(Misuse, OddOptions) {
    GenerateOptions how;
    how.maxDepth = 0;
    how.maxExpressions = 0;
    Diagnostics diagnostics;
    EXPECT_FALSE(compiler.generate(*document, gold, how, diagnostics));
    EXPECT_EQ(diagnostics.all()[0].code, "limit");
    doc::NoIncludes none;
    doc::ReadOptions limits{0, 0, 0, 0, 0, 0};
    EXPECT_FALSE(compiler.read("t.mtlx", "<materialx/>", none, diagnostics, limits));
    EXPECT_EQ(diagnostics.all()[1].code, "limit");
}

// What callers throw from their own code does not pass through.
TEST_F(Misuse, ThrowingCallbacks) {
    struct Thrower final : doc::Resolver {
        std::optional<doc::ResolvedFile> resolve(std::string_view, std::string_view) override { throw 7; }
    } resolver;
    struct Sink final : DumpSink {
        bool wants(StageName) override { return true; }
        void dump(StageName, const std::string&) override { throw std::string("no"); }
    } sink;
    Diagnostics diagnostics;
    EXPECT_FALSE(compiler.read("t.mtlx", "<materialx><xi:include href='a'/></materialx>", resolver, diagnostics));
    GenerateOptions how;
    how.dumps = &sink;
    EXPECT_FALSE(compiler.generate(*document, gold, how, diagnostics));
    EXPECT_EQ(diagnostics.errorCount(), 2u);
}

}  // namespace
}  // namespace shaderx
