#include "compile/compile.h"

#include <algorithm>
#include <array>
#include <optional>
#include <unordered_set>

#include <fmt/format.h>

#include "compile/bodies.h"
#include "compile/explain.h"
#include "compile/finished.h"
#include "compile/material_check.h"
#include "compile/reflection.h"
#include "compile/value_effects.h"
#include "doc/check.h"
#include "doc/upgrade.h"
#include "doc/write.h"
#include "graph/graph.h"
#include "ir/builder.h"
#include "ir/text.h"
#include "ir/validate.h"
#include "passes/expand.h"
#include "passes/flip.h"
#include "passes/gather.h"
#include "passes/place.h"
#include "passes/prune.h"
#include "passes/shade.h"
#include "passes/specialise.h"
#include "passes/stages.h"
#include "passes/topology.h"
#include "targets/glsl/glsl.h"

namespace shaderx {

static constexpr std::string_view kStages[] = {"read",  "check",     "graph", "lower",    "specialise",
                                               "shade", "interface", "place", "legalise", "print"};

std::string_view nameOf(StageName stage) { return kStages[static_cast<int>(stage)]; }

bool stageNamed(std::string_view name, StageName& stage) {
    for (std::size_t i = 0; i < std::size(kStages); i++)
        if (kStages[i] == name) {
            stage = static_cast<StageName>(i);
            return true;
        }
    return false;
}

bool interfaceNamed(std::string_view name, Interface& interface) {
    if (name == "complete") interface = Interface::Complete;
    if (name == "live") interface = Interface::Live;
    if (name == "baked" || name == "reduced") interface = Interface::Baked;
    return name == "complete" || name == "live" || name == "baked" || name == "reduced";
}

struct Compiler::State {
    explicit State(std::span<const std::uint8_t> image)
        : names(namesOf(image)), known(names), builtin(openLibrary(names, image)) {}

    std::vector<Library*> libraries() const {
        std::vector<Library*> all;
        for (std::size_t i = user.size(); i-- > 0;) all.push_back(user[i].get());
        if (builtin) all.push_back(builtin.get());
        return all;
    }
    // False, with a message, for documents that cannot be compiled here because of how they were made.
    bool accepts(const doc::Document& document, Diagnostics& diagnostics) const {
        if (&document.names() != &names)
            diagnostics.error("foreign-document", "the document belongs to another compiler");
        else if (document.badEdits())
            diagnostics.error("foreign-element", "the document was edited at elements that it does not have");
        else
            return true;
        return false;
    }
    // Of the libraries alone.
    doc::Definitions definitions() const {
        doc::Definitions all;
        for (Library* l : libraries()) all.add(l->document(), l->index());
        return all;
    }
    doc::Definitions definitions(const doc::Document& document) const {
        doc::Definitions all;
        all.add(document);
        for (Library* l : libraries()) all.add(l->document(), l->index());
        return all;
    }

    NameTable names;
    doc::WellKnown known;
    std::unique_ptr<Library> builtin;
    std::vector<std::unique_ptr<Library>> user;
};

Compiler::Compiler(std::span<const std::uint8_t> libraryImage) : state_(std::make_unique<State>(libraryImage)) {}
Compiler::~Compiler() = default;

NameTable& Compiler::names() { return state_->names; }

std::unique_ptr<doc::Document> Compiler::newDocument() {
    return std::make_unique<doc::Document>(state_->names, state_->known);
}

// Runs a step of the public interface: a bug of ours becomes a diagnostic here.
template <class F>
static bool guarded(Diagnostics& diagnostics, std::string_view step, F&& run) {
    try {
        return run();
    } catch (const std::bad_alloc&) {
        diagnostics.error("out-of-memory", fmt::format("{}: not enough memory", step));
    } catch (const std::exception& e) {
        diagnostics.add(Severity::Internal, "internal", fmt::format("{}: {}", step, e.what()));
    } catch (...) {  // a caller's own, from a resolver or a sink
        diagnostics.add(Severity::Internal, "internal", fmt::format("{}: an exception of unknown type", step));
    }
    return false;
}

bool Compiler::addLibrary(std::vector<LibraryFile> files, Diagnostics& diagnostics) {
    return guarded(diagnostics, "library", [&] {
        std::vector<Library*> below = state_->libraries();
        auto library = makeLibrary(state_->names, std::move(files), below, diagnostics);
        if (!library) return false;
        state_->user.push_back(std::move(library));
        return true;
    });
}

std::unique_ptr<doc::Document> Compiler::read(std::string_view file, std::string text, doc::Resolver& resolver,
                                              Diagnostics& diagnostics, const doc::ReadOptions& limits,
                                              std::vector<doc::Edit>* edits) {
    auto document = newDocument();
    bool ok = guarded(diagnostics, "read", [&] {
        if (!doc::read(*document, file, std::move(text), resolver, diagnostics, limits)) return false;
        doc::Definitions libraries = state_->definitions();
        doc::upgrade(*document, diagnostics, {&libraries, edits});
        return true;
    });
    return ok ? std::move(document) : nullptr;
}

std::optional<doc::ColorSpace> Compiler::colorSpace(std::string_view name) const {
    doc::Definitions all;
    for (Library* l : state_->libraries()) all.add(l->document(), l->index());
    doc::ColorSpaces spaces(all);
    const doc::ColorSpace* found = spaces.find(name);
    return found ? std::optional(*found) : std::nullopt;
}

std::vector<doc::ElementId> Compiler::renderableElements(const doc::Document& document) {
    return doc::renderableElements(document);
}

namespace {

// Functions of the library that stand in for others where the environment's maps are prefiltered: F_prefiltered for F.
class Prefiltered final : public ir::FunctionSource {
  public:
    Prefiltered(NameTable& names, const ir::Module& module) : names_(names), module_(module) {}
    const ir::Function* find(Name name) override {
        Name other = names_.find(std::string(names_.text(name)) + "_prefiltered");
        return other ? module_.find(other) : nullptr;
    }

  private:
    NameTable& names_;
    const ir::Module& module_;
};

constexpr std::string_view kFormNode = "node";  // see Compilation::completeForm

graph::SceneConventions sceneOf(const GenerateOptions& options) {
    graph::SceneConventions scene;
    scene.colorspace = options.colorspace;
    scene.distanceUnit = options.unit;
    return scene;
}

BodyOptions bodyOptions(const GenerateOptions& options) {
    return {sceneOf(options), options.maxDepth, options.unknownIsDefault};
}

// One element on its way to a shader. The stages in the order in which they run.
struct Compilation {
    const doc::Document& document;
    doc::ElementId element;
    const GenerateOptions& options;
    Diagnostics& diagnostics;
    NameTable& names;
    const doc::Definitions& definitions;
    NodeBodies& bodies;
    passes::Specialisations& made;
    FinishedFunctions* finished;  // where something of it is kept, else none
    text::FunctionTexts& texts;
    ir::Module module;
    graph::Graph graph{};
    passes::ShaderInterface interface{};
    std::vector<graph::Authored> authored{};
    std::unordered_set<Name> baked{};  // uniforms that decide topology
    bool traces = false;               // whether expressions say from which node they come
    Explainer* explainer = nullptr;    // none where the document is our own
    passes::ExpansionLimits limits{};
    Name pixel = names.intern("@pixel"), vertex = names.intern("@vertex");

    bool run(Shader& shader) {
        dumpDocument();
        if (!makeGraph() || !lower()) return false;
        const bool isComplete = takeCompleteForm();
        if (!specialise() || !(isComplete || shade())) return false;
        finishPixel();
        interface = passes::makeStages(module, pixel, vertex);
        interface.usesBlocks = options.blocks;
        interface.bindingBase = options.bindingBase;
        dump(StageName::Interface);
        finish();
        print(shader);
        return true;
    }

    // Whatever is wrong with an element shows by then, whichever shader is wanted; and which values have an effect.
    bool check(ValueEffects& effects) {
        if (!makeGraph() || !lower() || !fold()) return false;
        noteEffects(effects);
        if (!needsShading()) return true;
        passes::prune(module, std::array{pixel});
        return shade();
    }

    void noteEffects(ValueEffects& effects) const {
        std::unordered_set<Name> read;
        const ir::Function& entry = *module.findOwn(pixel);
        const std::vector<bool> needed = ir::reachable(entry);
        for (std::size_t i = 0; i < needed.size(); i++)
            if (needed[i] && entry.exprs[i].op == ir::Op::Uniform) read.insert(Name(entry.exprs[i].payload));
        for (const graph::Authored& a : authored)
            if (a.element && !isForHost(names.text(a.port->name)))
                effects.note(a.element, !a.uniform || baked.count(a.uniform) || read.count(a.uniform));
    }

    // Whether shading may have something to say: of volumes, and of closures that a user's library brings.
    bool needsShading() {
        const auto isOdd = [&](const ir::Expr& e) {
            return e.op == ir::Op::Leaf && (e.type == ir::Type::VDF || bodies.findLeaf(Name(e.payload)));
        };
        const std::vector<ir::Expr>& all = module.findOwn(pixel)->exprs;
        return std::any_of(all.begin(), all.end(), isOdd);
    }

    // With all values of the document as uniforms, nothing is removed yet.
    bool findLobes(std::vector<passes::Lobe>& lobes) {
        traces = true;
        if (!makeGraph() || !lower() || !passes::specialise(module, pixel, {}, made, diagnostics, limits)) return false;
        lobes = passes::lobesOf(module, pixel);
        return true;
    }

    bool findCosts(std::vector<passes::NodeCost>& costs) {
        traces = true;
        if (!makeGraph() || !lower() || !specialise() || !shade()) return false;
        finishPixel();
        costs = passes::costsByNode(module, pixel);
        return true;
    }

    // The complete form of a node that makes a surface of numbers: what the pixel's function becomes where every input
    // of the node may change, as a function of the inputs. A library's were made when it was packed, which saves each
    // document most of the way. Geometric properties are its own, but for inputs that are connected. Its name; none
    // where there is no such form, because the node chooses attributes of the mesh, say, or is worth a warning.
    Name completeForm(doc::NodeDef def, Name function, std::span<const Name> connected) {
        std::string text(names.text(function));
        text += "@complete";
        for (Name input : connected) text.append("+").append(names.text(input));  // no name has a plus
        Name name = names.intern(text);
        if (bodies.isPrecompiled(function)) return module.find(name) ? name : Name();
        return bodies.made().findOwn(name) || makeCompleteForm(def, name, connected) ? name : Name();
    }

    bool makeCompleteForm(doc::NodeDef def, Name name, std::span<const Name> connected) {
        doc::Document blank(names, document.known());
        const doc::NodeDefRow& row = definitions.row(def);
        doc::ElementId node = blank.append(blank.root(), names.text(row.category), kFormNode);
        blank.set(node, blank.known().type, row.output);
        blank.set(node, blank.known().nodedef, row.name);
        for (Name input : connected) {
            const Name type = definitions.input(def, input)->type;
            blank.set(blank.append(blank.root(), "constant", names.text(input)), blank.known().type, type);
            doc::ElementId port = blank.append(node, "input", names.text(input));
            blank.set(port, blank.known().type, type);
            blank.set(port, blank.known().nodename, input);
        }
        GenerateOptions how;
        how.interface = Interface::Complete;
        Diagnostics told;
        passes::Specialisations ownMade;
        Compilation c{blank, node, how, told, names, definitions, bodies, ownMade, nullptr, texts, ir::Module(names)};
        c.module.sources = module.sources;
        bodies.forgetNames();
        if (!c.makeGraph() || !c.hasCompleteForm(c.graph.nodes.back())) return false;
        if (!c.lower() || !c.specialise() || !c.baked.empty() || !c.shade()) return false;
        c.finishPixel();
        if (!told.all().empty() || !c.takeInputs(name)) return false;
        c.keepForm(name);
        return true;
    }

    // Makes parameters of the uniforms that stand for the inputs of the one node.
    bool takeInputs(Name name) {
        ir::Function& f = *module.findOwn(pixel);
        const graph::Node& node = graph.nodes.back();
        std::unordered_map<Name, std::uint32_t> inputs;  // by uniform
        for (const graph::Input& input : graph.inputsOf(node)) {
            const std::string_view port = names.text(input.port->name);
            const bool isConnected = input.source.kind == graph::Source::Kind::Node;
            Name uniform =
                names.intern(isConnected ? fmt::format("{}_value", port) : fmt::format("{}_{}", kFormNode, port));
            inputs[uniform] = static_cast<std::uint32_t>(f.params.size());
            f.params.push_back({input.port->name, input.type});
        }
        for (const auto& each : module.functions)
            for (ir::Expr& e : each->exprs) {
                if (e.op != ir::Op::Uniform) continue;
                auto at = inputs.find(Name(e.payload));
                if (at == inputs.end() || each.get() != &f) return false;
                e.op = ir::Op::Param;
                e.payload = at->second;
            }
        f.name = name;
        f.isInline = true;
        return true;
    }

    // Gives the functions that the form calls names of their own and keeps them all.
    void keepForm(Name form) {
        std::unordered_map<Name, Name> renamed;
        for (const auto& f : module.functions) {
            std::string_view own = names.text(f->name);
            std::string_view stem = own.substr(0, own.find('@'));
            if (f->name != form)
                renamed[f->name] = names.intern(fmt::format("{}@{}{}", stem, names.text(form), renamed.size()));
        }
        for (const auto& f : module.functions) {
            for (ir::Expr& e : f->exprs)
                if (e.op == ir::Op::Call) e.payload = renamed.at(Name(e.payload)).index;
            if (f->name != form) f->name = renamed.at(f->name);
            f->isApart = f->name != form;
            bodies.keep(std::move(*f));
        }
    }

    // The node whose surface the output is, and its call; none where the output is anything else. A material may stand
    // between them, if it only hands the surface on.
    const graph::Node* surface(const ir::Function& entry, ir::ExprId& call) const {
        graph::Source source = graph.outputs[0].source;
        call = entry.results[0].value;
        while (source.kind == graph::Source::Kind::Node) {
            const graph::Node& node = graph.nodes[source.node.index];
            call = unwrapped(entry, call);
            const ir::Function* function =
                entry[call].op == ir::Op::Call ? module.find(Name(entry[call].payload)) : nullptr;
            if (!function || function->results.size() != 1) return nullptr;
            if (function->results[0].type == ir::Type::SurfaceShader) return &node;
            const ir::Expr& handedOn = (*function)[unwrapped(*function, function->results[0].value)];
            if (handedOn.op != ir::Op::Param) return nullptr;
            source = graph.inputsOf(node)[handedOn.payload].source;
            call = entry.operand(call, handedOn.payload);
        }
        return nullptr;
    }

    static ir::ExprId unwrapped(const ir::Function& f, ir::ExprId e) {
        while (f[e].op == ir::Op::Retype) e = f.operand(e, 0);
        return e;
    }

    // Whether a node of a library makes a surface of numbers, by a graph.
    bool hasCompleteForm(const graph::Node& node) const {
        const doc::NodeDef def = graph.kindOf(node).def;
        if (definitions.element(def).document == &document) return false;
        const doc::Implementation how = definitions.implementation(def);
        if (how.kind != doc::Implementation::Kind::Graph || how.graph.document == &document) return false;
        auto inputs = graph.inputsOf(node);
        return std::all_of(inputs.begin(), inputs.end(),
                           [](const graph::Input& i) { return ir::componentCount(i.type) > 0; });
    }

    bool isProperty(doc::NodeDef def, const doc::Port& port) const {
        return static_cast<bool>(definitions.element(def, port).attribute(document.known().defaultgeomprop));
    }

    // Makes of the call of a surface node one of its complete form. False where that has none or would be another.
    bool takeCompleteForm() {
        if (options.interface != Interface::Complete || options.environment != EnvironmentLight::Samples ||
            options.transparency)
            return false;
        ir::Function& entry = *module.findOwn(pixel);
        ir::ExprId call;
        const graph::Node* node = surface(entry, call);
        if (!node || !hasCompleteForm(*node)) return false;
        const doc::NodeDef def = graph.kindOf(*node).def;
        std::vector<Name> connected;
        for (const graph::Input& input : graph.inputsOf(*node))
            if (input.source.kind == graph::Source::Kind::Node && isProperty(def, *input.port))
                connected.push_back(input.port->name);
        Name form = completeForm(def, Name(entry[call].payload), connected);
        if (!form) return false;
        ir::Builder b(module, entry);
        std::vector<ir::ExprId> inputs(entry.operandsOf(call).begin(), entry.operandsOf(call).end());
        const ir::ResultValue& color = module.find(form)->results[0];
        entry.results = {{color.name, color.type, b.call(form, color.type, inputs)}};
        return true;
    }

    bool wants(StageName stage) const { return options.dumps && options.dumps->wants(stage); }

    // Shows the program and, where asserts are on, proves that it keeps the rules of the IR.
    void dump(StageName stage) {
        if (wants(stage)) options.dumps->dump(stage, ir::print(module));
#ifndef NDEBUG
        Diagnostics broken;
        if (!ir::validate(module, broken)) internalError(fmt::format("after {}:\n{}", nameOf(stage), broken.text()));
#endif
    }

    void dumpDocument() {
        if (wants(StageName::Read)) options.dumps->dump(StageName::Read, doc::write(document));
        if (!wants(StageName::Check)) return;
        Diagnostics found;
        doc::validate(document, definitions, found);
        options.dumps->dump(StageName::Check, found.all().empty() ? "no mistakes\n" : found.text());
    }

    bool refuse(std::string_view code, std::string message) {
        Diagnostic& e = diagnostics.error(code, std::move(message));
        e.where = document.locate(element);
        e.path = document.path(element);
        return false;
    }

    bool makeGraph() {
        Diagnostics own;
        graph.unknownIsDefault = options.unknownIsDefault;
        bool built = graph::build(document, element, definitions, graph, own);
        if (explainer && (!built || explainer->isNeeded(graph)) && !explainer->explain(graph, diagnostics))
            return false;
        for (const Diagnostic& d : own.all()) diagnostics.add(d);
        if (!built) return false;
        if (graph.outputs.empty()) return refuse("no-output", "the element has no output to compute");
        if (graph.outputs[0].type == ir::Type::Void && graph.outputs[0].source.kind != graph::Source::Kind::Node)
            return refuse("no-output", "the output has neither a type nor a node that tells it");
        if (ir::isStruct(graph.outputs[0].type))
            return refuse("no-output", "a structure cannot be shown: only its members can");
        if (!checkMaterial(document, graph, diagnostics)) return refuse("no-shader", "the material has no shader");
        graph.outputs.resize(1);
        if (wants(StageName::Graph)) options.dumps->dump(StageName::Graph, graph::print(graph, definitions));
        return true;
    }

    bool lower() {
        graph::LowerOptions how;
        how.interface = options.interface;
        how.authored = &authored;
        how.scene = sceneOf(options);
        how.traces = traces;
        if (options.unit != graph::SceneConventions().distanceUnit && !bodies.unitScale("distance", options.unit)) {
            diagnostics.error("unknown-scene-unit", fmt::format("there is no unit of distance '{}'", options.unit));
            return false;
        }
        if (options.colorspace != graph::SceneConventions().colorspace &&
            !bodies.colorSpaces().find(options.colorspace)) {
            const std::string_view near = bodies.colorSpaces().nearest(options.colorspace);
            Diagnostic& e = diagnostics.error("unknown-working-space",
                                              fmt::format("there is no colour space '{}'", options.colorspace));
            if (!near.empty()) e.hint = fmt::format("did you mean '{}'?", near);
            return false;
        }
        module.structs = bodies.made().structs;
        bool ok = graph::lower(graph, definitions, bodies, {}, pixel, how, module, diagnostics);
        // Textures inside of nodes that graphs implement.
        const std::vector<ir::Uniform>& inside = bodies.made().uniforms;
        module.uniforms.insert(module.uniforms.end(), inside.begin(), inside.end());
        const std::vector<ir::AttributeDefault>& usual = bodies.made().attributeDefaults;
        module.attributeDefaults.insert(module.attributeDefaults.end(), usual.begin(), usual.end());
        if (!ok) return false;
        // What a long document makes of its own nodes is no explosion.
        limits = {options.maxDepth, options.maxExpressions + 32 * module.findOwn(pixel)->exprs.size()};
        dump(StageName::Lower);
        return true;
    }

    // With the values that are known, but for live ones that decide nothing.
    bool fold() {
        bool ok = passes::specialise(module, pixel, {}, made, diagnostics, limits);
        if (ok && options.interface != Interface::Baked) {
            const ir::Function& entry = *module.findOwn(pixel);
            bool live = options.interface == Interface::Live;
            baked = live ? passes::topologyUniforms(module, entry) : passes::attributeUniforms(module, entry);
            ok = baked.empty() || passes::specialise(module, pixel, baked, made, diagnostics, limits);
        }
        return ok;
    }

    bool specialise() {
        if (!fold()) return false;
        passes::prune(module, std::array{pixel});
        dump(StageName::Specialise);
        return true;
    }

    bool shade() {
        std::string_view port = names.text(graph.outputs[0].name);
        bool isShader = ir::isClosure(graph.outputs[0].type);
        Name output = names.intern(isShader || port == "out" || port.empty() ? "out1" : port);
        passes::ShadeOptions how;
        how.environment = options.environment != EnvironmentLight::None;
        how.transparency = options.transparency;
        how.skipsUnused = options.interface == Interface::Complete;
        if (!passes::shade(module, pixel, output, how, diagnostics)) return false;
        if (how.skipsUnused) {
            passes::expandToLongWork(module, pixel);
            passes::gather(module, pixel);
        }
        return passes::specialise(module, pixel, {}, made, diagnostics, limits);
    }

    void finishPixel() {
        passes::expandCalledOnce(module, pixel);
        passes::prune(module, std::array{pixel});
        if (options.flipV) passes::flipTextures(module);
        dump(StageName::Shade);
    }

    void legalise(ir::Function& f) { glsl::legalise(f); }

    void place(ir::Function& f) {
        passes::PlaceOptions how;
        how.isEntry = f.name == pixel;
        how.names = &names;
        passes::place(f, how);
    }

    // Legalises and places, one stage after the other where that is to be seen.
    void finish() {
        if (wants(StageName::Legalise) || wants(StageName::Place)) finished = nullptr;
        if (!finished) {
            for (auto& f : module.functions) legalise(*f);
            dump(StageName::Legalise);
            for (auto& f : module.functions) place(*f);
        } else {
            auto both = [&](ir::Function& f) {
                legalise(f);
                place(f);
            };
            const std::array entries{pixel, vertex};
            finished->finish(module, entries, both);
            texts.numbers = &finished->numbers();
            for (Name entry : entries) both(*module.findOwn(entry));
        }
        dump(StageName::Place);
    }

    void print(Shader& shader) {
        std::string title = document.path(element);
        glsl::Sources sources = glsl::print(module, interface, title, finished ? &texts : nullptr);
        shader.element = document.path(element);
        shader.vertex = std::move(sources.vertex);
        shader.pixel = std::move(sources.pixel);
        shader.output = std::move(sources.output);
        shader.topology = stableHash(shader.vertex);
        std::size_t at = 0;
        for (auto [begin, end] : sources.apart) {
            shader.topology = stableHash(std::string_view(shader.pixel).substr(at, begin - at), shader.topology);
            at = end;
        }
        shader.topology = stableHash(std::string_view(shader.pixel).substr(at), shader.topology);
        reflect({module, interface, document, definitions, authored, baked, sources.names}, shader);
        if (wants(StageName::Print)) options.dumps->dump(StageName::Print, shader.vertex + "\n" + shader.pixel);
        module.sources.clear();  // nothing is left to look up, and what they point to goes
        shader.program = std::make_shared<const Program>(Program{std::move(module), std::move(interface)});
    }
};

}  // namespace

// A document's bodies and what was specialised of them, from one element to the next.
struct Compiler::Batch {
    std::optional<doc::Definitions> definitions{};
    std::optional<NodeBodies> bodies{};
    passes::Specialisations made{};
    FinishedFunctions finished{};
    text::FunctionTexts texts{};
    bool isSeveral = false;  // elements: it pays to keep what is finished
    std::optional<Explainer> explainer{};
};

template <class Run>
bool Compiler::compile(Batch& batch, const doc::Document& document, doc::ElementId element,
                       const GenerateOptions& options, Diagnostics& diagnostics, Run&& run) {
    if (!state_->accepts(document, diagnostics)) return false;
    if (!document.has(element)) {
        diagnostics.error("foreign-element", "the document has no such element");
        return false;
    }
    auto& [definitions, bodies, made, finished, texts, isSeveral, explainer] = batch;
    Diagnostics own;
    bool ok = guarded(own, fmt::format("generating '{}'", document.path(element)), [&] {
        if (!definitions) definitions = state_->definitions(document);
        // Uniforms inside of bodies have taken names that another element may want.
        if (bodies && !bodies->made().uniforms.empty()) {
            bodies.reset();
            made.clear();
        }
        if (!bodies) bodies.emplace(state_->names, *definitions, state_->libraries(), bodyOptions(options));
        bodies->forgetNames();
        Compilation c{document,
                      element,
                      options,
                      own,
                      state_->names,
                      *definitions,
                      *bodies,
                      made,
                      isSeveral ? &finished : nullptr,
                      texts,
                      ir::Module(state_->names)};
        if (!explainer) explainer.emplace(document, *definitions, doc::CheckOptions{options.unknownIsDefault, false});
        c.explainer = &*explainer;
        Prefiltered prefiltered(state_->names, c.module);
        if (options.environment != EnvironmentLight::Samples) c.module.sources.push_back(&prefiltered);
        c.module.sources.push_back(&*bodies);
        for (Library* l : state_->libraries()) c.module.sources.push_back(l);
        return run(c);
    });
    Unrepeated said;  // two stages may have met the same mistake
    for (const Diagnostic& d : own.all()) {
        if (!said.isNew(d)) continue;
        Diagnostic told = d;
        if (options.strict && told.severity == Severity::Warning) {
            told.severity = Severity::Error;
            ok = false;
        }
        if (told.where.file.empty() && !told.where.line) {  // passes know no document
            told.where = document.locate(element);
            if (told.path.empty()) told.path = document.path(element);
        }
        diagnostics.add(std::move(told));
    }
    return ok;
}

// Makes the functions of the nodes that a document defines, whether or not anything uses them.
bool Compiler::checkDefinitions(Batch& batch, const doc::Document& document, const GenerateOptions& options,
                                Diagnostics& diagnostics) {
    return guarded(diagnostics, "check", [&] {
        const doc::Definitions& definitions = *batch.definitions;
        NodeBodies bodies(state_->names, definitions, state_->libraries(), bodyOptions(options));
        const std::size_t errors = diagnostics.errorCount();
        for (doc::ElementId e : doc::children(document, document.root())) {
            if (document[e].category != document.known().nodedef) continue;
            const doc::NodeDef def = definitions.byName(document[e].name, document.namespaceOf(e));
            if (def && definitions.element(def).document == &document && definitions.implementation(def))
                bodies.functionOf(def, diagnostics);
        }
        return diagnostics.errorCount() == errors;
    });
}

bool Compiler::validate(const doc::Document& document, Diagnostics& diagnostics, const GenerateOptions& options) {
    if (!state_->accepts(document, diagnostics)) return false;
    Diagnostics found;
    Batch batch;
    bool ok = guarded(found, "check", [&] {
        batch.definitions = state_->definitions(document);
        return doc::validate(document, *batch.definitions, found, {options.unknownIsDefault, false});
    });
    // What is told once compiling begins: nodes without a body, sources with mistakes, materials without a shader.
    Unrepeated said;
    for (const Diagnostic& d : found.all()) said.isNew(d);
    const auto addNew = [&](const Diagnostics& later) {
        for (const Diagnostic& d : later.all())
            if (said.isNew(d)) found.add(d);
    };
    const std::vector<doc::ElementId> elements = doc::renderableElements(document);
    if (!elements.empty()) doc::reportUnrendered(document, false, found);
    ValueEffects effects;
    GenerateOptions how = options;
    how.interface = Interface::Live;  // which knows the values from what follows of them
    for (doc::ElementId element : elements) {
        Diagnostics own;
        ok = compile(batch, document, element, how, own, [&](Compilation& c) { return c.check(effects); }) && ok;
        addNew(own);
    }
    if (ok) {
        Diagnostics own;
        ok = checkDefinitions(batch, document, options, own);
        addNew(own);
        effects.report(document, found);
    }
    for (const Diagnostic& d : found.all()) diagnostics.add(d);
    const auto isWarning = [](const Diagnostic& d) { return d.severity == Severity::Warning; };
    return ok && !(options.strict && std::any_of(found.all().begin(), found.all().end(), isWarning));
}

void Compiler::generate(const doc::Document& document, std::span<const doc::ElementId> elements,
                        const GenerateOptions& options, const Done& done) {
    Batch batch;
    batch.isSeveral = elements.size() > 1;
    for (doc::ElementId element : elements) {
        Shader shader;
        Diagnostics diagnostics;
        bool ok =
            compile(batch, document, element, options, diagnostics, [&](Compilation& c) { return c.run(shader); });
        done(element, ok ? Result<Shader>(std::move(shader)) : Failure{}, diagnostics);
    }
}

Result<Shader> Compiler::generate(const doc::Document& document, doc::ElementId element, const GenerateOptions& options,
                                  Diagnostics& diagnostics) {
    Result<Shader> made = Failure{};
    generate(document, std::span(&element, 1), options,
             [&](doc::ElementId, Result<Shader> shader, const Diagnostics& found) {
                 for (const Diagnostic& d : found.all()) diagnostics.add(d.severity, d.code, d.message) = d;
                 made = std::move(shader);
             });
    return made;
}

Result<std::vector<passes::Lobe>> Compiler::lobes(const doc::Document& document, doc::ElementId element,
                                                  const GenerateOptions& options, Diagnostics& diagnostics) {
    std::vector<passes::Lobe> lobes;
    GenerateOptions all = options;
    all.interface = Interface::Complete;
    Batch batch;
    if (!compile(batch, document, element, all, diagnostics, [&](Compilation& c) { return c.findLobes(lobes); }))
        return Failure{};
    return lobes;
}

Result<std::vector<passes::NodeCost>> Compiler::costs(const doc::Document& document, doc::ElementId element,
                                                      const GenerateOptions& options, Diagnostics& diagnostics) {
    std::vector<passes::NodeCost> costs;
    Batch batch;
    if (!compile(batch, document, element, options, diagnostics, [&](Compilation& c) { return c.findCosts(costs); }))
        return Failure{};
    return costs;
}

// Of all nodes of a library that make surfaces: with no geometric property connected, and with one.
static void makeCompleteForms(NameTable& names, const doc::Definitions& definitions, NodeBodies& bodies,
                              Library& library) {
    const doc::Document none(names, library.document().known());
    const GenerateOptions how;
    Diagnostics told;
    passes::Specialisations made;
    text::FunctionTexts texts;
    Compilation c{none, none.root(), how, told, names, definitions, bodies, made, nullptr, texts, ir::Module(names)};
    c.module.sources = {&bodies, &library};
    for (const doc::NodeDefRow& row : library.index().nodedefs)
        if (row.output == none.known().surfaceshader) {
            const doc::NodeDef def = definitions.byName(row.name);
            const Name function = bodies.functionOf(def, told);
            if (!function) continue;
            c.completeForm(def, function, {});
            for (const doc::Port& port : definitions.inputs(def))
                if (c.isProperty(def, port)) c.completeForm(def, function, std::span(&port.name, 1));
        }
}

std::vector<std::uint8_t> packLibrary(std::vector<LibraryFile> files, Diagnostics& diagnostics) {
    std::vector<std::uint8_t> image;
    guarded(diagnostics, "library", [&] {
        NameTable names;
        auto library = makeLibrary(names, std::move(files), {}, diagnostics);
        if (!library) return false;
        doc::Definitions definitions;
        definitions.add(library->document(), library->index());
        bool valid = doc::validate(library->document(), definitions, diagnostics, {false, true});
        NodeBodies bodies(names, definitions, {library.get()});
        for (const doc::NodeDefRow& row : library->index().nodedefs)
            if (doc::NodeDef def = definitions.byName(row.name); definitions.implementation(def))
                valid = bodies.functionOf(def, diagnostics) && valid;
        if (!valid) return false;
        makeCompleteForms(names, definitions, bodies, *library);
        std::vector<const ir::Function*> functions = library->functions();
        for (const auto& f : bodies.made().functions) functions.push_back(f.get());
        std::sort(functions.begin(), functions.end(), [](const auto* a, const auto* b) { return a->name < b->name; });
        image = writeImage(*library, library->signatures(), functions, bodies.made().leaves, names);
        return true;
    });
    return image;
}

}  // namespace shaderx
