#include "graph/values.h"

#include <bit>

#include "doc/values.h"

namespace shaderx::graph {

using namespace ir;

static std::optional<doc::Value> parse(Type type, std::string_view text, std::string* problem) {
    std::optional<doc::ValueType> kind = doc::valueType(info(type).name);
    if (!kind) return {};
    return doc::parseValue(*kind, text, problem);
}

static std::vector<std::uint32_t> words(Type type, const doc::Value& v) {
    std::vector<std::uint32_t> out;
    Scalar scalar = info(type).scalar;
    for (int i = 0; i < componentCount(type); i++)
        out.push_back(scalar == Scalar::Float ? std::bit_cast<std::uint32_t>(v.numbers[static_cast<std::size_t>(i)])
                                              : static_cast<std::uint32_t>(v.integer));
    return out;
}

std::vector<std::uint32_t> wordsOf(Type type, std::string_view text) {
    if (text.empty()) return std::vector<std::uint32_t>(static_cast<std::size_t>(componentCount(type)));
    std::optional<doc::Value> v = parse(type, text, nullptr);
    return v ? words(type, *v) : std::vector<std::uint32_t>();
}

ExprId constantOf(Builder& b, Type type, std::string_view text, std::string* problem) {
    if (type == Type::String) return b.string(b.module().names->intern(text));
    if (componentCount(type) == 0 || text.empty()) return b.null(type);
    std::optional<doc::Value> v = parse(type, text, problem);
    return v ? b.constant(type, words(type, *v)) : ExprId();
}

}  // namespace shaderx::graph
