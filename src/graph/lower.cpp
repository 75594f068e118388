#include "graph/lower.h"

#include <algorithm>
#include <bit>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "doc/color_spaces.h"
#include "doc/values.h"
#include "graph/texture_hints.h"
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
    static constexpr std::size_t kNone = ~std::size_t{0};
    std::vector<KindInput> inputs;
    std::vector<Type> outputs;
    bool isMet = false, isAsked = false, hasFiles = false;
    // Of a node that reads an attribute of the mesh: the inputs that name it and that say what it is where it is
    // lacking.
    std::size_t attributeName = kNone, attributeDefault = kNone;
    bool isSet = false;  // texcoord, geomcolor: one of several sets of the mesh, by index
    Name function;       // once asked for; none where nothing implements it
};

// The colour space that is said for a value, and by which element.
struct SaidSpace {
    Name name;  // none where nothing says one
    doc::ElementId by;
    bool isExplicit = false;  // said by a port
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
    std::unordered_map<Name, ExprId> geometric{}, openInputs{};
    std::unordered_map<doc::ElementId, Name> uniformOf{};
    Name fileprefix = d.names().intern("fileprefix"), working = d.names().intern(options.scene.colorspace);
    // Inputs of nodes that read images.
    Name uaddressmode = d.names().intern("uaddressmode"), vaddressmode = d.names().intern("vaddressmode");
    Name filtertype = d.names().intern("filtertype"), defaultColor = d.names().intern("default");
    Name uniformWord = d.names().intern("uniform"), unit = d.names().intern("unit");
    std::vector<FileSpace> files{};                                     // of the node at hand, by input
    std::unordered_set<Name> failed{};                                  // nodedefs without a function
    std::unordered_set<doc::ElementId> told{};                          // what says an unknown colour space
    std::set<std::pair<const doc::Document*, std::uint32_t>> judged{};  // whose value is told to be odd or wrong
    doc::ElementId scope{};  // the nodegraph or document whose colour space was asked for last
    SaidSpace scopeSays{};
    std::string wanted{};  // room to make a uniform's name in
    bool ok = true;

    bool run(Name name) {
        fresh.name = name;
        if (implemented) {
            fresh.isInline = true;
            for (const doc::Port& p : definitions.inputs(implemented))
                fresh.params.push_back({p.name, typeOf(definitions, d.text(p.type))});
        }
        results.reserve(graph.nodes.size());
        firstResult.reserve(graph.nodes.size());
        if (options.interface != Interface::Baked) module.uniforms.reserve(module.uniforms.size() + valueCount());
        for (const Node& n : graph.nodes) node(n);
        if (!ok) return false;
        for (const Output& o : graph.outputs) {
            ExprId value = fitted(valueOf(o.source, o.type, nullptr, nullptr), o.source, o.type, o.element);
            if (!value && o.source.kind == Source::Kind::Interface) noParameter(o.source.input, o.element);
            if (!value) value = b.null(o.type);
            b.addResult(o.name ? o.name : d.names().intern("out"), value);  // an element may lack its name
        }
        if (!ok) return false;
        compact(fresh);
        module.put(std::move(fresh));
        return true;
    }

    // How many uniforms there may be.
    std::size_t valueCount() const {
        if (options.interface == Interface::Complete) return graph.inputs.size();
        const auto isValue = [](const Input& i) { return i.source.kind == Source::Kind::Value; };
        return static_cast<std::size_t>(std::count_if(graph.inputs.begin(), graph.inputs.end(), isValue));
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
        const Input* file = nullptr;
        for (const Input& input : graph.inputsOf(n)) {
            ExprId value = valueOf(input.source, input.type, &input, &n);
            if (value && b.type(value) != input.type) value = fitted(value, input.source, input.type, portOf(input, n));
            if (!value && input.source.kind == Source::Kind::Interface)
                noParameter(input.source.input, portOf(input, n));
            if (!value) value = b.null(input.type);
            if (input.type == Type::Texture2D && input.source.kind == Source::Kind::Value) file = &input;
            operands.push_back(value);
        }
        const Kind& kind = known(n);
        if (kind.attributeName != Kind::kNone && kind.attributeDefault != Kind::kNone) noteDefault(n, kind);
        FileSpace toDecode;
        Name function = kind.function ? instance(n, kind, toDecode) : Name();
        if (!function) {
            ok = false;
            for (Type type : kind.outputs) results.push_back(b.null(type));
            return;
        }
        bool isSingle = kind.outputs.size() == 1;
        ExprId made = b.call(function, isSingle ? kind.outputs[0] : Type::Tuple, operands);
        Name nodeName = d[n.element].name, fileUnit = file ? d.attribute(file->source.element, unit) : Name();
        for (std::uint32_t k = 0; k < kind.outputs.size(); k++) {
            Type type = kind.outputs[k];
            ExprId value = isSingle ? made : b.result(made, k, type);
            if (toDecode.name && (type == Type::Color3 || type == Type::Color4))
                value = converted(value, {toDecode.name, n.element});
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
        for (const doc::Port& o : of.outputs) kind.outputs.push_back(typeOf(definitions, d.text(o.type)));
        const doc::WellKnown& k = d.known();
        kind.inputs.reserve(of.inputs.size());
        for (std::size_t i = 0; i < of.inputs.size(); i++) {
            const Name name = of.inputs[i].name;
            kind.inputs.push_back({definitions.element(of.def, of.inputs[i]).attribute(k.defaultgeomprop), {}});
            if (name == k.geomprop || name == k.varname) kind.attributeName = i;
            if (name == k.defaultName || name == k.fallback) kind.attributeDefault = i;
        }
        const doc::NodeDefRow& row = definitions.row(of.def);
        kind.isSet = row.category == k.texcoord || row.category == k.geomcolor;
        kind.hasFiles = row.flags & doc::NodeDefRow::HasTokens;
        for (const Input& i : graph.inputsOf(n)) kind.hasFiles = kind.hasFiles || i.type == Type::Texture2D;
    }

    // What the host is to supply for an attribute that a mesh lacks, where the node says both by value.
    void noteDefault(const Node& n, const Kind& kind) {
        const ExprId name = operands[kind.attributeName], usual = operands[kind.attributeDefault];
        const Expr &n1 = fresh[name], &n2 = fresh[usual];
        if (n1.op != Op::Constant || n1.type != Type::String || !Name(n1.payload)) return;
        std::vector<std::uint32_t> words;
        if (n2.op == Op::Uniform && n2.type != Type::Texture2D) words = module.uniform(Name(n2.payload))->values;
        if (n2.op == Op::Constant && componentCount(n2.type)) {
            auto bits = fresh.constantWords(usual);
            words.assign(bits.begin(), bits.end());
        }
        if (std::all_of(words.begin(), words.end(), [](std::uint32_t w) { return w == 0; })) return;
        const Name attribute = d.names().intern(fmt::format("geomprop_{}", d.text(Name(n1.payload))));
        Type type = graph.inputsOf(n)[kind.attributeDefault].type;
        if (info(type).scalar != Scalar::Float) {  // meshes carry floats
            type = Type::Float;
            words[0] = std::bit_cast<std::uint32_t>(static_cast<float>(static_cast<int>(words[0])));
        }
        module.attributeDefaults.push_back({attribute, type, words});
    }

    // The function of a node: that of its kind, unless its files are in other spaces than the scene's or their names
    // have tokens. Where that function gives colours as the file has them, `toDecode` is their space.
    Name instance(const Node& n, const Kind& kind, FileSpace& toDecode) {
        if (kind.isSet) return bodies.setOf(graph.kindOf(n).def, setIndex(), diagnostics);
        if (!kind.hasFiles) return kind.function;
        bool isOther = false;
        files.clear();
        for (const Input& input : graph.inputsOf(n)) {
            files.push_back(input.type == Type::Texture2D ? fileSpace(input, n) : FileSpace());
            if (files.back().name == working && !files.back().isExplicit) files.back() = {};
            if (files.back().name && !isKnownSpace(files.back().name, input, n)) files.back() = {};
            isOther = isOther || files.back().name;
            if (files.back().name) toDecode = files.back();
        }
        const std::vector<std::pair<Name, Name>> tokens = tokensOf(n);
        if (!isOther && tokens.empty()) return kind.function;
        bool decodes = false;
        Name function = bodies.instanceOf(graph.kindOf(n).def, {files, tokens}, decodes, diagnostics);
        if (decodes) toDecode = {};
        return function;
    }

    // Which set of the mesh the node at hand reads, below 0 where that is not known.
    int setIndex() const {
        if (operands.empty()) return 0;
        const Expr& index = fresh[operands[0]];
        if (index.op == Op::Constant) return std::max(0, static_cast<int>(fresh.constantWords(operands[0])[0]));
        // A uniform is baked to its value later on.
        const Uniform* u = index.op == Op::Uniform ? module.uniform(Name(index.payload)) : nullptr;
        return u && static_cast<int>(u->values[0]) < kUsualSets ? 0 : -1;
    }

    // The space of a node's file. What a port says of it, the outermost first, goes before the scope that it is
    // written in.
    FileSpace fileSpace(const Input& input, const Node& owner) {
        const Source& s = input.source;
        switch (s.kind) {
            case Source::Kind::Value: {
                const SaidSpace said = spaceOf(s);
                return {said.name, said.isExplicit};
            }
            case Source::Kind::Interface: {
                const FileSpace outer = fileOfInterface(s.input);
                return outer.isExplicit || !s.colorspace ? outer : FileSpace{s.colorspace, true};
            }
            case Source::Kind::Default: {
                const doc::ElementRef port = definitions.element(graph.kindOf(owner).def, *input.port);
                const Name own = port.attribute(d.known().colorspace);
                return {own ? own : port.document->inherited(port.id, d.known().colorspace), bool(own)};
            }
            case Source::Kind::Node:
            case Source::Kind::Geometric:
                break;
        }
        return {};
    }

    FileSpace fileOfInterface(Name name) const {
        if (!implemented) return {};
        auto ports = definitions.inputs(implemented);
        for (std::size_t i = 0; i < ports.size() && i < options.instance.files.size(); i++)
            if (ports[i].name == name) return options.instance.files[i];
        return {};
    }

    bool isKnownSpace(Name space, const Input& input, const Node& owner) {
        if (bodies.toWorkingSpace(space, Type::Color3, diagnostics).isKnown) return true;
        const bool isHere = input.source.kind == Source::Kind::Value;
        unknownSpace(isHere ? spaceOf(input.source) : SaidSpace{space, portOf(input, owner)});
        return false;
    }

    // What the tokens of a node's nodedef stand for: what the node says, else the nodedef.
    std::vector<std::pair<Name, Name>> tokensOf(const Node& n) const {
        std::vector<std::pair<Name, Name>> all;
        const doc::NodeDef def = graph.kindOf(n).def;
        if (!(definitions.row(def).flags & doc::NodeDefRow::HasTokens)) return all;
        const doc::ElementRef nodedef = definitions.element(def);
        const doc::WellKnown& k = d.known();
        for (doc::ElementId e : doc::children(*nodedef.document, nodedef.id)) {
            const Name name = (*nodedef.document)[e].name;
            if ((*nodedef.document)[e].category != k.token || !name) continue;
            const doc::ElementId own = d.child(n.element, k.token, name);
            all.emplace_back(name, own ? d.attribute(own, k.value) : nodedef.document->attribute(e, k.value));
        }
        return all;
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
        if (isFirst && diagnostics.errorCount() == errors) noImplementation(n, of.def);
        return kind;
    }

    // Says what there is for other languages.
    void noImplementation(const Node& n, doc::NodeDef def) {
        const std::string_view category = d.text(d[n.element].category), name = d.text(definitions.row(def).name);
        Diagnostic& e =
            error(n.element, "no-implementation", fmt::format("nothing implements '{}' ({})", category, name));
        for (const doc::ElementRef& each : definitions.implementations(def)) {
            const doc::WellKnown& k = d.known();
            const Name target = each.attribute(k.target) ? each.attribute(k.target) : each.attribute(k.language);
            e.notes.push_back({each.document->locate(each.id),
                               fmt::format("'{}' is for {} alone", d.text(each->name), d.text(target))});
        }
        if (!e.notes.empty()) e.hint = "a nodegraph, or an implementation without a target, serves every language";
    }

    // The value of an input (`input` is null for outputs of the graph), or none where it has none of its own.
    ExprId valueOf(const Source& s, Type type, const Input* input, const Node* owner) {
        switch (s.kind) {
            case Source::Kind::Node:
                return results[firstResult[s.node.index] + s.output];
            case Source::Kind::Interface:
                return implemented ? parameter(s.input) : openInput(s.input);
            case Source::Kind::Geometric:
                if (d.attribute(s.element, d.known().value)) ignoredValue(s.element, s.input);
                return geometricValue(s.input, s.element);
            case Source::Kind::Value:
                if (input && isGeometric(s, *input, *owner)) return defaultOf(*input, *owner);
                return written(s, type, input, owner);
            case Source::Kind::Default:
                return input ? defaultOf(*input, *owner) : ExprId();
        }
        return {};
    }

    // An input that stands for a geometric property is that property unless it is connected. Documents write what is no
    // place or direction of a mesh there, such as 0 or a normal in tangent space, and are drawn by others without it.
    bool isGeometric(const Source& s, const Input& input, const Node& owner) {
        Name property = kindOf(input, owner).property;
        if (!property) return false;
        ignoredValue(s.element, property);
        return true;
    }

    void ignoredValue(doc::ElementId port, Name property) {
        Diagnostic& w = diagnostics.warning(
            "ignored-value",
            fmt::format("the value of '{}' is not read: unless connected, it is the geometric property {}",
                        d.text(d[port].name), d.text(property)));
        w.where = d.locate(port, d.known().value);
        w.path = d.path(port);
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

    // An input of the nodedef that the graph implements, where what is compiled is a part of that graph and nobody
    // gives it: its default value.
    ExprId openInput(Name name) {
        if (auto it = openInputs.find(name); it != openInputs.end()) return it->second;
        const doc::Port* port = graph.interface ? definitions.input(graph.interface, name) : nullptr;
        if (!port) return {};
        const doc::ElementRef element = definitions.element(graph.interface, *port);
        const Type type = typeOf(definitions, d.text(port->type));
        const std::string_view value = element.attributeText(d.known().value);
        ExprId made;
        if (Name property = element.attribute(d.known().defaultgeomprop))
            made = geometricValue(property, graph.outputs[0].element);
        else if (type == Type::Texture2D || (options.interface != Interface::Baked && componentCount(type)))
            made = openUniform(*port, element, type, value);
        else
            made = constant(element, type, value);
        return openInputs[name] = made;
    }

    ExprId openUniform(const doc::Port& port, doc::ElementRef element, Type type, std::string_view value) {
        const std::string_view name = d.text(port.name);
        const std::string owner(d.text(definitions.row(graph.interface).name));
        Uniform u;
        u.name = freeName(fmt::format("{}_{}", owner, name));
        u.type = type;
        u.path = fmt::format("{}/{}", owner, name);
        if (type == Type::Texture2D)
            u.file = fileOf(element, value);
        else if (!readDefault(element, type, value, u.values))
            return {};
        module.uniforms.push_back(u);
        return b.uniform(u.name, type);
    }

    void noParameter(Name name, doc::ElementId port) {
        const doc::NodeDef def = implemented ? implemented : graph.interface;
        if (definitions.input(def, name)) return;  // what is wrong with it is said
        const doc::ElementId owner = d[port].parent;
        const doc::ElementId around = d[port].category == d.known().input ? d[owner].parent : owner;
        error(port, "dangling-interfacename", fmt::format("'{}' has no input '{}'", d.path(around), d.text(name)))
            .where = d.locate(port, d.known().interfacename);
    }

    // Reads a value; what is odd about it, or wrong, is told.
    bool readPlainly(doc::ElementRef element, Type type, std::string_view text, Words& words) {
        const bool isRight = readWords(type, text, words);
        if (isRight && !words.isOdd) return true;
        return isReadable(element, isRight);
    }

    // Says what is wrong or odd with the value of an element, once; that of a nodedef has many readers.
    bool isReadable(doc::ElementRef element, bool otherwise) {
        std::optional<Diagnostic> found = doc::judgeValue(*element.document, element.id);
        if (!found) return otherwise;
        const bool isRead = found->severity == Severity::Warning;
        ok = ok && isRead;
        if (judged.emplace(element.document, element.id.index).second) diagnostics.add(std::move(*found));
        return isRead;
    }

    // Whether the text is one of those that the nodedef lists.
    bool isUnknownChoice(doc::ElementId element, const Input& input, const Node& owner) {
        const doc::ElementRef declared = definitions.element(graph.kindOf(owner).def, *input.port);
        std::optional<Diagnostic> found = doc::judgeChoice(d, element, declared);
        if (found) diagnostics.add(std::move(*found));
        return found.has_value();
    }

    ExprId written(const Source& s, Type type, const Input* input, const Node* owner) {
        const doc::ElementId element = s.element;
        if (type == Type::Texture2D) return texture(s, input, owner);
        const Name given = d.attribute(element, d.known().value);
        const std::string_view text = d.text(given);
        Words words;
        ExprId value;
        Name live;
        if (isStruct(type)) {
            value = structConstant(b, definitions, type, text);
            if (!value) return badStruct({&d, element});
        } else if (componentCount(type) == 0) {
            const bool isChoice = type == Type::String && input && isUnknownChoice(element, *input, *owner);
            value = isChoice ? defaultOf(*input, *owner) : constantOf(b, type, text);
        } else if (!readPlainly({&d, element}, type, text, words)) {
            return {};
        } else {
            if (isLive(type, input, owner)) live = uniform(element, type, words, owner);
            value = live ? b.uniform(live, type) : b.constant(type, words.all());
        }
        if (options.interface != Interface::Baked) record(live, element, input, owner);
        if (type == Type::Color3 || type == Type::Color4)
            if (const SaidSpace said = spaceOf(s); said.name && said.name != working) value = converted(value, said);
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

    ExprId texture(const Source& s, const Input* input, const Node* reader) {
        const doc::ElementId element = s.element;
        auto it = uniformOf.find(element);
        if (it == uniformOf.end()) it = uniformOf.emplace(element, newTexture(s, input, reader)).first;
        record(it->second, element, input, reader);
        return b.uniform(it->second, Type::Texture2D);
    }

    Name newTexture(const Source& s, const Input* input, const Node* reader) {
        if (d.attributeText(s.element, d.known().value).find('\\') != std::string_view::npos) {
            Diagnostic& w = diagnostics.warning("odd-value", "the file is written with '\\', which is read as '/'");
            w.where = d.locate(s.element, d.known().value);
            w.path = d.path(s.element);
        }
        warnOfTiles(s.element);
        Uniform& u = addUniform(s.element, Type::Texture2D);
        u.file = fileOf({&d, s.element}, withTokens(s.element, d.attributeText(s.element, d.known().value)));
        u.colorspace = d.text(spaceOf(s).name);
        if (reader && input) readHints(u, *reader, input->port->name);
        return u.name;
    }

    // How the node that reads the texture wants it read; `file` is its input.
    void readHints(Uniform& u, const Node& n, Name file) {
        const TextureReader reader(definitions, graph.kindOf(n).def, file);
        for (const Name hint : {uaddressmode, vaddressmode, filtertype, defaultColor}) {
            const HintSource from = reader.source(hint);
            Type type = Type::Void;
            const std::string_view value =
                from.fixed ? from.fixed.attributeText(d.known().value) : textOfInput(n, from.input, type);
            if (value.empty()) continue;
            if (from.fixed) type = typeNamed(from.fixed.attributeText(d.known().type));
            if (hint == uaddressmode) u.uAddress = addressMode(value);
            if (hint == vaddressmode) u.vAddress = addressMode(value);
            if (hint == filtertype) u.filter = value;
            Words words;
            if (hint == defaultColor && readWords(type, value, words))
                for (std::uint32_t w : words.all()) u.defaultColor.push_back(std::bit_cast<float>(w));
        }
    }

    // The value of a node's input as it is written or else as the nodedef has it, for connected ones, too.
    std::string_view textOfInput(const Node& n, Name input, Type& type) const {
        for (const Input& i : graph.inputsOf(n)) {
            if (i.port->name != input) continue;
            type = i.type;
            return i.source.kind == Source::Kind::Value
                       ? d.attributeText(i.source.element, d.known().value)
                       : definitions.element(graph.kindOf(n).def, *i.port).attributeText(d.known().value);
        }
        return {};
    }

    // Sets of files, one for each tile of texture space, are one sampler here.
    void warnOfTiles(doc::ElementId element) {
        for (std::string_view token : {"<UDIM>", "<UVTILE>"}) {
            if (d.attributeText(element, d.known().value).find(token) == std::string_view::npos) continue;
            Diagnostic& w = diagnostics.warning(
                "tiled-texture",
                fmt::format(
                    "{} stands for a file of each tile: tiles are not drawn yet, the host has to supply one picture",
                    token));
            w.where = d.locate(element, d.known().value);
            w.path = d.path(element);
        }
    }

    // A file as it is to be found from the document: with the prefix of where it is written.
    std::string fileOf(doc::ElementRef element, std::string_view file) const {
        if (file.empty()) return {};
        std::string path = std::string(d.text(element.document->inherited(element.id, fileprefix))).append(file);
        std::replace(path.begin(), path.end(), '\\', '/');  // as Windows writes it
        return path;
    }

    // A file name whose [tokens] are replaced by what they stand for: in the element's own node or a graph around it,
    // in the node that the graph implements, in the nodedef of that.
    std::string withTokens(doc::ElementId element, std::string_view file) const {
        std::string out;
        for (;;) {
            const std::size_t open = file.find('['), close = file.find(']', open);
            if (close == std::string_view::npos) return out.append(file);
            const std::string_view word = file.substr(open + 1, close - open - 1);
            const Name name = d.names().find(word);
            const Name value = name ? tokenValue(element, name) : Name();
            out.append(file.substr(0, open));
            out.append(value ? d.text(value) : file.substr(open, close + 1 - open));
            file.remove_prefix(close + 1);
        }
    }

    Name tokenValue(doc::ElementId element, Name name) const {
        const doc::WellKnown& k = d.known();
        for (doc::ElementId at = d[element].parent; at && at != d.root(); at = d[at].parent)
            if (doc::ElementId own = d.child(at, k.token, name)) return d.attribute(own, k.value);
        for (const auto& [token, value] : options.instance.tokens)
            if (token == name) return value;
        if (!graph.interface) return {};
        const doc::ElementRef nodedef = definitions.element(graph.interface);
        const doc::ElementId own = nodedef.document->child(nodedef.id, k.token, name);
        return own ? nodedef.document->attribute(own, k.value) : Name();
    }

    // The colour space of a value: what a port says, the outermost first, else the node, nodegraph or document that the
    // value stands in.
    SaidSpace spaceOf(const Source& s) {
        if (s.colorspace) return {s.colorspace, s.element, true};
        const Name word = d.known().colorspace;
        const doc::ElementId node = d[s.element].parent;
        if (const Name own = d.attribute(node, word); own && !d.text(own).empty()) return {own, node};
        if (d[node].parent != scope || !scope) {
            scope = d[node].parent;
            scopeSays = {};
            for (doc::ElementId at = scope; at && !scopeSays.name; at = d[at].parent)
                if (const Name own = d.attribute(at, word); own && !d.text(own).empty()) scopeSays = {own, at};
        }
        return scopeSays;
    }

    // A colour of a space in the working space.
    ExprId converted(ExprId value, const SaidSpace& from) {
        if (from.name == working) return value;
        const Type type = b.type(value);
        const ColorConversion conversion = bodies.toWorkingSpace(from.name, type, diagnostics);
        if (!conversion.isKnown) unknownSpace(from);
        if (!conversion.function) return value;
        return b.call(conversion.function, type, std::span<const ExprId>(&value, 1));
    }

    // Said once for each element that says the space.
    void unknownSpace(const SaidSpace& said) {
        if (!told.insert(said.by).second) return;
        doc::warnUnknownColorSpace(d, said.by, options.scene.colorspace, bodies.nearestColorSpace(d.text(said.name)),
                                   diagnostics);
    }

    // A value that the document gives in a unit, in that of the scene.
    ExprId inUnits(ExprId value, Name given, doc::ElementId at, const Input* input, const Node* owner) {
        Name word = d.names().intern("unittype");
        std::string_view type = d.attributeText(at, word), from = d.text(given);
        if (type.empty() && input)
            type = definitions.element(graph.kindOf(*owner).def, *input->port).attributeText(word);
        std::string_view to = type == "distance" ? options.scene.distanceUnit
                              : type == "angle"  ? options.scene.angleUnit
                                                 : from;
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
            return inScene(unwritten(input, owner, element, value), element);
        return usual = inScene(constant(element, input.type, value), element);
    }

    // The value that a port of a nodedef gives.
    ExprId constant(doc::ElementRef port, Type type, std::string_view text) {
        if (isStruct(type)) {
            const ExprId value = structConstant(b, definitions, type, text);
            return value ? value : badStruct(port);
        }
        if (componentCount(type) == 0 || text.empty()) return constantOf(b, type, text);
        Words words;
        return readPlainly(port, type, text, words) ? b.constant(type, words.all()) : ExprId();
    }

    bool readDefault(doc::ElementRef port, Type type, std::string_view text, std::vector<std::uint32_t>& values) {
        Words words;
        if (!readPlainly(port, type, text, words)) return false;
        values.assign(words.all().begin(), words.all().end());
        return true;
    }

    ExprId badStruct(doc::ElementRef port) {
        ok = false;
        if (!judged.emplace(port.document, port.id.index).second) return {};
        Diagnostic& e = diagnostics.error(
            "bad-value", fmt::format("bad value of type {}: expected a value for each member, such as {{0.5; 1}}",
                                     port.attributeText(d.known().type)));
        e.where = port.document->locate(port.id, d.known().value);
        e.path = port.document->path(port.id);
        return {};
    }

    // A colour that a nodedef gives, in the working space.
    ExprId inScene(ExprId value, doc::ElementRef port) {
        const Type type = value ? b.type(value) : Type::Void;
        if (type != Type::Color3 && type != Type::Color4) return value;
        const Name space = port.document->inherited(port.id, d.known().colorspace);
        if (!space || space == working) return value;
        const ColorConversion conversion = bodies.toWorkingSpace(space, type, diagnostics);
        return conversion.function ? b.call(conversion.function, type, std::span<const ExprId>(&value, 1)) : value;
    }

    // A uniform for an input that the document does not write: the host may set it.
    ExprId unwritten(const Input& input, const Node& owner, doc::ElementRef port, std::string_view value) {
        std::string_view name = d.text(input.port->name);
        Uniform u;
        u.name = freeName(fmt::format("{}_{}", d.text(d[owner.element].name), name));
        u.type = input.type;
        u.path = fmt::format("{}/{}", d.path(owner.element), name);
        if (u.type == Type::Texture2D) {
            u.file = fileOf(port, value);
            readHints(u, owner, input.port->name);
        } else if (!readDefault(port, u.type, value, u.values)) {
            return {};
        }
        module.uniforms.push_back(u);
        record(u.name, {}, &input, &owner);
        return b.uniform(u.name, u.type);
    }

    ExprId badProperty(doc::ElementRef prop, Name attribute) {
        ok = false;
        if (!judged.emplace(prop.document, prop.id.index).second) return {};
        Diagnostic& e = diagnostics.error(
            "bad-value", fmt::format("bad value of '{}': '{}'", d.text(attribute), prop.attributeText(attribute)));
        e.where = prop.document->locate(prop.id, attribute);
        e.path = prop.document->path(prop.id);
        return {};
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
            const ExprId argument = constantOf(b, typeNamed(d.text(p.type)), text);
            if (!argument) return badProperty(prop, p.name);
            arguments.push_back(argument);
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
