#include "graph/lower.h"

#include <bit>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "graph/values.h"

namespace shaderx::graph {

using namespace ir;

namespace {

struct Lowerer {
    const Graph& graph;
    const doc::Definitions& definitions;
    Bodies& bodies;
    doc::NodeDef implemented;
    const LowerOptions& options;
    Module& module;
    Diagnostics& diagnostics;
    const doc::Document& d = *graph.document;
    Function fresh{};
    Builder b{module, fresh};
    std::vector<std::vector<ExprId>> results = std::vector<std::vector<ExprId>>(graph.nodes.size());
    std::unordered_map<Name, ExprId> geometric{};
    std::unordered_map<doc::ElementId, Name> uniformOf{};
    Name colorspace = d.names().intern("colorspace"), fileprefix = d.names().intern("fileprefix");
    Name uniformWord = d.names().intern("uniform"), unit = d.names().intern("unit");
    std::unordered_set<Name> failed{};  // nodedefs without a function
    bool ok = true;

    bool run(Name name) {
        fresh.name = name;
        if (implemented) {
            fresh.isInline = true;
            for (const doc::Port& p : definitions.inputs(implemented))
                fresh.params.push_back({p.name, typeNamed(d.text(p.type))});
        }
        for (std::uint32_t i = 0; i < graph.nodes.size(); i++) node(i);
        if (!ok) return false;
        for (const Output& o : graph.outputs) {
            ExprId value = fitted(valueOf(o.source, o.type, nullptr, nullptr), o.source, o.type, o.element);
            if (!value) value = b.null(o.type);
            b.addResult(o.name, value);
        }
        if (!ok) return false;
        compact(fresh);
        module.put(std::move(fresh));
        return true;
    }

    Diagnostic& error(doc::ElementId at, std::string_view code, std::string message) {
        ok = false;
        Diagnostic& e = diagnostics.error(code, std::move(message));
        e.where = d.locate(at);
        e.path = d.path(at);
        return e;
    }

    void node(std::uint32_t i) {
        const Node& n = graph.nodes[i];
        if (options.traces) fresh.beginOrigin(d.names().intern(d.path(n.element)));
        auto outputs = definitions.outputs(n.def);
        std::vector<ExprId> arguments;
        Name fileSpace, fileUnit;
        const Input* file = nullptr;
        for (const Input& input : graph.inputsOf(n)) {
            ExprId value = valueOf(input.source, input.type, &input, &n);
            if (value && b.type(value) != input.type) value = fitted(value, input.source, input.type, portOf(input, n));
            if (!value && input.source.kind == Source::Kind::Interface)
                noParameter(input.source.input, portOf(input, n));
            if (!value) value = b.null(input.type);
            if (input.type == Type::Texture2D && input.source.kind == Source::Kind::Value) {
                file = &input;
                fileSpace = d.inherited(input.source.element, colorspace);
                fileUnit = d.attribute(input.source.element, unit);
            }
            arguments.push_back(value);
        }
        std::size_t errors = diagnostics.errorCount();
        Name defName = definitions.row(n.def).name;
        Name function = failed.count(defName) ? Name() : bodies.functionOf(n.def, diagnostics);
        if (!function) {
            bool isFirst = failed.insert(defName).second;  // what is wrong with a definition is said once
            if (isFirst && diagnostics.errorCount() == errors)
                error(n.element, "no-implementation",
                      fmt::format("nothing implements '{}' ({})", d.text(d[n.element].category),
                                  d.text(definitions.row(n.def).name)));
            ok = false;
        }
        std::vector<ExprId>& made = results[i];
        if (!function) {
            for (const doc::Port& o : outputs) made.push_back(b.null(typeNamed(d.text(o.type))));
            return;
        }
        call(function, arguments, outputs, made);
        for (std::size_t k = 0; k < made.size(); k++) {
            Type type = b.type(made[k]);
            if (fileSpace && (type == Type::Color3 || type == Type::Color4))
                made[k] = transformed(made[k], fileSpace, n.element);
            if (fileUnit) made[k] = inUnits(made[k], fileUnit, file->source.element, file, &n);
            std::string_view nodeName = d.text(d[n.element].name);
            b.hint(made[k], made.size() == 1
                                ? d[n.element].name
                                : d.names().intern(fmt::format("{}_{}", nodeName, d.text(outputs[k].name))));
        }
    }

    void call(Name function, std::span<const ExprId> arguments, std::span<const doc::Port> outputs,
              std::vector<ExprId>& made) {
        if (outputs.size() == 1) {
            made.push_back(b.call(function, typeNamed(d.text(outputs[0].type)), arguments));
            return;
        }
        ExprId tuple = b.call(function, Type::Tuple, arguments);
        for (std::uint32_t k = 0; k < outputs.size(); k++)
            made.push_back(b.result(tuple, k, typeNamed(d.text(outputs[k].type))));
    }

    // The value of an input (`input` is null for outputs of the graph), or none where it has none of its own.
    ExprId valueOf(const Source& s, Type type, const Input* input, const Node* owner) {
        switch (s.kind) {
            case Source::Kind::Node:
                return results[s.node.index][s.output];
            case Source::Kind::Interface:
                return parameter(s.input);
            case Source::Kind::Value:
                if (input && isGeometric(s, *input, *owner)) return defaultOf(*input, *owner);
                return written(s.element, type, input, owner);
            case Source::Kind::Default:
                return input ? defaultOf(*input, *owner) : ExprId();
        }
        return {};
    }

    // An input that stands for a geometric property is that property unless it is connected. Documents write what is no
    // place or direction of a mesh there, such as 0 or a normal in tangent space, and are drawn by others without it.
    bool isGeometric(const Source& s, const Input& input, const Node& owner) {
        Name property = definitions.element(owner.def, *input.port).attribute(d.known().defaultgeomprop);
        if (!property || d[s.element].parent != owner.element) return false;
        Diagnostic& w = diagnostics.warning(
            "ignored-value",
            fmt::format("the value of '{}' is not read: unless connected, it is the geometric property {}",
                        d.text(d[s.element].name), d.text(property)));
        w.where = d.locate(s.element, d.known().value);
        w.path = d.path(s.element);
        return true;
    }

    // Where the document connects an input.
    doc::ElementId portOf(const Input& input, const Node& owner) const {
        doc::ElementId port = d.child(owner.element, d.known().input, input.port->name);
        return port ? port : owner.element;
    }

    // A connection between types that differ only in how they are read. An output without a type is what it gets.
    ExprId fitted(ExprId value, const Source& s, Type type, doc::ElementId port) {
        if (!value || b.type(value) == type) return value;
        if (type == Type::Void && d.attributeText(port, d.known().type).empty()) return value;
        ExprId converted = type == Type::Void || b.type(value) == Type::Void ? ExprId() : b.convert(value, type);
        if (converted) return converted;
        Name from = s.kind == Source::Kind::Node ? d[graph.nodes[s.node.index].element].name : s.input;
        error(port, "type-mismatch",
              fmt::format("'{}' is {}, but '{}' gives {}", d.text(d[port].name), info(type).name, d.text(from),
                          info(b.type(value)).name));
        return {};
    }

    ExprId parameter(Name name) {
        for (std::uint32_t i = 0; i < fresh.params.size(); i++)
            if (fresh.params[i].name == name) return b.param(i);
        return {};
    }

    void noParameter(Name name, doc::ElementId port) {
        error(port, "dangling-interfacename",
              fmt::format("'{}' has no input '{}'", d.text(definitions.row(implemented).name), d.text(name)));
    }

    ExprId written(doc::ElementId element, Type type, const Input* input, const Node* owner) {
        if (type == Type::Texture2D) return texture(element, input, owner);
        const Name given = d.attribute(element, d.known().value);
        std::string problem = "there is none";
        ExprId value;
        if (!given || !d.text(given).empty() || componentCount(type) == 0)
            value = constantOf(b, type, d.text(given), &problem);
        if (!value) {
            error(element, "bad-value", fmt::format("bad value of type {}: {}", info(type).name, problem));
            return {};
        }
        bool live = isLive(type, input, owner);
        if (live) value = uniform(element, type);
        if (options.interface != Interface::Baked) record(live ? uniformOf[element] : Name(), element, input, owner);
        if (type == Type::Color3 || type == Type::Color4)
            if (Name space = d.attribute(element, colorspace)) value = transformed(value, space, element);
        if (Name from = d.attribute(element, unit)) value = inUnits(value, from, element, input, owner);
        return value;
    }

    void record(Name uniform, doc::ElementId element, const Input* input, const Node* reader) {
        if (options.authored && input)
            options.authored->push_back({uniform, element, reader->element, reader->def, input->port});
    }

    // Values that may change without a new shader: numbers, but for counts and choices that a nodedef says are fixed.
    // A complete interface leaves nothing out.
    bool isLive(Type type, const Input* input, const Node* owner) const {
        if (options.interface == Interface::Baked || implemented || componentCount(type) == 0) return false;
        if (options.interface == Interface::Complete || !input || info(type).scalar == Scalar::Float) return true;
        return definitions.element(owner->def, *input->port).attributeText(uniformWord) != "true";
    }

    Name uniformName(doc::ElementId element) {
        doc::ElementId owner = d[element].parent;
        std::string text = fmt::format("{}_{}", d.text(d[owner].name), d.text(d[element].name));
        if (!d[owner].name) text = d.text(d[element].name);
        return freeName(text);
    }

    // Names of two nodes in two graphs may be one; the later is numbered.
    Name freeName(const std::string& text) {
        Name name = d.names().intern(text);
        for (int i = 2; !bodies.takeName(name); i++) name = d.names().intern(fmt::format("{}{}", text, i));
        return name;
    }

    Uniform& addUniform(doc::ElementId element, Type type) {
        Uniform u;
        u.name = uniformName(element);
        u.type = type;
        u.path = d.path(element);
        u.values = wordsOf(type, d.attributeText(element, d.known().value));
        uniformOf[element] = u.name;
        return module.uniforms.emplace_back(std::move(u));
    }

    // One uniform for an element, however many nodes read it.
    ExprId uniform(doc::ElementId element, Type type) {
        if (auto it = uniformOf.find(element); it != uniformOf.end()) return b.uniform(it->second, type);
        return b.uniform(addUniform(element, type).name, type);
    }

    ExprId texture(doc::ElementId element, const Input* input, const Node* reader) {
        auto it = uniformOf.find(element);
        if (it == uniformOf.end()) it = uniformOf.emplace(element, newTexture(element, reader)).first;
        record(it->second, element, input, reader);
        return b.uniform(it->second, Type::Texture2D);
    }

    Name newTexture(doc::ElementId element, const Node* reader) {
        Uniform& u = addUniform(element, Type::Texture2D);
        std::string_view prefix = d.text(d.inherited(element, fileprefix));
        u.file = std::string(prefix) + std::string(d.attributeText(element, d.known().value));
        u.colorspace = d.text(d.inherited(element, colorspace));
        if (reader) readHints(u, *reader);
        return u.name;
    }

    // How the node that reads the texture wants it read.
    void readHints(Uniform& u, const Node& n) {
        for (const Input& i : graph.inputsOf(n)) {
            std::string_view name = d.text(i.port->name);
            std::string value(i.source.kind == Source::Kind::Value
                                  ? d.attributeText(i.source.element, d.known().value)
                                  : definitions.element(n.def, *i.port).attributeText(d.known().value));
            if (value.empty()) continue;
            if (name == "uaddressmode") u.uAddress = value;
            if (name == "vaddressmode") u.vAddress = value;
            if (name == "filtertype") u.filter = value;
            if (name == "default")
                for (std::uint32_t w : wordsOf(i.type, value)) u.defaultColor.push_back(std::bit_cast<float>(w));
        }
    }

    ExprId transformed(ExprId value, Name space, doc::ElementId at) {
        std::string_view from = d.text(space), to = options.targetColorSpace;
        if (from.empty() || from == to || from == "none" || from == "raw" || from == "data") return value;
        doc::NodeDef def = bodies.colorTransform(from, to, b.type(value));
        if (!def) {
            Diagnostic& w =
                diagnostics.warning("unknown-colorspace", fmt::format("no transform from colour space '{}' to '{}'; "
                                                                      "the value is used as it is",
                                                                      from, to));
            w.where = d.locate(at);
            w.path = d.path(at);
            return value;
        }
        Name function = bodies.functionOf(def, diagnostics);
        if (!function) return value;
        Type type = b.type(value);
        return b.call(function, type, std::span<const ExprId>(&value, 1));
    }

    // A value that the document gives in a unit, in that of the scene.
    ExprId inUnits(ExprId value, Name given, doc::ElementId at, const Input* input, const Node* owner) {
        Name word = d.names().intern("unittype");
        std::string_view type = d.attributeText(at, word), from = d.text(given);
        if (type.empty() && input) type = definitions.element(owner->def, *input->port).attributeText(word);
        std::string_view to = type == "distance" ? options.distanceUnit : type == "angle" ? options.angleUnit : from;
        if (from == to || info(b.type(value)).scalar != Scalar::Float) return value;
        float scale = bodies.unitScale(type, from), target = bodies.unitScale(type, to);
        if (scale > 0 && target > 0) return b.op(Op::Mul, {value, b.number(scale / target)});
        Diagnostic& w = diagnostics.warning(
            "unknown-unit",
            fmt::format("there is no unit '{}' of the type '{}'; the value is used as it is", from, type));
        w.where = d.locate(at, unit);
        w.path = d.path(at);
        return value;
    }

    // What an input is where nothing is written: a geometric property, or the nodedef's value.
    ExprId defaultOf(const Input& input, const Node& owner) {
        doc::ElementRef element = definitions.element(owner.def, *input.port);
        if (Name property = element.attribute(d.known().defaultgeomprop)) {
            ExprId value = geometricValue(property, owner.element);
            return fitted(value, input.source, input.type, owner.element);
        }
        std::string_view value = element.attributeText(d.known().value);
        bool isComplete = options.interface == Interface::Complete && !implemented;
        if (input.type == Type::Texture2D || (isComplete && componentCount(input.type)))
            return unwritten(input, owner, value);
        return constantOf(b, input.type, value);
    }

    // A uniform for an input that the document does not write: the host may set it.
    ExprId unwritten(const Input& input, const Node& owner, std::string_view value) {
        std::string_view name = d.text(input.port->name);
        Uniform u;
        u.name = freeName(fmt::format("{}_{}", d.text(d[owner.element].name), name));
        u.type = input.type;
        u.path = fmt::format("{}/{}", d.path(owner.element), name);
        if (u.type == Type::Texture2D)
            readHints(u, owner);
        else if (value.empty())
            u.values.assign(static_cast<std::size_t>(componentCount(u.type)), 0);
        else
            u.values = wordsOf(u.type, value);
        module.uniforms.push_back(u);
        record(u.name, {}, &input, &owner);
        return b.uniform(u.name, u.type);
    }

    ExprId geometricValue(Name property, doc::ElementId at) {
        if (auto it = geometric.find(property); it != geometric.end()) return it->second;
        doc::ElementRef prop = bodies.geometricProperty(property);
        if (!prop) {
            error(at, "unknown-geomprop", fmt::format("there is no geometric property '{}'", d.text(property)));
            return {};
        }
        Type type = typeNamed(prop.attributeText(d.known().type));
        doc::NodeDef def = bodies.nodeFor(prop.attributeText(d.names().intern("geomprop")), type);
        Name function = def ? bodies.functionOf(def, diagnostics) : Name();
        if (!function) {
            ok = false;
            return {};
        }
        std::vector<ExprId> arguments;
        for (const doc::Port& p : definitions.inputs(def)) {
            std::string_view text = prop.attributeText(p.name);
            if (text.empty()) text = definitions.element(def, p).attributeText(d.known().value);
            arguments.push_back(constantOf(b, typeNamed(d.text(p.type)), text));
        }
        ExprId value = b.call(function, type, arguments);
        return geometric[property] = value;
    }
};

}  // namespace

bool lower(const Graph& graph, const doc::Definitions& definitions, Bodies& bodies, doc::NodeDef implemented, Name name,
           const LowerOptions& options, Module& module, Diagnostics& diagnostics) {
    Lowerer l{graph, definitions, bodies, implemented, options, module, diagnostics};
    return l.run(name);
}

}  // namespace shaderx::graph
