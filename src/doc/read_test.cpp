#include "doc/read.h"

#include <chrono>
#include <filesystem>

#include <gtest/gtest.h>

#include "doc/check.h"
#include "doc/file_resolver.h"
#include "doc/test_documents.h"
#include "doc/write.h"

namespace shaderx::doc {
namespace {

// What reading says; empty if all is well.
std::string errorsOf(const std::string& text, const ReadOptions& options = {}, Resolver* files = nullptr) {
    NameTable names;
    Document d(names);
    Diagnostics diagnostics;
    NoIncludes none;
    bool good = static_cast<bool>(read(d, "t.mtlx", text, files ? *files : none, diagnostics, options));
    EXPECT_EQ(good, !diagnostics.hasErrors());
    return diagnostics.text();
}

TEST(Read, RefusesWhatIsNotUtf8) {
    EXPECT_NE(errorsOf(std::string("\xFF\xFE<\0m\0", 6)).find("[bad-encoding]"), std::string::npos);
    EXPECT_NE(errorsOf(std::string("\xFE\xFF\0<\0m", 6)).find("UTF-16"), std::string::npos);
    EXPECT_EQ(errorsOf(wrap("<a x='\xC3'/>")), "t.mtlx:1:33: error: byte 0xc3 is not UTF-8 here [bad-encoding]\n");
    EXPECT_NE(errorsOf(wrap("\xED\xA0\x80")).find("[bad-encoding]"), std::string::npos);
    EXPECT_NE(errorsOf(wrap(std::string("a\0b", 3))).find("a zero byte is not text"), std::string::npos);
    EXPECT_EQ(errorsOf(wrap("<a name='びまん性'/>")), "");
}

TEST(Read, KeepsToItsLimits) {
    std::string deep;
    for (int i = 0; i < 100000; i++) deep += "<a>";
    EXPECT_NE(errorsOf(wrap(deep)).find("[bad-xml]"), std::string::npos);
    for (int i = 0; i < 100000; i++) deep += "</a>";
    EXPECT_NE(errorsOf(wrap(deep)).find("nested deeper than 1024 [limit]"), std::string::npos);
    ReadOptions options;
    options.maxNesting = 1000000;
    EXPECT_EQ(errorsOf(wrap(deep), options), "");
    options.maxElements = 1000;
    EXPECT_NE(errorsOf(wrap(deep), options).find("more than 1000 elements [limit]"), std::string::npos);
    options = {};
    EXPECT_EQ(errorsOf(wrap("<a x='" + std::string(5 << 20, 'x') + "'/>")), "");
    options.maxAttributeBytes = 100;
    EXPECT_NE(errorsOf(wrap("<a x='" + std::string(101, 'x') + "'/>"), options).find("[limit]"), std::string::npos);
    options.maxFileBytes = 10;
    EXPECT_NE(errorsOf(wrap(""), options).find("[limit]"), std::string::npos);
    std::string many = "<a";
    for (int i = 0; i < 20000; i++) many += " x" + std::to_string(i) + "=''";
    EXPECT_NE(errorsOf(wrap(many + "/>")).find("more than 10000 attributes [limit]"), std::string::npos);
}

TEST(Read, DeepTreesAreWrittenAndCheckedWithoutRecursion) {
    std::string deep;
    for (int i = 0; i < 100000; i++) deep += "<a>";
    for (int i = 0; i < 100000; i++) deep += "</a>";
    NameTable names;
    Document d(names), again(names);
    Diagnostics diagnostics;
    NoIncludes none;
    ReadOptions options;
    options.maxNesting = 1000000;
    ASSERT_TRUE(static_cast<bool>(read(d, "t.mtlx", wrap(deep), none, diagnostics, options)));
    d.remove(d[d.root()].firstChild);
    EXPECT_EQ(write(d), "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" />\n");
}

TEST(Read, MergesIncludes) {
    MemoryFiles files;
    files.files["lib/a.mtlx"] =
        "<materialx version='1.38' fileprefix='tex/' namespace='ns'><!-- c --><xi:include "
        "href='b.mtlx'/><add name='a' fileprefix='own/'/></materialx>";
    files.files["lib/b.mtlx"] =
        "<materialx version='1.39' colorspace='acescg'><add name='b'><input name='i' "
        "nodename='a'/></add></materialx>";
    NameTable names;
    Document d(names);
    Diagnostics diagnostics;
    std::string text = wrap(
        "<xi:include href='lib/a.mtlx'><xi:fallback><xi:include href='no'/></xi:fallback></xi:include>"
        "<xi:include href='lib/b.mtlx'/><add name='main'/><!-- end -->");
    ASSERT_TRUE(static_cast<bool>(read(d, "main.mtlx", text, files, diagnostics))) << diagnostics.text();
    ElementId a = d.find("ns:a"), b = d.find("ns:b");
    ASSERT_TRUE(a && b && d.find("main"));
    EXPECT_EQ(d.text(d.inherited(a, d.known().fileprefix)), "own/");
    EXPECT_EQ(d.text(d.inherited(b, d.known().fileprefix)), "tex/");
    EXPECT_EQ(d.text(d.inherited(b, d.known().colorspace)), "acescg");
    EXPECT_FALSE(d.inherited(d.find("main"), d.known().colorspace));
    EXPECT_EQ(d.childFrom(b, d.root(), names.find("a")), a);
    EXPECT_EQ(d.locate(b).file, "lib/b.mtlx");
    EXPECT_EQ(d.sources().size(), 3u);
    // Writing keeps the includes, or merges.
    EXPECT_NE(write(d).find("<xi:fallback>"), std::string::npos);
    EXPECT_EQ(write(d).find("ns:a"), std::string::npos);
    EXPECT_EQ(write(d, {false}).find("xi:include"), std::string::npos);
    EXPECT_NE(write(d, {false}).find("ns:b"), std::string::npos);
}

TEST(Read, SaysWhenIncludesGoRound) {
    MemoryFiles files;
    files.files["a.mtlx"] = wrap("<xi:include href='b.mtlx'/>");
    files.files["b.mtlx"] = wrap("\n<xi:include href='./a.mtlx'/>");
    EXPECT_EQ(
        errorsOf(wrap("<xi:include href='a.mtlx'/>"), {}, &files),
        "b.mtlx:2:13: error: './a.mtlx' includes itself [include-cycle]\n  note: a.mtlx:1:27: included from here\n");
    EXPECT_NE(errorsOf(wrap("<xi:include href='t.mtlx'/>"), {}, &files).find("[missing-include]"), std::string::npos);
    files.files["t.mtlx"] = "";
    EXPECT_NE(errorsOf(wrap("<xi:include href='t.mtlx'/>"), {}, &files).find("[include-cycle]"), std::string::npos);
    for (int i = 0; i < 100; i++)
        files.files["d" + std::to_string(i)] = wrap("<xi:include href='d" + std::to_string(i + 1) + "'/>");
    EXPECT_NE(errorsOf(wrap("<xi:include href='d0'/>"), {}, &files).find("nested deeper than 32 [limit]"),
              std::string::npos);
    files.files["bad.mtlx"] = "<materialx><add</materialx>";
    std::string bad = errorsOf(wrap("<xi:include href='bad.mtlx'/>"), {}, &files);
    EXPECT_NE(bad.find("bad.mtlx:1:16: error"), std::string::npos) << bad;
    EXPECT_NE(bad.find("note: t.mtlx:1:27: included from here"), std::string::npos) << bad;
}

TEST(Read, ResolvesFilesOnDisk) {
    std::filesystem::path dir = std::filesystem::temp_directory_path() / "shaderx_read_test";
    std::filesystem::create_directories(dir / "sub");
    auto put = [](const std::filesystem::path& p, const std::string& text) {
        std::FILE* f = std::fopen(p.string().c_str(), "wb");
        ASSERT_TRUE(f);
        std::fwrite(text.data(), 1, text.size(), f);
        std::fclose(f);
    };
    put(dir / "sub" / "a.mtlx", wrap("<xi:include href=\"b.mtlx\"/>"));
    put(dir / "sub" / "b.mtlx", wrap("<add name='b'/>"));
    FileResolver resolver({(dir / "sub").string()});
    EXPECT_EQ(errorsOf(wrap("<xi:include href='a.mtlx'/>"), {}, &resolver), "");
    EXPECT_FALSE(resolver.resolve("", dir.string()));  // a folder is no file
    EXPECT_FALSE(FileResolver({}, 5).resolve("a.mtlx", (dir / "sub").string()));
    std::filesystem::remove_all(dir);
}

TEST(Read, NormalisesPaths) {
    EXPECT_EQ(normalPath("a/../b/./c"), "b/c");
    EXPECT_EQ(normalPath("../a"), "../a");
    EXPECT_EQ(normalPath("/../a//b"), "/a/b");
    EXPECT_EQ(directoryOf("/a"), "/");
    EXPECT_EQ(directoryOf("a"), "");
}

// A long chain of nodes: reading and checking stay linear and do not recurse.
TEST(Read, AChainOfManyNodes) {
    constexpr int kNodes = 200000;
    std::string text = "<materialx version=\"1.39\"><add name=\"n0\" type=\"float\"/>\n";
    for (int i = 1; i < kNodes; i++) {
        std::string n = std::to_string(i), before = std::to_string(i - 1);
        text += "<add name=\"n" + n + "\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"n" + before +
                "\"/><input name=\"in2\" type=\"float\" value=\"0.1\"/></add>\n";
    }
    text += "<output name=\"o\" type=\"float\" nodename=\"n199999\"/></materialx>";
    NameTable names;
    Document library(names), d(names);
    readInto(library, kTestLibrary);
    auto start = std::chrono::steady_clock::now();
    readInto(d, text);
    Definitions definitions;
    definitions.add(d);
    definitions.add(library);
    Diagnostics diagnostics;
    EXPECT_TRUE(validate(d, definitions, diagnostics)) << diagnostics.all().size();
    double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("read and checked %d nodes in %.2f s\n", kNodes, seconds);
    // Closed to a ring, it is one cycle.
    ElementId first = d.append(d.find("n0"), "input", "in1");
    d.set(first, "type", "float");
    d.set(first, "nodename", "n199999");
    EXPECT_FALSE(validate(d, definitions, diagnostics));
    ASSERT_EQ(diagnostics.all().size(), 1u);
    EXPECT_EQ(diagnostics.all()[0].code, "cycle");
    EXPECT_LT(diagnostics.all()[0].message.size(), 400u);
}

}  // namespace
}  // namespace shaderx::doc
