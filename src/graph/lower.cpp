#include "graph/lower.h"

#include <bit>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "graph/values.h"

namespace shaderx::graph {

using namespace ir;

namespace {

// What lowering knows of a kind of node once it has met one.
struct Kind {
    struct KindInput {
        Name property;  // the geometric property that it stands for, if any
        ExprId usual;   // the constant that is its default, once asked for
    };
    std::vector<KindInput> inputs;
    std::vector<Type> outputs;
    bool isMet = false, isAsked = false;
    Name function;  // once asked for; none where nothing implements it
};

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
    std::vector<ExprId> results{};             // of all nodes in turn, each with its outputs in order
    std::vector<std::uint32_t> firstResult{};  // by node
    std::vector<Kind> kinds = std::vector<Kind>(graph.kinds.size());
    std::vector<ExprId> operands{};  // of the node at hand
    std::unordered_map<Name, ExprId> geometric{};
    std::unordered_map<doc::ElementId, Name> uniformOf{};
    Name colorspace = d.names().intern("colorspace"), fileprefix = d.names().intern("fileprefix");
    // Inputs of nodes that read images.
    Name uaddressmode = d.names().intern("uaddressmode"), vaddressmode = d.names().intern("vaddressmode");
    Name filtertype = d.names().intern("filtertype"), defaultColor = d.names().intern("default");
    Name uniformWord = d.names().intern("uniform"), unit = d.names().intern("unit");
    std::unordered_set<Name> failed{};  // nodedefs without a function
    std::string wanted{};               // room to make a uniform's name in
    bool ok = true;

    bool run(Name name) {
        fresh.name = name;
        if (implemented) {
            fresh.isInline = true;
            for (const doc::Port& p : definitions.inputs(implemented))
                fresh.params.push_back({p.name, typeNamed(d.text(p.type))});
        }
        results.reserve(graph.nodes.size());
        firstResult.reserve(graph.nodes.size());
        constexpr std::size_t kUsual = 8;
        if (options.interface != Interface::Baked) module.uniforms.reserve(std::max(kUsual, graph.nodes.size()));
        for (const Node& n : graph.nodes) node(n);
        if (!ok) return false;
        for (const Output& o : graph.outputs) {
            ExprId value = fitted(valueOf(o.source, o.type, nullptr, nullptr), o.source, o.type, o.element);
            if (!value) value = b.null(o.type);
            b.addResult(o.name ? o.name : d.names().intern("out"), value);  // an element may lack its name
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

    void node(const Node& n) {
        if (options.traces) fresh.beginOrigin(d.names().intern(d.path(n.element)));
        firstResult.push_back(static_cast<std::uint32_t>(results.size()));
        operands.clear();
        meet(n);
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
            operands.push_back(value);
        }
        const Kind& kind = known(n);
        if (!kind.function) {
            ok = false;
            for (Type type : kind.outputs) results.push_back(b.null(type));
            return;
        }
        bool isSingle = kind.outputs.size() == 1;
        ExprId made = b.call(kind.function, isSingle ? kind.outputs[0] : Type::Tuple, operands);
        Name nodeName = d[n.element].name;
        for (std::uint32_t k = 0; k < kind.outputs.size(); k++) {
            Type type = kind.outputs[k];
            ExprId value = isSingle ? made : b.result(made, k, type);
            if (fileSpace && (type == Type::Color3 || type == Type::Color4))
                value = transformed(value, fileSpace, n.element);
            if (fileUnit) value = inUnits(value, fileUnit, file->source.element, file, &n);
            Name output = graph.kindOf(n).outputs[k].name;
            b.hint(value,
                   isSingle ? nodeName : d.names().intern(fmt::format("{}_{}", d.text(nodeName), d.text(output))));
            results.push_back(value);
        }
    }

    void meet(const Node& n) {
        Kind& kind = kinds[n.kind];
        if (kind.isMet) return;
        kind.isMet = true;
        const NodeKind& of = graph.kindOf(n);
        for (const doc::Port& o : of.outputs) kind.outputs.push_back(typeNamed(d.text(o.type)));
        for (const doc::Port& i : of.inputs)
            kind.inputs.push_back({definitions.element(of.def, i).attribute(d.known().defaultgeomprop), {}});
    }

    // The kind of a node; asks for its function at the first of that kind.
    const Kind& known(const Node& n) {
        Kind& kind = kinds[n.kind];
        if (kind.isAsked) return kind;
        kind.isAsked = true;
        const NodeKind& of = graph.kindOf(n);
        std::size_t errors = diagnostics.errorCount();
        Name defName = definitions.row(of.def).name;
        if (!failed.count(defName)) kind.function = bodies.functionOf(of.def, diagnostics);
        if (kind.function) return kind;
        bool isFirst = failed.insert(defName).second;  // what is wrong with a definition is said once
        if (isFirst && diagnostics.errorCount() == errors)
            error(n.element, "no-implementation",
                  fmt::format("nothing implements '{}' ({})", d.text(d[n.element].category), d.text(defName)));
        return kind;
    }

    // The value of an input (`input` is null for outputs of the graph), or none where it has none of its own.
    ExprId valueOf(const Source& s, Type type, const Input* input, const Node* owner) {
        switch (s.kind) {
            case Source::Kind::Node:
                return results[firstResult[s.node.index] + s.output];
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
        Name property = kindOf(input, owner).property;
        if (!property || d[s.element].parent != owner.element) return false;
        Diagnostic& w = diagnostics.warning(
            "ignored-value",
            fmt::format("the value of '{}' is not read: unless connected, it is the geometric property {}",
                        d.text(d[s.element].name), d.text(property)));
        w.where = d.locate(s.element, d.known().value);
        w.path = d.path(s.element);
        return true;
    }

    Kind::KindInput& kindOf(const Input& input, const Node& owner) {
        return kinds[owner.kind].inputs[static_cast<std::size_t>(&input - graph.inputsOf(owner).data())];
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
        const std::string_view text = d.text(given);
        Words words;
        ExprId value;
        Name live;
        if (componentCount(type) == 0) {
            value = constantOf(b, type, text);
        } else if ((given && text.empty()) || !readWords(type, text, words)) {
            std::string problem = "there is none";
            if (!text.empty()) readWords(type, text, words, &problem);
            error(element, "bad-value", fmt::format("bad value of type {}: {}", info(type).name, problem));
            return {};
        } else {
            if (isLive(type, input, owner)) live = uniform(element, type, words, owner);
            value = live ? b.uniform(live, type) : b.constant(type, words.all());
        }
        if (options.interface != Interface::Baked) record(live, element, input, owner);
        if (type == Type::Color3 || type == Type::Color4)
            if (Name space = d.attribute(element, colorspace)) value = transformed(value, space, element);
        if (Name from = d.attribute(element, unit)) value = inUnits(value, from, element, input, owner);
        return value;
    }

    void record(Name uniform, doc::ElementId element, const Input* input, const Node* reader) {
        if (options.authored && input)
            options.authored->push_back({uniform, element, reader->element, graph.kindOf(*reader).def, input->port});
    }

    // Values that may change without a new shader: numbers, but for counts and choices that a nodedef says are fixed.
    // A complete interface leaves nothing out.
    bool isLive(Type type, const Input* input, const Node* owner) const {
        if (options.interface == Interface::Baked || implemented || componentCount(type) == 0) return false;
        if (options.interface == Interface::Complete || !input || info(type).scalar == Scalar::Float) return true;
        return definitions.element(graph.kindOf(*owner).def, *input->port).attributeText(uniformWord) != "true";
    }

    Name uniformName(doc::ElementId element) {
        doc::ElementId owner = d[element].parent;
        wanted = d.text(d[owner].name);
        if (d[owner].name) wanted += '_';
        wanted += d.text(d[element].name);
        return freeName(wanted);
    }

    // Names of two nodes in two graphs may be one; the later is numbered.
    Name freeName(const std::string& text) {
        Name name = d.names().intern(text);
        for (int i = 2; !bodies.takeName(name); i++) name = d.names().intern(fmt::format("{}{}", text, i));
        return name;
    }

    Uniform& addUniform(doc::ElementId element, Type type) {
        Uniform& u = module.uniforms.emplace_back();
        u.name = uniformName(element);
        u.type = type;
        u.path = d.path(element);
        return u;
    }

    // One uniform for an element, however many nodes read it: that of a node's own input, only the node itself.
    Name uniform(doc::ElementId element, Type type, const Words& words, const Node* reader) {
        bool isOwn = reader && d[element].parent == reader->element;
        if (!isOwn)
            if (auto it = uniformOf.find(element); it != uniformOf.end()) return it->second;
        Uniform& u = addUniform(element, type);
        u.values.assign(words.all().begin(), words.all().end());
        if (!isOwn) uniformOf[element] = u.name;
        return u.name;
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
            const Name name = i.port->name;
            if (name != uaddressmode && name != vaddressmode && name != filtertype && name != defaultColor) continue;
            std::string_view value =
                i.source.kind == Source::Kind::Value
                    ? d.attributeText(i.source.element, d.known().value)
                    : definitions.element(graph.kindOf(n).def, *i.port).attributeText(d.known().value);
            if (value.empty()) continue;
            if (name == uaddressmode) u.uAddress = value;
            if (name == vaddressmode) u.vAddress = value;
            if (name == filtertype) u.filter = value;
            Words words;
            if (name == defaultColor && readWords(i.type, value, words))
                for (std::uint32_t w : words.all()) u.defaultColor.push_back(std::bit_cast<float>(w));
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
        if (type.empty() && input)
            type = definitions.element(graph.kindOf(*owner).def, *input->port).attributeText(word);
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
        auto& [property, usual] = kindOf(input, owner);
        if (usual) return usual;
        if (property) {
            ExprId value = geometricValue(property, owner.element);
            return fitted(value, input.source, input.type, owner.element);
        }
        doc::ElementRef element = definitions.element(graph.kindOf(owner).def, *input.port);
        std::string_view value = element.attributeText(d.known().value);
        bool isComplete = options.interface == Interface::Complete && !implemented;
        if (input.type == Type::Texture2D || (isComplete && componentCount(input.type)))
            return unwritten(input, owner, value);
        return usual = constantOf(b, input.type, value);
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
