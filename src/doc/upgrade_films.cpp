// Thin films until 1.38: a closure of its own in a layer, which 1.39 says by two inputs of the closures below it.
#include <algorithm>
#include <unordered_set>

#include "doc/upgrade_rules.h"

namespace shaderx::doc {

namespace {

using Kind = Connection::Kind;

struct Films {
    Upgrader& u;
    Document& d;
    const WellKnown& k;
    Name film, layer;
    Upgrader::Readers readers{};
    std::vector<ElementId> used{};  // films of which a layer was resolved

    // What lies below the layer in work.
    struct Below {
        std::vector<ElementId> all{}, leaves{};  // nodes, outputs and graph inputs; of these the closures with a film
        std::unordered_set<ElementId> met{};
        bool isOpen = false;  // something below it is not to be seen from here
    };

    void run();
    ElementId filmOf(ElementId layerNode) const;
    Below below(ElementId base) const;
    void visit(ElementId node, Below& found, std::vector<ElementId>& ports) const;
    bool isShared(const Below& found, ElementId base) const;
    bool makeOwn(ElementId layerNode, ElementId base, const Below& found);
    void learnReaders(ElementId tree);
    void redirectCopy(ElementId original, ElementId copy, const std::unordered_map<ElementId, ElementId>& copies);
    bool coat(ElementId filmNode, ElementId leaf, std::string_view from, std::string_view to);
    void resolve(ElementId layerNode);
    void bypass(ElementId layerNode, ElementId base);
};

// The film that lies on top of a layer, if one does.
ElementId Films::filmOf(ElementId layerNode) const {
    ElementId port = u.input(layerNode, "top");
    for (int hops = 0; port && hops < 8; hops++) {
        Connection c = connection(d, port);
        if (c.kind == Kind::Node) return d[c.target].category == film ? c.target : ElementId();
        if (c.kind != Kind::Output) return {};
        port = c.target;
    }
    return {};
}

bool canHaveFilm(std::string_view category) {
    return category == "dielectric_bsdf" || category == "conductor_bsdf" || category == "generalized_schlick_bsdf";
}

void Films::visit(ElementId node, Below& found, std::vector<ElementId>& ports) const {
    std::string_view c = u.category(node);
    if (canHaveFilm(c)) {
        ElementId mode = u.input(node, "scatter_mode");
        if (!mode || u.value(mode) != "T") found.leaves.push_back(node);
        return;
    }
    if (d[node].category == layer && filmOf(node)) return;  // what is below has that film
    constexpr std::string_view kPassOn[] = {"layer",     "mix",         "add",     "multiply",
                                            "ifgreater", "ifgreatereq", "ifequal", "switch"};
    if (std::find(std::begin(kPassOn), std::end(kPassOn), c) == std::end(kPassOn)) {
        if (!c.ends_with("_bsdf")) found.isOpen = true;  // a node of which only its definition knows what is below
        return;
    }
    for (ElementId in : children(d, node))
        if (d[in].category == k.input && u.type(in) == "BSDF") ports.push_back(in);
}

Films::Below Films::below(ElementId base) const {
    Below found;
    std::vector<ElementId> ports{base};
    while (!ports.empty()) {
        Connection c = connection(d, ports.back());
        ports.pop_back();
        if (c.kind == Kind::None || c.kind == Kind::Dangling) continue;
        if (!c.target) {
            found.isOpen = true;
            continue;
        }
        if (!found.met.insert(c.target).second) continue;
        found.all.push_back(c.target);
        if (c.kind == Kind::Node)
            visit(c.target, found, ports);
        else
            ports.push_back(c.target);
    }
    return found;
}

// True if something else reads a part of it, which must not get the film.
bool Films::isShared(const Below& found, ElementId base) const {
    for (ElementId e : found.all) {
        auto all = readers.find(e);
        if (all == readers.end()) continue;
        for (ElementId port : all->second)
            if (port != base && !found.met.contains(port) && !found.met.contains(d[port].parent) &&
                connection(d, port).target == e)  // still
                return true;
    }
    return false;
}

// Lets what a copy reads be the copies of what the original reads.
void Films::redirectCopy(ElementId original, ElementId copy, const std::unordered_map<ElementId, ElementId>& copies) {
    Connection c = connection(d, original);
    if (c.kind != Kind::Node && c.kind != Kind::Output) return;
    ElementId owner = c.kind == Kind::Node ? c.target : d[c.target].parent;
    auto found = copies.find(owner);
    if (found != copies.end() && c.attribute != k.output) d.set(copy, c.attribute, d[found->second].name);
}

// Copies of what lies below the layer, for it alone. False if there cannot be.
bool Films::makeOwn(ElementId layerNode, ElementId base, const Below& found) {
    ElementId scope = d[layerNode].parent;
    std::unordered_map<ElementId, ElementId> copies;
    std::vector<ElementId> originals;
    for (ElementId e : found.all) {
        if (d[e].category == k.input) return false;  // it comes in from outside of the graph
        ElementId whole = d[e].category == k.output && d[e].parent != d.root() ? d[e].parent : e;
        if (d[whole].category == k.output) return false;
        if (d[whole].parent != scope && d[d[whole].parent].category == k.nodegraph) continue;  // copied with its graph
        if (!copies.try_emplace(whole).second) continue;
        std::string name = u.freeName(d[whole].parent, fmt::format("{}_film", u.text(d[whole].name)));
        ElementId copy = u.copyTree(whole, {}, whole, name);
        if (!copy) return false;
        u.edited(copy, "", u.tag(copy));
        copies[whole] = copy;
        originals.push_back(whole);
    }
    for (ElementId original : originals) {
        ElementId copy = copies[original];
        if (d[original].category == k.nodegraph) continue;
        for (ElementId from = d[original].firstChild, to = d[copy].firstChild; from && to;
             from = d[from].next, to = d[to].next)
            if (d[from].category == k.input) redirectCopy(from, to, copies);
    }
    redirectCopy(base, base, copies);
    for (ElementId original : originals) learnReaders(copies[original]);
    if (ElementId target = connection(d, base).target) readers[target].push_back(base);
    return true;
}

void Films::learnReaders(ElementId tree) {
    std::vector<ElementId> left{tree};
    while (!left.empty()) {
        ElementId e = left.back();
        left.pop_back();
        bool isPort = d[e].category == k.input || d[e].category == k.output;
        if (ElementId target = isPort ? connection(d, e).target : ElementId()) readers[target].push_back(e);
        for (ElementId c : children(d, e)) left.push_back(c);
    }
}

// Gives a closure one of the film's inputs. False if it cannot be read there.
bool Films::coat(ElementId filmNode, ElementId leaf, std::string_view from, std::string_view to) {
    ElementId in = u.input(filmNode, from);
    if (!in) {
        if (from == "thickness") u.addValue(leaf, to, "float", "550");  // the default of 1.38
        return true;
    }
    if (!u.isConnected(in) || d[leaf].parent == d[filmNode].parent) {
        u.copyInput(in, leaf, to);
        return true;
    }
    // Into a graph that stands beside the film: by an input of the graph.
    ElementId graph = d[leaf].parent;
    if (d[graph].category != k.nodegraph || d[graph].parent != d[filmNode].parent) return false;
    ElementId port = u.input(graph, to);
    if (!port) port = u.copyInput(in, graph, to);
    ElementId inner = u.addInput(leaf, to, "float");
    d.set(inner, k.interfacename, d[port].name);
    return true;
}

// All that read the layer read its base.
void Films::bypass(ElementId layerNode, ElementId base) {
    std::vector<ElementId> all = std::move(readers[layerNode]);
    readers.erase(layerNode);
    Connection c = connection(d, base);
    for (ElementId port : all) {
        u.copyConnection(base, port);
        if (c.target) readers[c.target].push_back(port);
    }
    u.edited(layerNode, u.tag(layerNode) + " with a thin film on top", "inputs of the closures below");
    d.remove(layerNode);
}

void Films::resolve(ElementId layerNode) {
    ElementId filmNode = filmOf(layerNode), base = u.input(layerNode, "base");
    if (!filmNode) return;
    if (!base) base = u.addInput(layerNode, "base", "BSDF");
    Below found = below(base);
    if (!found.leaves.empty() && isShared(found, base)) {
        if (!makeOwn(layerNode, base, found))
            return u.warn(layerNode, "the film is not told to what is below it, because others read that too");
        found = below(base);
    }
    bool isLost = found.isOpen;
    for (ElementId leaf : found.leaves) {
        if (u.input(leaf, "thinfilm_thickness")) continue;  // a nearer film
        bool done =
            coat(filmNode, leaf, "thickness", "thinfilm_thickness") && coat(filmNode, leaf, "ior", "thinfilm_ior");
        if (done) u.edited(leaf, u.tag(leaf), u.tag(leaf) + " with the film's inputs");
        isLost |= !done;
    }
    if (isLost) u.warn(layerNode, "the film does not reach all closures below it: it is lost on these");
    used.push_back(filmNode);
    bypass(layerNode, base);
}

void Films::run() {
    readers = u.readers();
    u.each(kNewestMinor, [&](ElementId e) {
        if (d[e].category == layer && isNode(d, e)) resolve(e);
    });
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    readers = u.readers();
    for (ElementId e : used)
        if (!readers.contains(e)) d.remove(e);
    u.each(kNewestMinor, [&](ElementId e) {
        if (d[e].category == film && isNode(d, e))
            u.warn(e, "this thin film lies on nothing: 1.39 has no such closure");
    });
}

}  // namespace

void upgradeFilms(Upgrader& u) {
    Name film = u.d.names().find("thin_film_bsdf"), layer = u.d.names().find("layer");
    if (!film) return;
    bool any = false;
    u.each(kNewestMinor, [&](ElementId e) { any |= u.d[e].category == film; });
    if (!any) return;
    Films films{u, u.d, u.k, film, layer};
    films.run();
}

}  // namespace shaderx::doc
