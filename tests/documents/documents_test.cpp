// Documents of the kinds that people have: what each element is in the middle of the picture.
// tests/documents/values.txt has a line for each, same.txt a line for each two that are drawn alike, messages.txt one
// for what `validate` and `generate` have to say; how messages are worded is tested elsewhere (tests/errors).
#include <cmath>
#include <cstring>
#include <sstream>

#include "support.h"

namespace shaderx::tests {
namespace {

struct Expectation {
    std::string document, element, options, name;
    std::vector<float> value;
};

void PrintTo(const Expectation& e, std::ostream* out) { *out << e.document << " " << e.element << e.options; }

// A folder of shared samples beside the sources; a checkout has none.
fs::path sharedFolder() { return fs::path(SHADERX_SOURCE_DIR) / ".." / "shared"; }

std::vector<Expectation> expectations() {
    std::vector<Expectation> all;
    std::istringstream lines(fileText(testFolder("documents") / "values.txt"));
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line[0] == '#') continue;
        Expectation e;
        std::istringstream words(line);
        words >> e.document >> e.element;
        for (std::string word; words >> word && word != "=";)
            e.options += " " + (word.rfind("cases/", 0) == 0 ? "'" + (sharedFolder() / word).string() + "'" : word);
        for (float v; words >> v;) e.value.push_back(v);
        e.name = std::to_string(all.size()) + "_" + e.document + "_" + e.element;
        for (char& c : e.name)
            if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
        all.push_back(std::move(e));
    }
    return all;
}

// A picture in a PFM file, three numbers a pixel; empty if there is none.
struct Picture {
    std::size_t width = 0, height = 0;
    std::vector<float> pixels;
};

Picture readPicture(const fs::path& picture) {
    std::istringstream in(fileText(picture));
    std::string kind;
    std::size_t width = 0, height = 0;
    float scale = 0;
    in >> kind >> width >> height >> scale;
    in.get();
    std::vector<float> pixels(width * height * 3);
    in.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(pixels.size() * sizeof(float)));
    if (kind != "PF" || !in) return {};
    return {width, height, std::move(pixels)};
}

// The pixel in the middle of a picture of an odd size.
std::vector<float> middleOf(const fs::path& file) {
    const Picture p = readPicture(file);
    if (p.pixels.empty()) return {};
    const std::size_t at = (p.height / 2 * p.width + p.width / 2) * 3;
    return {p.pixels[at], p.pixels[at + 1], p.pixels[at + 2]};
}

// The lines of a list that say something, as words.
std::vector<std::vector<std::string>> wordsOf(const char* list) {
    std::vector<std::vector<std::string>> all;
    std::istringstream lines(fileText(testFolder("documents") / list));
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream words(line);
        all.emplace_back();
        for (std::string word; words >> word;) all.back().push_back(word);
    }
    return all;
}

// A document of this folder, or of the shared samples: cases/NAME.
fs::path documentFile(const std::string& name) {
    return (name.rfind("cases/", 0) == 0 ? sharedFolder() : testFolder("documents")) / (name + ".mtlx");
}

class Documents : public testing::TestWithParam<Expectation> {};

TEST_P(Documents, AreDrawnAsExpected) {
    const Expectation& e = GetParam();
    const fs::path file = documentFile(e.document);
    if (!fs::exists(file)) GTEST_SKIP() << "the shared samples are not here";
    ASSERT_EQ(e.value.size(), 3u);
    OwnFolder own;
    for (const char* with : {"gl", "interpreter"}) {
        const std::string picture = own / "picture.pfm";
        Ran ran = runCommand(std::string("'") + SHADERX_PROGRAM + "' draw '" + file.string() + "' --element " +
                             e.element + e.options + " --with " + with + " --size 9 --samples 16 -o '" + picture + "'");
        if (ran.errors.find("no-driver") != std::string::npos) continue;
        ASSERT_EQ(ran.exitCode, 0) << ran.errors;
        const std::vector<float> found = middleOf(picture);
        ASSERT_EQ(found.size(), 3u);
        for (std::size_t c = 0; c < 3; c++)
            EXPECT_NEAR(found[c], e.value[c], 2e-4f) << with << ", component " << c << "\n" << ran.errors;
    }
}

std::string nameOf(const testing::TestParamInfo<Expectation>& tested) { return tested.param.name; }
INSTANTIATE_TEST_SUITE_P(All, Documents, testing::ValuesIn(expectations()), nameOf);

TEST(Documents, ThatMeanTheSameAreDrawnAlike) {
    OwnFolder own;
    for (const std::vector<std::string>& words : wordsOf("same.txt")) {
        ASSERT_EQ(words.size(), 5u);
        if (!fs::exists(documentFile(words[0]))) continue;
        Picture pictures[2];
        for (std::size_t i : {0u, 1u}) {
            const std::string picture = own / "picture.pfm";
            const Ran ran = runCommand(std::string("'") + SHADERX_PROGRAM + "' draw '" +
                                       documentFile(words[i * 3]).string() + "' --element " + words[i * 3 + 1] +
                                       " --with interpreter --size 12 --samples 4 -o '" + picture + "'");
            EXPECT_EQ(ran.exitCode, 0) << words[i * 3] << "\n" << ran.errors;
            pictures[i] = readPicture(picture);
        }
        ASSERT_EQ(pictures[0].pixels.size(), pictures[1].pixels.size());
        ASSERT_FALSE(pictures[0].pixels.empty());
        float most = 0;
        for (std::size_t i = 0; i < pictures[0].pixels.size(); i++)
            most = std::max(most, std::fabs(pictures[0].pixels[i] - pictures[1].pixels[i]));
        EXPECT_LE(most, 1e-4f) << words[0] << " " << words[1];
    }
}

// The lines and codes of errors and warnings: "4:odd-value".
std::vector<std::string> codesIn(const std::string& errors) {
    std::vector<std::string> all;
    std::istringstream lines(errors);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t file = line.find(".mtlx:"), code = line.rfind(" [");
        if (line.find(": note: ") != std::string::npos || code == std::string::npos) continue;
        std::string where = file == std::string::npos ? "-" : line.substr(file + 6);
        where = where.substr(0, where.find(':'));
        all.push_back(where + ":" + line.substr(code + 2, line.size() - code - 3));
    }
    return all;
}

TEST(Documents, AreSaidWhatIsExpected) {
    OwnFolder own;
    for (const std::vector<std::string>& words : wordsOf("messages.txt")) {
        ASSERT_GE(words.size(), 4u);
        if (!fs::exists(documentFile(words[0]))) continue;
        std::string command = words[1] == "generate" ? "generate -o out" : words[1];
        std::size_t at = 2;
        for (; at < words.size() && words[at] != "="; at++) command += " " + words[at];
        ASSERT_LT(at + 1, words.size()) << words[0];
        const Ran ran = runCommand(
            std::string("'") + SHADERX_PROGRAM + "' " + command + " '" + documentFile(words[0]).string() + "'",
            own.path());
        EXPECT_EQ(std::to_string(ran.exitCode), words[at + 1]) << words[0] << " " << command << "\n" << ran.errors;
        EXPECT_EQ(codesIn(ran.errors), std::vector<std::string>(words.begin() + static_cast<long>(at) + 2, words.end()))
            << words[0] << " " << command << "\n"
            << ran.errors;
        for (char c : ran.errors) EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= ' ') << words[0];
    }
}

}  // namespace
}  // namespace shaderx::tests
