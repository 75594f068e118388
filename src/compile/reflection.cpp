#include "compile/reflection.h"

#include <bit>

#include <nlohmann/json.hpp>

namespace shaderx {

using Json = nlohmann::ordered_json;
using namespace ir;

static Json valueOf(Type type, const std::vector<std::uint32_t>& words) {
    auto number = [&](std::uint32_t w) -> Json {
        switch (info(type).scalar) {
            case Scalar::Boolean:
                return w != 0;
            case Scalar::Integer:
                return static_cast<int>(w);
            case Scalar::Float:
                return std::bit_cast<float>(w);
            case Scalar::None:
                break;
        }
        return nullptr;
    };
    if (words.size() == 1) return number(words[0]);
    Json values = Json::array();
    for (std::uint32_t w : words) values.push_back(number(w));
    return values;
}

static bool holds(const std::vector<Context>& list, Context c) {
    for (Context x : list)
        if (x == c) return true;
    return false;
}

static Json stagesOf(bool vertex, bool pixel) {
    Json stages = Json::array();
    if (vertex) stages.push_back("vertex");
    if (pixel) stages.push_back("pixel");
    return stages;
}

std::string reflect(const Module& module, const passes::ShaderInterface& interface, std::string_view element,
                    const std::unordered_map<Name, std::string>& spelled, std::string_view output) {
    Json uniforms = Json::array(), samplers = Json::array(), inputs = Json::array();
    auto text = [&](Name n) { return spelled.at(n); };
    for (int i = 0; i < kContexts; i++) {
        Context c = static_cast<Context>(i);
        bool vertex = holds(interface.vertexUniforms.contexts, c), pixel = holds(interface.pixelUniforms.contexts, c);
        if (!vertex && !pixel) continue;
        if (info(c).type == Type::Texture2D)
            samplers.push_back({{"name", info(c).host}, {"kind", "predefined"}});
        else
            uniforms.push_back({{"name", info(c).host},
                                {"type", info(info(c).type).name},
                                {"value", valueOf(info(c).type, passes::defaultOf(c))},
                                {"kind", "predefined"},
                                {"stages", stagesOf(vertex, pixel)}});
    }
    for (Name name : interface.pixelUniforms.uniforms)
        if (const Uniform* known = module.uniform(name)) {
            const Uniform& u = *known;
            if (u.type != Type::Texture2D) {
                uniforms.push_back({{"name", text(u.name)},
                                    {"type", info(u.type).name},
                                    {"value", valueOf(u.type, u.values)},
                                    {"kind", "live"},
                                    {"path", u.path},
                                    {"stages", stagesOf(false, true)}});
                continue;
            }
            Json s = {{"name", text(u.name)},  {"kind", "texture"},          {"path", u.path},
                      {"file", u.file},        {"uaddressmode", u.uAddress}, {"vaddressmode", u.vAddress},
                      {"filtertype", u.filter}};
            if (!u.colorspace.empty()) s["colorspace"] = u.colorspace;
            if (!u.defaultColor.empty()) s["default"] = u.defaultColor;
            samplers.push_back(std::move(s));
        }
    for (const passes::VertexInput& in : interface.inputs)
        inputs.push_back({{"name", text(in.name)}, {"type", info(in.type).name}});
    Json all = {{"element", std::string(element)},
                {"output", {{"name", std::string(output)}, {"type", "vector4"}}},
                {"uniforms", std::move(uniforms)},
                {"samplers", std::move(samplers)},
                {"inputs", std::move(inputs)}};
    return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace shaderx
