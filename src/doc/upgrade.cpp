#include "doc/upgrade.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/numbers.h"
#include "doc/connect.h"
#include "doc/values.h"

namespace shaderx::doc {

namespace {

using Kind = Connection::Kind;

struct Upgrader {
    Document& d;
    Diagnostics& diagnostics;
    const WellKnown& k;
    std::vector<int> minors{};  // the minor version of each source
    int rootMinor = 39;

    std::string_view text(Name n) const { return d.text(n); }
    std::string_view category(ElementId e) const { return text(d[e].category); }
    std::string_view type(ElementId e) const { return d.attributeText(e, k.type); }
    ElementId input(ElementId node, std::string_view name) const { return d.child(node, name); }

    void warn(ElementId e, std::string message) {
        Diagnostic& out = diagnostics.warning("cannot-upgrade", std::move(message));
        out.where = d.locate(e);
        out.path = d.path(e);
    }

    int minorOf(Name version) const {
        std::string_view v = text(version);
        if (!v.starts_with("1.")) return 39;
        v.remove_prefix(2);
        return parseInt(v.substr(0, v.find('.'))).value_or(39);
    }
    int minorAt(ElementId e) const { return d[e].source < minors.size() ? minors[d[e].source] : rootMinor; }

    // A name that nothing in the scope has yet.
    std::string freeName(ElementId scope, std::string name) const {
        std::string out = name;
        for (int i = 2; d.child(scope, out); i++) out = fmt::format("{}{}", name, i);
        return out;
    }
    ElementId addNode(ElementId beside, std::string_view nodeCategory, std::string_view suffix,
                      std::string_view nodeType) {
        ElementId scope = d[beside].parent;
        std::string name = freeName(scope, fmt::format("{}_{}", text(d[beside].name), suffix));
        ElementId node = d.append(scope, nodeCategory, name);
        d.set(node, "type", nodeType);
        d.setOrigin(node, beside);
        return node;
    }
    ElementId addInput(ElementId node, std::string_view name, std::string_view inputType) {
        ElementId in = d.append(node, "input", name);
        d.set(in, "type", inputType);
        d.setOrigin(in, node);
        return in;
    }
    void addValue(ElementId node, std::string_view name, std::string_view inputType, std::string_view value) {
        d.set(addInput(node, name, inputType), "value", value);
    }
    void connect(ElementId node, std::string_view name, std::string_view inputType, ElementId from) {
        Name source = d[from].name;  // before the elements move
        d.set(addInput(node, name, inputType), k.nodename, source);
    }
    // What feeds one input, on another one: all attributes but the name.
    void copyInput(ElementId from, ElementId node, std::string_view name) {
        ElementId to = d.append(node, "input", name);
        d.setOrigin(to, from);
        std::vector<Attribute> all(d.attributes(from).begin(), d.attributes(from).end());
        for (const Attribute& a : all)
            if (a.name != k.name && a.name != k.nodedef) d.set(to, a.name, a.value);
    }
    void become(ElementId node, std::string_view newCategory) {
        d.setCategory(node, newCategory);
        d.unset(node, k.nodedef);
    }

    void old(ElementId e);
    void oldNode(ElementId e);
    void compare(ElementId e);
    void swizzle(ElementId e);
    void swizzleGeneral(ElementId e, ElementId in, std::string channels);
    void channels(ElementId port);
    void normalmap(ElementId e);
    void objectNormalmap(ElementId e);
    void subsurface(ElementId e);
    void run();
};

std::uint32_t componentCount(std::string_view type) {
    std::optional<ValueType> t = valueType(type);
    if (!t || *t < ValueType::Float || *t > ValueType::Vector4) return 0;
    return numberCount(*t);
}

// The component that a channel letter means; none for the constants 0 and 1 and for other letters.
std::optional<std::uint32_t> componentOf(char letter) {
    std::size_t at = std::string_view("rgbaxyzwst").find(letter);
    if (at == std::string_view::npos) return {};
    return static_cast<std::uint32_t>(at % 4);
}

// A swizzle node becomes dot, convert, extract, constant, or a combine of what a separate gives. Its name stays, so
// that whatever reads it goes on to.
void Upgrader::swizzle(ElementId e) {
    ElementId in = input(e, "in"), channelsInput = input(e, "channels");
    std::string letters(channelsInput ? d.attributeText(channelsInput, k.value) : std::string_view());
    if (!in) return warn(e, "a swizzle without an input 'in' has no counterpart in 1.39");
    std::string from(type(in)), to(type(e));
    std::uint32_t have = componentCount(from), want = componentCount(to);
    bool valid = have && want && letters.size() == want, identity = true;
    for (std::uint32_t i = 0; i < letters.size(); i++) {
        std::optional<std::uint32_t> c = componentOf(letters[i]);
        identity &= c == i;
        valid &= c ? *c < have : letters[i] == '0' || letters[i] == '1';
    }
    if (!valid)
        return warn(e, fmt::format("the swizzle of the channels '{}' from {} to {} has no counterpart in 1.39", letters,
                                   from, to));
    d.remove(channelsInput);
    if (identity && (from == to || want > 1)) return become(e, from == to ? "dot" : "convert");
    if (want > 1) return swizzleGeneral(e, in, letters);
    if (std::optional<std::uint32_t> c = componentOf(letters[0])) {
        become(e, "extract");
        addValue(e, "index", "integer", fmt::format("{}", *c));
    } else {
        become(e, "constant");
        d.remove(in);
        addValue(e, "value", "float", letters);
    }
}

void Upgrader::swizzleGeneral(ElementId e, ElementId in, std::string letters) {
    std::string from(type(in));
    std::uint32_t have = componentCount(from);
    bool color = from.starts_with("color");
    ElementId split;
    become(e, fmt::format("combine{}", letters.size()));
    for (std::size_t i = 0; i < letters.size(); i++) {
        std::string name = fmt::format("in{}", i + 1);
        std::optional<std::uint32_t> c = componentOf(letters[i]);
        if (!c) {
            addValue(e, name, "float", letters.substr(i, 1));
        } else if (have == 1) {
            copyInput(in, e, name);
        } else {
            if (!split) {
                split = addNode(e, fmt::format("separate{}", have), "separate", "multioutput");
                copyInput(in, split, "in");
            }
            connect(e, name, "float", split);
            d.set(input(e, name), "output", fmt::format("out{}", (color ? "rgba" : "xyzw")[*c]));
        }
    }
    d.remove(in);
}

// A port with the attribute `channels` reads a swizzle in between.
void Upgrader::channels(ElementId port) {
    Name letters = d.attribute(port, k.channels);
    Connection c = connection(d, port);
    std::string from;
    if (c.target) from = type(c.target);
    if (from == "multioutput") from = category(c.target).starts_with("separate") ? "float" : "";
    if (!componentCount(from))
        return warn(port, fmt::format("the channels '{}' cannot be upgraded: what they are taken from is not known",
                                      text(letters)));
    ElementId owner = d[port].parent;
    bool isOutput = d[port].category == k.output;
    ElementId beside = isOutput ? port : owner;
    std::string to(type(port));
    ElementId node =
        addNode(beside, "swizzle", isOutput ? "channels" : fmt::format("{}_channels", text(d[port].name)), to);
    if (d[port].source < minors.size() && d.namespaceOf(port)) d.set(node, k.namespaceName, d.namespaceOf(port));
    ElementId in = addInput(node, "in", from);
    for (Name attr : {k.nodename, k.nodegraph, k.output, k.interfacename})
        if (Name value = d.attribute(port, attr)) {
            d.set(in, attr, value);
            d.unset(port, attr);
        }
    addValue(node, "channels", "string", text(letters));
    d.unset(port, k.channels);
    d.set(port, k.nodename, d[node].name);
    swizzle(node);
}

void Upgrader::normalmap(ElementId e) {
    if (d.attributeText(e, k.nodedef) == "ND_normalmap") d.set(e, "nodedef", "ND_normalmap_float");
    ElementId space = input(e, "space");
    if (!space) return;
    std::string_view value = d.attributeText(space, k.value);
    if (connection(d, space).kind != Kind::None || (value != "tangent" && value != "object"))
        return warn(space,
                    "a normalmap of 1.39 is always in tangent space, and which space this one is in is not fixed");
    bool object = value == "object";
    d.remove(space);
    if (object) objectNormalmap(e);
}

// In object space a normal map only unpacks: normalize(2 in − 1); scale did nothing there.
void Upgrader::objectNormalmap(ElementId e) {
    ElementId doubled = addNode(e, "multiply", "double", "vector3");
    if (ElementId in = input(e, "in"))
        copyInput(in, doubled, "in1");
    else
        addValue(doubled, "in1", "vector3", "0.5, 0.5, 1");
    addValue(doubled, "in2", "float", "2");
    ElementId unpacked = addNode(e, "subtract", "unpacked", "vector3");
    connect(unpacked, "in1", "vector3", doubled);
    addValue(unpacked, "in2", "float", "1");
    for (ElementId c = d[e].firstChild; c;) {
        ElementId next = d[c].next;
        if (d[c].category == k.input) d.remove(c);
        c = next;
    }
    become(e, "normalize");
    connect(e, "in", "vector3", unpacked);
}

// Its radius was a vector3 and is a color3.
void Upgrader::subsurface(ElementId e) {
    ElementId radius = input(e, "radius");
    if (!radius || type(radius) != "vector3") return;
    if (connection(d, radius).kind != Kind::None) {
        ElementId node = addNode(e, "convert", "radius_color", "color3");
        copyInput(radius, node, "in");
        for (Name attr : {k.nodegraph, k.output, k.interfacename}) d.unset(radius, attr);
        d.set(radius, k.nodename, d[node].name);
    }
    d.set(radius, "type", "color3");
}

// compare was: intest > cutoff ? in2 : in1.
void Upgrader::compare(ElementId e) {
    ElementId in1 = input(e, "in1"), in2 = input(e, "in2"), test = input(e, "intest"), cutoff = input(e, "cutoff");
    become(e, "ifgreater");
    if (in1) d.rename(in1, "in2");
    if (in2) d.rename(in2, "in1");
    if (test) d.rename(test, "value1");
    if (cutoff) d.rename(cutoff, "value2");
    if (!test) addValue(e, "value1", "float", "0");
    if (!cutoff) addValue(e, "value2", "float", "0");
}

// Node names that 1.37 and 1.38 made plainer.
void Upgrader::oldNode(ElementId e) {
    std::string_view c = category(e), t = type(e);
    if (c == "rotate") {
        become(e, t == "vector2" ? "rotate2d" : "rotate3d");
    } else if (c == "invert" && t.starts_with("matrix")) {
        become(e, "invertmatrix");
    } else if (c.starts_with("transform") && input(e, "mat")) {
        become(e, "transformmatrix");
    } else if (c == "compare") {
        compare(e);
    } else if (c == "combine") {
        int inputs = 0;
        for (ElementId in : children(d, e)) inputs += d[in].category == k.input;
        if (inputs >= 2 && inputs <= 4) become(e, fmt::format("combine{}", inputs));
    } else if (c == "separate") {
        ElementId in = input(e, "in");
        std::uint32_t count = in ? componentCount(type(in)) : 0;
        if (count >= 2) become(e, fmt::format("separate{}", count));
    } else if (c == "geomattrvalue") {
        std::string attr(d.attributeText(e, d.names().intern("attrname")));
        become(e, "geompropvalue");
        d.unset(e, d.names().intern("attrname"));
        if (!attr.empty()) addValue(e, "geomprop", "string", attr);
    }
}

void Upgrader::old(ElementId e) {
    if (type(e) == "color2") d.set(e, "type", "vector2");
    if (d[e].category == k.parameter) d.setCategory(e, "input");
    if (category(e) == "geomattr") d.setCategory(e, "geomprop");
}

void Upgrader::run() {
    for (const Source& s : d.sources()) minors.push_back(s.version ? minorOf(s.version) : 39);
    Name version = d.attribute(d.root(), k.version);
    rootMinor = version ? minorOf(version) : 39;
    if (rootMinor >= 39 && std::all_of(minors.begin(), minors.end(), [](int minor) { return minor >= 39; })) return;
    std::uint32_t count = static_cast<std::uint32_t>(d.size());  // elements that are added are new already
    auto each = [&](int before, auto change) {
        for (std::uint32_t i = 0; i < count; i++)
            if (ElementId e(i); d[e].category && minorAt(e) < before) change(e);
    };
    each(39, [&](ElementId e) { old(e); });
    each(38, [&](ElementId e) {
        if (isNode(d, e)) oldNode(e);
    });
    each(39, [&](ElementId e) {
        if (d.attribute(e, k.channels) && (d[e].category == k.input || d[e].category == k.output)) channels(e);
    });
    each(39, [&](ElementId e) {
        std::string_view c = category(e);
        if (c == "swizzle" && isNode(d, e)) swizzle(e);
        if (c == "normalmap" && isNode(d, e)) normalmap(e);
        if (c == "subsurface_bsdf" && isNode(d, e)) subsurface(e);
        if (c == "geompropvalue" && (type(e) == "string" || type(e) == "filename")) become(e, "geompropvalueuniform");
        if (c != "atan2" || !isNode(d, e)) return;
        if (ElementId in = input(e, "in1")) d.rename(in, "iny");
        if (ElementId in = input(e, "in2")) d.rename(in, "inx");
    });
    Name now = d.names().intern("1.39");
    for (std::uint32_t s = 0; s < minors.size(); s++)
        if (minors[s] < 39) d.setSourceVersion(s, now);
    if (rootMinor < 39) d.set(d.root(), k.version, now);
}

}  // namespace

void upgrade(Document& document, Diagnostics& diagnostics) {
    Upgrader upgrader{document, diagnostics, document.known()};
    upgrader.run();
}

}  // namespace shaderx::doc
