#include "graph/values.h"

#include <algorithm>
#include <bit>

#include "base/numbers.h"
#include "doc/values.h"

namespace shaderx::graph {

using namespace ir;

// The document's type of a type with components; none for those that a document has no values of.
static std::optional<doc::ValueType> valueTypeOf(Type type) {
    switch (type) {
        case Type::Boolean:
            return doc::ValueType::Boolean;
        case Type::Integer:
            return doc::ValueType::Integer;
        case Type::Float:
            return doc::ValueType::Float;
        case Type::Color3:
            return doc::ValueType::Color3;
        case Type::Color4:
            return doc::ValueType::Color4;
        case Type::Vector2:
            return doc::ValueType::Vector2;
        case Type::Vector3:
            return doc::ValueType::Vector3;
        case Type::Vector4:
            return doc::ValueType::Vector4;
        case Type::Matrix33:
            return doc::ValueType::Matrix33;
        case Type::Matrix44:
            return doc::ValueType::Matrix44;
        case Type::Void:
        case Type::Point:
        case Type::Normal:
        case Type::String:
        case Type::Texture2D:
        case Type::Tuple:
        case Type::BSDF:
        case Type::EDF:
        case Type::VDF:
        case Type::SurfaceShader:
        case Type::DisplacementShader:
        case Type::VolumeShader:
        case Type::LightShader:
        case Type::Material:
        case Type::FirstStruct:
            break;
    }
    return {};
}

bool readWords(Type type, std::string_view text, Words& words, std::string* problem) {
    words.count = static_cast<std::uint32_t>(componentCount(type));
    if (words.count == 0) return false;
    if (text.empty()) {
        words.bits = {};
        return true;
    }
    std::optional<doc::ValueType> kind = valueTypeOf(type);
    if (!kind) return false;
    if (doc::parseWords(*kind, text, words.bits.data())) return true;
    const std::optional<doc::Value> odd = doc::parseValue(*kind, text, problem);
    if (!odd) return false;
    words.isOdd = true;
    for (std::uint32_t i = 0; i < words.count; i++)
        words.bits[i] = *kind <= doc::ValueType::Integer ? static_cast<std::uint32_t>(odd->integer)
                                                         : std::bit_cast<std::uint32_t>(odd->numbers[i]);
    return true;
}

std::vector<std::uint32_t> wordsOf(Type type, std::string_view text) {
    Words words;
    if (!readWords(type, text, words)) return {};
    return {words.all().begin(), words.all().end()};
}

Type typeOf(const doc::Definitions& definitions, std::string_view name) {
    const Type builtIn = typeNamed(name);
    if (builtIn != Type::Void || name.empty() || name == "void") return builtIn;
    const std::vector<doc::StructDef>& structs = definitions.structs();
    for (std::size_t i = 0; i < structs.size(); i++)
        if (definitions.text(structs[i].name) == name) return structType(i);
    return Type::String;
}

std::vector<StructType> structsOf(const doc::Definitions& definitions) {
    std::vector<StructType> all;
    for (const doc::StructDef& s : definitions.structs()) {
        StructType& made = all.emplace_back();
        made.name = s.name;
        for (const doc::StructDef::Member& m : s.members)
            made.members.push_back({m.name, typeOf(definitions, definitions.text(m.type))});
    }
    return all;
}

// The text of a structure's next member, taken off the front: up to a semicolon that no braces enclose.
static std::string_view nextMember(std::string_view& text) {
    int depth = 0;
    std::size_t at = 0;
    for (; at < text.size(); at++) {
        if (text[at] == '{') depth++;
        if (text[at] == '}') depth--;
        if (text[at] == ';' && depth == 0) break;
    }
    const std::string_view found = trim(text.substr(0, at));
    text.remove_prefix(std::min(text.size(), at + 1));
    return found;
}

ExprId structConstant(Builder& b, const doc::Definitions& definitions, Type type, std::string_view text) {
    const doc::StructDef& s = definitions.structs()[structIndex(type)];
    text = trim(text);
    if (!text.empty()) {
        if (text.size() < 2 || text.front() != '{' || text.back() != '}') return {};
        text = text.substr(1, text.size() - 2);
    }
    std::vector<ExprId> parts;
    for (const doc::StructDef::Member& m : s.members) {
        const NameTable& names = *b.module().names;
        const Type of = typeOf(definitions, names.text(m.type));
        std::string_view value = nextMember(text);
        if (value.empty()) value = names.text(m.value);
        const ExprId part = isStruct(of) ? structConstant(b, definitions, of, value) : constantOf(b, of, value);
        if (!part) return {};
        parts.push_back(part);
    }
    return trim(text).empty() ? b.emit(Op::Make, type, parts) : ExprId();
}

ExprId constantOf(Builder& b, Type type, std::string_view text) {
    if (type == Type::String) return b.string(b.module().names->intern(text));
    if (componentCount(type) == 0 || text.empty()) return b.null(type);
    Words words;
    return readWords(type, text, words) ? b.constant(type, words.all()) : ExprId();
}

}  // namespace shaderx::graph
