// Nodes of the standard library that 1.39 names otherwise or whose inputs it does.
#include <array>
#include <optional>

#include "doc/upgrade_rules.h"
#include "doc/values.h"

namespace shaderx::doc {

namespace {

// Until 1.37 in1 was x and in2 was y.
void atan2(Upgrader& u, ElementId e) {
    bool xFirst = u.minorAt(e) < 38;
    u.renameInput(e, "in1", xFirst ? "inx" : "iny");
    u.renameInput(e, "in2", xFirst ? "iny" : "inx");
}

// intest > cutoff ? in2 : in1
void compare(Upgrader& u, ElementId e) {
    u.become(e, "ifgreater");
    ElementId in1 = u.input(e, "in1"), in2 = u.input(e, "in2");
    if (in1) u.d.rename(in1, "in2");
    if (in2) u.d.rename(in2, "in1");
    if (in1 || in2) u.edited(e, "inputs 'in1', 'in2'", "inputs 'in2', 'in1'");
    u.renameInput(e, "intest", "value1");
    u.renameInput(e, "cutoff", "value2");
    for (const char* name : {"value1", "value2"})
        if (!u.input(e, name)) u.addValue(e, name, "float", "0");
}

void rotate(Upgrader& u, ElementId e) { u.become(e, u.type(e) == "vector2" ? "rotate2d" : "rotate3d"); }

void invert(Upgrader& u, ElementId e) {
    if (u.type(e).starts_with("matrix")) u.become(e, "invertmatrix");
}

// A transform without spaces was one by a matrix.
void transform(Upgrader& u, ElementId e) {
    bool hasSpace = u.input(e, "fromspace") || u.input(e, "tospace");
    if (u.input(e, "mat") || (!hasSpace && u.type(e) != "vector3")) u.become(e, "transformmatrix");
}

void combine(Upgrader& u, ElementId e) {
    for (int n = 4; n >= 2; n--)
        if (u.input(e, fmt::format("in{}", n))) return u.become(e, fmt::format("combine{}", n));
    u.warn(e, "a combine of fewer than two inputs has no counterpart in 1.39");
}

void separate(Upgrader& u, ElementId e) {
    ElementId in = u.input(e, "in");
    std::string_view from = in ? u.type(in) : std::string_view();
    char count = from.empty() ? ' ' : from.back();
    if (count < '2' || count > '4' || !(from.starts_with("color") || from.starts_with("vector")))
        return u.warn(e, "a separate of nothing that has parts has no counterpart in 1.39");
    u.become(e, fmt::format("separate{}", count));
}

// which = true took in2.
void switchOfBoolean(Upgrader& u, ElementId e) {
    ElementId which = u.input(e, "which");
    if (!which || u.type(which) != "boolean") return;
    u.become(e, "ifequal");
    ElementId in1 = u.input(e, "in1"), in2 = u.input(e, "in2");
    if (in1) u.d.rename(in1, "in2");
    if (in2) u.d.rename(in2, "in1");
    u.renameInput(e, "which", "value1");
    u.addValue(e, "value2", "boolean", "true");
}

// The attribute attrname or geomprop is an input; texts are uniform.
void geomprop(Upgrader& u, ElementId e) {
    Document& d = u.d;
    for (const char* attribute : {"attrname", "geomprop"}) {
        std::string given(u.attribute(e, attribute));
        if (given.empty()) continue;
        d.unset(e, d.names().intern(attribute));
        u.addValue(e, "geomprop", "string", given);
        u.edited(e, fmt::format("attribute '{}'", attribute), "input 'geomprop'");
    }
    u.renameInput(e, "attrname", "geomprop");
    bool isText = u.type(e) == "string" || u.type(e) == "filename";
    if (isText)
        u.become(e, "geompropvalueuniform");
    else if (u.category(e) == "geomattrvalue")
        u.become(e, "geompropvalue");
}

// In object space a normal map only unpacks: normalize(2 in − 1); scale did nothing there.
void objectNormalmap(Upgrader& u, ElementId e) {
    Document& d = u.d;
    ElementId unpacked = u.addNode(e, "subtract", "unpacked", "vector3");
    ElementId doubled = u.addNode(e, "multiply", "double", "vector3");
    if (ElementId in = u.input(e, "in"))
        u.copyInput(in, doubled, "in1");
    else
        u.addValue(doubled, "in1", "vector3", "0.5, 0.5, 1");
    u.addValue(doubled, "in2", "float", "2");
    u.connect(unpacked, "in1", "vector3", doubled);
    u.addValue(unpacked, "in2", "float", "1");
    for (ElementId c = d[e].firstChild; c;) {
        ElementId next = d[c].next;
        if (d[c].category == u.k.input) d.remove(c);
        c = next;
    }
    u.become(e, "normalize");
    u.connect(e, "in", "vector3", unpacked);
}

// The bitangent was made of the other two; it is an input of its own now, of which the default is the geometry's.
void bitangent(Upgrader& u, ElementId e) {
    if ((!u.input(e, "normal") && !u.input(e, "tangent")) || u.input(e, "bitangent")) return;
    ElementId cross = u.addNode(e, "crossproduct", "bitangent_cross", "vector3");
    constexpr std::pair<const char*, const char*> kFactors[] = {{"normal", "in1"}, {"tangent", "in2"}};
    for (auto [name, factor] : kFactors) {
        if (ElementId in = u.input(e, name)) {
            u.copyInput(in, cross, factor);
            continue;
        }
        ElementId geometric = u.addNode(e, name, fmt::format("world_{}", name), "vector3");
        u.addValue(geometric, "space", "string", "world");
        u.connect(cross, factor, "vector3", geometric);
    }
    ElementId unit = u.addNode(e, "normalize", "bitangent", "vector3");
    u.connect(unit, "in", "vector3", cross);
    u.connect(e, "bitangent", "vector3", unit);
}

void normalmap(Upgrader& u, ElementId e) {
    Document& d = u.d;
    if (d.attributeText(e, u.k.nodedef) == "ND_normalmap") {
        d.set(e, "nodedef", "ND_normalmap_float");
        u.edited(e, "nodedef 'ND_normalmap'", "nodedef 'ND_normalmap_float'");
    }
    if (ElementId space = u.input(e, "space")) {
        std::string value(d.attributeText(space, u.k.value));
        if (u.isConnected(space) || (value != "tangent" && value != "object" && !value.empty()))
            return u.warn(
                space, "a normalmap of 1.39 is always in tangent space, and which space this one is in is not fixed");
        u.edited(space, fmt::format("space '{}'", value), "none");
        d.remove(space);
        if (value == "object") return objectNormalmap(u, e);
    }
    bitangent(u, e);
}

// `metallic` was `metalness` in the first library that had it.
void usdPreviewSurface(Upgrader& u, ElementId e) {
    if (!u.input(e, "metallic")) u.renameInput(e, "metalness", "metallic");
}

void gone(Upgrader& u, ElementId e) { u.warn(e, fmt::format("<{}> has no counterpart in 1.39", u.category(e))); }

// The back of a surface of two sides is an input of the material: see upgradeBacks.
void thinSurface(Upgrader& u, ElementId e) {
    Document& d = u.d;
    ElementId back = u.input(e, "back_bsdf"), backGlow = u.input(e, "back_edf"), front = u.input(e, "front_bsdf");
    bool isDifferent = (back && u.isConnected(back)) || (backGlow && u.isConnected(backGlow));
    if (isDifferent) {
        ElementId other = u.addNode(e, "surface", "back", "surfaceshader");
        if (ElementId from = back && u.isConnected(back) ? back : front) u.copyInput(from, other, "bsdf");
        if (backGlow) u.copyInput(backGlow, other, "edf");
        if (ElementId opacity = u.input(e, "opacity")) u.copyInput(opacity, other, "opacity");
        u.addValue(other, "thin_walled", "boolean", "true");
        u.backs.push_back({e, other});
    }
    u.become(e, "surface");
    u.renameInput(e, "front_bsdf", "bsdf");
    u.renameInput(e, "front_edf", "edf");
    if (back) d.remove(back);
    if (backGlow) d.remove(backGlow);
    u.addValue(e, "thin_walled", "boolean", "true");
}

constexpr NodeRule kRules[] = {
    {"compare", 37, compare},
    {"rotate", 37, rotate},
    {"invert", 37, invert},
    {"transformpoint", 37, transform},
    {"transformvector", 37, transform},
    {"transformnormal", 37, transform},
    {"combine", 37, combine},
    {"separate", 37, separate},
    {"geomattrvalue", 37, geomprop},
    {"switch", 37, switchOfBoolean},
    {"UsdPreviewSurface", 38, usdPreviewSurface},
    {"complex_ior", 38, gone},
    {"backfacing", 38, gone},
    {"fresnel", 38, gone},
    {"atan2", 39, atan2},
    {"swizzle", 39, upgradeSwizzle},
    {"normalmap", 39, normalmap},
    {"geompropvalue", 39, geomprop},
    {"thin_surface", 39, thinSurface},
    {"arrayappend", 39, gone},
    {"ambientocclusion", 39, gone},
    {"curveadjust", 39, gone},
};

}  // namespace

void upgradeBacks(Upgrader& u) {
    if (u.backs.empty()) return;
    Upgrader::Readers readers = u.readers();
    for (auto [front, back] : u.backs) {
        bool found = false;
        for (ElementId port : readers[front]) {
            ElementId material = u.d[port].parent;
            if (u.category(material) != "surfacematerial" || u.text(u.d[port].name) != "surfaceshader") continue;
            u.connect(material, "backsurfaceshader", "surfaceshader", back);
            found = true;
        }
        if (!found) u.warn(front, "no material beside it can hold the back of this surface");
    }
}

std::span<const NodeRule> oldNodeRules() { return kRules; }

}  // namespace shaderx::doc
