#include "doc/check_unused.h"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "doc/check.h"
#include "doc/connect.h"

namespace shaderx::doc {

namespace {

struct UnusedFinder {
    const Document& d;
    const Resolved& resolved;
    const std::vector<bool>& isNamed;  // by an interfacename
    Findings& findings;
    const WellKnown& k = d.known();
    std::vector<bool> isRead = isNamed;
    bool drawsOutputs = true;  // of the document itself; where it has materials, these are drawn

    bool isFree(ElementId graph) const { return !resolved.nodedefs[graph.index] && !d.attribute(graph, k.nodedef); }
    std::string_view name(ElementId e) const { return d.text(d[e].name); }

    void visit(ElementId e) {
        const ElementId parent = d[e].parent;
        const Name category = d[e].category;
        const bool inGraph = d[parent].category == k.nodegraph;
        if (category == k.input) {
            if (inGraph && isFree(parent))
                findings.warning(
                    "unused-input",
                    fmt::format("nothing reads the input '{}' of the nodegraph '{}'", name(e), name(parent)), e);
        } else if (category == k.output) {
            if (inGraph && isFree(parent) && !drawsOutputs)
                findings.warning(
                    "unused-output",
                    fmt::format("nothing reads the output '{}' of the nodegraph '{}'", name(e), name(parent)), e);
            if (parent == d.root() && !drawsOutputs)
                findings.warning(
                    "unused-output",
                    fmt::format("the output '{}' is not drawn, because the document has materials", name(e)), e);
        } else if (category != k.nodegraph && isNode(d, e)) {
            const std::string_view type = d.attributeText(e, k.type);
            if (type != "material" && type != "lightshader")
                findings.warning("unused-node", fmt::format("nothing reads the node '{}'", name(e)), e);
        }
    }

    void run() {
        for (ElementId target : resolved.targets)
            if (target) isRead[target.index] = true;
        for (const Finding& f : findings.all)  // what is wrong with it has been said, and may be why nothing reads it
            if (f.element && f.diagnostic.severity == Severity::Error) {
                isRead[f.element.index] = true;
                if (d[f.element].category == k.input) isRead[d[f.element].parent.index] = true;
            }
        const std::vector<ElementId> drawn = renderableElements(d);
        drawsOutputs = drawn.empty() || d[drawn[0]].category == k.output;
        for (std::uint32_t i = 1; i < d.size(); i++) {
            const ElementId e(i);
            if (d[e].parent && !isRead[i] && d[e].name) visit(e);
        }
    }
};

// Whether a word is of a kind: each word is looked at once, for documents use few and each often.
class WordKind {
  public:
    template <class Judge>
    bool is(Name word, Judge&& judge) {
        if (word == last_) return lastVerdict_;
        last_ = word;
        const auto [at, isNew] = known_.try_emplace(word);
        if (isNew) at->second = judge();
        return lastVerdict_ = at->second;
    }

  private:
    std::unordered_map<Name, bool> known_;
    Name last_;
    bool lastVerdict_ = false;
};

// Elements of which nothing is said but that they might be materials.
class MaterialFinder {
  public:
    explicit MaterialFinder(const Document& document) : d(document) {}

    // Whether an element is called a material, or nearly so, by category or type.
    bool mayBe(ElementId e) {
        const WellKnown& k = d.known();
        const Name category = d[e].category;
        if (categories.is(category, [&] { return d.text(category).ends_with("material"); })) return true;
        const Name type = d.attribute(e, k.type);
        return type && types.is(type, [&] { return !nearest(d.text(type), {"material"}).empty(); });
    }

  private:
    const Document& d;
    WordKind categories{}, types{};
};

// What looks like a material and is none, and why. Empty for everything else.
std::string whyNoMaterial(const Document& d, ElementId e) {
    const WellKnown& k = d.known();
    const Name type = d.attribute(e, k.type);
    const std::string_view category = d.text(d[e].category);
    if (type == k.material && isNode(d, e))
        return d[e].parent == d.root() ? std::string() : "a material within a nodegraph is not drawn by itself";
    if (d[e].category == k.material) return "a <material> of version 1.37 and before, which was not brought up to date";
    if (!isNode(d, e)) return {};
    const bool isCalled = category.ends_with("material");
    if (!type) return isCalled ? fmt::format("<{}> has no type; it needs type=\"material\"", category) : std::string();
    const bool isMisspelt = !nearest(d.text(type), {"material"}).empty();
    if (!isCalled && !isMisspelt) return {};
    return fmt::format("<{}> has the type '{}', not 'material'", category, d.text(type));
}

// The same of what else might have been meant to be seen.
std::string whyNotDrawn(const Document& d, ElementId e) {
    const WellKnown& k = d.known();
    const Name category = d[e].category;
    if (category == k.nodedef)
        return fmt::format("defines the node <{}>, which has to be used to be seen", d.attributeText(e, k.node));
    if (category == k.nodegraph)
        return isFunctional(d, e) ? "implements a node, which has to be used to be seen"
                                  : "a nodegraph without outputs";
    if (category == k.look || category == k.lookgroup) return "assigns materials, of which the document has none";
    if (!isNode(d, e)) return {};
    if (d.attribute(e, k.type) == k.surfaceshader) return "a surface shader, which a <surfacematerial> has to read";
    return "a node, which an output or a material has to read";
}

}  // namespace

void reportUnused(const Document& document, const Resolved& resolved, const std::vector<bool>& isRead,
                  Findings& findings) {
    UnusedFinder{document, resolved, isRead, findings}.run();
}

void reportUnrendered(const Document& d, bool isAll, Diagnostics& diagnostics) {
    constexpr std::size_t kMost = 8;
    const WellKnown& k = d.known();
    std::vector<std::pair<ElementId, std::string>> materials, others;
    MaterialFinder finder(d);
    for (std::uint32_t i = 1; i < d.size(); i++) {
        const ElementId e(i);
        const Name category = d[e].category;
        if (category == k.input || category == k.output || !category || !d[e].parent) continue;
        if (std::string why = finder.mayBe(e) ? whyNoMaterial(d, e) : std::string(); !why.empty())
            materials.emplace_back(e, std::move(why));
        else if (isAll && d[e].parent == d.root() && others.size() < kMost)
            if (std::string other = whyNotDrawn(d, e); !other.empty()) others.emplace_back(e, std::move(other));
    }
    auto told = [&](const std::pair<ElementId, std::string>& one) {
        return d[one.first].name ? fmt::format("'{}': {}", d.text(d[one.first].name), one.second) : one.second;
    };
    if (!isAll) {
        for (const auto& one : materials) {
            if (d.attribute(one.first, k.type) == k.material) continue;
            Diagnostic& w = diagnostics.warning("unrendered-material", told(one));
            w.where = d.locate(one.first);
            w.path = d.path(one.first);
        }
        return;
    }
    Diagnostic& e = diagnostics.error("nothing-to-render", "the document has no material and no output");
    e.where = d.locate(d.root());
    if (e.where.file.empty() && !d.sources().empty()) e.where.file = d.sources()[0].file;
    for (const auto* list : {&materials, &others})
        for (const auto& one : *list)
            if (e.notes.size() < kMost) e.notes.push_back({d.locate(one.first), told(one)});
}

}  // namespace shaderx::doc
