#include "compile/bodies.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/numbers.h"
#include "compile/color_conversion.h"
#include "graph/values.h"
#include "ir/builder.h"
#include "passes/decode.h"
#include "passes/specialise.h"

namespace shaderx {

using namespace ir;

NodeBodies::NodeBodies(NameTable& names, const doc::Definitions& definitions, std::vector<Library*> libraries,
                       const BodyOptions& options)
    : names_(names), definitions_(definitions), libraries_(std::move(libraries)), options_(options), made_(names_) {
    made_.structs = graph::structsOf(definitions_);
    for (Library* l : libraries_) made_.sources.push_back(l);
}

const LeafInfo* NodeBodies::findLeaf(Name name) {
    for (const LeafInfo& l : made_.leaves)
        if (l.name == name) return &l;
    return nullptr;
}

Name NodeBodies::functionOf(doc::NodeDef def, Diagnostics& diagnostics) {
    Name name = nameOf(def);
    if (made_.find(name)) return name;
    doc::Implementation implementation = definitions_.implementation(def);
    std::size_t errors = diagnostics.errorCount();
    bool ok = guarded(def, diagnostics, [&] {
        switch (implementation.kind) {
            case doc::Implementation::Kind::Graph:
                return fromGraph(def, implementation, name, {}, diagnostics);
            case doc::Implementation::Kind::Source:
                return fromSource(def, implementation, diagnostics);
            case doc::Implementation::Kind::None:
                break;
        }
        return false;
    });
    if (ok) passes::flatten(made_, *made_.findOwn(name));
    if (!ok && implementation && diagnostics.errorCount() == errors) {
        doc::ElementRef element = implementation.element;
        Diagnostic& e =
            diagnostics.error("no-body", fmt::format("'{}' cannot be implemented like this", names_.text(name)));
        e.where = element.document->locate(element.id);
        e.path = element.document->path(element.id);
    }
    return ok ? name : Name();
}

// Makes a function of a nodedef unless that is under way already or too deep within others.
bool NodeBodies::guarded(doc::NodeDef def, Diagnostics& diagnostics, const std::function<bool()>& make) {
    const Name name = definitions_.row(def).name;
    const bool isTooDeep = underWay_.size() >= options_.maxDepth;
    if (!isTooDeep && underWay_.insert(name).second) {
        const bool ok = make();
        underWay_.erase(name);
        return ok;
    }
    doc::ElementRef element = definitions_.element(def);
    Diagnostic& e =
        isTooDeep
            ? diagnostics.error("limit", fmt::format("'{}' is used within more than {} nodes that are made of others",
                                                     names_.text(name), options_.maxDepth))
            : diagnostics.error("recursive-node",
                                fmt::format("the implementation of '{}' uses the node itself", names_.text(name)));
    e.where = element.document->locate(element.id);
    e.path = element.document->path(element.id);
    return false;
}

bool NodeBodies::fromGraph(doc::NodeDef def, const doc::Implementation& implementation, Name name,
                           const graph::Instance& instance, Diagnostics& diagnostics) {
    graph::Graph g;
    g.unknownIsDefault = options_.unknownIsDefault;
    const doc::Document& d = *implementation.graph.document;
    if (!graph::build(d, implementation.graph.id, definitions_, g, diagnostics)) return false;
    graph::LowerOptions how;
    how.scene = options_.scene;
    how.instance = instance;
    return graph::lower(g, definitions_, *this, def, name, how, made_, diagnostics);
}

// A graph is lowered anew for its files. In any other function, reads are converted where one that gives a color reads
// more than once; of one read, the caller may as well convert what it gives.
Name NodeBodies::instanceOf(doc::NodeDef def, const graph::Instance& instance, bool& decodes,
                            Diagnostics& diagnostics) {
    decodes = true;
    const doc::Implementation implementation = definitions_.implementation(def);
    const Name plain = functionOf(def, diagnostics);
    if (!plain) return {};
    if (implementation.kind == doc::Implementation::Kind::Graph) {
        std::string text(names_.text(plain));
        for (const graph::FileSpace& f : instance.files)
            text.append(f.isExplicit ? "@=" : "@").append(names_.text(f.name));
        for (const auto& [token, value] : instance.tokens)
            text.append("@[").append(names_.text(token)).append("]=").append(names_.text(value));
        const Name name = names_.intern(text);
        if (made_.findOwn(name)) return name;
        const bool ok =
            guarded(def, diagnostics, [&] { return fromGraph(def, implementation, name, instance, diagnostics); });
        if (ok) passes::flatten(made_, *made_.findOwn(name));
        return ok ? name : Name();
    }
    auto outputs = definitions_.outputs(def);
    const bool givesColor = std::any_of(outputs.begin(), outputs.end(), [&](const doc::Port& p) {
        const Type type = typeNamed(names_.text(p.type));
        return type == Type::Color3 || type == Type::Color4;
    });
    if (!givesColor) return plain;
    decodes = !passes::isPlainRead(*made_.find(plain));
    if (!decodes) return plain;
    std::vector<Name> conversions;
    for (const graph::FileSpace& f : instance.files)
        conversions.push_back(f.name ? toWorkingSpace(f.name, Type::Color4, diagnostics).function : Name());
    return passes::decodeReads(made_, plain, conversions);
}

bool NodeBodies::fromSource(doc::NodeDef def, const doc::Implementation& implementation, Diagnostics& diagnostics) {
    doc::ElementRef element = implementation.element;
    const doc::WellKnown& k = element.document->known();
    auto text = [&](std::string_view attribute) { return element.attributeText(names_.intern(attribute)); };
    const bool isLibrary = std::any_of(libraries_.begin(), libraries_.end(),
                                       [&](const Library* l) { return &l->document() == element.document; });
    const bool isReserved = !text("leaf").empty() || !text("builder").empty();
    if (isReserved && !(isLibrary && (text("builder").empty() || element.document == &libraries_.back()->document()))) {
        Diagnostic& e = diagnostics.error("reserved-attribute", "the implementation says what is for libraries only");
        e.where = element.document->locate(element.id);
        e.path = element.document->path(element.id);
        return false;
    }
    if (std::string_view name = text("leaf"); !name.empty()) return leaf(def, name);
    if (text("builder") == "attribute") return attribute(def);
    if (text("builder") == "colortransform") return colorTransform(def, element, diagnostics);
    if (Name code = element.attribute(k.sourcecode)) return inlineText(def, element, names_.text(code), diagnostics);
    if (Name function = element.attribute(k.function)) return wrap(def, element, names_.text(function), diagnostics);
    Diagnostic& e = diagnostics.error("no-body", "the implementation has neither source code nor a function");
    e.where = element.document->locate(element.id);
    e.path = element.document->path(element.id);
    return false;
}

const std::vector<sl::Signature>& NodeBodies::known() {
    if (known_.empty())
        for (Library* l : libraries_) known_.insert(known_.end(), l->signatures().begin(), l->signatures().end());
    return known_;
}

// The name of a nodedef's function: that of the nodedef, unless another library has a function of this name.
Name NodeBodies::nameOf(doc::NodeDef def) const {
    Name name = definitions_.row(def).name;
    const doc::Document* home = definitions_.element(def).document;
    for (Library* l : libraries_) {
        if (&l->document() == home) continue;
        if (l->find(name)) return names_.intern(fmt::format("{}#{}", names_.text(name), def.layer));
    }
    return name;
}

Function NodeBodies::start(doc::NodeDef def) const {
    Function f;
    f.name = nameOf(def);
    f.isInline = true;
    for (const doc::Port& p : definitions_.inputs(def))
        f.params.push_back({p.name, graph::typeOf(definitions_, names_.text(p.type))});
    return f;
}

// From a place in an implementation's source code to that in the document.
static void placeInCode(doc::ElementRef element, std::string_view code, Location& where) {
    if (!where.file.empty() || !where.line) return;
    std::size_t offset = where.column - 1;
    for (std::size_t line = 1, at = 0; line < where.line; line++) {
        const std::size_t next = code.find('\n', at) + 1;
        offset += next - at;
        at = next;
    }
    where = element.document->locateInValue(element.id, element.document->known().sourcecode, offset);
}

bool NodeBodies::inlineText(doc::NodeDef def, doc::ElementRef element, std::string_view text,
                            Diagnostics& diagnostics) {
    Function f = start(def);
    std::vector<Param> results;
    for (const doc::Port& p : definitions_.outputs(def))
        results.push_back({p.name, graph::typeOf(definitions_, names_.text(p.type))});
    Diagnostics found;
    const bool ok = sl::compileInline(made_, f.name, f.params, results, {{}, text}, known(), found);
    for (Diagnostic each : found.all()) {
        placeInCode(element, text, each.where);
        for (Note& n : each.notes) placeInCode(element, text, n.where);
        each.path = element.document->path(element.id);
        diagnostics.add(std::move(each));
    }
    return ok;
}

// A function of the library as the node's: parameters by position, converted where the types differ.
bool NodeBodies::wrap(doc::NodeDef def, doc::ElementRef element, std::string_view function, Diagnostics& diagnostics) {
    Function f = start(def);
    const Function* callee = nullptr;
    Builder b(made_, f);
    auto outputs = definitions_.outputs(def);
    auto fail = [&](std::string message) {
        Diagnostic& e = diagnostics.error("bad-function", std::move(message));
        e.where = element.document->locate(element.id);
        e.path = element.document->path(element.id);
        return false;
    };
    std::string problem = fmt::format("there is no function '{}'", function);
    for (const sl::Signature& s : known()) {
        if (names_.text(s.plainName) != function) continue;
        problem = fmt::format("no function '{}' takes the inputs of '{}'", function, names_.text(f.name));
        bool fits = s.params.size() == f.params.size() && (s.result != Type::Void) + s.outputs.size() == outputs.size();
        for (std::size_t i = 0; fits && i < s.params.size(); i++)
            fits = s.params[i].type == f.params[i].type ||
                   (componentCount(s.params[i].type) == componentCount(f.params[i].type) &&
                    componentCount(s.params[i].type) > 0);
        if (fits) callee = made_.find(s.name);
        if (callee) break;
    }
    if (!callee) return fail(problem);
    std::vector<ExprId> arguments;
    for (std::uint32_t i = 0; i < f.params.size(); i++)
        arguments.push_back(b.convert(b.param(i), callee->params[i].type));
    bool single = callee->results.size() == 1;
    ExprId call = b.call(callee->name, single ? callee->results[0].type : Type::Tuple, arguments);
    for (std::uint32_t k = 0; k < outputs.size(); k++) {
        ExprId value = single ? call : b.result(call, k, callee->results[k].type);
        value = b.convert(value, typeNamed(names_.text(outputs[k].type)));
        if (!value)
            return fail(
                fmt::format("'{}' gives another type than the output '{}'", function, names_.text(outputs[k].name)));
        b.addResult(outputs[k].name, value);
    }
    made_.put(std::move(f));
    return true;
}

bool NodeBodies::leaf(doc::NodeDef def, std::string_view name) {
    Function f = start(def);
    Builder b(made_, f);
    std::vector<ExprId> inputs;
    for (std::uint32_t i = 0; i < f.params.size(); i++) inputs.push_back(b.param(i));
    Name leafName = names_.intern(name);
    auto outputs = definitions_.outputs(def);
    if (outputs.size() != 1 || !isClosure(typeNamed(names_.text(outputs[0].type)))) return false;
    const LeafInfo* known = made_.leaf(leafName);
    auto isSame = [](const Param& x, const Param& y) { return x.name == y.name && x.type == y.type; };
    if (known && !std::equal(f.params.begin(), f.params.end(), known->params.begin(), known->params.end(), isSame))
        return false;  // whoever evaluates it finds its inputs by their places
    if (!known) made_.leaves.push_back({leafName, f.params});
    b.addResult(outputs[0].name, b.emit(Op::Leaf, typeNamed(names_.text(outputs[0].type)), inputs, leafName.index));
    made_.put(std::move(f));
    return true;
}

// texcoord and geomcolor by index, which picks one of the attributes; geompropvalue by name.
bool NodeBodies::attribute(doc::NodeDef def) {
    std::string_view category = names_.text(definitions_.row(def).category);
    if (category == "texcoord" || category == "geomcolor") return attributeSet(def, nameOf(def), 0, graph::kUsualSets);
    Function f = start(def);
    Builder b(made_, f);
    auto outputs = definitions_.outputs(def);
    Type type = typeNamed(names_.text(outputs[0].type));
    // Geometry carries floats; what text or file it names is not known where pixels are computed: that is the default.
    constexpr std::uint32_t kName = 0, kDefault = 1;
    ExprId value;
    if (componentCount(type) == 0)
        value = f.params.size() > kDefault ? b.param(kDefault) : b.null(type);
    else if (f.params.empty())
        value = b.null(type);
    else
        value = b.emit(Op::GeomProp, info(type).scalar == Scalar::Float ? type : Type::Float, {b.param(kName)});
    if (b.type(value) != type) value = b.convert(value, type);
    if (!value) return false;
    b.addResult(outputs[0].name, value);
    made_.put(std::move(f));
    return true;
}

// The function of a node that reads one of the sets from `first` to before `end`, by its index where these are several;
// another index is 0.
bool NodeBodies::attributeSet(doc::NodeDef def, Name name, int first, int end) {
    Function f = start(def);
    f.name = name;
    Builder b(made_, f);
    const bool isTexcoord = names_.text(definitions_.row(def).category) == "texcoord";
    auto outputs = definitions_.outputs(def);
    const Type type = typeNamed(names_.text(outputs[0].type)), held = isTexcoord ? Type::Vector2 : Type::Color4;
    ExprId value;
    for (int i = end; i-- > first;) {
        const ExprId set = b.attribute(names_.intern(fmt::format("{}_{}", isTexcoord ? "texcoord" : "color", i)), held);
        if (end - first == 1 || f.params.empty()) {
            value = set;
        } else {
            const ExprId isSet = b.op(Op::Equal, {b.param(0), b.integer(i)});
            value = b.select(isSet, set, value ? value : b.null(held));
        }
    }
    if (type == Type::Vector3) value = b.make(type, {value, b.number(0)});
    if (type == Type::Color3) value = b.swizzle(value, swizzleMask(3, 0, 1, 2));
    if (type == Type::Float) value = b.component(value, 0);
    if (b.type(value) != type) value = b.convert(value, type);
    if (!value) return false;
    b.addResult(outputs[0].name, value);
    made_.put(std::move(f));
    return true;
}

Name NodeBodies::setOf(doc::NodeDef def, int index, Diagnostics& diagnostics) {
    const Name plain = functionOf(def, diagnostics);
    if (!plain || (index >= 0 && index < graph::kUsualSets)) return plain;
    constexpr int kAllSets = 32;
    const std::string_view which = names_.text(plain);
    const Name name = names_.intern(index < 0 ? fmt::format("{}@any", which) : fmt::format("{}@{}", which, index));
    if (made_.findOwn(name)) return name;
    const bool ok = index < 0 ? attributeSet(def, name, 0, kAllSets) : attributeSet(def, name, index, index + 1);
    return ok ? name : Name();
}

doc::NodeDef NodeBodies::nodeFor(std::string_view category, Type type) {
    Name name = names_.find(category);
    if (!name) return {};
    for (doc::NodeDef def : definitions_.ofCategory(name))
        if (typeNamed(names_.text(definitions_.row(def).output)) == type) return def;
    return {};
}

graph::ColorConversion NodeBodies::toWorkingSpace(Name from, Type type, Diagnostics& diagnostics) {
    const std::uint64_t key = std::uint64_t{from.index} << 8 | static_cast<std::uint64_t>(type);
    auto [at, isNew] = conversions_.try_emplace(key);
    if (!isNew) return at->second;
    graph::ColorConversion made;
    const std::string_view space = names_.text(from);
    // Nodes of a library go before what is computed: X_to_Y.
    if (doc::NodeDef def = nodeFor(fmt::format("{}_to_{}", space, options_.scene.colorspace), type)) {
        made.function = functionOf(def, diagnostics);
    } else {
        const doc::ColorSpace *source = spaces_.find(space), *target = spaces_.find(options_.scene.colorspace);
        made.isKnown = source && target;
        if (made.isKnown) made.function = conversion(*source, *target, type, diagnostics);
    }
    return conversions_[key] = made;
}

Name NodeBodies::conversion(const doc::ColorSpace& from, const doc::ColorSpace& to, Type type,
                            Diagnostics& diagnostics) {
    const std::string text = conversionText(from, to, type == Type::Color4);
    if (text.empty()) return {};
    const std::string title = fmt::format("{}_to_{}", from.name, to.name);
    if (doc::NodeDef def = nodeFor(title, type)) return functionOf(def, diagnostics);
    const Name name = names_.intern(fmt::format("{}_{}", title, info(type).name));
    const Param in{names_.intern("in"), type}, out{names_.intern("out"), type};
    const bool ok = made_.find(name) || sl::compileInline(made_, name, std::span(&in, 1), std::span(&out, 1),
                                                          {title, text}, known(), diagnostics);
    return ok ? name : Name();
}

// A node that converts between two colour spaces.
bool NodeBodies::colorTransform(doc::NodeDef def, doc::ElementRef element, Diagnostics& diagnostics) {
    const doc::ColorSpace* from = spaces_.find(element.attributeText(names_.intern("from")));
    const doc::ColorSpace* to = spaces_.find(element.attributeText(names_.intern("to")));
    auto outputs = definitions_.outputs(def);
    if (!from || !to || outputs.size() != 1) return false;
    const std::string text = conversionText(*from, *to, typeNamed(names_.text(outputs[0].type)) == Type::Color4);
    return inlineText(def, element, text.empty() ? "{{in}}" : text, diagnostics);
}

float NodeBodies::unitScale(std::string_view type, std::string_view unit) {
    const Name unitType = names_.find("unittype"), scale = names_.find("scale");
    for (const doc::ElementRef& e : definitions_.declared("unitdef")) {
        if (e.attributeText(unitType) != type) continue;
        const doc::Document& d = *e.document;
        if (doc::ElementId found = d.child(e.id, unit)) return parseFloat(d.attributeText(found, scale)).value_or(0);
    }
    return 0;
}

doc::ElementRef NodeBodies::geometricProperty(Name name) {
    for (const doc::ElementRef& e : definitions_.declared("geompropdef"))
        if (e->name == name) return e;
    return {};
}

}  // namespace shaderx
