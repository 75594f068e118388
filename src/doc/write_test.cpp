#include "doc/write.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "doc/check.h"
#include "doc/file_resolver.h"
#include "doc/test_documents.h"

namespace shaderx::doc {
namespace {

// All elements and attributes in order, one a line.
std::string dump(const Document& d) {
    std::string out;
    for (std::uint32_t i = 0; i < d.size(); i++) {
        ElementId e(i);
        if (!d[e].category) continue;
        out += std::string(d.text(d[e].category)) + "(" + d.path(e) + ")";
        for (const Attribute& a : d.attributes(e))
            out += " " + std::string(d.text(a.name)) + "=" + std::string(d.text(a.value));
        out += "\n";
    }
    return out;
}

void expectRoundTrip(const std::string& text, const std::string& file, Resolver& resolver) {
    NameTable names;
    Document first(names), second(names);
    Diagnostics diagnostics;
    ASSERT_TRUE(static_cast<bool>(read(first, file, text, resolver, diagnostics))) << diagnostics.text();
    ASSERT_TRUE(static_cast<bool>(read(second, file, write(first), resolver, diagnostics))) << diagnostics.text();
    EXPECT_EQ(dump(first), dump(second)) << file;
    EXPECT_EQ(write(first), write(second));
}

TEST(Write, KeepsEverything) {
    NoIncludes none;
    expectRoundTrip(R"(<?xml version="1.0"?>
<!-- before --><!DOCTYPE materialx [<!ENTITY x "y">]>
<?tool run?>
<materialx xmlns:xi="http://www.w3.org/2001/XInclude" version="1.39" odd:attr="a &lt; b &amp; &quot;c&quot; &#10;&#9;d">
  <!-- one -->
  <unknown name="u" value='it&apos;s'>text &amp; <b>bold<i/></b> tail<!-- in text -->
  </unknown>
  <nodegraph name="g"><!-- inside --><add name="a"/><![CDATA[ raw <&> ]]></nodegraph>
  <?pi in here?><t> &#10; <u/>&#32;</t>
</materialx>
<!-- after -->)",
                    "t.mtlx", none);
}

TEST(Write, IndentsPlainly) {
    NameTable names;
    Document d(names);
    ElementId g = d.append(d.root(), "nodegraph", "g");
    d.append(g, "add", "a");
    EXPECT_EQ(write(d),
              "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\">\n  <nodegraph name=\"g\">\n    <add "
              "name=\"a\" />\n  </nodegraph>\n</materialx>\n");
}

TEST(Write, RealDocumentsComeBack) {
    std::filesystem::path materials = std::filesystem::path(SHADERX_SOURCE_DIR) / "../shared/resources/Materials";
    if (!std::filesystem::exists(materials)) GTEST_SKIP() << "the folder of example materials is not here";
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(materials))
        if (entry.path().extension() == ".mtlx") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    EXPECT_FALSE(files.empty());
    FileResolver resolver;
    for (const auto& file : files) {
        std::optional<std::string> text = readFile(file.string());
        ASSERT_TRUE(text) << file;
        expectRoundTrip(*text, file.string(), resolver);
    }
}

}  // namespace
}  // namespace shaderx::doc
