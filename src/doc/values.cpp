#include "doc/values.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

// A number as it is written by programs that write their own language's, 0.5f, and with a slip of the hand, 0.5.0.
std::optional<float> oddFloat(std::string_view item) {
    if (item.ends_with('f') || item.ends_with('F')) return parseFloat(item.substr(0, item.size() - 1));
    const std::size_t second = item.find('.', item.find('.') + 1);
    if (second == std::string_view::npos || item.find_first_not_of("+-0123456789.") != std::string_view::npos)
        return {};
    return parseFloat(item.substr(0, second));
}
// Whole numbers as 2.0.
std::optional<int> oddInt(std::string_view item) {
    std::optional<float> number = parseFloat(item);
    constexpr float kExact = 1 << 24;
    if (!number || !(std::abs(*number) < kExact) || *number != std::trunc(*number)) return {};
    return static_cast<int>(*number);
}

// What became of a text that is not written as the format has it.
struct Leniently {
    std::string odd, wrong;  // at most one of them says something

    void note(std::string text) {
        if (odd.empty()) odd = std::move(text);
    }
};

std::string wholeText(std::uint32_t n) {
    return n == 1 ? std::string("the first is taken") : fmt::format("the first {} are taken", n);
}

// Reads so many numbers as bits.
Leniently readNumbers(bool integer, std::uint32_t count, std::string_view text, std::uint32_t* words) {
    Leniently out;
    ListReader list{text, 0, false, {}};
    for (std::string_view item = list.next(); !item.empty(); item = list.next()) {
        std::optional<int> whole = integer ? parseInt(item) : std::nullopt;
        std::optional<float> number = integer ? std::nullopt : parseFloat(item);
        if (!whole && !number) {
            if (integer)
                whole = oddInt(item);
            else
                number = oddFloat(item);
            if (whole) out.note(fmt::format("{} is read as {}", quoted(item), *whole));
            if (number) out.note(fmt::format("{} is read as {}", quoted(item), formatFloat(*number)));
        }
        if (!whole && !number) {
            out.wrong = numberProblem(item, integer);
            return out;
        }
        if (list.taken > count) continue;
        words[list.taken - 1] = whole ? static_cast<std::uint32_t>(*whole) : std::bit_cast<std::uint32_t>(*number);
    }
    if (!list.problem.empty() && !(list.afterComma && list.taken >= count && list.text.empty())) {
        out.wrong = std::move(list.problem);
        return out;
    }
    if (list.taken != count) {
        std::string expected = fmt::format("expected {} number{}, found {}", count, count == 1 ? "" : "s",
                                           list.taken ? fmt::format("{}", list.taken) : "none");
        if (list.taken < count)
            out.wrong = std::move(expected);
        else
            out.note(fmt::format("{}; {}", expected, wholeText(count)));
    }
    if (!list.problem.empty()) out.note("the last comma is left out");
    return out;
}

Leniently readBoolean(std::string_view text, std::uint32_t& word) {
    Leniently out;
    std::string lower(text);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    word = lower == "true" || lower == "1";
    if (!word && lower != "false" && lower != "0")
        out.wrong = fmt::format("expected true or false, found {}", quoted(text));
    else if (text != "true" && text != "false")
        out.note(fmt::format("expected true or false; {} is read as {}", quoted(text), word ? "true" : "false"));
    return out;
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

std::optional<Value> parseValue(ValueType type, std::string_view text, std::string* problem, std::string* odd) {
    Value value;
    value.type = type;
    std::string wrong;
    switch (type) {
        case ValueType::Boolean:
        case ValueType::Integer:
        case ValueType::Float:
        case ValueType::Color3:
        case ValueType::Color4:
        case ValueType::Vector2:
        case ValueType::Vector3:
        case ValueType::Vector4:
        case ValueType::Matrix33:
        case ValueType::Matrix44: {
            std::uint32_t words[16] = {};
            Leniently read = type == ValueType::Boolean
                                 ? readBoolean(trim(text), words[0])
                                 : readNumbers(type == ValueType::Integer, numberCount(type), text, words);
            wrong = std::move(read.wrong);
            if (odd) *odd = std::move(read.odd);
            if (type <= ValueType::Integer) {
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

std::vector<std::string_view> choicesOf(std::string_view list) {
    std::vector<std::string_view> out;
    if (trim(list).empty()) return out;
    for (;;) {
        const std::size_t comma = list.find(',');
        out.push_back(trim(list.substr(0, comma)));
        if (comma == std::string_view::npos) return out;
        list.remove_prefix(comma + 1);
    }
}

std::optional<Diagnostic> judgeValue(const Document& d, ElementId port) {
    const WellKnown& k = d.known();
    const std::string_view type = d.attributeText(port, k.type), text = d.attributeText(port, k.value);
    const std::optional<ValueType> known = valueType(type);
    if (!known || (text.empty() && *known <= ValueType::Matrix44)) return {};
    std::string problem, odd;
    const bool isRead = parseValue(*known, text, &problem, &odd).has_value();
    if (isRead && odd.empty()) return {};
    Diagnostic out;
    out.severity = isRead ? Severity::Warning : Severity::Error;
    out.code = isRead ? "odd-value" : "bad-value";
    out.message = fmt::format("{} {} value of '{}': {}", isRead ? "odd" : "bad", type, d.text(d[port].name),
                              isRead ? odd : problem);
    out.where = d.locate(port, k.value);
    out.path = d.path(port);
    return out;
}

std::optional<Diagnostic> judgeChoice(const Document& d, ElementId port, ElementRef declared) {
    const WellKnown& k = d.known();
    const Name given = d.attribute(port, k.value), list = declared.attribute(k.enumName);
    if (!given || !list || d.text(given).empty()) return {};
    const std::vector<std::string_view> choices = choicesOf(d.text(list));
    const std::string_view word = d.text(given);
    if (choices.empty() || std::find(choices.begin(), choices.end(), word) != choices.end()) return {};
    Diagnostic out;
    out.severity = Severity::Warning;
    out.code = "unknown-choice";
    out.message = fmt::format("'{}' is no value of '{}'; the default '{}' is taken", word, d.text(d[port].name),
                              declared.attributeText(k.value));
    out.where = d.locate(port, k.value);
    out.path = d.path(port);
    const std::string_view near = nearest(word, choices);
    out.hint = near.empty() ? fmt::format("its values are {}", fmt::join(choices, ", "))
                            : fmt::format("did you mean '{}'?", near);
    return out;
}

}  // namespace shaderx::doc
