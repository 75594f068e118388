#include "graph/graph.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "doc/check.h"
#include "doc/connect.h"
#include "graph/values.h"

namespace shaderx::graph {

namespace {

using doc::Connection;
using doc::ElementId;

// A node on the way: its inputs are resolved one after the other, and those that come from a node not yet built wait
// until it is.
struct Frame {
    Node node;
    std::uint32_t next = 0;  // input
    Name output;             // of this node, which the frame below waits for
};

// How far each element is: not met, on the way, or built as which node.
class Progress {
  public:
    static constexpr std::uint32_t kNew = 0xffffffffu, kOpen = 0xfffffffeu;

    // Valid until the next call.
    std::uint32_t& operator[](ElementId element) {
        if (used_ * 2 >= slots_.size()) grow();
        Slot& slot = slots_[slotOf(element)];
        if (!slot.element) {
            slot.element = element;
            used_++;
        }
        return slot.state;
    }

  private:
    struct Slot {
        ElementId element;
        std::uint32_t state = kNew;
    };
    std::size_t slotOf(ElementId element) const {
        std::size_t mask = slots_.size() - 1, i = element.index * 0x9e3779b1u >> 4 & mask;  // the golden ratio spreads
        while (slots_[i].element && slots_[i].element != element) i = (i + 1) & mask;
        return i;
    }
    void grow() {
        std::vector<Slot> old(std::max<std::size_t>(64, slots_.size() * 2));
        old.swap(slots_);
        for (const Slot& s : old)
            if (s.element) slots_[slotOf(s.element)] = s;
    }

    std::vector<Slot> slots_;  // open addressing, a power of two long
    std::size_t used_ = 0;
};

// How a node is written, as far as its definition depends on it, and what that means. A document writes many nodes
// alike, so the last shape of a category and type is tried before the definitions are searched.
struct Shape {
    doc::Query query;  // without its inputs
    std::vector<doc::GivenInput> given;
    doc::Match match;
    std::uint32_t kind = 0;
    // By input of the kind.
    std::vector<std::uint32_t> from;  // which of `given` it is, or kAbsent
    std::vector<ir::Type> types;
    bool isPlain = true;  // it has a type, its inputs have types, and no two of them one name

    static constexpr std::uint32_t kAbsent = 0xffffffffu;
    bool isOf(const doc::Query& q, const std::vector<doc::GivenInput>& inputs) const {
        return query.category == q.category && query.type == q.type && query.version == q.version &&
               query.nodedef == q.nodedef && query.space == q.space && given == inputs;
    }
};

struct GraphBuilder {
    const doc::Document& d;
    const doc::Definitions& definitions;
    Graph& graph;
    Diagnostics& diagnostics;
    ElementId functional{};  // the nodegraph whose interface stays open, if any
    Progress progress{};
    std::vector<Frame> stack{};
    std::unordered_map<std::uint64_t, std::uint32_t> kinds{};  // by layer and row of the nodedef
    std::array<std::pair<Name, ir::Type>, 16> types{};
    std::vector<Shape> shapes{};
    std::array<std::uint32_t, 64> shapeAt{};  // by category and type: shape + 1
    std::vector<doc::GivenInput> given{};     // of the node at hand, and their elements
    std::vector<ElementId> givenElements{};
    bool hasOthers = false;                    // has it children by name that are no inputs?
    std::unordered_set<ElementId> circular{};  // ports that lead in a circle
    std::unordered_map<ElementId, ElementId>
        shortcuts{};  // from ports within long rows of ports to the last of the row
    bool ok = true;

    bool run(ElementId element) {
        const doc::WellKnown& k = d.known();
        Name category = d[element].category;
        const ElementId scope = category == k.nodegraph ? element : d[element].parent;
        if (scope && d[scope].category == k.nodegraph) {
            graph.interface = definitions.implementedBy(d, scope);
            if (graph.interface || doc::isFunctional(d, scope)) functional = scope;
            if (functional && !graph.interface) noInterface(scope);
        }
        if (category == k.nodegraph) {
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

    // A nodegraph that implements a nodedef which does not exist is one with the inputs that it has itself.
    void noInterface(ElementId scope) {
        functional = {};
        graph.visited.push_back(scope);
        isInOrder(false);
        const Name nodedef = d.attribute(scope, d.known().nodedef);
        Diagnostic& w =
            diagnostics.warning("dangling-nodedef", nodedef ? fmt::format("there is no nodedef '{}'", d.text(nodedef))
                                                            : "the nodedef that this implements does not exist");
        w.where = d.locate(scope, d.known().nodedef);
        w.path = d.path(scope);
    }

    void addOutput(ElementId output) {
        ir::Type type = graph::typeOf(definitions, d.attributeText(output, d.known().type));
        Output made{d[output].name, type, {}, output};
        graph.visited.push_back(output);
        isInOrder(d[output].name && d.isUnique(output));
        if (resolve(output, made.source)) graph.outputs.push_back(made);
    }

    void addNode(ElementId element) {
        Source source;
        if (!node(element, source)) return;
        for (const doc::Port& port : graph.kindOf(graph.nodes[source.node.index]).outputs) {
            graph.outputs.push_back({port.name, typeOf(port.type), source, element});
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

    // Whether what is at hand is written as it ought to be; the check of the document says what is wrong with it.
    void isInOrder(bool holds) { graph.isExact = graph.isExact && holds; }

    // From a port to the one that it reads.
    ElementId pass(ElementId port, ElementId target) {
        const doc::WellKnown& k = d.known();
        graph.visited.push_back(target);
        isInOrder(d.isUnique(target) && d.isUnique(d[target].parent));
        isInOrder(d.attribute(port, k.type) == d.attribute(target, k.type));
        return target;
    }

    // Follows a port to its value or node; builds what is upstream of it.
    bool resolve(ElementId port, Source& source) {
        Name output;
        ElementId target = follow(port, source, output);
        if (!target) return ok;
        if (!node(target, source)) return false;
        return pickOutput(port, output, source);
    }

    // Leaves the value or interface in `source`, or returns the node that the port leads to. Ports lead to ports only a
    // few times in a row, but a document may try otherwise: a circle is found where the row comes back to `passed`,
    // which moves up at every power of two steps; a long row is walked once.
    ElementId follow(ElementId port, Source& source, Name& output) {
        constexpr std::uint32_t kLong = 64;
        ElementId passed, longFrom;
        for (std::uint32_t step = 1;; step++) {
            if (step == kLong) {
                longFrom = port;
                if (auto it = shortcuts.find(port); it != shortcuts.end()) port = it->second;
            }
            if (port == passed || (!circular.empty() && circular.count(port))) return circle(port);
            if ((step & (step - 1)) == 0) passed = port;
            Connection c = doc::connection(d, port);
            if (c.colorspace) source.colorspace = c.colorspace;
            if (c.value) isInOrder(c.kind == Connection::Kind::None);
            if (c.kind == Connection::Kind::Interface && !c.target && isOuterPort(port)) {
                isInOrder(false);
                c.kind = Connection::Kind::None;
            }
            if (c.value == d.known().empty && !isText(d.attribute(port, d.known().type))) c.value = {};
            bool isLast = c.kind != Connection::Kind::Output && c.kind != Connection::Kind::Interface;
            if (isLast && longFrom) shortcuts[longFrom] = port;
            switch (c.kind) {
                case Connection::Kind::None:
                    if (!c.value && !c.defaultgeomprop) return {};
                    source.kind = c.defaultgeomprop ? Source::Kind::Geometric : Source::Kind::Value;
                    source.element = port;
                    source.input = c.defaultgeomprop;
                    return {};
                case Connection::Kind::Dangling:
                    error(port, "dangling-connection",
                          fmt::format("'{}' is connected to nothing that exists", d.text(d[port].name)));
                    return {};
                case Connection::Kind::Node:
                    output = c.output;
                    return c.target;
                case Connection::Kind::Output:
                    port = pass(port, c.target);
                    break;
                case Connection::Kind::Interface: {
                    const Name name = d.attribute(port, d.known().interfacename);
                    const ElementId scope = scopeOf(port);
                    if (!functional && !c.target) adopt(scope);
                    if (functional && scope == functional && (!c.target || isOpen(name))) {
                        source.kind = Source::Kind::Interface;
                        source.input = name;
                        return {};
                    }
                    if (!c.target && isOrphan(scope)) {
                        isInOrder(false);
                        return {};
                    }
                    if (!c.target) {
                        error(port, "dangling-interfacename",
                              fmt::format("the nodegraph has no input '{}'", d.text(name)));
                        return {};
                    }
                    port = pass(port, c.target);
                    break;
                }
            }
        }
    }

    // Of these the empty text is a value too.
    bool isText(Name type) const { return type == d.known().string || type == d.known().filename; }

    bool isOpen(Name input) const { return graph.interface && definitions.input(graph.interface, input); }

    // The nodegraph that a port of one of its nodes, or an output of its own, stands in.
    ElementId scopeOf(ElementId port) const {
        return d[port].category == d.known().output ? d[port].parent : doc::scopeOf(d, d[port].parent);
    }

    // A nodegraph that implements a node may be read as it is: its node's defaults are what it leaves open.
    void adopt(ElementId scope) {
        if (!scope || d[scope].category != d.known().nodegraph) return;
        graph.interface = definitions.implementedBy(d, scope);
        if (graph.interface) functional = scope;
    }

    // Whether a nodegraph says that it implements a nodedef which does not exist: that may have what is missing.
    bool isOrphan(ElementId scope) const {
        return scope && d[scope].category == d.known().nodegraph && d.attribute(scope, d.known().nodedef) &&
               !definitions.implementedBy(d, scope);
    }

    // Whether a port is that of a nodegraph which stands in no other. Exporters name inputs there of what was around
    // it.
    bool isOuterPort(ElementId port) const {
        const ElementId owner = d[port].parent;
        return d[port].category == d.known().input && d[owner].category == d.known().nodegraph &&
               d[owner].parent == d.root();
    }

    // Says once that the ports from this one on lead back to it.
    ElementId circle(ElementId port) {
        ok = false;
        if (circular.count(port)) return {};
        error(port, "cycle", "connections lead in a circle");
        while (circular.insert(port).second) port = doc::connection(d, port).target;
        return {};
    }

    bool pickOutput(ElementId port, Name output, Source& source) {
        auto outputs = graph.kindOf(graph.nodes[source.node.index]).outputs;
        const Name type = d.attribute(port, d.known().type);
        if (!output) {
            isInOrder(!outputs.empty() && outputs[0].type == type);
            return true;
        }
        for (std::size_t i = 0; i < outputs.size(); i++)
            if (outputs[i].name == output) {
                isInOrder(outputs[i].type == type);
                source.output = static_cast<std::uint32_t>(i);
                return true;
            }
        isInOrder(false);
        if (outputs.size() == 1) return true;
        error(port, "dangling-output", fmt::format("the node has no output '{}'", d.text(output)));
        return false;
    }

    // The node of an element, built with all that is upstream if it was not yet.
    bool node(ElementId element, Source& source) {
        if (progress[element] == Progress::kNew) {
            if (!push(element, {})) return false;
            while (!stack.empty()) step();
        }
        source = {};
        source.kind = Source::Kind::Node;
        source.node = NodeId(progress[element]);
        return true;
    }

    bool push(ElementId element, Name output) {
        graph.visited.push_back(element);
        const Shape& shape = shapeOf(element);
        isInOrder(shape.isPlain && d[element].name && d.isUnique(element));
        if (!shape.match && graph.unknownIsDefault &&
            !definitions.hasCategory(d[element].category, shape.query.space)) {
            isInOrder(false);
            return false;
        }
        if (!shape.match) {
            error(element, "unknown-node",
                  fmt::format("no definition of '{}' fits this node", d.text(d[element].category)));
            return false;
        }
        constexpr std::uint32_t kBroken = doc::NodeDefRow::InheritsItself | doc::NodeDefRow::TooManyPorts;
        if (std::uint32_t flags = definitions.row(shape.match.def).flags; flags & kBroken)
            return refuse(element, flags);
        graph.isExact = graph.isExact && shape.match.exact;
        Frame& frame = stack.emplace_back();
        frame.node = {element, shape.kind, static_cast<std::uint32_t>(graph.inputs.size())};
        frame.output = output;
        // Each input starts out with the port that the document has for it.
        auto ports = graph.kinds[shape.kind].inputs;
        std::size_t first = graph.inputs.size(), end = first + ports.size();
        if (end > graph.inputs.capacity()) graph.inputs.reserve(std::max(end, first * 2));
        graph.inputs.resize(end);
        for (std::size_t i = 0; i < ports.size(); i++) {
            Input& input = graph.inputs[first + i];
            input.port = &ports[i];
            input.type = shape.types[i];
            if (shape.from[i] != Shape::kAbsent)
                input.source.element = givenElements[shape.from[i]];
            else if (hasOthers)
                input.source.element = d.child(element, ports[i].name);
        }
        progress[element] = Progress::kOpen;
        return true;
    }

    const Shape& shapeOf(ElementId element) {
        const doc::WellKnown& k = d.known();
        doc::Query q;
        q.category = d[element].category;
        for (const doc::Attribute& a : d.attributes(element)) {
            if (a.name == k.type) q.type = a.value;
            if (a.name == k.version) q.version = a.value;
            if (a.name == k.nodedef) q.nodedef = a.value;
        }
        q.space = d.namespaceOf(element);
        given.clear();
        givenElements.clear();
        given.reserve(16);
        givenElements.reserve(16);
        hasOthers = false;
        for (ElementId c : doc::children(d, element)) {
            if (d[c].category != k.input || !d[c].name) {
                hasOthers = hasOthers || d[c].name;
                isInOrder(!d[c].name && d[c].category != k.input);
                continue;
            }
            given.push_back({d[c].name, d.attribute(c, k.type)});
            givenElements.push_back(c);
        }
        std::uint32_t& at = shapeAt[(q.category.index + 7 * q.type.index) % shapeAt.size()];
        if (at && shapes[at - 1].isOf(q, given)) return shapes[at - 1];
        if (!at) {
            shapes.emplace_back();
            at = static_cast<std::uint32_t>(shapes.size());
        }
        fill(shapes[at - 1], q);
        return shapes[at - 1];
    }

    void fill(Shape& shape, const doc::Query& q) {
        shape.query = q;
        shape.given = given;
        doc::Query whole = q;
        whole.inputs = given;
        shape.match = definitions.match(whole);
        shape.isPlain = q.type && std::all_of(given.begin(), given.end(), [](const auto& g) { return bool(g.type); });
        shape.from.clear();
        shape.types.clear();
        shape.types.reserve(given.size());
        if (!shape.match) return;
        shape.kind = kindOf(shape.match.def);
        auto ports = graph.kinds[shape.kind].inputs;
        for (const doc::Port& port : ports) shape.types.push_back(typeOf(port.type));
        // Backwards, so that of two of one name the first one counts. They mostly come in the order of the ports.
        shape.from.assign(ports.size(), Shape::kAbsent);
        std::size_t at = ports.size();
        for (std::size_t g = given.size(); g-- > 0;) {
            auto same = [&](const doc::Port& p) { return p.name == given[g].name; };
            if (at == 0 || !same(ports[at - 1]))
                at = static_cast<std::size_t>(std::find_if(ports.begin(), ports.end(), same) - ports.begin()) + 1;
            if (at > ports.size())
                at = ports.size();
            else
                shape.isPlain =
                    std::exchange(shape.from[--at], static_cast<std::uint32_t>(g)) == Shape::kAbsent && shape.isPlain;
        }
    }

    // Types have few names.
    ir::Type typeOf(Name name) {
        auto& [known, type] = types[name.index % types.size()];
        if (known != name) {
            known = name;
            type = graph::typeOf(definitions, d.text(name));
        }
        return type;
    }

    std::uint32_t kindOf(doc::NodeDef def) {
        auto [it, isNew] =
            kinds.try_emplace(std::uint64_t(def.layer) << 32 | def.row, static_cast<std::uint32_t>(graph.kinds.size()));
        if (isNew) graph.kinds.push_back({def, definitions.inputs(def), definitions.outputs(def)});
        return it->second;
    }

    // A node whose nodedef has no interface that could be told.
    bool refuse(ElementId element, std::uint32_t flags) {
        std::string_view category = d.text(d[element].category);
        if (flags & doc::NodeDefRow::InheritsItself)
            error(element, "inherit-cycle", fmt::format("the nodedef of '{}' inherits itself", category));
        else
            error(element, "limit", fmt::format("the nodedef of '{}' has too many inputs and outputs", category)).hint =
                "several nodes may share the work";
        return false;
    }

    // One input of the topmost node, or the node itself when all are there.
    void step() {
        Frame& frame = stack.back();
        if (frame.next == graph.kinds[frame.node.kind].inputs.size()) return finish();
        Input& input = graph.inputs[frame.node.firstInput + frame.next];
        ElementId port = input.source.element;
        input.source = {};
        Name output;
        ElementId target = port ? follow(port, input.source, output) : ElementId();
        if (!target) {
            frame.next++;
            return;
        }
        std::uint32_t state = progress[target];
        if (state == Progress::kNew) {
            input.source.element = port;  // for when it is built
            if (!push(target, output)) next({});
        } else if (state == Progress::kOpen) {
            cycle(target);
            frame.next++;
        } else {
            connect(NodeId(state), output, port);
        }
    }

    void finish() {
        Frame done = stack.back();
        NodeId made(static_cast<std::uint32_t>(graph.nodes.size()));
        progress[done.node.element] = made.index;
        graph.nodes.push_back(done.node);
        stack.pop_back();
        if (stack.empty()) return;
        const Frame& reader = stack.back();
        connect(made, done.output, graph.inputs[reader.node.firstInput + reader.next].source.element);
    }

    // The topmost node's next input comes from a node.
    void connect(NodeId from, Name output, ElementId port) {
        Source source;
        source.kind = Source::Kind::Node;
        source.node = from;
        pickOutput(port, output, source);
        next(source);
    }
    void next(const Source& source) {
        Frame& frame = stack.back();
        graph.inputs[frame.node.firstInput + frame.next++].source = source;
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
            case Source::Kind::Geometric:
                return fmt::format("geometric {}", d.text(s.input));
            case Source::Kind::Node: {
                const Node& n = graph.nodes[s.node.index];
                auto outputs = graph.kindOf(n).outputs;
                std::string name = d.path(n.element);
                return outputs.size() > 1 ? fmt::format("{}.{}", name, d.text(outputs[s.output].name)) : name;
            }
        }
        return {};
    };
    for (const Node& n : graph.nodes) {
        out += fmt::format("{} = {} ({})\n", d.path(n.element), d.text(d[n.element].category),
                           d.text(definitions.row(graph.kindOf(n).def).name));
        for (const Input& i : graph.inputsOf(n))
            out += fmt::format("    {}: {} = {}\n", d.text(i.port->name), info(i.type).name, source(i.source));
    }
    for (const Output& o : graph.outputs)
        out += fmt::format("output {}: {} = {}\n", d.text(o.name), info(o.type).name, source(o.source));
    return out;
}

}  // namespace shaderx::graph
