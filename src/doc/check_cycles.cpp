#include "doc/check_cycles.h"

#include <algorithm>

#include <fmt/format.h>

#include "doc/connect.h"

namespace shaderx::doc {

namespace {

enum class Colour : std::uint8_t { White, Grey, Black };

// "a → b → a" of the names; the middle of a long path is left out.
std::string pathText(const std::vector<std::string>& names) {
    constexpr std::size_t kEnds = 8;
    std::string out;
    for (std::size_t i = 0; i < names.size(); i++) {
        if (names.size() > 2 * kEnds + 1 && i == kEnds) {
            out += fmt::format(" → … {} more", names.size() - 2 * kEnds);
            i = names.size() - kEnds;
        }
        if (i) out += " → ";
        out += names[i];
    }
    return out;
}

// Depth-first over what reads what, on a stack of our own. Vertices are nodes, and the inputs and outputs of graphs;
// so a graph of which two outputs are used in turn is no cycle.
struct CycleFinder {
    struct Frame {
        ElementId vertex, port;  // port: the one whose target is visited next, none when done
    };
    const Document& d;
    const Resolved& resolved;
    Findings& findings;
    std::vector<Colour> colours{};
    std::vector<Frame> stack{};

    bool isPort(ElementId e) const { return d[e].category == d.known().input || d[e].category == d.known().output; }
    ElementId firstPort(ElementId vertex) const { return isPort(vertex) ? vertex : nextInput(d[vertex].firstChild); }
    ElementId nextPort(ElementId vertex, ElementId port) const {
        return port == vertex ? ElementId() : nextInput(d[port].next);
    }
    ElementId nextInput(ElementId c) const {
        while (c && d[c].category != d.known().input) c = d[c].next;
        return c;
    }

    void report(ElementId start, ElementId port) {
        auto begin = std::find_if(stack.begin(), stack.end(), [&](const Frame& f) { return f.vertex == start; });
        std::vector<std::string> names;
        for (auto f = begin; f != stack.end(); ++f) names.push_back(d.path(f->vertex));
        names.push_back(d.path(start));
        Diagnostic& out = findings.error("cycle", "the connections form a cycle: " + pathText(names), port);
        out.path = d.path(isPort(stack.back().vertex) ? port : d[port].parent);
    }

    void visit(ElementId start) {
        colours[start.index] = Colour::Grey;
        stack.push_back({start, firstPort(start)});
        while (!stack.empty()) {
            Frame& f = stack.back();
            if (!f.port) {
                colours[f.vertex.index] = Colour::Black;
                stack.pop_back();
                continue;
            }
            ElementId port = f.port, target = resolved.targets[port.index];
            if (target && colours[target.index] == Colour::Grey) report(target, port);
            f.port = nextPort(f.vertex, port);
            if (target && colours[target.index] == Colour::White) {
                colours[target.index] = Colour::Grey;
                stack.push_back({target, firstPort(target)});
            }
        }
    }
};

// The nodegraphs of this document that the nodes of a nodegraph stand for.
struct RecursionFinder {
    struct Frame {
        ElementId graph, child;
    };
    const Document& d;
    const Definitions& definitions;
    const Resolved& resolved;
    Findings& findings;
    std::vector<Colour> colours{};
    std::vector<Frame> stack{};

    ElementId graphOf(ElementId node) const {
        NodeDef def = resolved.nodedefs[node.index];
        if (!def || !isNode(d, node)) return {};
        Implementation found = definitions.implementation(def);
        return found.graph && found.graph.document == &d ? found.graph.id : ElementId();
    }
    void report(ElementId graph, ElementId node) {
        std::vector<std::string> names;
        for (auto f = stack.begin(); f != stack.end(); ++f)
            if (f->graph == graph || !names.empty()) names.push_back(d.path(f->graph));
        names.push_back(d.path(graph));
        findings.error("cycle", "the nodegraph uses the node that it implements: " + pathText(names), node);
    }
    void visit(ElementId start) {
        colours[start.index] = Colour::Grey;
        stack.push_back({start, d[start].firstChild});
        while (!stack.empty()) {
            Frame& f = stack.back();
            ElementId node = f.child;
            if (!node) {
                colours[f.graph.index] = Colour::Black;
                stack.pop_back();
                continue;
            }
            f.child = d[node].next;
            ElementId graph = graphOf(node);
            if (!graph) continue;
            if (colours[graph.index] == Colour::Grey) report(graph, node);
            if (colours[graph.index] == Colour::White) {
                colours[graph.index] = Colour::Grey;
                stack.push_back({graph, d[graph].firstChild});
            }
        }
    }
};

void reportInheritCycles(const Document& d, const Definitions& definitions, Findings& findings) {
    const WellKnown& k = d.known();
    std::vector<std::uint32_t> seen(d.size(), 0);  // the number of the walk that met the nodedef
    std::uint32_t walk = 0;
    for (ElementId start : children(d, d.root())) {
        if (d[start].category != k.nodedef) continue;
        walk++;
        if (NodeDef def = definitions.byName(d.qualified(d.namespaceOf(start), d[start].name));
            def && definitions.row(def).flags & NodeDefRow::TooManyPorts) {
            Diagnostic& out = findings.error(
                "limit",
                fmt::format("the nodedef has more than {} inputs or outputs, or those of all nodedefs are too many",
                            NodeDefRow::kMostPorts),
                start);
            out.hint = "several nodes may share the work";
        }
        for (ElementId at = start; at && seen[at.index] < walk;) {
            if (seen[at.index]) break;  // an earlier walk has been here
            seen[at.index] = walk;
            Name inherit = d.attribute(at, k.inherit);
            if (!inherit) break;
            NodeDef def = definitions.byName(inherit, d.namespaceOf(at));
            if (!def || definitions.element(def).document != &d) break;
            ElementId base = definitions.element(def).id;
            if (seen[base.index] == walk) {
                findings.error("inherit-cycle",
                               fmt::format("the nodedef inherits itself by way of '{}'", d.text(inherit)), at,
                               k.inherit);
            }
            at = base;
        }
    }
}

}  // namespace

void reportCycles(const Document& d, const Resolved& resolved, Findings& findings) {
    CycleFinder finder{d, resolved, findings};
    finder.colours.assign(d.size(), Colour::White);
    for (std::uint32_t i = 0; i < d.size(); i++) {
        ElementId target = resolved.targets[i];
        if (target && finder.colours[target.index] == Colour::White) finder.visit(target);
    }
}

void reportRecursiveDefinitions(const Document& d, const Definitions& definitions, const Resolved& resolved,
                                Findings& findings) {
    RecursionFinder finder{d, definitions, resolved, findings};
    finder.colours.assign(d.size(), Colour::White);
    for (ElementId e : children(d, d.root()))
        if (d[e].category == d.known().nodegraph && resolved.nodedefs[e.index] &&
            finder.colours[e.index] == Colour::White)
            finder.visit(e);
    reportInheritCycles(d, definitions, findings);
}

}  // namespace shaderx::doc
