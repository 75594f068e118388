// Documents with the shaders that come of them: each tests/golden/NAME.mtlx with NAME.ELEMENT.INTERFACE.vert, .frag and
// .json for all that can be rendered in it. NAME.options beside it may say `interfaces: live baked` (live alone where
// nothing is said) and `element: PATH`. SHADERX_BLESS=1 rewrites what is expected. Every pair of shaders also goes
// through a compiler of the shading language.
#include <set>
#include <sstream>

#include "compile/compile.h"
#include "doc/file_resolver.h"
#include "support.h"

namespace shaderx::tests {
namespace {

struct Options {
    std::vector<std::string> interfaces{"live"};
    std::string element;
};

Options optionsOf(fs::path document) {
    Options options;
    document.replace_extension(".options");
    if (!fs::exists(document)) return options;
    std::istringstream lines(fileText(document));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "interfaces:") {
            options.interfaces.clear();
            for (std::string word; words >> word;) options.interfaces.push_back(word);
        } else if (key == "element:") {
            words >> options.element;
        } else {
            ADD_FAILURE() << document.filename() << " has an unknown option: " << line;
        }
    }
    return options;
}

std::string fileNameOf(std::string_view path) {
    std::string out(path);
    for (char& c : out)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return out;
}

bool haveValidator() {
    static const bool have = runCommand("glslangValidator --version").exitCode == 0;
    return have;
}

void expectCompiles(const std::string& stem, const Shader& shader) {
    OwnFolder own;
    writeText(own / "shader.vert", shader.vertex);
    writeText(own / "shader.frag", shader.pixel);
    Ran ran = runCommand("glslangValidator -l shader.vert shader.frag", own.path());
    EXPECT_EQ(ran.exitCode, 0) << stem << ":\n" << ran.output << ran.errors;
}

class Golden : public testing::TestWithParam<fs::path> {
  protected:
    fs::path folder_ = testFolder("golden");
    Compiler compiler_{builtinLibrary()};
    std::set<std::string> expected_;

    void check(const doc::Document& document, doc::ElementId element, const std::string& interface) {
        GenerateOptions how;
        ASSERT_TRUE(interfaceNamed(interface, how.interface)) << interface;
        Diagnostics diagnostics;
        Result<Shader> shader = compiler_.generate(document, element, how, diagnostics);
        ASSERT_TRUE(shader) << diagnostics.text();
        EXPECT_EQ(diagnostics.text(), "");
        std::string stem = GetParam().stem().string() + "." + fileNameOf(shader->element) + "." + interface;
        expectOne(stem + ".vert", shader->vertex);
        expectOne(stem + ".frag", shader->pixel);
        expectOne(stem + ".json", shader->reflection());
        if (haveValidator()) expectCompiles(stem, *shader);
    }

    void expectOne(const std::string& name, const std::string& text) {
        EXPECT_TRUE(expected_.insert(name).second) << "two elements would be written to " << name;
        expectFile(folder_ / name, text);
    }

    // What is expected although nothing makes it any more.
    void checkLeftOver() {
        std::string start = GetParam().stem().string() + ".";
        for (const char* extension : {".vert", ".frag", ".json"})
            for (const fs::path& file : filesOf(folder_, extension)) {
                std::string name = file.filename().string();
                if (name.compare(0, start.size(), start) != 0 || expected_.count(name)) continue;
                if (blessing()) fs::remove(file);
                EXPECT_TRUE(blessing()) << "nothing makes " << name;
            }
    }
};

TEST_P(Golden, ShadersAreAsExpected) {
    Diagnostics diagnostics;
    doc::FileResolver files;
    auto document = compiler_.read(GetParam().string(), fileText(GetParam()), files, diagnostics);
    ASSERT_TRUE(document) << diagnostics.text();
    EXPECT_TRUE(compiler_.validate(*document, diagnostics)) << diagnostics.text();

    Options options = optionsOf(GetParam());
    std::vector<doc::ElementId> elements = compiler_.renderableElements(*document);
    if (!options.element.empty()) elements = {document->find(options.element)};
    ASSERT_FALSE(elements.empty());
    for (doc::ElementId element : elements) {
        ASSERT_TRUE(element) << options.element;
        for (const std::string& interface : options.interfaces) check(*document, element, interface);
    }
    checkLeftOver();
    if (!haveValidator()) GTEST_SKIP() << "the texts are as expected, but there is no glslangValidator to compile them";
}

INSTANTIATE_TEST_SUITE_P(All, Golden, testing::ValuesIn(filesOf(testFolder("golden"), ".mtlx")), testName);

}  // namespace
}  // namespace shaderx::tests
