// Random documents, each checked as a whole; and those that once failed.
#include <set>

#include "compile/compile.h"
#include "fuzz/check_document.h"
#include "fuzz/random_document.h"
#include "support.h"

namespace shaderx::fuzz {
namespace {

const NodeTable& nodes() {
    static const NodeTable table(builtinLibrary());
    return table;
}

constexpr std::uint32_t kSeeds = 40;  // of one test

class RandomGraphs : public testing::TestWithParam<int> {};

TEST_P(RandomGraphs, AreRight) {
    DocumentChecker checker;
    const std::uint32_t first = static_cast<std::uint32_t>(GetParam()) * kSeeds;
    std::size_t compared = 0, excused = 0;
    for (std::uint32_t seed = first; seed < first + kSeeds; seed++) {
        const std::string text = randomDocument(nodes(), passes::Dice(seed), checker.pictures());
        const Verdict v = checker.check(text, interfaceFor(seed));
        EXPECT_EQ(v.failure, "") << "seed " << seed << "\n" << text;
        compared += v.compared, excused += v.excused;
    }
    if (!checker.hasDriver()) GTEST_SKIP() << "no graphics driver here: compiled only";
    // Pictures that say nothing prove nothing.
    EXPECT_LT(excused, compared / 5);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomGraphs, testing::Range(0, 6));

TEST(RandomDocument, FollowsFromTheSeed) {
    const std::vector<std::string> pictures{"a.png"};
    for (std::uint32_t seed = 0; seed < 20; seed++)
        EXPECT_EQ(randomDocument(nodes(), passes::Dice(seed), pictures),
                  randomDocument(nodes(), passes::Dice(seed), pictures));
}

TEST(RandomDocument, ReachesEveryNode) {
    const std::vector<std::string> pictures{"a.png"};
    std::set<std::string> missing;
    for (const auto& [type, categories] : nodes().byType())
        for (const auto& [category, signatures] : categories) missing.insert(category);
    EXPECT_GT(missing.size(), 150u);
    for (std::uint32_t seed = 0; seed < 4000 && !missing.empty(); seed++) {
        const std::string text = randomDocument(nodes(), passes::Dice(seed), pictures);
        std::erase_if(missing, [&](const std::string& c) { return text.find("<" + c + " ") != std::string::npos; });
    }
    for (const std::string& category : missing) {
        // Nothing that is made here has such an output: there are no random texts.
        const bool isText = category == "geompropvalueuniform";
        EXPECT_TRUE(isText) << category;
    }
}

class Kept : public testing::TestWithParam<tests::fs::path> {};

TEST_P(Kept, IsRight) {
    DocumentChecker checker;
    for (Interface i : {Interface::Live, Interface::Baked, Interface::Complete})
        EXPECT_EQ(checker.check(tests::fileText(GetParam()), i).failure, "");
}

INSTANTIATE_TEST_SUITE_P(Documents, Kept,
                         testing::ValuesIn(tests::filesOf(tests::testFolder("fuzz/documents"), ".mtlx")),
                         tests::testName);

}  // namespace
}  // namespace shaderx::fuzz
