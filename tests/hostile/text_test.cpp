// Damaged documents, and XML that is not what it seems.
#include <algorithm>
#include <random>
#include <unordered_set>

#include "hostile.h"

namespace shaderx::tests {
namespace {

const char* const kGraph = "<constant name=\"a\" type=\"float\"/><output name=\"o\" type=\"float\" nodename=\"a\"/>";

TEST(Truncation, AtEveryByte) {
    std::string text = fileText(testFolder("golden") / "user_graph.mtlx");
    ASSERT_GT(text.size(), 1000u);
    for (std::size_t length = 0; length < text.size(); length++) {
        Outcome out = compile(text.substr(0, length));
        expectOrderly(out, "the first " + std::to_string(length) + " bytes");
        bool isWhole = text.find_first_not_of(" \r\n", length) == std::string::npos;
        EXPECT_EQ(out.isRead, isWhole) << length;
    }
}

// Cuts every document of a list at 500 places in all, spread evenly.
void cutAtManyPlaces(const std::vector<fs::path>& documents) {
    ASSERT_FALSE(documents.empty());
    std::size_t each = 500 / documents.size() + 1;
    for (const fs::path& document : documents) {
        std::string text = fileText(document);
        for (std::size_t i = 0; i < each; i++) {
            std::size_t length = text.size() * i / each;
            expectOrderly(compile(text.substr(0, length)), document.filename().string() + " " + std::to_string(length));
        }
    }
}

TEST(Truncation, AtManyPlacesOfOwnDocuments) { cutAtManyPlaces(ownDocuments()); }

TEST(Truncation, AtManyPlacesOfForeignDocuments) {
    fs::path folder = fs::path(SHADERX_SOURCE_DIR) / "../shared/resources/Materials/Examples/StandardSurface";
    if (!fs::is_directory(folder)) GTEST_SKIP() << "there are no foreign documents here";
    cutAtManyPlaces(filesOf(folder, ".mtlx"));
}

// 2,000 damaged documents in four parts; what still compiles must be right for the shading language's compiler too.
class Damage : public testing::TestWithParam<int> {};

// Where the text's tokens begin: words, quoted values, signs.
std::vector<std::pair<std::size_t, std::size_t>> tokensOf(const std::string& text) {
    std::vector<std::pair<std::size_t, std::size_t>> tokens;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at + 1;
        if (text[at] == '"') {
            end = std::min(text.find('"', end), text.size() - 1) + 1;
        } else if (std::isalnum(static_cast<unsigned char>(text[at]))) {
            while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_'))
                end++;
        }
        if (!std::isspace(static_cast<unsigned char>(text[at]))) tokens.push_back({at, end - at});
        at = end;
    }
    return tokens;
}

std::string damaged(std::string text, std::mt19937& dice) {
    std::size_t at = dice() % text.size();
    switch (dice() % 4) {
        case 0:  // a bit turned over
            text[at] = static_cast<char>(text[at] ^ (1 << (dice() % 8)));
            break;
        case 1:  // any byte
            text[at] = static_cast<char>(dice() % 256);
            break;
        case 2:
            text.erase(at, 1 + dice() % 8);
            break;
        default: {  // two tokens change places
            auto tokens = tokensOf(text);
            auto a = tokens[dice() % tokens.size()], b = tokens[dice() % tokens.size()];
            if (a.first > b.first) std::swap(a, b);
            if (a.first + a.second > b.first) break;
            std::string first = text.substr(a.first, a.second), second = text.substr(b.first, b.second);
            text.replace(b.first, b.second, first);
            text.replace(a.first, a.second, second);
        }
    }
    return text;
}

TEST_P(Damage, IsAMessageOrAShader) {
    std::mt19937 dice(static_cast<std::mt19937::result_type>(GetParam()));
    std::vector<fs::path> documents = ownDocuments();
    std::vector<Shader> compiled;
    std::unordered_set<std::string> seen;
    for (int i = 0; i < 500; i++) {
        const fs::path& document = documents[dice() % documents.size()];
        std::string text = damaged(fileText(document), dice);
        How how;
        how.interface = i % 2 ? Interface::Baked : Interface::Live;
        Outcome out = compile(text, how);
        expectOrderly(out, document.filename().string() + ", case " + std::to_string(i));
        for (Shader& s : out.shaders)
            if (compiled.size() < 60 && seen.insert(s.pixel).second) compiled.push_back(std::move(s));
    }
    EXPECT_GE(compiled.size(), 30u);
    expectCompiles(compiled, "damaged documents");
}

INSTANTIATE_TEST_SUITE_P(Parts, Damage, testing::Values(1, 2, 3, 4));

TEST(Xml, EntitiesStayText) {
    std::string text =
        "<?xml version=\"1.0\"?><!DOCTYPE l [<!ENTITY a \"lol\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">"
        "<!ENTITY c \"&b;&b;&b;&b;&b;&b;&b;&b;\"><!ENTITY d \"&c;&c;&c;&c;&c;&c;&c;&c;\">"
        "<!ENTITY x SYSTEM \"file:///etc/passwd\">]>\n<materialx version=\"1.39\">"
        "<constant name=\"a\" type=\"float\" doc=\"&d;&x;\"/><output name=\"o\" type=\"float\" nodename=\"a\"/>"
        "<!-- &d; &x; --></materialx>";
    Outcome out = compile(text);
    expectOrderly(out, "entities");
    ASSERT_EQ(out.shaders.size(), 1u) << out.errors;
    EXPECT_EQ(out.shaders[0].pixel.find("root"), std::string::npos);
    EXPECT_EQ(out.shaders[0].pixel.find("lol"), std::string::npos);
}

TEST(Xml, DeepNesting) {
    std::string open, close;
    for (int i = 0; i < 100000; i++) open += "<nodegraph name=\"g\">", close += "</nodegraph>";
    expectRefused(compile(wrapped(open + close)), "limit", "nested");
    expectRefused(compile(std::string(kHead) + open), "bad-xml", "never closed");
    expectRefused(compile(std::string(kHead) + close), "bad-xml", "never opened");
    How how;
    how.read.maxNesting = 2;
    expectRefused(compile(wrapped("<a><b><c/></b></a>"), how), "limit", "with a limit of two");
    EXPECT_TRUE(compile(wrapped("<a><b/></a>"), how).isRead);
}

TEST(Xml, LargeAttributes) {
    std::string name(1 << 20, 'n');
    Outcome out = compile(wrapped("<constant name=\"" + name +
                                  "\" type=\"float\"/><output name=\"o\" type=\"float\" "
                                  "nodename=\"" +
                                  name + "\"/>"));
    expectOrderly(out, "a name of a megabyte");
    EXPECT_EQ(out.shaders.size(), 1u) << out.errors.substr(0, 1000);
    expectCompiles(out.shaders, "a name of a megabyte");
    expectRefused(compile(wrapped("<constant name=\"c\" type=\"float\"><input name=\"value\" type=\"float\" value=\"" +
                                  std::string(1 << 20, '1') +
                                  "\"/></constant><output name=\"o\" type=\"float\" "
                                  "nodename=\"c\"/>")),
                  "bad-value", "a number of a megabyte");
    How how;
    how.read.maxAttributeBytes = 100;
    expectRefused(compile(wrapped("<a b=\"" + std::string(101, 'x') + "\"/>"), how), "limit", "a limit of 100 bytes");
}

TEST(Xml, ManyAttributesAndElements) {
    std::string many = "<constant name=\"a\" type=\"float\"";
    for (int i = 0; i < 100000; i++) many += " a" + std::to_string(i) + "=\"\"";
    expectRefused(compile(wrapped(many + "/>")), "limit", "100,000 attributes");
    std::string twice = "<constant name=\"a\" type=\"float\"";
    for (int i = 0; i < 5000; i++) twice += " a=\"\"";
    expectRefused(compile(wrapped(twice + "/>")), "duplicate-attribute", "one attribute 5,000 times");
    How how;
    how.read.maxElements = 50;
    std::string elements;
    for (int i = 0; i < 60; i++) elements += "<a/>";
    expectRefused(compile(wrapped(elements), how), "limit", "60 elements");
    // Far too many are found before the parser makes room for them.
    for (int i = 0; i < 18; i++) elements += elements;
    how.read.maxElements = 1 << 20;
    expectRefused(compile(wrapped(elements), how), "limit", "16 million elements");
}

TEST(Xml, Encodings) {
    auto wide = [](const std::string& text, bool bigEnd, bool mark) {
        std::string out = !mark ? "" : bigEnd ? "\xFE\xFF" : "\xFF\xFE";
        for (char c : text) {
            if (bigEnd) out += '\0';
            out += c;
            if (!bigEnd) out += '\0';
        }
        return out;
    };
    std::string text = wrapped(kGraph);
    for (bool bigEnd : {false, true})
        for (bool mark : {false, true}) expectRefused(compile(wide(text, bigEnd, mark)), "bad-encoding", "UTF-16");
    EXPECT_EQ(compile("\xEF\xBB\xBF" + text).shaders.size(), 1u);
    auto with = [&](std::string_view bytes) {
        std::string changed = text;
        return changed.insert(changed.find("\"a\"") + 1, bytes);
    };
    using namespace std::string_view_literals;
    // NUL, a continuation alone, overlong, a surrogate, beyond Unicode, and a cut character.
    for (std::string_view bytes :
         {"\0"sv, "\x80"sv, "\xC0\xAF"sv, "\xED\xA0\x80"sv, "\xF4\x90\x80\x80"sv, "\xE2\x82"sv})
        expectRefused(compile(with(bytes)), "bad-encoding", "no UTF-8");
    for (std::string_view reference : {"&#0;", "&#1;", "&#xD800;", "&#x110000;", "&#99999999999999999999;"})
        expectRefused(compile(with(reference)), "bad-encoding", reference);
    for (std::string_view reference : {"&#65;", "&#x41;", "&#;", "&#x;", "&#zz;", "&#"})
        expectOrderly(compile(with(reference)), reference);
    EXPECT_TRUE(compile(wrapped("<!-- &#0; --><![CDATA[&#0;]]>")).isRead);
    EXPECT_TRUE(compile(wrapped("<a b=\"&#9;&#x1F600;\"/>")).isRead);
}

TEST(Xml, OtherThings) {
    for (std::string_view text : {"", " ", "<", "<a", "<a/>", "<materialx", "<materialx/", "<materialx></materialx",
                                  "<materialx/><materialx/>", "<?xml version=\"1.0\"?>", "<!DOCTYPE", "<!DOCTYPE a [",
                                  "<!--", "<![CDATA[", "<materialx version=\"1.39\"/>x", "&", "]]>"})
        expectOrderly(compile(std::string(text)), text);
    for (std::string_view version : {"", "1", "1.", ".39", "0.0", "2.0", "-1.39", "1.99999999999999999999", "1.39.1"})
        expectOrderly(compile("<materialx version=\"" + std::string(version) + "\">" + kGraph + "</materialx>"),
                      version);
}

}  // namespace
}  // namespace shaderx::tests
