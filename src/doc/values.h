// Typed values from their MaterialX text.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "doc/document.h"

namespace shaderx::doc {

enum class ValueType : std::uint8_t {
    Boolean,
    Integer,
    Float,
    Color3,
    Color4,
    Vector2,
    Vector3,
    Vector4,
    Matrix33,
    Matrix44,
    String,
    Filename,
    Geomname,
    IntegerArray,
    FloatArray,
    Color3Array,
    Color4Array,
    Vector2Array,
    Vector3Array,
    Vector4Array,
    StringArray,
};

// The value type of a MaterialX type's name; none for types without values (BSDF, material) and for unknown ones.
std::optional<ValueType> valueType(std::string_view typeName);
// How many numbers one value has: 3 for color3, 16 for matrix44, 0 for texts; for arrays, that of an item.
std::uint32_t numberCount(ValueType type);

struct Value {
    ValueType type = ValueType::Float;
    std::array<float, 16> numbers{};   // Float … Matrix44, row by row as written; Boolean and Integer too
    int integer = 0;                   // Integer; Boolean as 0 or 1
    std::string_view text;             // String, Filename, Geomname: the text itself, which must outlive the value
    std::vector<float> floats;         // arrays of floats, colors and vectors: all items in a row
    std::vector<int> integers;         // IntegerArray
    std::vector<std::string> strings;  // StringArray, split at commas, blanks around the items removed
};

// Reads a value of Boolean … Matrix44 as bits: `numberCount` floats, or the integer, Boolean as 0 or 1. False where the
// text is wrong or the type has no numbers; parseValue tells what is wrong.
bool parseWords(ValueType type, std::string_view text, std::uint32_t* words);

// Parses a value. Numbers are separated by commas or blanks, as many as the type has. What others write is read too:
// more numbers than that, of which the first are taken, a last comma, 0.5f, a whole number as 2.0, and True or 1 for a
// boolean; then `odd`, if given, says what was made of it. Where the text is wrong, returns none and, if `problem` is
// given, says there what is wrong: "expected 3 numbers, found 2".
std::optional<Value> parseValue(ValueType type, std::string_view text, std::string* problem = nullptr,
                                std::string* odd = nullptr);

// The items of a list with commas between them, as the attribute `enum` has it.
std::vector<std::string_view> choicesOf(std::string_view list);

// What there is to say of the value that a port is given: the error bad-value, the warning odd-value, or nothing. An
// empty value of numbers is none.
std::optional<Diagnostic> judgeValue(const Document& document, ElementId port);
// The same of a text of which the nodedef's input `declared` lists all that it may be: the warning unknown-choice.
std::optional<Diagnostic> judgeChoice(const Document& document, ElementId port, ElementRef declared);

}  // namespace shaderx::doc
