// Materials until 1.37: <material> with its <shaderref>s, their bindings and inheritance, and the <shader>s and
// <override>s of 1.22 to 1.35.
#include <algorithm>
#include <optional>
#include <unordered_set>

#include "doc/upgrade_rules.h"
#include "doc/write.h"

namespace shaderx::doc {

namespace {

// A shader of a material: what declares it, in the material itself or in one that it inherits from, with the bindings
// of all of these; the nearer ones replace others of their name.
struct Use {
    ElementId reference;
    std::vector<ElementId> bindings{};
    std::unordered_map<Name, std::size_t> places{};  // of the bindings, by name
};

// What a shaderref means: a node of the material's that is to be made, or a <shader> that stands in the document.
struct Meaning {
    std::string category, type;
    ElementId definition;  // the nodedef of the document, or the <shader>
    ElementId shader;      // the <shader>, which is a node by now
};

constexpr std::size_t kMostAncestors = 100;

struct Materials {
    Upgrader& u;
    Document& d;
    const WellKnown& k;
    std::vector<ElementId> materials{}, spent{};
    std::vector<bool> isOld{};                             // by element: one of `materials`
    std::unordered_map<Name, ElementId> nodedefs{};        // of the document, by node
    std::unordered_map<ElementId, std::string> shaders{};  // <shader>s that are nodes now, with their types
    std::vector<ElementId> overrides{};                    // of the material in work
    std::vector<bool> isUsed{};                            // of these

    void run();
    void shaderToNode(ElementId e);
    std::vector<ElementId> chain(ElementId material);
    std::vector<Use> uses(const std::vector<ElementId>& chain);
    std::optional<Meaning> meaning(ElementId reference);
    std::string typeOfNodedef(ElementId nodedef) const;
    void convert(ElementId material);
    ElementId makeShader(ElementId material, ElementId after, const Use& use, const Meaning& m);
    void bind(ElementId shader, ElementId binding, const Meaning& m);
    void overrideShader(ElementId material, ElementId& shader, const Use& use, const Meaning& m);
    void overrideGraphs(ElementId material, ElementId shader);
    bool overrideBelow(ElementId graph, bool change);
    void spendOverrides(ElementId material);
    void place(ElementId material, ElementId shader, std::string_view type);
};

std::string typeOfKind(std::string_view kind) {
    return fmt::format("{}shader", kind.empty() ? std::string_view("surface") : kind);
}

std::string Materials::typeOfNodedef(ElementId nodedef) const {
    if (std::string_view t = u.type(nodedef); !t.empty()) return std::string(t);
    for (ElementId c : children(d, nodedef))
        if (d[c].category == k.output) return std::string(u.type(c));
    return {};
}

// <shader name="s" shadertype="surface" shaderprogram="p">: a node of the category p. Its name stays.
void Materials::shaderToNode(ElementId e) {
    std::string program;
    for (const char* attribute : {"node", "shaderprogram", "shadername"})
        if (program.empty()) program = u.attribute(e, attribute);
    if (program.empty()) return u.warn(e, "the shader does not say which program it runs");
    if (!isXmlName(program)) return u.warn(e, fmt::format("no node can be called '{}'", program));
    std::string was = u.tag(e), type = typeOfKind(u.attribute(e, "shadertype"));
    d.setCategory(e, program);
    d.set(e, "type", type);
    for (const char* attribute : {"node", "shaderprogram", "shadername", "shadertype"})
        d.unset(e, d.names().intern(attribute));
    for (ElementId c : children(d, e))
        if (d[c].category == k.parameter) d.setCategory(c, "input");
    u.edited(e, std::move(was), u.tag(e));
    shaders[e] = std::move(type);
}

// The material and those that it inherits from, nearest first.
std::vector<ElementId> Materials::chain(ElementId material) {
    std::vector<ElementId> all;
    std::unordered_set<ElementId> met;
    for (ElementId at = material; at;) {
        if (!met.insert(at).second) {
            u.warn(material, "the material inherits itself", k.inherit);
            break;
        }
        if (all.size() == kMostAncestors) {
            u.warn(material, fmt::format("the material inherits from more than {} others", kMostAncestors), k.inherit);
            break;
        }
        all.push_back(at);
        Name from = d.attribute(at, k.inherit);
        if (u.text(from).empty()) break;
        ElementId next = d.childFrom(at, d.root(), from);
        if (!next || next.index >= isOld.size() || !isOld[next.index]) {
            u.warn(at, fmt::format("there is no material '{}' of before 1.38 to inherit from", u.text(from)),
                   k.inherit);
            break;
        }
        at = next;
    }
    return all;
}

std::vector<Use> Materials::uses(const std::vector<ElementId>& chain) {
    std::vector<Use> all;
    for (auto material = chain.rbegin(); material != chain.rend(); ++material) {
        std::size_t inherited = all.size();
        for (ElementId r : children(d, *material)) {
            if (u.category(r) != "shaderref") continue;
            auto same = [&](const Use& other) {
                for (Name attr : {k.nodedef, k.node})
                    if (Name given = d.attribute(r, attr)) return d.attribute(other.reference, attr) == given;
                return d[other.reference].name == d[r].name;
            };
            // Within one material each stands for itself.
            auto own = all.begin() + static_cast<std::ptrdiff_t>(inherited);
            auto use = std::find_if(all.begin(), own, same);
            if (use == own) use = all.insert(all.end(), Use{r});
            use->reference = r;
            for (ElementId b : children(d, r)) {
                if (!d[b].name) continue;
                auto [place, isNew] = use->places.try_emplace(d[b].name, use->bindings.size());
                if (isNew)
                    use->bindings.push_back(b);
                else
                    use->bindings[place->second] = b;
            }
        }
    }
    return all;
}

std::optional<Meaning> Materials::meaning(ElementId reference) {
    Meaning m;
    Name nodedef = d.attribute(reference, k.nodedef), node = d.attribute(reference, k.node);
    if (nodedef) {
        m.definition = d.childFrom(reference, d.root(), nodedef);
        if (m.definition && d[m.definition].category != k.nodedef) m.definition = {};
        if (!node && m.definition) node = d.attribute(m.definition, k.node);
        if (!m.definition && u.options.libraries)
            if (NodeDef def = u.options.libraries->byName(nodedef)) {
                if (!node) node = u.options.libraries->row(def).category;
                m.type = u.text(u.options.libraries->row(def).output);
            }
    }
    if (!nodedef && !node) {
        m.shader = d.childFrom(reference, d.root(), d[reference].name);
        auto found = m.shader ? shaders.find(m.shader) : shaders.end();
        if (found == shaders.end()) return {};
        m.category = u.category(m.shader);
        m.type = found->second;
        m.definition = m.shader;
        return m;
    }
    if (!node) return {};
    if (!isXmlName(u.text(node))) {
        u.warn(reference, fmt::format("no node can be called '{}'", u.text(node)), k.node);
        return {};
    }
    m.category = u.text(node);
    if (!m.definition && !nodedef)
        if (auto found = nodedefs.find(node); found != nodedefs.end()) m.definition = found->second;
    if (m.definition) m.type = typeOfNodedef(m.definition);
    if (m.type.empty() && u.options.libraries)
        for (NodeDef def : u.options.libraries->ofCategory(node)) {
            m.type = u.text(u.options.libraries->row(def).output);
            if (m.type == "surfaceshader") break;
        }
    if (m.type.empty()) m.type = typeOfKind(u.attribute(reference, "shadertype"));
    return m;
}

// A binding as an input or token of the shader's node.
void Materials::bind(ElementId shader, ElementId binding, const Meaning& m) {
    std::string_view c = u.category(binding);
    if (c != "bindinput" && c != "bindparam" && c != "bindtoken" && c != "input" && c != "parameter" && c != "token")
        return;
    if (ElementId old = d.child(shader, d[binding].name)) d.remove(old);
    ElementId copy = u.copyTree(binding, shader, {}, u.text(d[binding].name));
    if (!copy) return;
    d.setCategory(copy, c == "bindtoken" || c == "token" ? "token" : "input");
    if (!d.attribute(copy, k.type) && m.definition)
        if (ElementId port = d.child(m.definition, d[binding].name)) d.set(copy, "type", std::string(u.type(port)));
    std::string_view t = u.type(copy);
    Name attr = t == "filename" ? k.fileprefix : k.colorspace;
    if (t != "filename" && !t.starts_with("color")) return;
    Name there = d.inherited(binding, attr);
    if (there && there != d.inherited(copy, attr)) d.set(copy, attr, there);
}

ElementId Materials::makeShader(ElementId material, ElementId after, const Use& use, const Meaning& m) {
    Name name = d[use.reference].name;
    std::string own(u.text(name));
    if (own.empty()) own = fmt::format("{}_shader", u.text(d[material].name));
    own = u.text(d.qualified(d.namespaceOf(material), d.names().intern(own)));
    if (d.child(d.root(), own))
        own = u.freeName(d.root(), fmt::format("{}_{}", u.text(d[material].name), u.text(name)));
    ElementId shader;
    if (m.shader) {
        shader = u.copyTree(m.shader, {}, after, own);
        if (!shader) return {};
    } else {
        shader = d.insertAfter(after, m.category, own);
        std::vector<Attribute> all(d.attributes(use.reference).begin(), d.attributes(use.reference).end());
        for (const Attribute& a : all)
            if (a.name != k.name && a.name != k.node && a.name != d.names().find("shadertype"))
                d.set(shader, a.name, a.value);
        d.set(shader, "type", m.type);
        u.keepScope(material, shader);
    }
    d.setOrigin(shader, d[use.reference].parent == material ? use.reference : material);
    for (ElementId binding : use.bindings) bind(shader, binding, m);
    u.edited(shader, u.tag(use.reference), u.tag(shader));
    return shader;
}

// Values of the public names of a shader's inputs.
void Materials::overrideShader(ElementId material, ElementId& shader, const Use& use, const Meaning& m) {
    if (!m.definition) return;
    Name publicName = d.names().intern("publicname");
    std::vector<std::pair<ElementId, ElementId>> found;  // the input of the definition, and the override
    for (ElementId port : children(d, m.definition)) {
        Name name = d.attribute(port, publicName);
        if (!name && m.shader) name = d[port].name;
        for (std::size_t i = 0; name && i < overrides.size(); i++)
            if (d[overrides[i]].name == name) {
                isUsed[i] = true;
                found.push_back({port, overrides[i]});
            }
    }
    if (found.empty()) return;
    if (shader == m.shader)
        shader = makeShader(material, material, use, m);  // others go on to use the <shader> as it is
    if (!shader) return;
    for (auto [port, by] : found) {
        if (use.places.contains(d[port].name)) continue;  // bound
        ElementId in = d.child(shader, d[port].name);
        if (!in) in = u.addInput(shader, u.text(d[port].name), std::string(u.type(port)));
        for (Name attr : {k.nodename, k.nodegraph, k.output, k.interfacename}) d.unset(in, attr);
        d.set(in, k.value, d.attribute(by, k.value));
        u.edited(by, u.tag(by), fmt::format("the value of '{}'", d.path(in)));
    }
}

// Looks for public names of overrides below a graph; changes the values if it is to.
bool Materials::overrideBelow(ElementId graph, bool change) {
    Name publicName = d.names().intern("publicname");
    bool found = false;
    for (ElementId node : children(d, graph))
        for (ElementId port : children(d, node)) {
            Name name = d.attribute(port, publicName);
            for (std::size_t i = 0; name && i < overrides.size(); i++) {
                if (d[overrides[i]].name != name) continue;
                found = isUsed[i] = true;
                if (!change) continue;
                for (Name attr : {k.nodename, k.nodegraph, k.output, k.interfacename}) d.unset(port, attr);
                d.set(port, k.value, d.attribute(overrides[i], k.value));
                u.edited(overrides[i], u.tag(overrides[i]), fmt::format("the value of '{}'", d.path(port)));
            }
        }
    return found;
}

// Graphs that a material's overrides change are the material's own.
void Materials::overrideGraphs(ElementId material, ElementId shader) {
    std::unordered_map<ElementId, Name> copies;
    for (ElementId in : children(d, shader)) {
        Name name = d.attribute(in, k.nodegraph);
        ElementId graph = name ? d.childFrom(in, d.root(), name) : ElementId();
        if (!graph || d[graph].category != k.nodegraph) continue;
        auto [copy, isNew] = copies.try_emplace(graph);
        if (isNew && overrideBelow(graph, false)) {
            std::string own = u.freeName(d.root(), fmt::format("{}_{}", u.text(name), u.text(d[material].name)));
            ElementId made = u.copyTree(graph, {}, graph, own);
            if (!made) return;
            overrideBelow(made, true);
            copy->second = d[made].name;
        }
        if (copy->second) d.set(in, k.nodegraph, copy->second);
    }
}

// Lets the material read a shader.
void Materials::place(ElementId material, ElementId shader, std::string_view type) {
    bool isHeld = u.category(material) == "volumematerial" ? type == "volumeshader"
                                                           : type == "surfaceshader" || type == "displacementshader";
    if (!isHeld) return u.warn(shader, fmt::format("a <{}> holds no {}", u.category(material), type));
    if (u.input(material, type))
        return u.warn(shader, fmt::format("the material has another {} already, which is taken", type));
    u.connect(material, type, type, shader);
}

void Materials::convert(ElementId material) {
    std::vector<ElementId> all = chain(material);
    overrides.clear();
    for (ElementId m : all)
        for (ElementId c : children(d, m)) {
            auto named = [&](ElementId other) { return d[other].name == d[c].name; };
            if (u.category(c) == "override" && std::none_of(overrides.begin(), overrides.end(), named))
                overrides.push_back(c);
        }
    isUsed.assign(overrides.size(), false);
    std::vector<Use> shaderUses = uses(all);
    if (all.size() > 1) u.edited(material, u.tag(material) + " that inherits", "all that it inherited");
    std::vector<std::pair<ElementId, std::string>> made;  // shaders with their types
    ElementId last = material;
    for (const Use& use : shaderUses) {
        std::optional<Meaning> m = meaning(use.reference);
        if (!m) {
            u.warn(use.reference,
                   fmt::format("nothing says which node the shader '{}' is", u.text(d[use.reference].name)));
            continue;
        }
        ElementId shader = m->shader;
        if (!shader || !use.bindings.empty()) shader = makeShader(material, last, use, *m);
        if (!overrides.empty() && shader) overrideShader(material, shader, use, *m);
        if (!shader) {
            u.warn(material, "the materials that inherit from each other make too many elements");
            continue;
        }
        if (!overrides.empty()) overrideGraphs(material, shader);
        if (shader != m->shader) last = shader;
        made.push_back({shader, m->type});
        if (d[use.reference].parent == material) spent.push_back(use.reference);
    }
    spendOverrides(material);
    bool isVolume = !made.empty() && std::all_of(made.begin(), made.end(),
                                                 [](const auto& each) { return each.second == "volumeshader"; });
    u.become(material, isVolume ? "volumematerial" : "surfacematerial");
    d.set(material, "type", "material");
    for (const auto& [shader, type] : made) place(material, shader, type);
}

void Materials::spendOverrides(ElementId material) {
    for (std::size_t i = 0; i < overrides.size(); i++) {
        if (d[overrides[i]].parent != material) continue;
        if (isUsed[i])
            spent.push_back(overrides[i]);
        else
            u.warn(overrides[i], fmt::format("nothing that the material uses has the public name '{}'",
                                             u.text(d[overrides[i]].name)));
    }
}

void Materials::run() {
    isOld.resize(d.size());
    for (ElementId e : children(d, d.root())) {
        if (u.minorAt(e) >= 38) continue;
        if (d[e].category == k.material) {
            materials.push_back(e);
            isOld[e.index] = true;
        }
    }
    std::vector<ElementId> old;
    for (ElementId e : children(d, d.root())) {
        if (u.minorAt(e) < 34 && u.category(e) == "shader") old.push_back(e);
        if (d[e].category == k.nodedef) nodedefs.try_emplace(d.attribute(e, k.node), e);
    }
    for (ElementId e : old) shaderToNode(e);
    for (ElementId e : materials) convert(e);
    for (ElementId e : materials) d.unset(e, k.inherit);
    for (ElementId e : spent) d.remove(e);
}

}  // namespace

void upgradeMaterials(Upgrader& u) {
    if (u.oldest >= 38) return;
    Materials materials{u, u.d, u.k};
    materials.run();
}

}  // namespace shaderx::doc
