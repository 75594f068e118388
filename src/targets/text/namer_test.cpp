#include "targets/text/namer.h"

#include <array>

#include <gtest/gtest.h>

namespace shaderx::text {
namespace {

constexpr std::array<std::string_view, 3> kWords = {"float", "mix", "out"};
constexpr auto kSlots = reservedSlots(kWords);
const ReservedWords kReserved{kWords, kSlots};

TEST(Identifier, KeepsLettersDigitsAndSingleUnderscores) {
    EXPECT_EQ(identifier("base_color"), "base_color");
    EXPECT_EQ(identifier("N1"), "N1");
    EXPECT_EQ(identifier("a b/c"), "a_b_c");
    EXPECT_EQ(identifier("a__b"), "a_b");
    EXPECT_EQ(identifier("a _ b"), "a_b");
    EXPECT_EQ(identifier("__a"), "_a");
}

TEST(Identifier, StartsWithNoDigit) {
    EXPECT_EQ(identifier("2d"), "n2d");
    EXPECT_EQ(identifier("9"), "n9");
}

TEST(Identifier, IsNeverEmpty) {
    EXPECT_EQ(identifier(""), "v");
    EXPECT_EQ(identifier("_"), "v");
    EXPECT_EQ(identifier("***"), "v");
    EXPECT_EQ(identifier("\xc3\xa4"), "v");
}

TEST(Identifier, IsOfLimitedLength) {
    EXPECT_LE(identifier(std::string(100000, 'a')).size(), 255u);
    EXPECT_LE(identifier(std::string(100000, '_')).size(), 255u);
}

TEST(Namer, NumbersWhatIsTaken) {
    Namer n(kReserved);
    EXPECT_EQ(n.global("color"), "color");
    EXPECT_EQ(n.global("color"), "color2");
    EXPECT_EQ(n.global("color"), "color3");
    EXPECT_EQ(n.global("color2"), "color2_2");
}

TEST(Namer, AvoidsReservedWords) {
    Namer n(kReserved);
    EXPECT_EQ(n.global("mix"), "mix2");
    EXPECT_EQ(n.local("out"), "out2");
}

TEST(Namer, KeepsNamesApartThatBecomeEqual) {
    Namer n(kReserved);
    EXPECT_EQ(n.global("a b"), "a_b");
    EXPECT_EQ(n.global("a/b"), "a_b2");
    EXPECT_EQ(n.global("a__b"), "a_b3");
    std::string longest(5000, 'x');
    EXPECT_NE(n.global(longest + "1"), n.global(longest + "2"));
}

TEST(Namer, MakesNoDoubleUnderscores) {
    Namer n(kReserved);
    for (std::string_view wanted : {"a_", "a_", "a_", "a_2", "a_2", "_", "_", "1_", "1_"}) {
        std::string name = n.global(wanted);
        EXPECT_EQ(name.find("__"), std::string::npos) << name;
    }
}

// Languages keep names that begin so for themselves.
TEST(Namer, AvoidsThePrefixOfBuiltInVariables) {
    Namer n(kReserved);
    for (std::string_view wanted : {"gl_Position", "gl_Position", "gl_", "gl__x"}) {
        std::string name = n.global(wanted);
        EXPECT_NE(name.rfind("gl_", 0), 0u) << name;
    }
}

TEST(Namer, LocalNamesLiveInOneFunction) {
    Namer n(kReserved);
    n.global("shared");
    EXPECT_EQ(n.local("x"), "x");
    EXPECT_EQ(n.local("x"), "x2");
    EXPECT_EQ(n.local("shared"), "shared2");
    n.enterFunction();
    EXPECT_EQ(n.local("x"), "x");
    EXPECT_EQ(n.local("shared"), "shared2");
}

}  // namespace
}  // namespace shaderx::text
