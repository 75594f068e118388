#include "compile/reflection.h"

#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "base/numbers.h"
#include "compile/json.h"
#include "graph/values.h"

namespace shaderx {

using namespace ir;

namespace {

bool holds(const std::vector<Context>& list, Context c) { return std::find(list.begin(), list.end(), c) != list.end(); }

// The attributes that say how a value is shown.
struct UiAttributes {
    explicit UiAttributes(NameTable& n)
        : name(n.find("uiname")),
          folder(n.find("uifolder")),
          min(n.find("uimin")),
          max(n.find("uimax")),
          softMin(n.find("uisoftmin")),
          softMax(n.find("uisoftmax")),
          step(n.find("uistep")),
          choices(n.find("enum")),
          choiceValues(n.find("enumvalues")),
          advanced(n.find("uiadvanced")),
          unit(n.find("unit")),
          unitType(n.find("unittype")),
          colorspace(n.find("colorspace")) {}
    Name name, folder, min, max, softMin, softMax, step, choices, choiceValues, advanced, unit, unitType, colorspace;
};

// How a texture is read is the business of whoever binds it: reflection says it with the sampler.
bool isSampling(std::string_view port) {
    return port == "uaddressmode" || port == "vaddressmode" || port == "filtertype";
}

struct Reflector {
    const ReflectionSource& from;
    Shader& shader;
    const doc::Document& d = from.document;
    UiAttributes attributes{d.names()};
    std::unordered_map<Name, std::size_t> firstOf{};  // of a uniform's readings in `authored`
    std::vector<bool> isRead{};                       // of `authored`, the first of a uniform

    void run() {
        shader.textures.reserve(from.interface.pixelUniforms.uniforms.size());
        for (std::size_t i = 0; i < from.authored.size(); i++)
            if (Name uniform = from.authored[i].uniform) firstOf.emplace(uniform, i);
        isRead.resize(from.authored.size());
        predefined();
        for (Name name : from.interface.pixelUniforms.uniforms)
            if (const Uniform* u = from.module.uniform(name)) u->type == Type::Texture2D ? texture(*u) : live(*u);
        if (from.interface.usesBlocks) blocks();
        if (from.interface.bindingBase >= 0) number();
        regenerated();
        idle();
        for (const passes::VertexInput& in : from.interface.inputs)
            shader.inputs.push_back({from.spelled.at(in.name), in.type, in.value});
    }

    void predefined() {
        const passes::StageUniforms &vertex = from.interface.vertexUniforms, &pixel = from.interface.pixelUniforms;
        shader.uniforms.reserve(vertex.contexts.size() + pixel.contexts.size() + pixel.uniforms.size());
        for (int i = 0; i < kContexts; i++) {
            Context c = static_cast<Context>(i);
            bool inVertex = holds(vertex.contexts, c), inPixel = holds(pixel.contexts, c);
            if (!inVertex && !inPixel) continue;
            UniformBinding& u = shader.uniforms.emplace_back();
            u.name = info(c).host;
            u.type = info(c).type;
            u.semantic = info(c).name;
            u.value = passes::defaultOf(c);
            u.isVertex = inVertex;
            u.isPixel = inPixel;
        }
    }

    // Contexts come before values, in the list as in the blocks.
    void blocks() {
        for (bool isPrivate : {true, false}) {
            BlockBinding block;
            block.name = isPrivate ? "PrivateUniforms" : "PublicUniforms";
            for (UniformBinding& u : shader.uniforms) {
                if (u.type == Type::Texture2D || u.semantic.empty() == isPrivate) continue;
                u.block = static_cast<int>(shader.blocks.size());
                u.offset = passes::placeMember(u.type, block.size);
                block.isVertex = block.isVertex || u.isVertex;
                block.isPixel = block.isPixel || u.isPixel;
            }
            if (!block.size) continue;
            block.size = (block.size + 15) / 16 * 16;
            shader.blocks.push_back(std::move(block));
        }
    }

    // Blocks, then textures, in the order of the text.
    void number() {
        int next = from.interface.bindingBase;
        for (BlockBinding& block : shader.blocks) block.binding = next++;
        for (UniformBinding& u : shader.uniforms)
            if (u.type == Type::Texture2D) u.binding = next++;
        for (TextureBinding& t : shader.textures) t.binding = next++;
    }

    void live(const Uniform& from_) {
        UniformBinding& u = shader.uniforms.emplace_back();
        u.name = from.spelled.at(from_.name);
        u.type = from_.type;
        u.value = from_.values;
        u.path = from_.path;
        u.isPixel = true;
        describe(from_.name, u.name, u);
    }

    void texture(const Uniform& u) {
        TextureBinding& t = shader.textures.emplace_back();
        t.uniform = from.spelled.at(u.name);
        t.file = u.file;
        t.uAddress = u.uAddress;
        t.vAddress = u.vAddress;
        t.filter = u.filter;
        t.defaultColor = u.defaultColor;
        t.path = u.path;
        t.colorspace = u.colorspace;
        describe(u.name, t.uniform, t);
    }

    // What the document and the nodedef say of a uniform's value; names that MaterialX gives it.
    void describe(Name uniform, const std::string& spelled, ValueDescription& to) {
        auto first = firstOf.find(uniform);
        if (first == firstOf.end()) return;
        const graph::Authored& a = from.authored[first->second];
        isRead[first->second] = true;
        describe(a, to);
        if (!a.element || d[a.element].parent == a.reader) {
            alias(a, spelled, to);
        } else {
            for (std::size_t i = first->second; i < from.authored.size(); i++)
                if (from.authored[i].uniform == uniform) alias(from.authored[i], spelled, to);
        }
    }

    void alias(const graph::Authored& a, const std::string& spelled, ValueDescription& to) {
        std::string name(d.text(d[a.reader].name));
        name.append(1, '_').append(d.text(a.port->name));
        if (name != spelled) to.aliases.push_back(std::move(name));
    }

    // The nodedef's attributes, in place of them those of the document's own element.
    void describe(const graph::Authored& a, ValueDescription& to) {
        doc::ElementRef port = from.definitions.element(a.def, *a.port);
        for (const doc::Attribute& x : port.document->attributes(port.id)) describe(x, to);
        if (!a.element) return;
        for (const doc::Attribute& x : d.attributes(a.element)) describe(x, to);
    }

    void describe(const doc::Attribute& x, ValueDescription& to) {
        if (x.name == d.known().name || x.name == d.known().type || x.name == d.known().value) return;
        const UiAttributes& k = attributes;
        UiHints& ui = to.ui;
        const std::pair<Name, std::string*> texts[] = {
            {k.name, &ui.name}, {k.folder, &ui.folder},     {k.min, &ui.min},
            {k.max, &ui.max},   {k.softMin, &ui.softMin},   {k.softMax, &ui.softMax},
            {k.step, &ui.step}, {k.choices, &ui.choices},   {k.choiceValues, &ui.choiceValues},
            {k.unit, &to.unit}, {k.unitType, &to.unitType}, {k.colorspace, &to.colorspace},
        };
        for (const auto& [name, text] : texts)
            if (x.name == name) *text = d.text(x.value);
        if (x.name == k.advanced) ui.isAdvanced = d.text(x.value) == "true";
    }

    // Values of the program itself, each once however many nodes read it.
    void regenerated() {
        std::unordered_set<doc::ElementId> seen;
        for (const graph::Authored& a : from.authored) {
            if (a.uniform && !from.baked.count(a.uniform)) continue;
            if (!a.element || isSampling(d.text(a.port->name)) || !seen.insert(a.element).second) continue;
            FixedValue& v = shader.regenerate.emplace_back();
            v.path = d.path(a.element);
            v.type = graph::typeOf(from.definitions, d.text(a.port->type));
            std::string_view text = d.attributeText(a.element, d.known().value);
            v.value = graph::wordsOf(v.type, text);
            if (v.value.empty()) v.text = text;
            describe(a, v);
        }
    }

    // Values that nothing reads, once the shader is what it is.
    void idle() {
        std::unordered_set<doc::ElementId> seen;
        for (const graph::Authored& a : from.authored)
            if (a.element && a.uniform && !from.baked.count(a.uniform) && !isRead[firstOf.at(a.uniform)] &&
                !isForHost(d.text(a.port->name)) && seen.insert(a.element).second)
                shader.withoutEffect.push_back(d.path(a.element));
    }
};

void writeValue(JsonWriter& json, Type type, std::span<const std::uint32_t> words) {
    auto number = [&](std::uint32_t w) {
        switch (info(type).scalar) {
            case Scalar::Boolean:
                return json.boolean(w != 0);
            case Scalar::Integer:
                return json.integer(static_cast<int>(w));
            case Scalar::Float:
                return json.number(std::bit_cast<float>(w));
            case Scalar::None:
                return json.null();
        }
    };
    if (words.size() == 1) return number(words[0]);
    json.openShortArray();
    for (std::uint32_t w : words) number(w);
    json.closeArray();
}

// Numbers as they are written, a list of them where there is a comma; a text that is none stays one.
void writeRange(JsonWriter& json, std::string_view name, std::string_view text) {
    if (text.empty()) return;
    std::vector<float> numbers;
    for (std::size_t at = 0; at <= text.size();) {
        std::size_t end = std::min(text.find(',', at), text.size());
        std::optional<float> number = parseFloat(text.substr(at, end - at));
        if (!number) return json.member(name, text);
        numbers.push_back(*number);
        at = end + 1;
    }
    json.key(name);
    if (numbers.size() == 1) return json.number(numbers[0]);
    json.openShortArray();
    for (float n : numbers) json.number(n);
    json.closeArray();
}

void writeList(JsonWriter& json, std::string_view name, std::string_view text) {
    if (text.empty()) return;
    json.key(name);
    json.openShortArray();
    for (std::size_t at = 0; at <= text.size();) {
        std::size_t end = std::min(text.find(',', at), text.size());
        json.text(trim(text.substr(at, end - at)));
        at = end + 1;
    }
    json.closeArray();
}

void writeDescription(JsonWriter& json, const ValueDescription& v) {
    json.member("colorspace", v.colorspace);
    json.member("unit", v.unit);
    json.member("unittype", v.unitType);
    if (!v.aliases.empty()) {
        json.key("aliases");
        json.openShortArray();
        for (const std::string& alias : v.aliases) json.text(alias);
        json.closeArray();
    }
    json.member("uiname", v.ui.name);
    json.member("uifolder", v.ui.folder);
    writeRange(json, "uimin", v.ui.min);
    writeRange(json, "uimax", v.ui.max);
    writeRange(json, "uisoftmin", v.ui.softMin);
    writeRange(json, "uisoftmax", v.ui.softMax);
    writeRange(json, "uistep", v.ui.step);
    writeList(json, "enum", v.ui.choices);
    writeList(json, "enumvalues", v.ui.choiceValues);
    if (v.ui.isAdvanced) {
        json.key("uiadvanced");
        json.boolean(true);
    }
}

void writeStages(JsonWriter& json, bool vertex, bool pixel) {
    json.key("stages");
    json.openShortArray();
    if (vertex) json.text("vertex");
    if (pixel) json.text("pixel");
    json.closeArray();
}

void writeBinding(JsonWriter& json, int binding) {
    if (binding < 0) return;
    json.key("binding");
    json.integer(binding);
}

void writeBlock(JsonWriter& json, const BlockBinding& b) {
    json.openShortObject();
    json.member("name", b.name);
    json.member("layout", "std140");
    json.key("size");
    json.integer(b.size);
    writeBinding(json, b.binding);
    writeStages(json, b.isVertex, b.isPixel);
    json.closeObject();
}

void writeUniform(JsonWriter& json, const UniformBinding& u, const std::vector<BlockBinding>& blocks) {
    json.openShortObject();
    json.member("name", u.name);
    json.member("type", info(u.type).name);
    json.key("value");
    writeValue(json, u.type, u.value);
    json.member("kind", u.semantic.empty() ? "live" : "predefined");
    json.member("semantic", u.semantic);
    json.member("path", u.path);
    writeStages(json, u.isVertex, u.isPixel);
    if (u.block >= 0) {
        json.member("block", blocks[static_cast<std::size_t>(u.block)].name);
        json.key("offset");
        json.integer(u.offset);
    }
    writeDescription(json, u);
    json.closeObject();
}

void writeTexture(JsonWriter& json, const TextureBinding& t) {
    json.openShortObject();
    json.member("name", t.uniform);
    json.member("kind", "texture");
    json.member("path", t.path);
    json.key("file");
    json.text(t.file);
    json.member("uaddressmode", t.uAddress);
    json.member("vaddressmode", t.vAddress);
    json.member("filtertype", t.filter);
    if (!t.defaultColor.empty()) {
        json.key("default");
        json.openShortArray();
        for (float c : t.defaultColor) json.number(c);
        json.closeArray();
    }
    writeBinding(json, t.binding);
    writeDescription(json, t);
    json.closeObject();
}

void writeFixed(JsonWriter& json, const FixedValue& v) {
    json.openShortObject();
    json.member("path", v.path);
    json.member("type", info(v.type).name);
    json.key("value");
    v.value.empty() ? json.text(v.text) : writeValue(json, v.type, v.value);
    writeDescription(json, v);
    json.closeObject();
}

}  // namespace

bool isForHost(std::string_view port) { return isSampling(port) || port == "default"; }

void reflect(const ReflectionSource& from, Shader& shader) { Reflector{from, shader}.run(); }

std::string Shader::reflection() const {
    JsonWriter json;
    auto list = [&](std::string_view name, auto&& write) {
        json.key(name);
        json.openArray();
        write();
        json.closeArray();
    };
    json.openObject();
    json.member("element", element);
    json.key("topology");
    json.text(fmt::format("{:016x}", topology));
    json.key("output");
    json.openShortObject();
    json.member("name", output);
    json.member("type", "vector4");
    json.closeObject();
    list("uniforms", [&] {
        for (const UniformBinding& u : uniforms)
            if (u.type != Type::Texture2D) writeUniform(json, u, blocks);
    });
    list("blocks", [&] {
        for (const BlockBinding& b : blocks) writeBlock(json, b);
    });
    list("regenerate", [&] {
        for (const FixedValue& v : regenerate) writeFixed(json, v);
    });
    list("withoutEffect", [&] {
        for (const std::string& path : withoutEffect) json.text(path);
    });
    list("samplers", [&] {
        // The maps of the environment close around it, from pole to pole.
        for (const UniformBinding& u : uniforms)
            if (u.type == Type::Texture2D) {
                json.openShortObject();
                json.member("name", u.name);
                json.member("kind", "predefined");
                json.member("semantic", u.semantic);
                json.member("uaddressmode", "periodic");
                json.member("vaddressmode", "clamp");
                json.member("filtertype", "linear");
                writeBinding(json, u.binding);
                json.closeObject();
            }
        for (const TextureBinding& t : textures) writeTexture(json, t);
    });
    list("inputs", [&] {
        for (const VertexInputBinding& in : inputs) {
            json.openShortObject();
            json.member("name", in.name);
            json.member("type", info(in.type).name);
            if (!in.value.empty()) {
                json.key("default");
                writeValue(json, in.type, in.value);
            }
            json.member("semantic", std::string_view(in.name).substr(std::min<std::size_t>(2, in.name.size())));
            json.closeObject();
        }
    });
    json.closeObject();
    return json.take();
}

// Eight bytes a step; the last ones are filled up with zeros.
std::uint64_t stableHash(std::string_view text, std::uint64_t seed) {
    std::uint64_t h = seed ^ (text.size() * 0x9e3779b97f4a7c15u);
    for (; text.size() >= 8; text.remove_prefix(8)) h = mixHash(h, loadText<std::uint64_t>(text.data()));
    std::uint64_t rest = 0;
    for (std::size_t k = 0; k < text.size(); k++) rest |= std::uint64_t(static_cast<unsigned char>(text[k])) << 8 * k;
    return mixHash(h, rest);
}

}  // namespace shaderx
