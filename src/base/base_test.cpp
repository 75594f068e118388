#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "base/names.h"
#include "base/numbers.h"

namespace shaderx {
namespace {

TEST(Names, EqualTextIsOneName) {
    NameTable names;
    Name a = names.intern("wood"), b = names.intern("wo"), empty = names.intern("");
    EXPECT_EQ(names.intern("wood"), a);
    EXPECT_NE(a, b);
    EXPECT_TRUE(empty);
    EXPECT_EQ(names.text(empty), "");
    EXPECT_EQ(names.text(Name()), "");
    EXPECT_FALSE(names.find("oak"));
    EXPECT_EQ(names.find("wo"), b);
}

TEST(Names, ManyStayFindable) {
    NameTable names;
    for (int i = 0; i < 20000; i++)
        ASSERT_EQ(names.intern("n" + std::to_string(i)).index, static_cast<std::uint32_t>(i));
    for (int i = 0; i < 20000; i++) ASSERT_EQ(names.text(names.find("n" + std::to_string(i))), "n" + std::to_string(i));
    std::string huge(1 << 20, 'x');
    EXPECT_EQ(names.text(names.intern(huge)), huge);
}

TEST(Names, StartFromAnImage) {
    std::string_view bytes = "addmix";
    std::uint32_t ends[] = {3, 6}, slots[8] = {};
    for (std::uint32_t i = 0; i < 2; i++) {
        std::uint32_t slot = hashText(i ? "mix" : "add") & 7;
        while (slots[slot]) slot = (slot + 1) & 7;
        slots[slot] = i + 1;
    }
    NameTable names(NameImage{ends, slots, bytes});
    EXPECT_EQ(names.intern("mix").index, 1u);
    EXPECT_EQ(names.intern("layer").index, 2u);
    EXPECT_EQ(names.text(Name(0)), "add");
    EXPECT_EQ(names.text(Name(2)), "layer");
}

TEST(Numbers, ShortestTextReadsBack) {
    EXPECT_EQ(formatFloat(0.2f), "0.2");
    EXPECT_EQ(formatFloat(1.0f), "1");
    for (float v : {0.1f, 1e-38f, 3.4028235e38f, 16777216.0f, -0.0f, 1.0f / 3.0f})
        EXPECT_EQ(parseFloat(formatFloat(v)), v);
}

TEST(Numbers, TextsAreThoseOfTheLibraryThatIsKnownToFindTheShortest) {
    auto check = [](float v) {
        ASSERT_EQ(formatFloat(v), fmt::format("{}", v));
        ASSERT_EQ(formatFloat(-v), fmt::format("{}", -v));
    };
    for (int digits = 1; digits < 1100000; digits += 7)
        for (float scale : {1.0f, 10.0f, 1e3f, 1e5f, 1e6f, 1e8f}) check(static_cast<float>(digits) / scale);
    std::mt19937 random(1);
    for (int i = 0; i < 300000; i++) {
        const float v = std::bit_cast<float>(static_cast<std::uint32_t>(random()) & 0x7fffffffu);
        if (std::isfinite(v)) check(v);
    }
    for (float v : {0.0f, 1.0f, 999.9999f, 1000.0f, 0.0001f, 0.00009999f, 0.99999994f, 16.0f, 0.5f}) check(v);
}

// Short decimals go a shorter way than others: the same number with an exponent must give the same float.
TEST(Numbers, ShortDecimalsAreNearest) {
    for (std::uint32_t digits = 0; digits < 10000000; digits += 997)
        for (int places = 0; places <= 7; places++) {
            std::string whole = std::to_string(digits);
            while (whole.size() <= static_cast<std::size_t>(places)) whole.insert(0, "0");
            std::string text = whole;
            if (places) text.insert(text.size() - static_cast<std::size_t>(places), ".");
            ASSERT_EQ(parseFloat(text), parseFloat(whole + "e-" + std::to_string(places))) << text;
        }
    EXPECT_TRUE(std::signbit(*parseFloat("-0.0")));
    EXPECT_EQ(parseFloat("-12.5"), -12.5f);
    EXPECT_EQ(parseFloat("+-0.25"), -0.25f);
    EXPECT_EQ(parseFloat("16777217"), 16777216.0f);
    EXPECT_EQ(parseFloat("1.5e2"), 150.0f);
}

TEST(Numbers, WhatIsNoNumberIsNone) {
    for (std::string_view text : {"", " ", "1.2.3", "0x10", "1e", "nan", "inf", "1e999", "1,2", "1 2", "--1"})
        EXPECT_FALSE(parseFloat(text)) << text;
    for (std::string_view text : {"", "1.5", "99999999999", "a", "1 2"}) EXPECT_FALSE(parseInt(text)) << text;
    EXPECT_EQ(parseFloat(" +0.5 "), 0.5f);
    EXPECT_EQ(parseInt("-7"), -7);
}

TEST(Diagnostics, FormatsPlacePathNotesAndHint) {
    Diagnostics all;
    Diagnostic& d = all.error("unknown-node", "there is no node <mux>");
    d.where = {"a.mtlx", 3, 5};
    d.path = "NG/mix1";
    d.notes.push_back({{"b.mtlx", 1, 1}, "included from here"});
    d.hint = "did you mean 'mix'?";
    all.warning("unused-input", "nothing reads this input");
    EXPECT_EQ(all.text(),
              "a.mtlx:3:5: error: there is no node <mux> [unknown-node]\n  at: NG/mix1\n"
              "  note: b.mtlx:1:1: included from here\n  hint: did you mean 'mix'?\n"
              "warning: nothing reads this input [unused-input]\n");
    EXPECT_EQ(all.errorCount(), 1u);
    EXPECT_FALSE(all.hasInternal());
}

TEST(Diagnostics, WhatTerminalsObeyIsWrittenOut) {
    EXPECT_EQ(visible("plain 'ä' → 日本 \U0001F600"), "plain 'ä' → 日本 \U0001F600");
    EXPECT_EQ(visible("\x1b[31mred\x7f"), "\\x1b[31mred\\x7f");
    EXPECT_EQ(visible("a\nb\rc\td"), "a\\nb\\rc\\td");
    EXPECT_EQ(visible("\u009b31m"), "\\x9b31m");                       // the one-character form of ESC [
    EXPECT_EQ(visible("\u202egnp.\u2066"), "\\u202egnp.\\u2066");      // would be read from the right
    EXPECT_EQ(visible("\xc3(\xff\xe2\x80"), "\\xc3(\\xff\\xe2\\x80");  // no UTF-8, and cut off
    EXPECT_EQ(visible(std::string_view("\0", 1)), "\\x00");
    EXPECT_EQ(visibleLines("a\n\tb\rc\x1b\n\u009b"), "a\n\tb\\rc\\x1b\n\\x9b");  // a text of lines
}

TEST(Diagnostics, NothingOfTheUsersReachesATerminalAsItIs) {
    Diagnostics all;
    Diagnostic& d = all.error("dangling-nodename", "there is no node 'x\ngood.mtlx:1:1: error: forged'");
    d.where = {"a\x1b.mtlx", 1, 2};
    d.path = "\rpath";
    d.notes.push_back({{"b\n.mtlx", 1, 1}, "in f:\n    %0 = 1\nforged"});
    d.hint = "did you mean '\u202e'?";
    EXPECT_EQ(all.text(),
              "a\\x1b.mtlx:1:2: error: there is no node 'x\\ngood.mtlx:1:1: error: forged' [dangling-nodename]\n"
              "  at: \\rpath\n  note: b\\n.mtlx:1:1: in f:\n    %0 = 1\\nforged\n"
              "  hint: did you mean '\\u202e'?\n");
}

TEST(Diagnostics, LocateCountsFromOne) {
    EXPECT_EQ(locate("f", "a\nbc\n", 3).line, 2u);
    EXPECT_EQ(locate("f", "a\nbc\n", 3).column, 2u);
    EXPECT_EQ(locate("f", "", 100).line, 1u);
}

TEST(Diagnostics, NearestIsALikelyMisspelling) {
    EXPECT_EQ(nearest("base_colour", {"base", "base_color", "coat_color"}), "base_color");
    EXPECT_EQ(nearest("xyz", {"base", "coat"}), "");
}

}  // namespace
}  // namespace shaderx
