// Words of 1.22 to 1.36 that later versions say otherwise, and types.
#include "doc/upgrade_rules.h"

namespace shaderx::doc {

namespace {

void replaceType(Upgrader& u, ElementId e, std::string_view from, std::string_view to) {
    if (u.type(e) != from) return;
    u.d.set(e, "type", to);
    u.edited(e, fmt::format("type '{}'", from), fmt::format("type '{}'", to));
}

void replaceCategory(Upgrader& u, ElementId e, std::string_view from, std::string_view to) {
    if (u.category(e) != from) return;
    u.d.setCategory(e, to);
    u.edited(e, fmt::format("<{}>", from), fmt::format("<{}>", to));
}

// <parameter type="opgraphnode" value="n">: a connection to the node n.
void connectByParameter(Upgrader& u, ElementId e) {
    Document& d = u.d;
    if (u.type(e) != "opgraphnode") return;
    ElementId owner = d[e].parent;
    Name target = d.attribute(e, u.k.value);
    if (d[owner].category == u.k.output && u.text(d[e].name) == "in") {
        d.set(owner, u.k.nodename, target);
        u.edited(e, u.tag(e), fmt::format("attribute 'nodename' of output '{}'", u.text(d[owner].name)));
        d.remove(e);
        return;
    }
    ElementId node = target ? d.child(d[owner].parent, target) : ElementId();
    if (!node) return u.warn(e, fmt::format("there is no node '{}' to connect to", u.text(target)));
    u.edited(e, "a value of type 'opgraphnode'", "attribute 'nodename'");
    d.setCategory(e, "input");
    d.unset(e, u.k.value);
    d.set(e, "type", std::string(u.type(node)));
    d.set(e, u.k.nodename, target);
}

// A child that names what its parent inherits from: an attribute since 1.36.
void inheritByAttribute(Upgrader& u, ElementId e, std::string_view childCategory, std::string_view attribute) {
    if (u.category(e) != childCategory) return;
    ElementId owner = u.d[e].parent;
    u.d.set(owner, "inherit", std::string(u.attribute(e, attribute)));
    u.edited(e, u.tag(e), fmt::format("attribute 'inherit' of '{}'", u.text(u.d[owner].name)));
    u.d.remove(e);
}

// <collectionadd geom="a"> and <collectionremove>: lists in attributes of the collection since 1.35.
void collect(Upgrader& u, ElementId e) {
    std::string_view c = u.category(e);
    if (c != "collectionadd" && c != "collectionremove") return;
    Document& d = u.d;
    ElementId owner = d[e].parent;
    if (u.attribute(e, "geom").empty()) return u.warn(e, fmt::format("<{}> without geometry means nothing", c));
    std::string_view list = c == "collectionadd" ? "includegeom" : "excludegeom";
    std::string all(u.attribute(owner, list));
    if (!all.empty()) all += ',';
    all += u.attribute(e, "geom");
    u.edited(e, u.tag(e), fmt::format("attribute '{}' of '{}'", list, u.text(d[owner].name)));
    d.set(owner, list, all);
    d.remove(e);
}

// Until 1.35 an assignment was named like its material.
void assign(Upgrader& u, ElementId e) {
    Document& d = u.d;
    replaceCategory(u, e, "assign", "materialassign");
    if (d[e].category != u.k.materialassign || d.attribute(e, u.k.material) || !d[e].name) return;
    d.set(e, u.k.material, d[e].name);
    u.edited(e, "material by 'name'", "attribute 'material'");
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

void fileTokens(Upgrader& u, ElementId e) {
    std::string_view was = u.value(e);
    if (u.type(e) != "filename" || was.find("%U") == std::string_view::npos) return;
    std::string now = replaced(replaced(std::string(was), "%UDIM", "<UDIM>"), "%UVTILE", "<UVTILE>");
    if (now == was) return;
    u.edited(e, fmt::format("file '{}'", was), fmt::format("file '{}'", now));
    u.d.set(e, "value", now);
}

void words26(Upgrader& u, ElementId e) {
    Document& d = u.d;
    if (u.minorAt(e) < 26 && u.category(e) == "constant") u.renameInput(e, "color", "value");
    replaceCategory(u, e, "opgraph", "nodegraph");
    if (d[e].category == u.k.input) {
        u.renameAttribute(e, "graphname", "nodegraph");
        u.renameAttribute(e, "opgraph", "nodegraph");
        u.renameAttribute(e, "graphoutput", "output");
    }
    connectByParameter(u, e);
}

void words34(Upgrader& u, ElementId e) {
    Document& d = u.d;
    bool holdsValue = d[e].category == u.k.input || d[e].category == u.k.parameter || d[e].category == u.k.token;
    if (holdsValue && !d.attribute(e, u.k.value)) u.renameAttribute(e, "default", "value");
    assign(u, e);
    collect(u, e);
}

// Scaled texture coordinates about a center of (0.5, 0.5).
void scale(Upgrader& u, ElementId e) {
    u.become(e, "place2d");
    u.renameInput(e, "in", "texcoord");
    u.renameInput(e, "center", "pivot");
    if (!u.input(e, "pivot")) u.addValue(e, "pivot", "vector2", "0.5, 0.5");
    u.renameInput(e, "amount", "scale");
    ElementId amount = u.input(e, "scale");
    if (amount && u.type(amount) == "float" && !u.isConnected(amount))
        u.d.set(amount, "value", fmt::format("{0}, {0}", u.value(amount)));
    u.retype(e, "scale", "float", "vector2");
}

// Nodes that 1.36 renamed.
void nodes35(Upgrader& u, ElementId e) {
    std::string_view c = u.category(e);
    if (c == "mix") u.renameInput(e, "mask", "mix");
    if (c == "exponent") u.become(e, "power");
    if (c == "scale" && u.type(e) == "vector2") scale(u, e);
    if (c == "pack") u.become(e, "combine");
    if (c == "hueshift") {
        ElementId amount = u.input(e, "amount");
        if (amount && u.isConnected(amount)) return;
        u.become(e, "hsvadjust");
        std::string hue(amount ? u.value(amount) : std::string_view("0"));
        if (amount) u.d.remove(amount);
        u.addValue(e, "amount", "vector3", hue + ", 1, 1");
    }
}

void words35(Upgrader& u, ElementId e) {
    if (u.type(e) == "geomname" && u.value(e) == "*") {
        u.d.set(e, "value", "/");
        u.edited(e, "geometry '*'", "geometry '/'");
    }
    if (u.attribute(e, "geom") == "*") {
        u.d.set(e, "geom", "/");
        u.edited(e, "geometry '*'", "geometry '/'");
    }
    fileTokens(u, e);
    if (isNode(u.d, e)) nodes35(u, e);
    inheritByAttribute(u, e, "materialinherit", "material");
    if (u.d[e].category) inheritByAttribute(u, e, "lookinherit", "look");
}

// type="t" of a nodedef: an output since 1.37. Its parameters are uniform inputs.
void nodedef(Upgrader& u, ElementId e) {
    Document& d = u.d;
    std::string outputType(u.type(e));
    if (outputType.empty()) return;
    bool has = false;
    for (ElementId c : children(d, e)) has |= d[c].category == u.k.output;
    Name defaultInput = d.names().intern("defaultinput"), given = d.attribute(e, defaultInput);
    if (outputType != "multioutput" && !has) {
        ElementId out = d.append(e, "output", "out");
        d.set(out, "type", outputType);
        d.setOrigin(out, e);
        if (given) d.set(out, defaultInput, given);
        u.edited(e, fmt::format("type '{}'", outputType), "an output 'out' of that type");
    }
    d.unset(e, u.k.type);
    d.unset(e, defaultInput);
}

// The parameters of a backdrop: attributes since 1.37.
void backdrop(Upgrader& u, ElementId e) {
    Document& d = u.d;
    for (ElementId c = d[e].firstChild; c;) {
        ElementId next = d[c].next;
        Name given = d.attribute(c, u.k.value);
        if (d[c].category == u.k.parameter && d[c].name && given) {
            u.edited(c, u.tag(c), fmt::format("attribute '{}'", u.text(d[c].name)));
            d.set(e, d[c].name, given);
            d.remove(c);
        }
        c = next;
    }
}

void words36(Upgrader& u, ElementId e) {
    if (u.d[e].category == u.k.nodedef) nodedef(u, e);
    replaceCategory(u, e, "geomattr", "geomprop");
    if (u.category(e) == "backdrop") backdrop(u, e);
}

// r, a of a color2 are x, y of a vector2.
std::string vector2Letters(std::string_view letters) {
    std::string out(letters);
    for (char& c : out) c = c == 'r' ? 'x' : c == 'a' ? 'y' : c;
    return out;
}

// What names the components of a color2 that it reads. Before the types change.
void color2Reader(Upgrader& u, ElementId e) {
    Document& d = u.d;
    if (d[e].category != u.k.input && d[e].category != u.k.output && d[e].category != u.k.parameter) return;
    Name letters = d.attribute(e, u.k.channels), output = d.attribute(e, u.k.output);
    if (!letters && !output) return;
    ElementId target = connection(d, e).target;
    if (!target) return;
    if (letters && u.type(target) == "color2") d.set(e, "channels", vector2Letters(u.text(letters)));
    ElementId in = u.category(target).starts_with("separate") ? u.input(target, "in") : ElementId();
    if (!in || u.type(in) != "color2") return;
    if (u.text(output) == "outr") d.set(e, "output", "outx");
    if (u.text(output) == "outa") d.set(e, "output", "outy");
}

void color2Swizzle(Upgrader& u, ElementId e) {
    if (u.category(e) != "swizzle") return;
    ElementId in = u.input(e, "in"), letters = u.input(e, "channels");
    if (in && letters && u.type(in) == "color2") u.d.set(letters, "value", vector2Letters(u.value(letters)));
}

// Two color2 made a color4, which two vector2 do not.
void combineColor2(Upgrader& u, ElementId e) {
    ElementId in1 = u.input(e, "in1"), in2 = u.input(e, "in2");
    if (u.type(e) != "color4" || !in1 || !in2 || u.type(in1) != "color2" || u.type(in2) != "color2") return;
    Document& d = u.d;
    ElementId parts = u.addNode(e, "combine2", "vector", "vector4");
    for (ElementId in : {in1, in2}) {
        d.set(u.copyInput(in, parts, u.text(d[in].name)), "type", "vector2");
        d.remove(in);
    }
    u.become(e, "convert");
    u.connect(e, "in", "vector4", parts);
}

void color2(Upgrader& u, ElementId e) {
    std::string_view c = u.category(e);
    if (c == "combine" || c == "combine2") combineColor2(u, e);
    ElementId in = c == "convert" && u.type(e) == "color2" ? u.input(e, "in") : ElementId();
    if (in && (u.type(in) == "color2" || u.type(in) == "vector2")) u.become(e, "dot");
    in = c == "convert" && u.type(e) == "vector2" ? u.input(e, "in") : ElementId();
    if (in && u.type(in) == "color2") u.become(e, "dot");
    replaceType(u, e, "color2", "vector2");
    if (u.d.attributeText(e, u.k.nodedef).find("color2") != std::string_view::npos && isNode(u.d, e)) {
        u.edited(e, "a nodedef of color2", "the one that fits");
        u.d.unset(e, u.k.nodedef);
    }
}

}  // namespace

void upgradeWords(Upgrader& u) {
    u.each(23, [&](ElementId e) { replaceType(u, e, "vector", "vector3"); });
    u.each(35, [&](ElementId e) { replaceType(u, e, "matrix", "matrix44"); });
    u.each(34, [&](ElementId e) { words26(u, e); });
    u.each(35, [&](ElementId e) { words34(u, e); });
    u.each(36, [&](ElementId e) { words35(u, e); });
    u.each(37, [&](ElementId e) { words36(u, e); });
}

void upgradeTypes(Upgrader& u) {
    if (u.d.names().find("color2")) {
        u.each(38, [&](ElementId e) { color2Reader(u, e); });
        u.each(38, [&](ElementId e) { color2Swizzle(u, e); });
        u.each(38, [&](ElementId e) { color2(u, e); });
    }
    u.each(kNewestMinor, [&](ElementId e) {
        if (u.d[e].category != u.k.parameter) return;
        u.become(e, "input");
        if (u.d[u.d[e].parent].category == u.k.nodedef) u.d.set(e, "uniform", "true");
    });
}

}  // namespace shaderx::doc
