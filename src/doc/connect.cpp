#include "doc/connect.h"

namespace shaderx::doc {

ElementId scopeOf(const Document& d, ElementId element) {
    ElementId at = d[element].parent;
    while (at && d[at].parent && d[at].category != d.known().nodegraph) at = d[at].parent;
    return at;
}

// The first output of a nodegraph.
static ElementId firstOutput(const Document& d, ElementId graph) {
    for (ElementId c : children(d, graph))
        if (d[c].category == d.known().output) return c;
    return {};
}

// An output of a nodegraph by name, or its first one.
static ElementId outputOf(const Document& d, ElementId graph, Name output) {
    return output ? d.child(graph, d.known().output, output) : firstOutput(d, graph);
}

// An element beside the port's owner; a nodegraph may also stand at the top.
static ElementId lookUp(const Document& d, ElementId port, ElementId scope, Name name) {
    ElementId found = d.childFrom(port, scope, name);
    if (found || scope == d.root()) return found;
    ElementId top = d.childFrom(port, d.root(), name);
    return top && d[top].category == d.known().nodegraph ? top : ElementId();
}

static Connection toGraphOrNode(const Document& d, ElementId port, ElementId scope, Name attribute, Name name) {
    const WellKnown& k = d.known();
    Connection c;
    c.kind = Connection::Kind::Dangling;
    c.output = d.attribute(port, k.output);
    c.attribute = attribute;
    ElementId found = attribute == k.nodename ? d.childFrom(port, scope, name) : lookUp(d, port, scope, name);
    if (!found) return c;
    if (d[found].category == k.nodegraph) {
        c.target = outputOf(d, found, c.output);
        if (c.target)
            c.kind = Connection::Kind::Output;
        else
            c.attribute = k.output;
    } else if (attribute == k.nodename && d[found].category == k.output) {
        c.target = found;
        c.kind = Connection::Kind::Output;
    } else if (attribute == k.nodename && isNode(d, found)) {
        c.target = found;
        c.kind = Connection::Kind::Node;
    }
    return c;
}

// What the attributes of a port connect it to.
struct Wires {
    Name nodename, nodegraph, output, interfacename;
};

static Connection resolved(const Document& d, ElementId port, const Wires& wires) {
    const WellKnown& k = d.known();
    const auto [nodename, nodegraph, output, interfacename] = wires;
    // An output stands in its scope, an input in a node or graph that stands in its scope.
    ElementId owner = d[port].parent;
    ElementId scope = d[port].category == k.output || !owner || !d[owner].parent ? owner : d[owner].parent;
    if (!scope) return {};
    if (nodegraph) return toGraphOrNode(d, port, scope, k.nodegraph, nodegraph);
    if (nodename) return toGraphOrNode(d, port, scope, k.nodename, nodename);
    Connection c;
    if (interfacename) {
        c.kind = Connection::Kind::Interface;
        c.attribute = k.interfacename;
        c.target = d.child(scope, interfacename);
        if (c.target && d[c.target].category != k.input) c.target = {};
        return c;
    }
    c.kind = Connection::Kind::Output;
    c.target = d.childFrom(port, scope, output);
    c.output = output;
    c.attribute = k.output;
    if (c.target && d[c.target].category != k.output) c.target = d.child(scope, k.output, output);
    if (!c.target || c.target == port) {
        c.kind = Connection::Kind::Dangling;
        c.target = {};
    }
    return c;
}

Connection connection(const Document& d, ElementId port) {
    const WellKnown& k = d.known();
    Wires wires;
    Name value, colorspace, defaultgeomprop;
    for (const Attribute& a : d.attributes(port)) {
        if (a.name == k.name || a.name == k.type) continue;  // as most are
        if (a.name == k.nodename) wires.nodename = a.value;
        if (a.name == k.nodegraph) wires.nodegraph = a.value;
        if (a.name == k.output) wires.output = a.value;
        if (a.name == k.interfacename) wires.interfacename = a.value;
        if (a.name == k.value) value = a.value;
        if (a.name == k.colorspace && !d.text(a.value).empty()) colorspace = a.value;
        if (a.name == k.defaultgeomprop) defaultgeomprop = a.value;
    }
    const bool isWired = wires.nodename || wires.nodegraph || wires.output || wires.interfacename;
    Connection c = isWired ? resolved(d, port, wires) : Connection();
    c.value = value;
    c.colorspace = colorspace;
    c.defaultgeomprop = defaultgeomprop;
    return c;
}

bool isNode(const Document& d, ElementId element) {
    const Element& e = d[element];
    if (!e.parent || !e.category) return false;
    if (e.parent != d.root() && d[e.parent].category != d.known().nodegraph) return false;
    if (d.known().isFormat(e.category)) return false;
    std::string_view text = d.text(e.category);
    return !text.empty() && text[0] != '#';
}

}  // namespace shaderx::doc
