// Of which version of MaterialX each file of a document is.
#include <algorithm>
#include <array>

#include "base/numbers.h"
#include "doc/upgrade_rules.h"

namespace shaderx::doc {

namespace {

// A word of old syntax and the last minor version that had it.
struct Mark {
    std::string_view word;
    int last;
};

constexpr Mark kCategories[] = {
    {"assign", 23},
    {"opgraph", 26},
    {"shader", 26},
    {"collectionadd", 34},
    {"collectionremove", 34},
    {"materialinherit", 35},
    {"lookinherit", 35},
    {"override", 35},
    {"geomattr", 36},
    {"geomattrvalue", 36},
    {"compare", 36},
    {"rotate", 36},
    {"combine", 36},
    {"separate", 36},
    {"parameter", 37},
    {"material", 37},
    {"shaderref", 37},
    {"bindinput", 37},
    {"bindparam", 37},
    {"bindtoken", 37},
    {"diffuse_brdf", 37},
    {"diffuse_btdf", 37},
    {"burley_diffuse_brdf", 37},
    {"dielectric_brdf", 37},
    {"dielectric_btdf", 37},
    {"conductor_brdf", 37},
    {"generalized_schlick_brdf", 37},
    {"subsurface_brdf", 37},
    {"sheen_brdf", 37},
    {"thin_film_brdf", 37},
    {"complex_ior", 37},
    {"swizzle", 38},
    {"thin_film_bsdf", 38},
    {"thin_surface", 38},
};

constexpr Mark kAttributes[] = {
    {"shadername", 23}, {"graphname", 24},  {"opgraph", 26},  {"graphoutput", 26}, {"shaderprogram", 26},
    {"shadertype", 33}, {"publicname", 35}, {"attrname", 36}, {"channels", 38},
};

constexpr Mark kTypes[] = {{"vector", 22}, {"opgraphnode", 26}, {"matrix", 34}, {"color2", 37}};

// Inputs that only nodes of old versions have.
struct InputMark {
    std::string_view node, input;
    int last;
};
constexpr InputMark kInputs[] = {
    {"constant", "color", 25}, {"atan2", "in1", 38}, {"atan2", "in2", 38}, {"normalmap", "space", 38}};

int minorOf(const Document& d, Name version) {
    std::string_view v = d.text(version);
    if (!v.starts_with("1.")) return kNewestMinor;
    v.remove_prefix(2);
    return parseInt(v.substr(0, v.find('.'))).value_or(kNewestMinor);
}

// Looks through files without a version.
struct Detective {
    Upgrader& u;
    std::vector<std::pair<Name, int>> categories{}, attributes{}, types{};

    void learn(std::span<const Mark> marks, std::vector<std::pair<Name, int>>& into) {
        for (const Mark& m : marks)
            if (Name name = u.d.names().find(m.word)) into.push_back({name, m.last});
    }
    static void lower(int& minor, const std::vector<std::pair<Name, int>>& marks, Name name) {
        for (const auto& [word, last] : marks)
            if (word == name) minor = std::min(minor, last);
    }
    // True for a category that the document itself defines.
    bool isDefined(Name category) const {
        for (ElementId e : children(u.d, u.d.root()))
            if (u.d[e].category == u.k.nodedef && u.d.attribute(e, u.k.node) == category) return true;
        return false;
    }
    void look(ElementId e, int& minor) {
        const Document& d = u.d;
        const Element& element = d[e];
        int byCategory = minor;
        lower(byCategory, categories, element.category);
        if (byCategory < minor && !(isNode(d, e) && isDefined(element.category))) minor = byCategory;
        for (const Attribute& a : d.attributes(e)) {
            if (a.name == u.k.type) lower(minor, types, a.value);
            if (a.name == u.k.value && d.text(a.value).find("%U") != std::string_view::npos &&
                (d.text(a.value).find("%UDIM") != std::string_view::npos ||
                 d.text(a.value).find("%UVTILE") != std::string_view::npos))
                minor = std::min(minor, 35);
            lower(minor, attributes, a.name);
        }
        if (element.category == u.k.nodedef && d.attribute(e, u.k.type)) minor = std::min(minor, 36);
        bool isInput = element.category == u.k.input || element.category == u.k.parameter;
        if (!isInput || !element.parent) return;
        for (const InputMark& m : kInputs)
            if (d.text(element.name) == m.input && d.text(d[element.parent].category) == m.node)
                minor = std::min(minor, m.last);
    }
};

}  // namespace

void findVersions(Upgrader& u) {
    Document& d = u.d;
    bool allKnown = true;
    for (const Source& s : d.sources()) {
        u.minors.push_back(s.version ? minorOf(d, s.version) : kNewestMinor);
        allKnown &= static_cast<bool>(s.version);
    }
    Name version = d.attribute(d.root(), u.k.version);
    if (!allKnown) {
        Detective detective{u};
        detective.learn(kCategories, detective.categories);
        detective.learn(kAttributes, detective.attributes);
        detective.learn(kTypes, detective.types);
        for (std::uint32_t i = 0; i < d.size(); i++)
            if (std::uint32_t s = d[ElementId(i)].source; s < u.minors.size() && !d.sources()[s].version)
                detective.look(ElementId(i), u.minors[s]);
        for (std::uint32_t s = 0; s < u.minors.size(); s++) {
            const Source& source = d.sources()[s];
            if (source.version) continue;
            std::size_t root = source.text.find("<materialx");
            Diagnostic& w = u.diagnostics.warning(
                "assumed-version", fmt::format("the file has no version: it is read as one of 1.{}", u.minors[s]));
            w.where = d.locateOffset(s, root == std::string::npos ? 0 : root);
            w.hint = fmt::format("write version=\"1.{}\"", u.minors[s]);
        }
    }
    u.rootMinor = !u.minors.empty() ? u.minors[0] : version ? minorOf(d, version) : kNewestMinor;
    u.oldest = u.rootMinor;
    for (int minor : u.minors) u.oldest = std::min(u.oldest, minor);
}

}  // namespace shaderx::doc
