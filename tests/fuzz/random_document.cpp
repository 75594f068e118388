#include "fuzz/random_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/names.h"
#include "compile/library.h"
#include "doc/definitions.h"
#include "doc/values.h"
#include "doc/write.h"

namespace shaderx::fuzz {

namespace {

constexpr std::string_view kTransform = "_to_lin_rec709";
constexpr std::array<std::string_view, 10> kValueTypes = {"float",   "color3",  "vector3", "color4",   "vector2",
                                                          "vector4", "boolean", "integer", "matrix33", "matrix44"};
constexpr std::array<std::string_view, 9> kClosureTypes = {
    "BSDF", "EDF", "VDF", "surfaceshader", "displacementshader", "volumeshader", "lightshader", "material", ""};

bool isClosure(std::string_view type) {
    return std::find(kClosureTypes.begin(), kClosureTypes.end(), type) != kClosureTypes.end();
}
bool isColor(std::string_view type) { return type == "color3" || type == "color4"; }

std::vector<std::string> splitAtCommas(std::string_view text) {
    const std::optional<doc::Value> list = doc::parseValue(doc::ValueType::StringArray, text);
    return list ? list->strings : std::vector<std::string>{};
}

// ---- The declarations ----

struct TableMaker {
    const doc::Definitions& definitions;
    NameTable& names;

    std::string text(Name n) const { return std::string(names.text(n)); }
    std::string attribute(doc::ElementRef e, std::string_view name) const {
        return std::string(e.attributeText(names.find(name)));
    }
    std::vector<float> numbers(doc::ElementRef e, std::string_view name, std::string_view soft,
                               std::string_view type) const {
        std::string value = attribute(e, name);
        if (value.empty()) value = attribute(e, soft);
        const std::optional<doc::ValueType> kind = doc::valueType(type);
        if (value.empty() || !kind) return {};
        const std::optional<doc::Value> parsed = doc::parseValue(*kind, value);
        if (!parsed) return {};
        return {parsed->numbers.begin(), parsed->numbers.begin() + doc::numberCount(*kind)};
    }

    Port port(doc::NodeDef def, const doc::Port& p) const {
        const doc::ElementRef e = definitions.element(def, p);
        Port out{text(p.name), text(p.type), attribute(e, "value"), {}, {}, {}, attribute(e, "unittype")};
        out.choices = splitAtCommas(attribute(e, "enumvalues"));
        if (out.choices.empty()) out.choices = splitAtCommas(attribute(e, "enum"));
        if (out.type != "string" && out.type != "integer") out.choices.clear();
        out.lowest = numbers(e, "uimin", "uisoftmin", out.type);
        out.highest = numbers(e, "uimax", "uisoftmax", out.type);
        out.isUniform = attribute(e, "uniform") == "true" || out.type == "string" || out.type == "filename";
        return out;
    }

    Signature signature(doc::NodeDef def) const {
        const doc::NodeDefRow& row = definitions.row(def);
        Signature s{text(row.category), text(row.name), "", {}, {}};
        if (row.version && !(row.flags & doc::NodeDefRow::DefaultVersion)) s.version = text(row.version);
        for (const doc::Port& p : definitions.inputs(def)) s.inputs.push_back(port(def, p));
        for (const doc::Port& p : definitions.outputs(def)) s.outputs.push_back(port(def, p));
        const std::string group = attribute(definitions.element(def), "nodegroup");
        s.isShading = group == "pbr" || group == "shader";
        return s;
    }
};

}  // namespace

// Hexagonal tiles take the fractions of products of some thousands as random numbers, which a driver that fuses
// multiplications with additions rounds to others.
static bool isOfItsDriver(std::string_view category) {
    return category == "hextiledimage" || category == "hextilednormalmap";
}

NodeTable::NodeTable(std::span<const std::uint8_t> libraryImage) {
    NameTable names(namesOf(libraryImage));
    const std::unique_ptr<Library> library = openLibrary(names, libraryImage);
    if (!library) return;
    doc::Definitions definitions;
    definitions.add(library->document(), library->index());
    const TableMaker maker{definitions, names};
    for (const doc::NodeDefRow& row : library->index().nodedefs) {
        const doc::NodeDef def = definitions.byName(row.name);
        if (!definitions.implementation(def) || isOfItsDriver(names.text(row.category))) continue;
        signatures_.push_back(maker.signature(def));
        const std::string& category = signatures_.back().category;
        if (category.ends_with(kTransform) && signatures_.back().outputs[0].type == "color3")
            colorspaces_.push_back(category.substr(0, category.size() - kTransform.size()));
    }
    for (const Signature& s : signatures_)
        for (const Port& p : s.outputs) {
            std::vector<const Signature*>& all = byType_[p.type][s.category];
            if (all.empty() || all.back() != &s) all.push_back(&s);
        }
}

namespace {

// ---- A document ----

struct Attribute {
    std::string name, value;
};
struct Element {
    std::string category;
    std::vector<Attribute> attributes;
    std::vector<Element> children;

    void write(std::string& out, int depth) const {
        out.append(static_cast<std::size_t>(depth) * 2, ' ').append("<").append(category);
        for (const Attribute& a : attributes) out += fmt::format(" {}=\"{}\"", a.name, a.value);
        if (children.empty()) {
            out += "/>\n";
            return;
        }
        out += ">\n";
        for (const Element& c : children) c.write(out, depth + 1);
        out.append(static_cast<std::size_t>(depth) * 2, ' ').append("</").append(category).append(">\n");
    }
};

// Something that an input may read, as the attributes that say so.
struct Source {
    std::string type;
    std::vector<Attribute> reads;
};

// The document's root or a nodegraph under way.
struct Scope {
    Element element;
    std::vector<Source> pool = {};
    std::vector<Element> interface = {};
    bool isGraph = false, isFunctional = false;
};

struct Maker {
    const NodeTable& table;
    passes::Dice dice;
    std::span<const std::string> pictures;
    std::vector<Scope> scopes = {};  // the innermost last
    std::vector<Element> declarations = {};
    std::vector<Signature> declared = {};
    int budget = 0, names = 0;

    std::uint32_t roll(std::uint32_t n) { return dice.roll(n); }
    bool oneIn(std::uint32_t n) { return roll(n) == 0; }
    template <class T>
    const T& oneOf(const std::vector<T>& all) {
        return all[roll(static_cast<std::uint32_t>(all.size()))];
    }
    Scope& scope() { return scopes.back(); }
    std::string name(std::string_view stem) { return fmt::format("{}{}", stem, ++names); }

    // ---- Values ----

    static std::string numberText(float v) { return fmt::format("{:.5g}", v); }

    float number(const Port& p, std::size_t i, bool isShading) {
        const bool isShare = isShading || isColor(p.type);
        const float low = i < p.lowest.size() ? p.lowest[i] : isShare ? 0.0f : -2.0f;
        const float high = i < p.highest.size() ? p.highest[i] : isShare ? std::max(1.0f, low + 1) : low + 4;
        switch (roll(8)) {
            case 0:
                return low;
            case 1:
                return high;
            case 2:
                return std::clamp(static_cast<float>(roll(2)), low, std::max(low, high));
            default:
                return low + (high - low) * static_cast<float>(roll(1001)) / 1000.0f;
        }
    }

    // None: what the declaration has.
    std::string value(const Port& p, bool isShading) {
        if (!p.choices.empty()) return oneOf(p.choices);
        if (p.type == "boolean") return oneIn(2) ? "true" : "false";
        if (p.type == "filename") return oneIn(8) ? "" : pictures[roll(static_cast<std::uint32_t>(pictures.size()))];
        if (p.type == "integer") {
            if (!p.lowest.empty() || !p.highest.empty()) {
                const int low = p.lowest.empty() ? 0 : static_cast<int>(p.lowest[0]);
                const int high = p.highest.empty() ? low + 10 : static_cast<int>(p.highest[0]);
                return fmt::format("{}", low + static_cast<int>(roll(static_cast<std::uint32_t>(high - low + 1))));
            }
            return fmt::format("{}", static_cast<int>(roll(6)) - (oneIn(4) ? 2 : 0));
        }
        const std::optional<doc::ValueType> kind = doc::valueType(p.type);
        if (!kind || doc::numberCount(*kind) == 0) return p.value;
        const std::size_t count = doc::numberCount(*kind);
        std::string out;
        const bool same = count > 1 && oneIn(6);
        const float first = number(p, 0, isShading);
        for (std::size_t i = 0; i < count; i++) {
            const float v = i == 0 || same ? first : number(p, i, isShading);
            out += (i ? ", " : "") + numberText(v);
        }
        return out;
    }

    // Directions, whose length must be 1: left as they are, or normalised.
    static bool isFrame(const Port& p) {
        return p.type == "vector3" && (p.name.ends_with("normal") || p.name.ends_with("tangent"));
    }
    std::optional<Source> direction(int depth) {
        const auto vectors = table.byType().find("vector3");
        if (vectors == table.byType().end()) return {};
        const auto normalize = vectors->second.find("normalize");
        if (normalize == vectors->second.end()) return {};
        return instance(*normalize->second[0], "vector3", depth);
    }

    // ---- Sources ----

    Element input(const Port& p) { return {"input", {{"name", p.name}, {"type", p.type}}, {}}; }

    void giveValue(Element& in, const Port& p, bool isShading) {
        in.attributes.push_back({"value", value(p, isShading)});
        if ((isColor(p.type) || p.type == "filename") && oneIn(6) && !table.colorspaces().empty())
            in.attributes.push_back({"colorspace", oneOf(table.colorspaces())});
        if (p.unittype == "angle" && oneIn(3)) in.attributes.push_back({"unit", oneIn(2) ? "degree" : "radian"});
        if (p.unittype == "distance" && oneIn(3))
            in.attributes.push_back({"unit", oneIn(2) ? "centimeter" : "nanometer"});
    }

    std::optional<Source> pooled(const std::string& type) {
        std::vector<const Source*> fitting;
        for (const Source& s : scope().pool)
            if (s.type == type) fitting.push_back(&s);
        if (fitting.empty()) return {};
        return *fitting[roll(static_cast<std::uint32_t>(fitting.size()))];
    }

    // A port of the graph around: one that is there or a new one.
    Source interfaceSource(const Port& p, bool isShading) {
        std::vector<const Element*> fitting;
        for (const Element& e : scope().interface)
            if (e.attributes[1].value == p.type) fitting.push_back(&e);
        if (!fitting.empty() && oneIn(2)) {
            const Element& e = *fitting[roll(static_cast<std::uint32_t>(fitting.size()))];
            return {p.type, {{"interfacename", e.attributes[0].value}}};
        }
        Port own = p;
        own.name = name("port");
        Element e = input(own);
        giveValue(e, own, isShading);
        scope().interface.push_back(e);
        return {p.type, {{"interfacename", own.name}}};
    }

    // A node that gives the type, with all that it reads; none where no node does.
    std::optional<Source> node(const std::string& type, int depth) {
        const auto found = table.byType().find(type);
        std::vector<const Signature*> mine;
        for (const Signature& s : declared)
            for (const Port& p : s.outputs)
                if (p.type == type) mine.push_back(&s);
        if (!mine.empty() && oneIn(6)) return instance(*oneOf(mine), type, depth);
        if (found == table.byType().end()) return {};
        auto category = found->second.begin();
        std::advance(category, roll(static_cast<std::uint32_t>(found->second.size())));
        return instance(*oneOf(category->second), type, depth);
    }

    Source instance(const Signature& s, const std::string& type, int depth) {
        budget--;
        Element e{s.category, {}, {}};
        const bool isMany = s.outputs.size() > 1;
        std::vector<Element> inputs;
        for (const Port& p : s.inputs) addInput(inputs, s, p, depth);
        const std::string own = name(s.category + "_");
        e.attributes = {{"name", own}, {"type", isMany ? "multioutput" : s.outputs[0].type}};
        if (!s.version.empty()) e.attributes.push_back({"version", s.version});
        // Signatures with other outputs may fit a node without inputs as well.
        if (oneIn(8) || (isMany && inputs.empty())) e.attributes.push_back({"nodedef", s.nodedef});
        e.children = std::move(inputs);
        scope().element.children.push_back(e);
        std::vector<Source> fitting;
        for (const Port& p : s.outputs) {
            Source source{p.type, {{"nodename", own}}};
            if (isMany) source.reads.push_back({"output", p.name});
            scope().pool.push_back(source);
            if (p.type == type) fitting.push_back(source);
        }
        return oneOf(fitting);
    }

    void addInput(std::vector<Element>& inputs, const Signature& s, const Port& p, int depth) {
        const bool isShading = s.isShading;
        Element in = input(p);
        if (isClosure(p.type)) {
            if (s.category != "surfacematerial" && s.category != "volumematerial" && oneIn(10)) return;
            if (const std::optional<Source> from = source(p.type, depth + 1)) {
                in.attributes.insert(in.attributes.end(), from->reads.begin(), from->reads.end());
                inputs.push_back(in);
            }
            return;
        }
        if (isFrame(p)) {
            if (budget <= 0 || !oneIn(4)) return;
            if (const std::optional<Source> from = direction(depth + 1)) {
                in.attributes.insert(in.attributes.end(), from->reads.begin(), from->reads.end());
                inputs.push_back(in);
            }
            return;
        }
        const bool mayRead = !p.isUniform && p.type != "filename" && p.type != "string";
        const std::uint32_t choice = roll(10);
        if (mayRead && choice < 4) {
            if (const std::optional<Source> from = source(p.type, depth + 1)) {
                in.attributes.insert(in.attributes.end(), from->reads.begin(), from->reads.end());
                inputs.push_back(in);
                return;
            }
        }
        if (choice < 6 && scope().isGraph && oneIn(2) && (!scope().isFunctional || mayRead)) {
            const Source from = interfaceSource(p, isShading);
            in.attributes.insert(in.attributes.end(), from.reads.begin(), from.reads.end());
            inputs.push_back(in);
        } else if (choice < 8) {
            giveValue(in, p, isShading);
            inputs.push_back(in);
        }
    }

    std::optional<Source> source(const std::string& type, int depth) {
        const bool isSpent = budget <= 0 || depth > 8;
        if (isSpent || oneIn(3))
            if (std::optional<Source> s = pooled(type)) return s;
        // A closure without leaves below it would be black.
        if (isSpent && (!isClosure(type) || depth > 12)) return {};
        if (!scope().isGraph && oneIn(6) && !isSpent) return graph(type, depth);
        return node(type, depth);
    }

    // A nodegraph of one to three outputs, the first of the type.
    std::optional<Source> graph(const std::string& type, int depth) {
        scopes.push_back({{"nodegraph", {}, {}}});
        scope().isGraph = true;
        std::vector<Element> outputs;
        std::vector<Source> sources;
        const std::string own = name("graph");
        for (std::uint32_t i = 0, n = 1 + (oneIn(3) ? roll(3) : 0); i < n; i++) {
            const std::string t = i == 0 ? type : std::string(kValueTypes[roll(kValueTypes.size())]);
            std::optional<Source> s = node(t, depth + 1);
            if (!s) continue;
            const std::string out = name("out");
            outputs.push_back({"output", {{"name", out}, {"type", t}}, {}});
            Element& e = outputs.back();
            e.attributes.insert(e.attributes.end(), s->reads.begin(), s->reads.end());
            sources.push_back({t, {{"nodegraph", own}, {"output", out}}});
        }
        Scope inner = std::move(scopes.back());
        scopes.pop_back();
        if (sources.empty() || sources[0].type != type) return {};
        Element e{"nodegraph", {{"name", own}}, {}};
        // Some ports of a graph are connected outside of it.
        for (Element& port : inner.interface) {
            const std::string& t = port.attributes[1].value;
            const bool mayRead = t != "string" && t != "filename";
            if (std::optional<Source> s =
                    mayRead && !isUsedAsUniform(inner, port) && oneIn(3) ? pooled(t) : std::nullopt) {
                port.attributes.resize(2);
                port.attributes.insert(port.attributes.end(), s->reads.begin(), s->reads.end());
            }
        }
        std::move(inner.interface.begin(), inner.interface.end(), std::back_inserter(e.children));
        std::move(inner.element.children.begin(), inner.element.children.end(), std::back_inserter(e.children));
        std::move(outputs.begin(), outputs.end(), std::back_inserter(e.children));
        scope().element.children.push_back(e);
        scope().pool.insert(scope().pool.end(), sources.begin(), sources.end());
        return sources[0];
    }

    // Whether an input that takes no connection reads the port.
    bool isUsedAsUniform(const Scope& graph, const Element& port) const {
        for (const Element& n : graph.element.children)
            for (const Element& in : n.children)
                for (const Attribute& a : in.attributes)
                    if (a.name == "interfacename" && a.value == port.attributes[0].value) {
                        const auto found = uniformInputs.find({n.category, in.attributes[0].value});
                        if (found != uniformInputs.end()) return true;
                    }
        return false;
    }

    // ---- A declared node of the document's own, with a graph that implements it ----

    void declare() {
        Signature s{name("custom"), name("ND_custom"), "", {}, {}};
        scopes.push_back({{"nodegraph", {}, {}}});
        scope().isGraph = scope().isFunctional = true;
        const int saved = std::exchange(budget, 1 + static_cast<int>(roll(5)));
        const std::string type(kValueTypes[roll(kValueTypes.size())]);
        const std::optional<Source> s1 = node(type, 4);
        budget = saved;
        Scope inner = std::move(scopes.back());
        scopes.pop_back();
        if (!s1) return;
        Element def{"nodedef", {{"name", s.nodedef}, {"node", s.category}}, {}};
        for (Element& port : inner.interface) {
            // What is declared has no colour space or unit of its own.
            std::erase_if(port.attributes,
                          [](const Attribute& a) { return a.name == "colorspace" || a.name == "unit"; });
            Port p{port.attributes[0].value, port.attributes[1].value, port.attributes[2].value, {}, {}, {}, {}};
            p.isUniform = p.type == "string" || p.type == "filename";
            s.inputs.push_back(p);
            def.children.push_back(port);
        }
        def.children.push_back({"output", {{"name", "out"}, {"type", type}}, {}});
        Element body{"nodegraph", {{"name", name("NG_custom")}, {"nodedef", s.nodedef}}, inner.element.children};
        Element out{"output", {{"name", "out"}, {"type", type}}, {}};
        out.attributes.insert(out.attributes.end(), s1->reads.begin(), s1->reads.end());
        body.children.push_back(out);
        s.outputs.push_back({"out", type, "", {}, {}, {}, {}});
        declarations.push_back(def);
        declarations.push_back(body);
        declared.push_back(s);
    }

    // ---- The whole ----

    void output(const std::string& type) {
        const std::optional<Source> s = source(type, 0);
        if (!s) return;
        Element e{"output", {{"name", name("result")}, {"type", type}}, {}};
        e.attributes.insert(e.attributes.end(), s->reads.begin(), s->reads.end());
        scope().element.children.push_back(e);
    }

    void fillUniformInputs() {
        for (const auto& [type, categories] : table.byType())
            for (const auto& [category, signatures] : categories)
                for (const Signature* s : signatures)
                    for (const Port& p : s->inputs)
                        if (p.isUniform) uniformInputs[{category, p.name}] = true;
    }
    std::map<std::pair<std::string, std::string>, bool> uniformInputs = {};

    std::string run() {
        fillUniformInputs();
        scopes.push_back({{"materialx", {{"version", "1.39"}}, {}}});
        declared.reserve(2);  // they are pointed at
        while (declared.size() < 2 && oneIn(6)) declare();
        budget = 3 + static_cast<int>(roll(10)) + (oneIn(5) ? static_cast<int>(roll(30)) : 0);
        switch (roll(8)) {
            case 0:
            case 1:
                output("material");
                break;
            case 2:
                output("surfaceshader");
                break;
            case 3:
                output(std::string(kClosureTypes[roll(6)]));
                break;
            default:
                for (std::uint32_t i = 0, n = 1 + roll(2); i < n; i++)
                    output(std::string(kValueTypes[roll(kValueTypes.size())]));
        }
        Element root = scopes[0].element;
        root.children.insert(root.children.begin(), declarations.begin(), declarations.end());
        std::string out = "<?xml version=\"1.0\"?>\n";
        root.write(out, 0);
        return out;
    }
};

}  // namespace

std::string randomDocument(const NodeTable& nodes, passes::Dice dice, std::span<const std::string> pictures) {
    return Maker{nodes, dice, pictures}.run();
}

}  // namespace shaderx::fuzz
