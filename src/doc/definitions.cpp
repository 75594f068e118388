#include "doc/definitions.h"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

#include "doc/values.h"

namespace shaderx::doc {

namespace {

bool isInterface(const WellKnown& k, Name category) {
    return category == k.input || category == k.output || category == k.parameter;
}

// Puts the ports of a nodedef's element into lists that already hold those of its base. False if some found no room.
bool mergePorts(const Document& d, ElementId nodedef, std::uint32_t layer, std::vector<Port>& inputs,
                std::vector<Port>& outputs) {
    const WellKnown& k = d.known();
    bool fits = true;
    for (ElementId c : children(d, nodedef)) {
        if (!isInterface(k, d[c].category) || !d[c].name) continue;
        std::vector<Port>& ports = d[c].category == k.output ? outputs : inputs;
        if (ports.size() == NodeDefRow::kMostPorts) {
            fits = false;
            continue;
        }
        Port port{d[c].name, d.attribute(c, k.type), c, layer};
        auto same = std::find_if(ports.begin(), ports.end(), [&](const Port& p) { return p.name == port.name; });
        if (same != ports.end())
            *same = port;
        else
            ports.push_back(port);
    }
    // Before 1.37, a nodedef with one output says its type itself.
    if (Name type = d.attribute(nodedef, k.type); outputs.empty() && type && type != k.multioutput)
        outputs.push_back({k.out, type, nodedef, layer});
    return fits;
}

struct Builder {
    enum class State : std::uint8_t { New, UnderWay, Done };

    const Document& d;
    const WellKnown& k;
    DefinitionsTables t{};
    std::vector<State> states{};  // of the nodedefs' ports

    Name space(ElementId e) const { return d.namespaceOf(e); }

    void nodedef(ElementId e) {
        Name node = d.attribute(e, k.node), name = d[e].name;
        if (!node || !name) return;
        NodeDefRow row;
        row.category = d.qualified(space(e), node);
        row.name = d.qualified(space(e), name);
        row.version = d.attribute(e, k.version);
        row.target = d.attribute(e, k.target);
        row.inherit = d.attribute(e, k.inherit);
        row.element = e;
        if (d.attribute(e, k.isdefaultversion) == k.trueValue) row.flags |= NodeDefRow::DefaultVersion;
        for (ElementId c : children(d, e))
            if (d[c].category == k.token) row.flags |= NodeDefRow::HasTokens;
        t.nodedefs.push_back(row);
    }

    void implementation(ElementId e) {
        Name nodedef = d.attribute(e, k.nodedef), node = d.attribute(e, k.node);
        ImplementationRow row{nodedef, d.attribute(e, k.target), e, ImplementationRow::Graph};
        if (!row.target) row.target = d.attribute(e, k.language);
        if (d[e].category == k.implementation) {
            row.kind = d.attribute(e, k.nodegraph) ? ImplementationRow::LinkedGraph : ImplementationRow::Source;
            if (!nodedef && node) {
                row.kind = ImplementationRow::CategoryWide;
                row.key = d.qualified(space(e), node);
            }
        }
        if (row.key) t.implementations.push_back(row);
    }

    const NodeDefRow* byName(Name name) const {
        auto at =
            std::lower_bound(t.names.begin(), t.names.end(), name, [](const NameRow& r, Name n) { return r.name < n; });
        return at != t.names.end() && at->name == name ? &t.nodedefs[at->row] : nullptr;
    }
    std::size_t indexOf(const NodeDefRow& row) const { return static_cast<std::size_t>(&row - t.nodedefs.data()); }
    const NodeDefRow* base(const NodeDefRow& row) const {
        if (!row.inherit) return nullptr;
        const NodeDefRow* found = byName(d.qualified(space(row.element), row.inherit));
        return found ? found : byName(row.inherit);
    }

    // The ports of a row after those of what it inherits, each computed once, on a stack of our own.
    void ports(NodeDefRow* row) {
        std::vector<NodeDefRow*> chain;
        const NodeDefRow* known = row;
        while (known && states[indexOf(*known)] == State::New) {
            chain.push_back(&t.nodedefs[indexOf(*known)]);
            states[indexOf(*known)] = State::UnderWay;
            known = base(*known);
        }
        if (known && states[indexOf(*known)] == State::UnderWay) {
            for (NodeDefRow* r : chain) r->flags |= NodeDefRow::InheritsItself;
            known = nullptr;
        }
        for (; !chain.empty(); chain.pop_back()) {
            merge(known, *chain.back());
            known = chain.back();
            states[indexOf(*known)] = State::Done;
        }
    }

    void merge(const NodeDefRow* from, NodeDefRow& row) {
        constexpr std::size_t kMostInAll = std::size_t{4} << 20;
        constexpr std::uint32_t kPassedOn =
            NodeDefRow::OpenInherit | NodeDefRow::InheritsItself | NodeDefRow::TooManyPorts;
        if (from) row.flags |= from->flags & kPassedOn;
        if (row.inherit && !base(row)) row.flags |= NodeDefRow::OpenInherit;
        std::vector<Port> inputs, outputs;
        if (from) {
            auto first = t.ports.begin() + from->firstPort;
            inputs.assign(first, first + from->inputCount);
            outputs.assign(first + from->inputCount, first + from->inputCount + from->outputCount);
        }
        bool fits = mergePorts(d, row.element, Port::kOwnLayer, inputs, outputs);
        if (!fits || t.ports.size() + inputs.size() + outputs.size() > kMostInAll) {
            row.flags |= NodeDefRow::TooManyPorts;
            inputs.clear();
        }
        row.firstPort = static_cast<std::uint32_t>(t.ports.size());
        row.inputCount = static_cast<std::uint32_t>(inputs.size());
        row.outputCount = static_cast<std::uint32_t>(outputs.size());
        row.output = outputs.size() == 1 ? outputs[0].type : k.multioutput;
        t.ports.insert(t.ports.end(), inputs.begin(), inputs.end());
        t.ports.insert(t.ports.end(), outputs.begin(), outputs.end());
    }

    void run() {
        NameTable& names = d.names();
        const Name declaring[] = {names.intern("geompropdef"), names.intern("unitdef"), names.intern("typedef"),
                                  names.intern("colorspacedef")};
        for (ElementId e : children(d, d.root())) {
            Name category = d[e].category;
            if (category == k.nodedef)
                nodedef(e);
            else if (category == k.implementation || category == k.nodegraph)
                implementation(e);
            else if (std::find(std::begin(declaring), std::end(declaring), category) != std::end(declaring))
                t.declarations.push_back(e);
        }
        std::sort(t.declarations.begin(), t.declarations.end(),
                  [&](ElementId a, ElementId b) { return std::tie(d[a].category, a) < std::tie(d[b].category, b); });
        std::sort(t.nodedefs.begin(), t.nodedefs.end(), [](const NodeDefRow& a, const NodeDefRow& b) {
            return std::tie(a.category, a.element) < std::tie(b.category, b.element);
        });
        for (std::uint32_t i = 0; i < t.nodedefs.size(); i++) t.names.push_back({t.nodedefs[i].name, i});
        std::sort(t.names.begin(), t.names.end(),
                  [](const NameRow& a, const NameRow& b) { return std::tie(a.name, a.row) < std::tie(b.name, b.row); });
        states.assign(t.nodedefs.size(), State::New);
        for (NodeDefRow& row : t.nodedefs) ports(&row);
        for (ImplementationRow& row : t.implementations)  // "space:name" where there is such a nodedef here
            if (row.kind != ImplementationRow::CategoryWide)
                if (Name full = d.qualified(space(row.element), row.key); byName(full)) row.key = full;
        std::sort(t.implementations.begin(), t.implementations.end(),
                  [](const ImplementationRow& a, const ImplementationRow& b) {
                      return std::tie(a.key, a.element) < std::tie(b.key, b.element);
                  });
    }
};

}  // namespace

DefinitionsTables buildIndex(const Document& document) {
    Builder builder{document, document.known()};
    builder.run();
    return std::move(builder.t);
}

void Definitions::add(const Document& document) {
    auto tables = std::make_unique<DefinitionsTables>(buildIndex(document));
    DefinitionsIndex index = tables->index();
    layers_.push_back({&document, index, std::move(tables)});
}

void Definitions::add(const Document& document, DefinitionsIndex index) {
    layers_.push_back({&document, index, nullptr});
}

std::span<const NodeDefRow> Definitions::range(const Layer& layer, Name category) const {
    auto rows = layer.index.nodedefs;
    auto first = std::lower_bound(rows.begin(), rows.end(), category,
                                  [](const NodeDefRow& r, Name n) { return r.category < n; });
    auto last = first;
    while (last != rows.end() && last->category == category) ++last;
    return rows.subspan(static_cast<std::size_t>(first - rows.begin()), static_cast<std::size_t>(last - first));
}

NodeDef Definitions::byName(Name name, Name space) const {
    if (!name) return {};
    if (space && !layers_.empty()) {
        Name full = layers_[0].document->qualified(space, name);
        if (full != name)
            if (NodeDef def = byName(full)) return def;
    }
    for (std::uint32_t l = 0; l < layers_.size(); l++) {
        auto names = layers_[l].index.names;
        auto at =
            std::lower_bound(names.begin(), names.end(), name, [](const NameRow& r, Name n) { return r.name < n; });
        if (at != names.end() && at->name == name) return {l, at->row};
    }
    return {};
}

std::vector<NodeDef> Definitions::ofCategory(Name category, Name space) const {
    std::vector<NodeDef> out;
    if (space && !layers_.empty()) {
        Name full = layers_[0].document->qualified(space, category);
        if (full != category) out = ofCategory(full);
        if (!out.empty()) return out;
    }
    for (std::uint32_t l = 0; l < layers_.size(); l++) {
        auto rows = range(layers_[l], category);
        auto first = static_cast<std::uint32_t>(rows.data() - layers_[l].index.nodedefs.data());
        for (std::uint32_t i = 0; i < rows.size(); i++) out.push_back({l, first + i});
    }
    return out;
}

bool Definitions::hasCategory(Name category, Name space) const {
    if (space && !layers_.empty()) {
        Name full = layers_[0].document->qualified(space, category);
        if (full != category && hasCategory(full)) return true;
    }
    return std::any_of(layers_.begin(), layers_.end(),
                       [&](const Layer& layer) { return !range(layer, category).empty(); });
}

const std::vector<StructDef>& Definitions::structs() const {
    if (!hasStructs_) collectStructs();
    return structs_;
}

void Definitions::collectStructs() const {
    hasStructs_ = true;
    std::vector<StructDef> waiting;
    for (const ElementRef& e : declared("typedef")) {
        const Document& d = *e.document;
        if (!d[e.id].firstChild) continue;
        const Name member = d.names().find("member");
        StructDef s{e->name, {}};
        for (ElementId c : children(d, e.id))
            if (d[c].category == member && d[c].name)
                s.members.push_back({d[c].name, d.attribute(c, d.known().type), d.attribute(c, d.known().value)});
        if (s.name && !s.members.empty()) waiting.push_back(std::move(s));
    }
    // Those whose members are known come first, and so on, until none is left that could be known.
    auto isDone = [&](Name name) {
        return std::any_of(structs_.begin(), structs_.end(), [&](const StructDef& s) { return s.name == name; });
    };
    for (bool more = !waiting.empty(); more;) {
        more = false;
        for (StructDef& s : waiting) {
            const bool isKnown = std::all_of(s.members.begin(), s.members.end(), [&](const StructDef::Member& m) {
                return isDone(m.type) || valueType(layers_[0].document->text(m.type));
            });
            if (!isKnown || s.members.empty() || isDone(s.name)) continue;
            structs_.push_back(std::exchange(s, {}));
            more = true;
        }
    }
}

std::vector<ElementRef> Definitions::declared(std::string_view category) const {
    std::vector<ElementRef> all;
    for (const Layer& layer : layers_) {
        const Document& d = *layer.document;
        const Name word = d.names().find(category);
        const std::span<const ElementId> rows = layer.index.declarations;
        auto at = std::partition_point(rows.begin(), rows.end(), [&](ElementId e) { return d[e].category < word; });
        for (; at != rows.end() && d[*at].category == word; ++at) all.push_back({&d, *at});
    }
    return all;
}

std::vector<Name> Definitions::categories() const {
    std::vector<Name> out;
    for (const Layer& layer : layers_)
        for (const NodeDefRow& row : layer.index.nodedefs)
            if (out.empty() || out.back() != row.category) out.push_back(row.category);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

// How well a nodedef's version answers a request: 2 is what was asked for or the default, 0 is wrong.
static int versionRank(const NodeDefRow& row, Name wanted) {
    if (!wanted || !row.version) return !row.version || (row.flags & NodeDefRow::DefaultVersion) ? 2 : 1;
    return row.version == wanted ? 2 : 0;
}

Match Definitions::match(const Query& q) const {
    Name inSpace = q.space && !layers_.empty() ? layers_[0].document->qualified(q.space, q.category) : q.category;
    if (inSpace != q.category && !q.nodedef && hasCategory(inSpace)) {
        Query full = q;
        full.category = inSpace;
        full.space = {};
        return match(full);
    }
    auto fits = [&](NodeDef def) {
        auto ports = inputs(def);
        std::size_t at = 0;  // given inputs mostly come in the order of the ports
        for (const GivenInput& given : q.inputs) {
            auto same = [&](const Port& p) { return p.name == given.name; };
            if (at >= ports.size() || !same(ports[at]))
                at = static_cast<std::size_t>(std::find_if(ports.begin(), ports.end(), same) - ports.begin());
            if (at == ports.size() || (given.type && ports[at].type != given.type)) return false;
            at++;
        }
        return true;
    };
    if (q.nodedef) {
        NodeDef def = byName(q.nodedef, q.space);
        if (!def) return {};
        const NodeDefRow& r = row(def);
        bool typed = !q.type || q.type == r.output || (r.flags & NodeDefRow::OpenInherit);
        return {def, typed && fits(def)};
    }
    Match best;
    int bestRank = 0;
    for (std::uint32_t l = 0; l < layers_.size(); l++) {
        auto rows = range(layers_[l], q.category);
        for (const NodeDefRow& r : rows) {
            NodeDef def{l, static_cast<std::uint32_t>(&r - layers_[l].index.nodedefs.data())};
            Name output = r.output;
            if (r.flags & NodeDefRow::OpenInherit) {
                auto all = outputs(def);
                output = all.size() == 1 ? all[0].type : layers_[l].document->known().multioutput;
            }
            if (q.type && output != q.type) continue;
            if (q.target && r.target && r.target != q.target) continue;
            int version = versionRank(r, q.version);
            if (!version) continue;
            bool exact = fits(def);
            if (exact && version == 2) return {def, true};
            int rank = (exact ? 4 : 0) + version;
            if (rank <= bestRank) continue;
            best = {def, exact};
            bestRank = rank;
        }
    }
    return best;
}

Match Definitions::match(const Document& d, ElementId node, Name target) const {
    const WellKnown& k = d.known();
    constexpr std::size_t kUsual = 64;
    GivenInput usual[kUsual];
    std::vector<GivenInput> many;
    std::size_t count = 0;
    for (ElementId c : children(d, node)) {
        if (d[c].category != k.input || !d[c].name) continue;
        GivenInput given{d[c].name, d.attribute(c, k.type)};
        if (count < kUsual)
            usual[count] = given;
        else {
            if (many.empty()) many.assign(usual, usual + kUsual);
            many.push_back(given);
        }
        count++;
    }
    Query q;
    q.category = d[node].category;
    q.type = d.attribute(node, k.type);
    q.inputs = many.empty() ? std::span<const GivenInput>(usual, count) : std::span<const GivenInput>(many);
    q.version = d.attribute(node, k.version);
    q.nodedef = d.attribute(node, k.nodedef);
    q.target = target;
    q.space = d.namespaceOf(node);
    return match(q);
}

// Notices that a walk goes in a circle: it comes back to a place kept, which moves up at every power of two steps.
struct Revisit {
    NodeDef kept{};
    std::uint32_t steps = 0;
    bool met(NodeDef at) {
        if (at == kept) return true;
        if ((steps & (steps + 1)) == 0) kept = at;
        steps++;
        return false;
    }
};

NodeDef Definitions::base(NodeDef def) const {
    const NodeDefRow& r = row(def);
    return r.inherit ? byName(r.inherit, layers_[def.layer].document->namespaceOf(r.element)) : NodeDef{};
}

// The interface of a nodedef whose base is in another document; null for others.
const Definitions::Flat* Definitions::flatten(NodeDef def) const {
    if (!(row(def).flags & NodeDefRow::OpenInherit)) return nullptr;
    auto [at, isNew] = flat_.try_emplace(std::uint64_t{def.layer} << 32 | def.row);
    if (!isNew) return &at->second;
    std::vector<NodeDef> chain{def};
    Revisit revisit;
    for (NodeDef b = base(def); b && !revisit.met(b); b = base(b)) chain.push_back(b);
    std::vector<Port> in, out;
    for (auto c = chain.rbegin(); c != chain.rend(); ++c)
        if (!mergePorts(*layers_[c->layer].document, row(*c).element, c->layer, in, out)) break;
    Flat& f = at->second;
    f.inputCount = static_cast<std::uint32_t>(in.size());
    f.ports = std::move(in);
    f.ports.insert(f.ports.end(), out.begin(), out.end());
    return &f;
}

std::span<const Port> Definitions::inputs(NodeDef def) const {
    if (const Flat* f = flatten(def)) return std::span<const Port>(f->ports).first(f->inputCount);
    const NodeDefRow& r = row(def);
    return layers_[def.layer].index.ports.subspan(r.firstPort, r.inputCount);
}

std::span<const Port> Definitions::outputs(NodeDef def) const {
    if (const Flat* f = flatten(def)) return std::span<const Port>(f->ports).subspan(f->inputCount);
    const NodeDefRow& r = row(def);
    return layers_[def.layer].index.ports.subspan(r.firstPort + r.inputCount, r.outputCount);
}

ElementRef Definitions::element(NodeDef def, const Port& port) const {
    return {layers_[port.layer == Port::kOwnLayer ? def.layer : port.layer].document, port.element};
}

const Port* Definitions::input(NodeDef def, Name name) const {
    for (const Port& p : inputs(def))
        if (p.name == name) return &p;
    return nullptr;
}

const Port* Definitions::output(NodeDef def, Name name) const {
    for (const Port& p : outputs(def))
        if (p.name == name) return &p;
    return nullptr;
}

Implementation Definitions::inLayer(const Layer& layer, Name key, bool categoryWide,
                                    std::span<const Name> targets) const {
    auto rows = layer.index.implementations;
    auto at =
        std::lower_bound(rows.begin(), rows.end(), key, [](const ImplementationRow& r, Name n) { return r.key < n; });
    const ImplementationRow* best = nullptr;
    std::size_t bestRank = targets.size() + 1;  // the place in `targets`, portable ones last
    for (; at != rows.end() && at->key == key; ++at) {
        if ((at->kind == ImplementationRow::CategoryWide) != categoryWide) continue;
        std::size_t rank = targets.size();
        if (at->target) {
            rank = static_cast<std::size_t>(std::find(targets.begin(), targets.end(), at->target) - targets.begin());
            if (rank == targets.size()) continue;
        }
        if (rank >= bestRank) continue;
        best = &*at;
        bestRank = rank;
    }
    Implementation out;
    if (!best) return out;
    const Document& d = *layer.document;
    out.element = {&d, best->element};
    out.target = best->target;
    Name graph = d.attribute(best->element, d.known().nodegraph);
    if (best->kind == ImplementationRow::Graph)
        out.graph = out.element;
    else if (graph && best->kind != ImplementationRow::Source)
        for (const Layer& l : layers_) {  // the graph may be in another document
            const Document& other = *l.document;
            ElementId found = other.child(other.root(), d.qualified(d.namespaceOf(best->element), graph));
            if (!found) found = other.child(other.root(), graph);
            if (!found || other[found].category != other.known().nodegraph) continue;
            out.graph = {&other, found};
            break;
        }
    out.kind = out.graph ? Implementation::Kind::Graph : Implementation::Kind::Source;
    if (!out.graph && graph) out.kind = Implementation::Kind::None;  // a graph that is nowhere
    return out;
}

Implementation Definitions::implementation(NodeDef def, std::span<const Name> targets) const {
    Revisit revisit;
    for (NodeDef at = def; at && !revisit.met(at); at = base(at)) {
        for (const Layer& layer : layers_) {
            if (Implementation found = inLayer(layer, row(at).name, false, targets)) return found;
            if (Implementation found = inLayer(layer, row(at).category, true, targets)) return found;
        }
    }
    return {};
}

std::vector<ElementRef> Definitions::implementations(NodeDef def) const {
    std::vector<ElementRef> out;
    Revisit revisit;
    for (NodeDef at = def; at && !revisit.met(at); at = base(at))
        for (const Layer& layer : layers_)
            for (const ImplementationRow& r : layer.index.implementations)
                if (r.key == (r.kind == ImplementationRow::CategoryWide ? row(at).category : row(at).name))
                    out.push_back({layer.document, r.element});
    return out;
}

bool Definitions::hasType(Name name) const {
    return std::any_of(layers_.begin(), layers_.end(), [&](const Layer& layer) {
        const Document& d = *layer.document;
        return static_cast<bool>(d.child(d.root(), d.known().typedefName, name));
    });
}

std::vector<std::string_view> Definitions::types() const {
    std::vector<std::string_view> out;
    for (const Layer& layer : layers_)
        for (ElementId e : children(*layer.document, layer.document->root()))
            if (const Document& d = *layer.document; d[e].category == d.known().typedefName && d[e].name)
                out.push_back(d.text(d[e].name));
    return out;
}

NodeDef Definitions::implementedBy(const Document& d, ElementId graph) const {
    const WellKnown& k = d.known();
    if (Name nodedef = d.attribute(graph, k.nodedef)) return byName(nodedef, d.namespaceOf(graph));
    for (const Layer& layer : layers_) {
        if (layer.document != &d) continue;
        for (const ImplementationRow& row : layer.index.implementations)
            if (row.kind == ImplementationRow::LinkedGraph &&
                d.childFrom(row.element, d.root(), d.attribute(row.element, k.nodegraph)) == graph)
                return byName(row.key);
    }
    return {};
}

}  // namespace shaderx::doc
