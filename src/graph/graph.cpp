#include "graph/graph.h"

#include <unordered_map>

#include <fmt/format.h>

#include "doc/check.h"
#include "doc/connect.h"

namespace shaderx::graph {

namespace {

using doc::Connection;
using doc::ElementId;

// A node on the way: its inputs are resolved one after the other, and those that come from a node not yet built wait
// until it is.
struct Frame {
    Node node;
    std::vector<Input> inputs;
    std::size_t next = 0;
};

struct GraphBuilder {
    const doc::Document& d;
    const doc::Definitions& definitions;
    Graph& graph;
    Diagnostics& diagnostics;
    ElementId functional{};  // the nodegraph whose interface stays open, if any
    std::unordered_map<ElementId, NodeId> built{};
    std::unordered_map<ElementId, bool> open{};
    std::vector<Frame> stack{};
    bool ok = true;

    bool run(ElementId element) {
        const doc::WellKnown& k = d.known();
        Name category = d[element].category;
        if (category == k.nodegraph) {
            if (doc::isFunctional(d, element) || definitions.implementedBy(d, element)) functional = element;
            for (ElementId c : doc::children(d, element))
                if (d[c].category == k.output) addOutput(c);
            if (graph.outputs.empty()) error(element, "no-output", "the nodegraph has no output");
        } else if (category == k.output) {
            addOutput(element);
        } else {
            addNode(element);
        }
        return ok;
    }

    void addOutput(ElementId output) {
        ir::Type type = ir::typeNamed(d.attributeText(output, d.known().type));
        Output made{d[output].name, type, {}, output};
        if (resolve(output, made.source)) graph.outputs.push_back(made);
    }

    void addNode(ElementId element) {
        Source source;
        if (!node(element, source)) return;
        doc::NodeDef def = graph.nodes[source.node.index].def;
        for (const doc::Port& port : definitions.outputs(def)) {
            graph.outputs.push_back({port.name, ir::typeNamed(d.text(port.type)), source, element});
            source.output++;
        }
    }

    Diagnostic& error(ElementId at, std::string_view code, std::string message) {
        ok = false;
        Diagnostic& e = diagnostics.error(code, std::move(message));
        e.where = d.locate(at);
        e.path = d.path(at);
        return e;
    }

    // Follows a port to its value or node; builds what is upstream of it. Ports lead to ports only a few times in a
    // row, but a document may try otherwise, so the steps are counted.
    bool resolve(ElementId port, Source& source) {
        Name output;
        ElementId target = follow(port, source, output);
        if (!target) return ok;
        if (!node(target, source)) return false;
        return pickOutput(port, output, source);
    }

    // Leaves the value or interface in `source`, or returns the node that the port leads to.
    ElementId follow(ElementId port, Source& source, Name& output) {
        constexpr int kMostSteps = 100000;
        for (int step = 0; step < kMostSteps; step++) {
            Connection c = doc::connection(d, port);
            switch (c.kind) {
                case Connection::Kind::None:
                    if (d.attribute(port, d.known().value)) source = {Source::Kind::Value, {}, 0, port, {}};
                    return {};
                case Connection::Kind::Dangling:
                    error(port, "dangling-connection",
                          fmt::format("'{}' is connected to nothing that exists", d.text(d[port].name)));
                    return {};
                case Connection::Kind::Node:
                    output = c.output;
                    return c.target;
                case Connection::Kind::Output:
                    port = c.target;
                    break;
                case Connection::Kind::Interface: {
                    Name name = d.attribute(port, d.known().interfacename);
                    if (functional && doc::scopeOf(d, d[port].parent) == functional) {
                        source = {Source::Kind::Interface, {}, 0, {}, name};
                        return {};
                    }
                    if (!c.target) {
                        error(port, "dangling-interfacename",
                              fmt::format("the nodegraph has no input '{}'", d.text(name)));
                        return {};
                    }
                    port = c.target;
                    break;
                }
            }
        }
        error(port, "cycle", "connections lead in a circle");
        return {};
    }

    bool pickOutput(ElementId port, Name output, Source& source) {
        if (!output) return true;
        auto outputs = definitions.outputs(graph.nodes[source.node.index].def);
        for (std::size_t i = 0; i < outputs.size(); i++)
            if (outputs[i].name == output) {
                source.output = static_cast<std::uint32_t>(i);
                return true;
            }
        if (outputs.size() == 1) return true;
        error(port, "dangling-output", fmt::format("the node has no output '{}'", d.text(output)));
        return false;
    }

    // The node of an element, built with all that is upstream if it was not yet.
    bool node(ElementId element, Source& source) {
        if (auto it = built.find(element); it != built.end()) {
            source = {Source::Kind::Node, it->second, 0, {}, {}};
            return true;
        }
        std::size_t base = stack.size();
        if (!push(element)) return false;
        while (stack.size() > base) step();
        auto it = built.find(element);
        if (it == built.end()) return false;
        source = {Source::Kind::Node, it->second, 0, {}, {}};
        return true;
    }

    bool push(ElementId element) {
        Frame frame;
        frame.node.element = element;
        graph.visited.push_back(element);
        doc::Match match = definitions.match(d, element);
        if (!match) {
            error(element, "unknown-node",
                  fmt::format("no definition of '{}' fits this node", d.text(d[element].category)));
            return false;
        }
        frame.node.def = match.def;
        graph.isExact = graph.isExact && match.exact;
        for (const doc::Port& port : definitions.inputs(match.def))
            frame.inputs.push_back({&port, ir::typeNamed(d.text(port.type)), {}});
        open[element] = true;
        stack.push_back(std::move(frame));
        return true;
    }

    // One input of the topmost node, or the node itself when all are there.
    void step() {
        Frame& frame = stack.back();
        if (frame.next == frame.inputs.size()) {
            frame.node.firstInput = static_cast<std::uint32_t>(graph.inputs.size());
            frame.node.inputCount = static_cast<std::uint32_t>(frame.inputs.size());
            graph.inputs.insert(graph.inputs.end(), frame.inputs.begin(), frame.inputs.end());
            built[frame.node.element] = NodeId(static_cast<std::uint32_t>(graph.nodes.size()));
            open.erase(frame.node.element);
            graph.nodes.push_back(frame.node);
            stack.pop_back();
            return;
        }
        Input& input = frame.inputs[frame.next];
        ElementId port = d.child(frame.node.element, d.known().input, input.port->name);
        if (!port) port = d.child(frame.node.element, input.port->name);
        Name output;
        ElementId target = port ? follow(port, input.source, output) : ElementId();
        if (!target) {
            frame.next++;
            return;
        }
        if (auto it = built.find(target); it != built.end()) {
            input.source = {Source::Kind::Node, it->second, 0, {}, {}};
            pickOutput(port, output, input.source);
            frame.next++;
        } else if (open.count(target)) {
            cycle(target);
            frame.next++;
        } else if (!push(target)) {
            stack.back().next++;
        }
    }

    void cycle(ElementId start) {
        std::string path;
        bool in = false;
        for (const Frame& f : stack) {
            in = in || f.node.element == start;
            if (in) path += d.path(f.node.element) + " -> ";
        }
        error(start, "cycle", "nodes depend on each other in a circle: " + path + d.path(start));
    }
};

}  // namespace

bool build(const doc::Document& document, ElementId element, const doc::Definitions& definitions, Graph& graph,
           Diagnostics& diagnostics) {
    graph.document = &document;
    return GraphBuilder{document, definitions, graph, diagnostics}.run(element);
}

std::string print(const Graph& graph, const doc::Definitions& definitions) {
    const doc::Document& d = *graph.document;
    std::string out;
    auto source = [&](const Source& s) -> std::string {
        switch (s.kind) {
            case Source::Kind::Default:
                return "default";
            case Source::Kind::Value:
                return fmt::format("\"{}\"", d.attributeText(s.element, d.known().value));
            case Source::Kind::Interface:
                return fmt::format("interface {}", d.text(s.input));
            case Source::Kind::Node: {
                const Node& n = graph.nodes[s.node.index];
                auto outputs = definitions.outputs(n.def);
                std::string name = d.path(n.element);
                return outputs.size() > 1 ? fmt::format("{}.{}", name, d.text(outputs[s.output].name)) : name;
            }
        }
        return {};
    };
    for (const Node& n : graph.nodes) {
        out += fmt::format("{} = {} ({})\n", d.path(n.element), d.text(d[n.element].category),
                           d.text(definitions.row(n.def).name));
        for (const Input& i : graph.inputsOf(n))
            out += fmt::format("    {}: {} = {}\n", d.text(i.port->name), info(i.type).name, source(i.source));
    }
    for (const Output& o : graph.outputs)
        out += fmt::format("output {}: {} = {}\n", d.text(o.name), info(o.type).name, source(o.source));
    return out;
}

}  // namespace shaderx::graph
