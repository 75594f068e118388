#include "graph/values.h"

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
    if (problem) (void)doc::parseValue(*kind, text, problem);  // tells what is wrong
    return false;
}

std::vector<std::uint32_t> wordsOf(Type type, std::string_view text) {
    Words words;
    if (!readWords(type, text, words)) return {};
    return {words.all().begin(), words.all().end()};
}

ExprId constantOf(Builder& b, Type type, std::string_view text) {
    if (type == Type::String) return b.string(b.module().names->intern(text));
    if (componentCount(type) == 0 || text.empty()) return b.null(type);
    Words words;
    return readWords(type, text, words) ? b.constant(type, words.all()) : ExprId();
}

}  // namespace shaderx::graph
