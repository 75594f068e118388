#include "doc/check.h"

#include <algorithm>

#include <fmt/format.h>

#include "doc/check_cycles.h"
#include "doc/check_unused.h"
#include "doc/color_spaces.h"
#include "doc/connect.h"
#include "doc/values.h"

namespace shaderx::doc {

namespace {

using Kind = Connection::Kind;

struct Checker {
    const Document& d;
    const Definitions& definitions;
    const CheckOptions& options;
    Findings findings{d};
    const WellKnown& k = d.known();
    Resolved resolved{};
    std::vector<bool> isRead{};  // of graph inputs: an interfacename names it
    int hintsLeft = 100;         // looking for similar names is slow, so a wholly wrong document gets only some hints
    std::vector<Name> knownCategories{};

    std::string_view text(Name n) const { return d.text(n); }
    Name typeOf(ElementId e) const { return d.attribute(e, k.type); }
    bool is(ElementId e, Name category) const { return d[e].category == category; }

    Diagnostic& error(std::string_view code, std::string message, ElementId e, Name attr = {}) {
        return findings.error(code, std::move(message), e, attr);
    }
    Diagnostic& warning(std::string_view code, std::string message, ElementId e, Name attr = {}) {
        return findings.warning(code, std::move(message), e, attr);
    }
    static void note(Diagnostic& out, std::string message) { out.notes.emplace_back().message = std::move(message); }
    void hint(Diagnostic& out, Name word, const std::vector<std::string_view>& candidates) {
        if (hintsLeft <= 0) return;
        hintsLeft--;
        if (std::string_view best = nearest(text(word), candidates); !best.empty() && best != text(word))
            out.hint = fmt::format("did you mean '{}'?", best);
    }

    // Names of the children that a test accepts, for hints.
    template <class Test>
    std::vector<std::string_view> namesIn(ElementId scope, Test test) const {
        constexpr std::size_t kMost = 2000;
        std::vector<std::string_view> out;
        if (hintsLeft <= 0) return out;
        for (ElementId c : children(d, scope))
            if (d[c].name && out.size() < kMost && test(c)) out.push_back(text(d[c].name));
        return out;
    }

    void run();
    void checkName(ElementId e);
    void checkNode(ElementId node);
    void untyped(ElementId node, Match found);
    void checkChildren(ElementId node);
    void explain(ElementId node, Match found);
    void unknownNode(ElementId node);
    void explainInputs(ElementId node, const std::vector<NodeDef>& candidates);
    void checkInput(ElementId input, ElementId owner);
    void checkPort(ElementId port);
    void checkInterface(ElementId port, const Connection& c);
    void dangling(ElementId port, const Connection& c);
    Name upstreamType(ElementId port, const Connection& c, std::string& source);
    void checkValue(ElementId e);
    void checkChoice(ElementId port);
    void checkType(ElementId e);
    void checkNodedef(ElementId e);
    void checkGraph(ElementId e);
    void checkImplementation(ElementId e);
    void checkLook(ElementId e);
    void checkReference(ElementId e, Name attr, std::string_view what, bool found, Name wanted,
                        Severity severity = Severity::Error);
    std::string signature(NodeDef def) const;
};

bool hasRequiredName(const Document& d, ElementId e) {
    const WellKnown& k = d.known();
    Name c = d[e].category;
    return c == k.input || c == k.output || c == k.nodegraph || c == k.nodedef || c == k.token || c == k.implementation;
}

void Checker::checkName(ElementId e) {
    Name name = d[e].name;
    if (!name || text(name).empty()) {
        if (hasRequiredName(d, e) || isNode(d, e))
            error("missing-name", fmt::format("<{}> needs a name", text(d[e].category)), e);
        return;
    }
    ElementId first = d.child(d[e].parent, name);
    if (!first || first == e) return;
    Diagnostic& out = error("duplicate-name", fmt::format("the name '{}' is used twice here", text(name)), e, k.name);
    out.notes.push_back({d.locate(first, k.name), "it is first used here"});
    findings.all.back().other = first;
}

void Checker::checkValue(ElementId e) {
    if (!d.attribute(e, k.value)) return;
    if (std::optional<Diagnostic> found = judgeValue(d, e)) findings.add(std::move(*found), e);
}

// Whether a node's text is one of those that its nodedef lists.
void Checker::checkChoice(ElementId port) {
    if (typeOf(port) != k.string || !d.attribute(port, k.value)) return;
    NodeDef def = resolved.nodedefs[d[port].parent.index];
    const Port* declared = def ? definitions.input(def, d[port].name) : nullptr;
    if (!declared) return;
    if (std::optional<Diagnostic> found = judgeChoice(d, port, definitions.element(def, *declared)))
        findings.add(std::move(*found), port);
}

// Whether the type of a port is one at all.
void Checker::checkType(ElementId e) {
    Name type = typeOf(e);
    if (!type || valueType(text(type)) || type == k.surfaceshader || type == k.material || definitions.hasType(type))
        return;
    hint(error("unknown-type", fmt::format("there is no type '{}'", text(type)), e, k.type), type, definitions.types());
}

std::string Checker::signature(NodeDef def) const {
    std::string out(text(definitions.row(def).category));
    out += '(';
    constexpr std::size_t kMost = 8;
    std::size_t count = 0;
    for (const Port& p : definitions.inputs(def)) {
        if (count) out += ", ";
        if (count++ == kMost) {
            out += "…";
            break;
        }
        out.append(text(p.name)).append(": ").append(text(p.type));
    }
    return out + fmt::format(") gives {}", text(definitions.row(def).output));
}

// "a, b or c"
std::string alternatives(const std::vector<std::string_view>& words) {
    std::string out;
    for (std::size_t i = 0; i < words.size(); i++) {
        if (i) out += i + 1 == words.size() ? " or " : ", ";
        out += words[i];
    }
    return out;
}

void addOnce(std::vector<std::string_view>& words, std::string_view word) {
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
}

void Checker::unknownNode(ElementId node) {
    Name category = d[node].category;
    std::string message = fmt::format("there is no node <{}>", text(category));
    if (options.unknownIsDefault) {
        warning("unknown-node", message + "; what reads it takes its default", node);
        return;
    }
    Diagnostic& out = error("unknown-node", std::move(message), node);
    if (knownCategories.empty()) knownCategories = definitions.categories();
    std::vector<std::string_view> names;
    if (hintsLeft > 0)
        for (Name n : knownCategories) names.push_back(text(n));
    hint(out, category, names);
    if (out.hint.empty())
        out.hint = "--library adds the definitions of a folder; with --unknown=default its readers take their defaults";
}

// Says why no nodedef fits a node exactly.
void Checker::explain(ElementId node, Match found) {
    Name category = d[node].category, type = typeOf(node), space = d.namespaceOf(node);
    Name nodedef = d.attribute(node, k.nodedef), version = d.attribute(node, k.version);
    if (nodedef) {
        if (!found && options.unknownIsDefault && !definitions.hasCategory(category, space)) return unknownNode(node);
        if (!found) {
            Diagnostic& out =
                error("dangling-nodedef", fmt::format("there is no nodedef '{}'", text(nodedef)), node, k.nodedef);
            std::vector<std::string_view> names;
            for (NodeDef def : definitions.ofCategory(category, space))
                names.push_back(text(definitions.row(def).name));
            hint(out, nodedef, names);
            return;
        }
        Name output = definitions.row(found.def).output;
        if (type && type != output)
            error("type-mismatch",
                  fmt::format("the nodedef '{}' gives {}, not {}", text(nodedef), text(output), text(type)), node,
                  k.type);
        explainInputs(node, {found.def});
        return;
    }
    std::vector<NodeDef> all = definitions.ofCategory(category, space), typed;
    if (all.empty()) return unknownNode(node);
    std::vector<std::string_view> types, versions;
    for (NodeDef def : all) {
        Name defVersion = definitions.row(def).version;
        if (version && defVersion && defVersion != version) {
            addOnce(versions, text(defVersion));
            continue;
        }
        addOnce(types, text(definitions.row(def).output));
        if (!type || definitions.row(def).output == type) typed.push_back(def);
    }
    if (types.empty()) {
        note(error("unknown-version", fmt::format("<{}> has no version {}", text(category), text(version)), node,
                   k.version),
             fmt::format("its versions are {}", alternatives(versions)));
    } else if (typed.empty()) {
        note(error("no-signature", fmt::format("<{}> cannot give {}", text(category), text(type)), node, k.type),
             fmt::format("it gives {}", alternatives(types)));
    } else {
        explainInputs(node, typed);
    }
}

void Checker::explainInputs(ElementId node, const std::vector<NodeDef>& candidates) {
    bool told = false;
    std::string given;
    for (ElementId c : children(d, node)) {
        if (!is(c, k.input) || !d[c].name) continue;
        std::vector<std::string_view> names, types;
        bool fits = false;
        for (NodeDef def : candidates)
            for (const Port& p : definitions.inputs(def)) {
                addOnce(names, text(p.name));
                if (p.name != d[c].name) continue;
                addOnce(types, text(p.type));
                fits |= !typeOf(c) || p.type == typeOf(c);
            }
        given += fmt::format("{}{}: {}", given.empty() ? "" : ", ", text(d[c].name), text(typeOf(c)));
        if (types.empty()) {
            Diagnostic& out =
                error("unknown-input", fmt::format("<{}> has no input '{}'", text(d[node].category), text(d[c].name)),
                      c, k.name);
            hint(out, d[c].name, names);
            told = true;
        } else if (!fits) {
            error("type-mismatch",
                  fmt::format("the input '{}' of <{}> is {}, not {}", text(d[c].name), text(d[node].category),
                              alternatives(types), text(typeOf(c))),
                  c, k.type);
            told = true;
        }
    }
    if (told || candidates.size() < 2) return;
    Diagnostic& out = error(
        "no-signature",
        fmt::format("no signature of <{}> takes ({}) and gives {}", text(d[node].category), given, text(typeOf(node))),
        node);
    constexpr std::size_t kMost = 8;
    for (std::size_t i = 0; i < candidates.size() && i < kMost; i++) note(out, "there is " + signature(candidates[i]));
}

void Checker::checkNode(ElementId node) {
    Match found = definitions.match(d, node);
    resolved.nodedefs[node.index] = found.def;
    if (!typeOf(node)) untyped(node, found);
    if (!found.exact) explain(node, found);
    checkChildren(node);
}

// A node without a type. One that names its nodedef is none the less understood.
void Checker::untyped(ElementId node, Match found) {
    const std::string_view category = text(d[node].category);
    if (found && d.attribute(node, k.nodedef))
        warning(
            "odd-value",
            fmt::format("<{}> has no type; its nodedef gives {}", category, text(definitions.row(found.def).output)),
            node);
    else
        error("missing-attribute", fmt::format("<{}> needs a type", category), node);
}

// A misspelt <input> would do nothing.
void Checker::checkChildren(ElementId node) {
    for (ElementId c : children(d, node)) {
        Name category = d[c].category;
        if (category == k.input || category == k.output || category == k.token || category == k.parameter) continue;
        if (text(category).starts_with('#')) continue;
        hint(warning("ignored-element", fmt::format("a node has no <{}>; it is left out", text(category)), c), category,
             {"input", "output", "token"});
    }
}

// The type of what a port reads, none if it is not known (and said elsewhere).
Name Checker::upstreamType(ElementId port, const Connection& c, std::string& source) {
    source = d.path(c.target);
    Name type = typeOf(c.target);
    if (c.kind != Kind::Node) return type;
    NodeDef def = resolved.nodedefs[c.target.index];
    if (!type && def) type = definitions.row(def).output;
    if (!c.output) {
        if (type != k.multioutput || !def) return type == k.multioutput ? Name() : type;
        auto outputs = definitions.outputs(def);
        return outputs.empty() ? Name() : outputs[0].type;
    }
    source += fmt::format(" (output {})", text(c.output));
    const Port* output = def ? definitions.output(def, c.output) : nullptr;
    if (output) return output->type;
    if (ElementId own = d.child(c.target, k.output, c.output)) return typeOf(own);
    if (type != k.multioutput && c.output == k.out) return type;
    if (!def) return {};
    Diagnostic& out = error("dangling-output", fmt::format("'{}' has no output '{}'", d.path(c.target), text(c.output)),
                            port, k.output);
    std::vector<std::string_view> names;
    for (const Port& p : definitions.outputs(def)) names.push_back(text(p.name));
    hint(out, c.output, names);
    return {};
}

void Checker::dangling(ElementId port, const Connection& c) {
    Name wanted = d.attribute(port, c.attribute);
    ElementId owner = d[port].parent;
    ElementId scope = is(port, k.output) || !d[owner].parent ? owner : d[owner].parent;
    std::string where = scope == d.root() ? "the document" : fmt::format("'{}'", d.path(scope));
    std::vector<std::string_view> names;
    std::string message;
    if (c.attribute == k.nodename) {
        message = fmt::format("there is no node '{}' in {}", text(wanted), where);
        names = namesIn(scope, [&](ElementId e) { return isNode(d, e) || is(e, k.nodegraph); });
    } else if (c.attribute == k.nodegraph) {
        message = fmt::format("there is no nodegraph '{}' in {}", text(wanted), where);
        names = namesIn(d.root(), [&](ElementId e) { return is(e, k.nodegraph); });
    } else {
        Name graphName = d.attribute(port, k.nodegraph);
        if (!graphName) graphName = d.attribute(port, k.nodename);
        ElementId graph = graphName ? d.childFrom(port, scope, graphName) : scope;
        if (!graph) graph = d.childFrom(port, d.root(), graphName);
        if (graphName) where = fmt::format("the nodegraph '{}'", text(graphName));
        message = wanted ? fmt::format("there is no output '{}' in {}", text(wanted), where)
                         : fmt::format("{} has no output", where);
        if (graph) names = namesIn(graph, [&](ElementId e) { return is(e, k.output); });
    }
    std::string code = fmt::format("dangling-{}", text(c.attribute));
    Diagnostic& out = error(code, std::move(message), port, wanted ? c.attribute : Name());
    if (wanted) hint(out, wanted, names);
}

void Checker::checkInterface(ElementId port, const Connection& c) {
    Name wanted = d.attribute(port, k.interfacename), type = c.target ? typeOf(c.target) : Name();
    if (c.target) isRead[c.target.index] = true;
    ElementId owner = d[port].parent, graph = is(port, k.output) ? owner : d[owner].parent;
    bool inGraph = graph && is(graph, k.nodegraph);
    NodeDef def = inGraph ? resolved.nodedefs[graph.index] : NodeDef();
    if (const Port* p = def ? definitions.input(def, wanted) : nullptr; p && !c.target) type = p->type;
    if (!c.target && !type) {
        if (is(owner, k.nodegraph) && !is(port, k.output) && !inGraph) {
            warning("dangling-interfacename",
                    fmt::format("'{}' names an input '{}' of what is around it, but nothing is; {}", d.path(port),
                                text(wanted),
                                d.attribute(port, k.value) ? "its value holds" : "its readers take their defaults"),
                    port, k.interfacename);
            return;
        }
        // The nodedef that is missing may have it.
        const bool isOrphan = inGraph && !def && d.attribute(graph, k.nodedef);
        Diagnostic& out = error("dangling-interfacename",
                                inGraph ? fmt::format("'{}' has no input '{}'", d.path(graph), text(wanted))
                                        : fmt::format("'{}' is not in a nodegraph with inputs", d.path(port)),
                                port, k.interfacename);
        if (isOrphan) out.severity = Severity::Warning;
        std::vector<std::string_view> names;
        if (inGraph) names = namesIn(graph, [&](ElementId e) { return is(e, k.input); });
        if (def)
            for (const Port& p : definitions.inputs(def)) names.push_back(text(p.name));
        hint(out, wanted, names);
        return;
    }
    if (type && typeOf(port) && type != typeOf(port))
        error("type-mismatch",
              fmt::format("the input '{}' is {}, but the interface input '{}' is {}", text(d[port].name),
                          text(typeOf(port)), text(wanted), text(type)),
              port, k.interfacename);
}

// An input or output: its value and connection.
void Checker::checkPort(ElementId port) {
    if (!typeOf(port) && d[port].name)
        error("missing-attribute", fmt::format("<{}> needs a type", text(d[port].category)), port);
    ElementId owner = d[port].parent;
    if (owner == d.root() || is(owner, k.nodegraph)) checkType(port);
    checkValue(port);
    Connection c = connection(d, port);
    if (c.kind == Kind::None) return checkChoice(port);
    if (c.kind == Kind::Dangling) return dangling(port, c);
    resolved.targets[port.index] = c.target;
    if (c.kind == Kind::Interface) return checkInterface(port, c);
    std::string source;
    Name type = upstreamType(port, c, source);
    if (!type || !typeOf(port) || type == typeOf(port) || d.attribute(port, k.channels)) return;
    error("type-mismatch",
          fmt::format("the {} '{}' is {}, but '{}' gives {}", text(d[port].category), text(d[port].name),
                      text(typeOf(port)), source, text(type)),
          port, c.attribute);
}

void Checker::checkReference(ElementId e, Name attr, std::string_view what, bool found, Name wanted,
                             Severity severity) {
    if (!wanted || found) return;
    Diagnostic& out = error(fmt::format("dangling-{}", what == "collection" ? "collection" : text(attr)),
                            fmt::format("there is no {} '{}'", what, text(wanted)), e, attr);
    out.severity = severity;
    hint(out, wanted, namesIn(d.root(), [&](ElementId c) {
             if (what == "material") return typeOf(c) == k.material;
             return text(d[c].category) == what;
         }));
}

void Checker::checkNodedef(ElementId e) {
    if (!d.attribute(e, k.node))
        error("missing-attribute", "a nodedef needs an attribute 'node': the category of its nodes", e);
    Name inherit = d.attribute(e, k.inherit);
    checkReference(e, k.inherit, "nodedef", static_cast<bool>(definitions.byName(inherit, d.namespaceOf(e))), inherit);
    for (ElementId c : children(d, e)) {
        if (!is(c, k.input) && !is(c, k.output) && !is(c, k.token)) continue;
        if (!typeOf(c) && d[c].name)
            error("missing-attribute", fmt::format("<{}> needs a type", text(d[c].category)), c);
        if (!is(c, k.token)) checkType(c);
        checkValue(c);
    }
}

void Checker::checkGraph(ElementId e) {
    Name nodedef = d.attribute(e, k.nodedef);
    NodeDef def = definitions.implementedBy(d, e);
    resolved.nodedefs[e.index] = def;
    // A graph of no node's is still one that can be drawn.
    checkReference(e, k.nodedef, "nodedef", static_cast<bool>(def), nodedef, Severity::Warning);
}

void Checker::checkImplementation(ElementId e) {
    for (const Attribute& a : d.attributes(e))
        if (!options.isLibrary && (text(a.name) == "builder" || text(a.name) == "leaf"))
            error("reserved-attribute", fmt::format("'{}' is for libraries only", text(a.name)), e, a.name);
    Name nodedef = d.attribute(e, k.nodedef), node = d.attribute(e, k.node), graph = d.attribute(e, k.nodegraph);
    Name space = d.namespaceOf(e);
    if (!nodedef && !node) error("missing-attribute", "an implementation needs an attribute 'nodedef' or 'node'", e);
    checkReference(e, k.nodedef, "nodedef", static_cast<bool>(definitions.byName(nodedef, space)), nodedef);
    if (!nodedef && node) checkReference(e, k.node, "node", definitions.hasCategory(node, space), node);
    ElementId found = graph ? d.childFrom(e, d.root(), graph) : ElementId();
    bool elsewhere = false;  // in another document
    if (graph && !found) {
        NodeDef def = definitions.byName(nodedef, space);
        elsewhere = def && definitions.implementation(def).kind == Implementation::Kind::Graph;
    }
    checkReference(e, k.nodegraph, "nodegraph", (found && is(found, k.nodegraph)) || elsewhere, graph);
}

void Checker::checkLook(ElementId e) {
    Name inherit = d.attribute(e, k.inherit);
    checkReference(e, k.inherit, "look", static_cast<bool>(d.child(d.root(), k.look, inherit)), inherit);
    for (ElementId c : children(d, e)) {
        if (!is(c, k.materialassign)) continue;
        Name material = d.attribute(c, k.material), collection = d.attribute(c, k.collection);
        ElementId found = material ? d.childFrom(c, d.root(), material) : ElementId();
        if (!found && material) found = d.find(text(material));
        if (!material) error("missing-attribute", "a materialassign needs an attribute 'material'", c);
        checkReference(c, k.material, "material", static_cast<bool>(found), material);
        if (found && typeOf(found) && typeOf(found) != k.material)
            error("type-mismatch", fmt::format("'{}' is {}, not material", text(material), text(typeOf(found))), c,
                  k.material);
        if (collection && !text(collection).empty())
            checkReference(c, k.collection, "collection",
                           static_cast<bool>(d.child(d.root(), k.collection, collection)), collection);
    }
}

void Checker::run() {
    std::uint32_t count = static_cast<std::uint32_t>(d.size());
    resolved.targets.resize(count);
    resolved.nodedefs.resize(count);
    isRead.resize(count);
    // What every node is comes first: connections go backwards and forwards.
    for (std::uint32_t i = 1; i < count; i++) {
        ElementId e(i);
        if (!d[e].category || !d[e].parent || text(d[e].category).starts_with('#')) continue;
        checkName(e);
        if (is(e, k.nodegraph))
            checkGraph(e);
        else if (is(e, k.nodedef))
            checkNodedef(e);
        else if (is(e, k.implementation))
            checkImplementation(e);
        else if (is(e, k.look))
            checkLook(e);
        else if (!is(e, k.input) && !is(e, k.output) && isNode(d, e))
            checkNode(e);
    }
    for (std::uint32_t i = 1; i < count; i++) {
        ElementId e(i), parent = d[e].parent;
        if (!parent) continue;
        bool inGraph = parent == d.root() || is(parent, k.nodegraph);
        if (is(e, k.output) ? inGraph : is(e, k.input) && (inGraph || isNode(d, parent))) checkPort(e);
    }
    reportUnused(d, resolved, isRead, findings);
    Diagnostics spaces;
    reportUnknownColorSpaces(d, definitions, spaces);
    for (const Diagnostic& x : spaces.all()) findings.add(x, d.find(x.path));
    reportCycles(d, resolved, findings);
    reportRecursiveDefinitions(d, definitions, resolved, findings);
}

}  // namespace

std::vector<Finding> findMistakes(const Document& document, const Definitions& definitions,
                                  const CheckOptions& options) {
    Checker checker{document, definitions, options};
    checker.run();
    std::vector<Finding>& found = checker.findings.all;

    // The checks go by kind; the reader goes by line.
    auto fileOf = [&](const Diagnostic& x) {
        std::size_t i = 0;
        while (i < document.sources().size() && document.sources()[i].file != x.where.file) i++;
        return i;
    };
    struct Key {
        std::size_t file;
        std::uint32_t line, column;
        std::size_t index;
        auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> order;
    for (const Finding& x : found) {
        const Location& where = x.diagnostic.where;
        order.push_back({fileOf(x.diagnostic), where.line, where.column, order.size()});
    }
    std::sort(order.begin(), order.end());
    std::vector<Finding> sorted;
    sorted.reserve(found.size());
    for (const Key& key : order) sorted.push_back(std::move(found[key.index]));
    return sorted;
}

bool validate(const Document& document, const Definitions& definitions, Diagnostics& diagnostics,
              const CheckOptions& options) {
    const std::size_t errors = diagnostics.errorCount();
    for (Finding& f : findMistakes(document, definitions, options)) diagnostics.add(std::move(f.diagnostic));
    return diagnostics.errorCount() == errors;
}

// The nodegraphs that <implementation> elements link, sorted.
static std::vector<ElementId> linkedGraphs(const Document& d) {
    const WellKnown& k = d.known();
    std::vector<ElementId> out;
    for (ElementId e : children(d, d.root()))
        if (d[e].category == k.implementation)
            if (Name graph = d.attribute(e, k.nodegraph))
                if (ElementId found = d.childFrom(e, d.root(), graph)) out.push_back(found);
    std::sort(out.begin(), out.end());
    return out;
}

bool isFunctional(const Document& d, ElementId graph) {
    if (d.attribute(graph, d.known().nodedef)) return true;
    std::vector<ElementId> linked = linkedGraphs(d);
    return std::binary_search(linked.begin(), linked.end(), graph);
}

std::vector<ElementId> renderableElements(const Document& d) {
    const WellKnown& k = d.known();
    std::vector<ElementId> out;
    for (ElementId e : children(d, d.root()))
        if (d.attribute(e, k.type) == k.material && isNode(d, e)) out.push_back(e);
    if (!out.empty()) return out;
    std::vector<ElementId> linked = linkedGraphs(d);
    for (ElementId e : children(d, d.root())) {
        if (d[e].category == k.output) out.push_back(e);
        if (d[e].category != k.nodegraph || d.attribute(e, k.nodedef)) continue;
        if (std::binary_search(linked.begin(), linked.end(), e)) continue;
        for (ElementId c : children(d, e))
            if (d[c].category == k.output) out.push_back(c);
    }
    if (!out.empty()) return out;
    // A document of definitions shows what they are for.
    for (ElementId e : children(d, d.root()))
        if (d[e].category == k.nodegraph)
            for (ElementId c : children(d, e))
                if (d[c].category == k.output) out.push_back(c);
    return out;
}

}  // namespace shaderx::doc
