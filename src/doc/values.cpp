#include "doc/values.h"

#include <bit>

#include <fmt/format.h>

#include "base/numbers.h"

namespace shaderx::doc {

namespace {

struct TypeRow {
    std::string_view name;
    ValueType type;
    std::uint32_t numbers;
};
// In the order of the enum.
constexpr TypeRow kTypes[] = {
    {"boolean", ValueType::Boolean, 1},
    {"integer", ValueType::Integer, 1},
    {"float", ValueType::Float, 1},
    {"color3", ValueType::Color3, 3},
    {"color4", ValueType::Color4, 4},
    {"vector2", ValueType::Vector2, 2},
    {"vector3", ValueType::Vector3, 3},
    {"vector4", ValueType::Vector4, 4},
    {"matrix33", ValueType::Matrix33, 9},
    {"matrix44", ValueType::Matrix44, 16},
    {"string", ValueType::String, 0},
    {"filename", ValueType::Filename, 0},
    {"geomname", ValueType::Geomname, 0},
    {"integerarray", ValueType::IntegerArray, 1},
    {"floatarray", ValueType::FloatArray, 1},
    {"color3array", ValueType::Color3Array, 3},
    {"color4array", ValueType::Color4Array, 4},
    {"vector2array", ValueType::Vector2Array, 2},
    {"vector3array", ValueType::Vector3Array, 3},
    {"vector4array", ValueType::Vector4Array, 4},
    {"stringarray", ValueType::StringArray, 0},
};

std::string quoted(std::string_view text) {
    constexpr std::size_t kLongest = 40;
    if (text.size() <= kLongest) return fmt::format("'{}'", text);
    std::size_t cut = kLongest;
    while (cut && (static_cast<unsigned char>(text[cut]) & 0xC0) == 0x80) cut--;  // not inside a character
    return fmt::format("'{}…'", text.substr(0, cut));
}

// Takes numbers off a list that commas or blanks separate.
struct ListReader {
    std::string_view text;
    std::uint32_t taken = 0;
    bool afterComma = false;
    std::string problem;

    void skipBlanks() {
        std::size_t at = text.find_first_not_of(" \t\r\n");
        text.remove_prefix(at == std::string_view::npos ? text.size() : at);
    }
    // The next item; empty at the end or after a mistake.
    std::string_view next() {
        skipBlanks();
        if (text.empty()) {
            if (afterComma) problem = "a number is missing after the last comma";
            return {};
        }
        std::string_view item = text.substr(0, text.find_first_of(", \t\r\n"));
        if (item.empty()) {
            problem = fmt::format("number {} is missing", taken + 1);
            return {};
        }
        text.remove_prefix(item.size());
        skipBlanks();
        afterComma = !text.empty() && text[0] == ',';
        if (afterComma) text.remove_prefix(1);
        taken++;
        return item;
    }
};

std::string numberProblem(std::string_view item, bool integer) {
    if (!integer) return fmt::format("{} is not a number", quoted(item));
    return fmt::format("{} is not an integer", quoted(item));
}

// What is wrong with a text that should be so many numbers; empty where nothing is.
std::string fixedProblem(bool integer, std::uint32_t count, std::string_view text) {
    ListReader list{text, 0, false, {}};
    for (std::string_view item = list.next(); !item.empty(); item = list.next())
        if (integer ? !parseInt(item) : !parseFloat(item)) return numberProblem(item, integer);
    if (!list.problem.empty() || list.taken == count) return list.problem;
    return fmt::format("expected {} number{}, found {}", count, count == 1 ? "" : "s",
                       list.taken ? fmt::format("{}", list.taken) : "none");
}

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

// The same grammar as ListReader's, for the usual case that all is well.
bool readFloats(std::string_view text, std::uint32_t count, std::uint32_t* words) {
    const char *at = text.data(), *end = at + text.size();
    bool afterComma = false;
    for (std::uint32_t taken = 0;; taken++) {
        while (at != end && isBlank(*at)) at++;
        if (at == end) return taken == count && !afterComma;
        float value = 0;
        if (taken == count || !(at = readFloat(at, end, value))) return false;
        words[taken] = std::bit_cast<std::uint32_t>(value);
        if (at != end && !isBlank(*at) && *at != ',') return false;
        while (at != end && isBlank(*at)) at++;
        afterComma = at != end && *at == ',';
        if (afterComma) at++;
    }
}

bool readArray(Value& value, std::uint32_t itemNumbers, std::string_view text, std::string& problem) {
    ListReader list{text, 0, false, {}};
    for (std::string_view item = list.next(); !item.empty(); item = list.next()) {
        if (value.type == ValueType::IntegerArray) {
            std::optional<int> n = parseInt(item);
            if (!n) problem = numberProblem(item, true);
            value.integers.push_back(n.value_or(0));
        } else {
            std::optional<float> n = parseFloat(item);
            if (!n) problem = numberProblem(item, false);
            value.floats.push_back(n.value_or(0));
        }
        if (!problem.empty()) return false;
    }
    problem = list.problem;
    if (problem.empty() && list.taken % itemNumbers)
        problem = fmt::format("expected a multiple of {} numbers, found {}", itemNumbers, list.taken);
    return problem.empty();
}

void readStrings(Value& value, std::string_view text) {
    if (trim(text).empty()) return;
    for (;;) {
        std::size_t comma = text.find(',');
        value.strings.emplace_back(trim(text.substr(0, comma)));
        if (comma == std::string_view::npos) return;
        text.remove_prefix(comma + 1);
    }
}

}  // namespace

std::optional<ValueType> valueType(std::string_view typeName) {
    for (const TypeRow& row : kTypes)
        if (row.name == typeName) return row.type;
    return {};
}

std::uint32_t numberCount(ValueType type) { return kTypes[static_cast<std::size_t>(type)].numbers; }

bool parseWords(ValueType type, std::string_view text, std::uint32_t* words) {
    if (type > ValueType::Matrix44) return false;
    if (type > ValueType::Integer) return readFloats(text, numberCount(type), words);
    text = trim(text);
    if (type == ValueType::Boolean) {
        words[0] = text == "true";
        return text == "true" || text == "false";
    }
    ListReader list{text, 0, false, {}};
    std::optional<int> n = parseInt(list.next());
    words[0] = static_cast<std::uint32_t>(n.value_or(0));
    return n && list.next().empty() && list.problem.empty();
}

std::optional<Value> parseValue(ValueType type, std::string_view text, std::string* problem) {
    Value value;
    value.type = type;
    std::string wrong;
    switch (type) {
        case ValueType::Boolean:
            text = trim(text);
            value.integer = text == "true";
            value.numbers[0] = static_cast<float>(value.integer);
            if (text != "true" && text != "false")
                wrong = fmt::format("expected true or false, found {}", quoted(text));
            break;
        case ValueType::Integer:
        case ValueType::Float:
        case ValueType::Color3:
        case ValueType::Color4:
        case ValueType::Vector2:
        case ValueType::Vector3:
        case ValueType::Vector4:
        case ValueType::Matrix33:
        case ValueType::Matrix44: {
            std::uint32_t words[16];
            wrong = fixedProblem(type == ValueType::Integer, numberCount(type), text);
            if (!wrong.empty() || !parseWords(type, text, words)) break;
            if (type == ValueType::Integer) {
                value.integer = static_cast<int>(words[0]);
                value.numbers[0] = static_cast<float>(value.integer);
            } else {
                for (std::uint32_t i = 0; i < numberCount(type); i++) value.numbers[i] = std::bit_cast<float>(words[i]);
            }
            break;
        }
        case ValueType::String:
        case ValueType::Filename:
        case ValueType::Geomname:
            value.text = text;
            break;
        case ValueType::IntegerArray:
        case ValueType::FloatArray:
        case ValueType::Color3Array:
        case ValueType::Color4Array:
        case ValueType::Vector2Array:
        case ValueType::Vector3Array:
        case ValueType::Vector4Array:
            readArray(value, numberCount(type), text, wrong);
            break;
        case ValueType::StringArray:
            readStrings(value, text);
            break;
    }
    if (wrong.empty()) return value;
    if (problem) *problem = std::move(wrong);
    return {};
}

}  // namespace shaderx::doc
