// Documents of the kinds that people have: what each element is in the middle of the picture.
// tests/documents/values.txt has a line for each; what messages say is tested elsewhere (tests/errors).
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

// The pixel in the middle of a PFM picture of an odd size.
std::vector<float> middleOf(const fs::path& picture) {
    std::istringstream in(fileText(picture));
    std::string kind;
    std::size_t width = 0, height = 0;
    float scale = 0;
    in >> kind >> width >> height >> scale;
    in.get();
    std::vector<float> pixels(width * height * 3);
    in.read(reinterpret_cast<char*>(pixels.data()), static_cast<std::streamsize>(pixels.size() * sizeof(float)));
    if (kind != "PF" || !in || pixels.empty()) return {};
    const std::size_t at = (height / 2 * width + width / 2) * 3;
    return {pixels[at], pixels[at + 1], pixels[at + 2]};
}

class Documents : public testing::TestWithParam<Expectation> {};

TEST_P(Documents, AreDrawnAsExpected) {
    const Expectation& e = GetParam();
    const bool isShared = e.document.rfind("cases/", 0) == 0;
    const fs::path file = (isShared ? sharedFolder() : testFolder("documents")) / (e.document + ".mtlx");
    if (isShared && !fs::exists(file)) GTEST_SKIP() << "the shared samples are not here";
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

}  // namespace
}  // namespace shaderx::tests
