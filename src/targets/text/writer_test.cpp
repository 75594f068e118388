#include "targets/text/writer.h"

#include <gtest/gtest.h>

namespace shaderx::text {
namespace {

TEST(Writer, Indents) {
    Writer w;
    w.open("void main()");
    w.line("x = 1;");
    w.line();
    w.open("if (y)");
    EXPECT_EQ(w.depth(), 2);
    w.line("z;");
    w.close();
    w.close("};");
    EXPECT_EQ(w.take(), "void main()\n{\n\tx = 1;\n\n\tif (y)\n\t{\n\t\tz;\n\t}\n};\n");
}

std::string comment(std::string_view text, std::size_t width = 118) {
    Writer w;
    w.comment(text, width);
    return w.take();
}

TEST(Writer, WrapsComments) {
    EXPECT_EQ(comment("One two three."), "// One two three.\n");
    EXPECT_EQ(comment("aaaa bbbb cccc", 12), "// aaaa bbbb\n// cccc\n");
    EXPECT_EQ(comment("aaaa bbbb cccc", 11), "// aaaa\n// bbbb\n// cccc\n");
    EXPECT_EQ(comment("a  b\n\tc"), "// a b c\n");
    EXPECT_EQ(comment(""), "");
    EXPECT_EQ(comment(" \n "), "");
    EXPECT_EQ(comment(std::string(300, 'x'), 20), "// " + std::string(300, 'x') + "\n");
}

// What follows a comment must not become part of it, nor the comment end early.
TEST(Writer, CommentsEndWhereTheyEnd) {
    EXPECT_EQ(comment("ends with \\"), "// ends with \n");
    EXPECT_EQ(comment("\\\\"), "// \n");
    EXPECT_EQ(comment("a\rb"), "// a b\n");
}

TEST(Writer, FindsTheFirstSentence) {
    EXPECT_EQ(Writer::firstSentence("One. Two."), "One.");
    EXPECT_EQ(Writer::firstSentence("One.\nTwo."), "One.");
    EXPECT_EQ(Writer::firstSentence("Version 1.5 of it. Two."), "Version 1.5 of it.");
    EXPECT_EQ(Writer::firstSentence("No end\n\nTwo."), "No end");
    EXPECT_EQ(Writer::firstSentence("No end"), "No end");
    EXPECT_EQ(Writer::firstSentence(""), "");
}

}  // namespace
}  // namespace shaderx::text
