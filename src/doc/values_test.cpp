#include "doc/values.h"

#include <bit>

#include <gtest/gtest.h>

namespace shaderx::doc {
namespace {

std::string problem(ValueType type, std::string_view text) {
    std::string out;
    EXPECT_FALSE(parseValue(type, text, &out)) << text;
    return out;
}

TEST(Values, ParsesEachKind) {
    EXPECT_EQ(parseValue(ValueType::Boolean, " true ")->integer, 1);
    EXPECT_EQ(parseValue(ValueType::Integer, "-12")->integer, -12);
    EXPECT_FLOAT_EQ(parseValue(ValueType::Float, " 1e-3 ")->numbers[0], 1e-3f);
    EXPECT_FLOAT_EQ(parseValue(ValueType::Color3, "0.1, 0.2,0.3")->numbers[2], 0.3f);
    EXPECT_FLOAT_EQ(parseValue(ValueType::Vector2, "1 2")->numbers[1], 2);
    EXPECT_FLOAT_EQ(parseValue(ValueType::Matrix33, "1,0,0, 0,1,0, 4,5,1")->numbers[7], 5);
    EXPECT_FLOAT_EQ(parseValue(ValueType::Matrix44, "1,0,0,0, 0,1,0,0, 0,0,1,0, 7,8,9,1")->numbers[14], 9);
    EXPECT_EQ(parseValue(ValueType::String, " a b ")->text, " a b ");
    EXPECT_EQ(parseValue(ValueType::Filename, "")->text, "");
    EXPECT_EQ(parseValue(ValueType::IntegerArray, "1, 2, 3")->integers.size(), 3u);
    EXPECT_TRUE(parseValue(ValueType::FloatArray, "")->floats.empty());
    EXPECT_EQ(parseValue(ValueType::Color3Array, "1,2,3, 4,5,6")->floats.size(), 6u);
    EXPECT_EQ(parseValue(ValueType::StringArray, "a, b c ,d")->strings, (std::vector<std::string>{"a", "b c", "d"}));
    EXPECT_EQ(valueType("color3"), ValueType::Color3);
    EXPECT_EQ(valueType("vector4array"), ValueType::Vector4Array);
    EXPECT_FALSE(valueType("BSDF"));
    EXPECT_EQ(numberCount(ValueType::Matrix44), 16u);
}

std::string odd(ValueType type, std::string_view text, Value* value = nullptr) {
    std::string out, wrong;
    std::optional<Value> read = parseValue(type, text, &wrong, &out);
    EXPECT_TRUE(read) << text << ": " << wrong;
    if (read && value) *value = *read;
    return out;
}

// The quick reader of numbers takes the texts of which the other one has nothing to say.
TEST(Values, WordsAreThoseOfTheValue) {
    const std::string_view parts[] = {"",   " ", "1",   "-2.5", "+3", "1e2", ",",
                                      ", ", "x", "nan", "1.",   ".5", "1e",  "true"};
    std::uint32_t words[16];
    for (std::string_view a : parts)
        for (std::string_view b : parts)
            for (std::string_view c : parts)
                for (ValueType type : {ValueType::Boolean, ValueType::Integer, ValueType::Float, ValueType::Vector2}) {
                    std::string text = std::string(a) + std::string(b) + std::string(c);
                    std::string what;
                    std::optional<Value> value = parseValue(type, text, nullptr, &what);
                    ASSERT_EQ(parseWords(type, text, words), value && what.empty()) << text;
                    if (!value || !what.empty()) continue;
                    bool whole = type == ValueType::Boolean || type == ValueType::Integer;
                    EXPECT_EQ(words[0], whole ? static_cast<std::uint32_t>(value->integer)
                                              : std::bit_cast<std::uint32_t>(value->numbers[0]));
                }
    EXPECT_FALSE(parseWords(ValueType::String, "1", words));
}

TEST(Values, ReadsWhatOthersWriteAndSaysSo) {
    Value v;
    EXPECT_EQ(odd(ValueType::Float, "1.8, 1.0, 0.35", &v), "expected 1 number, found 3; the first is taken");
    EXPECT_EQ(v.numbers[0], 1.8f);
    EXPECT_EQ(odd(ValueType::Color3, "0.1 0.2 0.3 0.4", &v), "expected 3 numbers, found 4; the first 3 are taken");
    EXPECT_EQ(v.numbers[2], 0.3f);
    EXPECT_EQ(odd(ValueType::Vector2, "1, 2,", &v), "the last comma is left out");
    EXPECT_EQ(v.numbers[1], 2);
    EXPECT_EQ(odd(ValueType::Float, "0.5f", &v), "'0.5f' is read as 0.5");
    EXPECT_EQ(v.numbers[0], 0.5f);
    EXPECT_EQ(odd(ValueType::Float, "-0.25.0", &v), "'-0.25.0' is read as -0.25");
    EXPECT_EQ(v.numbers[0], -0.25f);
    EXPECT_EQ(odd(ValueType::Integer, "2.0", &v), "'2.0' is read as 2");
    EXPECT_EQ(v.integer, 2);
    for (std::string_view yes : {"True", "TRUE", "1", " true"}) {
        EXPECT_EQ(odd(ValueType::Boolean, yes, &v).empty(), yes == " true") << yes;
        EXPECT_EQ(v.integer, 1);
    }
    for (std::string_view no : {"False", "FALSE", "0"}) {
        EXPECT_EQ(odd(ValueType::Boolean, no, &v),
                  "expected true or false; '" + std::string(no) + "' is read as false");
        EXPECT_EQ(v.integer, 0);
    }
    for (std::string_view plain : {"0.5", " 1 ", "-2e3"}) EXPECT_EQ(odd(ValueType::Float, plain), "") << plain;
    EXPECT_EQ(choicesOf(" a, b c ,d"), (std::vector<std::string_view>{"a", "b c", "d"}));
    EXPECT_TRUE(choicesOf(" ").empty());
}

TEST(Values, SaysWhatIsWrong) {
    EXPECT_EQ(problem(ValueType::Color3, "1, 2"), "expected 3 numbers, found 2");
    EXPECT_EQ(problem(ValueType::Float, ""), "expected 1 number, found none");
    EXPECT_EQ(problem(ValueType::Float, "0.5.x"), "'0.5.x' is not a number");
    EXPECT_EQ(problem(ValueType::Float, "1, 2, x"), "'x' is not a number");
    EXPECT_EQ(problem(ValueType::Vector2, "1, x"), "'x' is not a number");
    EXPECT_EQ(problem(ValueType::Vector2, "1, nan"), "'nan' is not a number");
    EXPECT_EQ(problem(ValueType::Vector2, "1,, 2"), "number 2 is missing");
    EXPECT_EQ(problem(ValueType::Vector2, "1,"), "a number is missing after the last comma");
    EXPECT_EQ(problem(ValueType::Integer, "1.5"), "'1.5' is not an integer");
    EXPECT_EQ(problem(ValueType::Integer, "99999999999"), "'99999999999' is not an integer");
    EXPECT_EQ(problem(ValueType::Boolean, "yes"), "expected true or false, found 'yes'");
    EXPECT_EQ(problem(ValueType::Color3Array, "1,2,3,4"), "expected a multiple of 3 numbers, found 4");
    EXPECT_LT(problem(ValueType::Float, std::string(100000, 'x')).size(), 100u);
    EXPECT_EQ(problem(ValueType::Float, std::string(39, 'x') + "ééé"),
              "'" + std::string(39, 'x') + "…' is not a number");
}

}  // namespace
}  // namespace shaderx::doc
