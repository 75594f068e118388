// Closures: their names until 1.37, and inputs whose types or defaults were others.
#include "doc/upgrade_rules.h"

namespace shaderx::doc {

namespace {

// Until 1.37 what a closure lay on was an input of it. The layer gets the name, so that what read the whole still does.
void lieOn(Upgrader& u, ElementId e, std::string_view name, std::string_view baseType) {
    Document& d = u.d;
    ElementId base = u.input(e, name);
    if (!base) return;
    if (!u.isConnected(base)) return d.remove(base);
    Name whole = d[e].name;
    std::string was = u.tag(e);
    d.rename(e, u.freeName(d[e].parent, fmt::format("{}_top", u.text(whole))));
    ElementId layer = d.insertAfter(e, "layer", u.text(whole));
    d.set(layer, "type", "BSDF");
    d.setOrigin(layer, e);
    u.keepScope(e, layer);
    u.connect(layer, "top", "BSDF", e);
    d.set(u.copyInput(base, layer, "base"), "type", baseType);
    d.remove(base);
    u.edited(e, fmt::format("input '{}' of {}", name, was), u.tag(layer) + " of " + u.tag(e));
}

void addDefault(Upgrader& u, ElementId e, std::string_view name, std::string_view type, std::string_view value) {
    if (u.input(e, name)) return;
    u.addValue(e, name, type, value);
    u.edited(e, fmt::format("the default of '{}'", name), fmt::format("'{}'", value));
}

// Microfacet closures were smooth by default.
void microfacet(Upgrader& u, ElementId e, std::string_view now) {
    u.become(e, now);
    addDefault(u, e, "roughness", "vector2", "0, 0");
}

void dielectricReflection(Upgrader& u, ElementId e) {
    microfacet(u, e, "dielectric_bsdf");
    lieOn(u, e, "base", "BSDF");
}

void dielectricTransmission(Upgrader& u, ElementId e) {
    microfacet(u, e, "dielectric_bsdf");
    u.addValue(e, "scatter_mode", "string", "T");
    lieOn(u, e, "interior", "VDF");
}

void schlick(Upgrader& u, ElementId e) {
    microfacet(u, e, "generalized_schlick_bsdf");
    lieOn(u, e, "base", "BSDF");
}

void sheen(Upgrader& u, ElementId e) {
    u.become(e, "sheen_bsdf");
    lieOn(u, e, "base", "BSDF");
}

void thinFilm(Upgrader& u, ElementId e) {
    u.become(e, "thin_film_bsdf");
    addDefault(u, e, "thickness", "float", "1000");
    lieOn(u, e, "base", "BSDF");
}

void diffuse(Upgrader& u, ElementId e) { u.become(e, "oren_nayar_diffuse_bsdf"); }
void burley(Upgrader& u, ElementId e) { u.become(e, "burley_diffuse_bsdf"); }
void translucent(Upgrader& u, ElementId e) { u.become(e, "translucent_bsdf"); }

void subsurface(Upgrader& u, ElementId e) {
    if (u.category(e) != "subsurface_bsdf") u.become(e, "subsurface_bsdf");
    u.retype(e, "radius", "vector3", "color3");
}

// A conductor was described by its reflectivity and edge color; 1.39 wants its indices, which artistic_ior finds.
void conductor(Upgrader& u, ElementId e) {
    Document& d = u.d;
    microfacet(u, e, "conductor_bsdf");
    ElementId indices = u.addNode(e, "artistic_ior", "artistic_ior", "multioutput");
    for (const char* name : {"reflectivity", "edge_color"})
        if (ElementId in = u.input(e, name)) {
            u.copyInput(in, indices, name);
            d.remove(in);
        }
    for (const char* name : {"ior", "extinction"}) u.connect(e, name, "color3", indices, name);
}

void conductorIndices(Upgrader& u, ElementId e) {
    for (const char* name : {"ior", "extinction"}) u.retype(e, name, "vector3", "color3");
}

// The outputs of artistic_ior are colors since 1.38: what reads them as vectors reads a convert, a conductor as colors.
void readIndices(Upgrader& u, ElementId port) {
    Document& d = u.d;
    if (d[port].category == u.k.output && u.category(d[port].parent) == "artistic_ior" && u.type(port) == "vector3")
        return d.set(port, "type", "color3");
    bool isPort = d[port].category == u.k.input || d[port].category == u.k.output;
    if (!isPort || !d.attribute(port, u.k.output) || u.type(port) != "vector3") return;
    ElementId from = connection(d, port).target, owner = d[port].parent;
    if (!from || u.category(from) != "artistic_ior") return;
    u.edited(port, "type 'vector3'", "type 'color3', as artistic_ior gives");
    if (u.category(owner) == "conductor_bsdf") return d.set(port, "type", "color3");
    if (d[port].category == u.k.output) owner = port;
    ElementId between = u.addNode(owner, "convert", fmt::format("{}_vector", u.text(d[port].name)), "vector3");
    d.set(u.copyInput(port, between, "in"), "type", "color3");
    u.redirect(port, between);
}

// Rates were colors in documents after the specification.
void rates(Upgrader& u, ElementId e) {
    for (const char* name : {"absorption", "scattering"}) u.retype(e, name, "color3", "vector3");
}

// A mix of closures took the first one where it did not say.
void mix(Upgrader& u, ElementId e) {
    std::string_view t = u.type(e);
    if (t == "BSDF" || t == "EDF" || t == "VDF") addDefault(u, e, "mix", "float", "1");
}

constexpr NodeRule kRules[] = {
    {"diffuse_brdf", 38, diffuse},
    {"diffuse_btdf", 38, translucent},
    {"burley_diffuse_brdf", 38, burley},
    {"dielectric_brdf", 38, dielectricReflection},
    {"dielectric_btdf", 38, dielectricTransmission},
    {"conductor_brdf", 38, conductor},
    {"generalized_schlick_brdf", 38, schlick},
    {"subsurface_brdf", 38, subsurface},
    {"sheen_brdf", 38, sheen},
    {"thin_film_brdf", 38, thinFilm},
    {"mix", 38, mix},
    {"subsurface_bsdf", 39, subsurface},
    {"conductor_bsdf", 39, conductorIndices},
    {"absorption_vdf", 39, rates},
    {"anisotropic_vdf", 39, rates},
};

}  // namespace

void upgradeIndices(Upgrader& u) {
    if (!u.d.names().find("artistic_ior")) return;
    u.each(kNewestMinor, [&](ElementId e) { readIndices(u, e); });
}

std::span<const NodeRule> oldClosureRules() { return kRules; }

}  // namespace shaderx::doc
