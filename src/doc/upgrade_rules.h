// What the parts of the upgrade share: the document with the versions of its files, and the edits that rules are made
// of. Only for the upgrade's own files.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "doc/connect.h"
#include "doc/upgrade.h"

namespace shaderx::doc {

constexpr int kNewestMinor = 39;

struct Upgrader {
    Document& d;
    Diagnostics& diagnostics;
    const UpgradeOptions& options;
    const WellKnown& k;
    std::vector<int> minors{};  // the minor version of each source
    int rootMinor = kNewestMinor, oldest = kNewestMinor;
    std::vector<std::pair<ElementId, ElementId>> backs{};  // surfaces whose back is another surface
    std::unordered_map<std::uint64_t, int> numbers{};      // by scope and name: the next that freeName tries
    std::size_t copiesLeft = 0;                            // how many elements may still be copied: see copyTree

    std::string_view text(Name n) const { return d.text(n); }
    std::string_view category(ElementId e) const { return text(d[e].category); }
    std::string_view type(ElementId e) const { return d.attributeText(e, k.type); }
    std::string_view value(ElementId e) const { return d.attributeText(e, k.value); }
    std::string_view attribute(ElementId e, std::string_view name) const {
        Name known = d.names().find(name);
        return known ? d.attributeText(e, known) : std::string_view();
    }
    ElementId input(ElementId node, std::string_view name) const { return d.child(node, name); }
    bool isConnected(ElementId port) const { return connection(d, port).kind != Connection::Kind::None; }
    int minorAt(ElementId e) const { return d[e].source < minors.size() ? minors[d[e].source] : rootMinor; }

    // Applies a change to every element of a version before 1.`before`. Those that it adds are new already.
    template <class Change>
    void each(int before, Change change) {
        if (oldest >= before) return;
        std::uint32_t count = static_cast<std::uint32_t>(d.size());
        for (std::uint32_t i = 0; i < count; i++)
            if (ElementId e(i); d[e].category && minorAt(e) < before) change(e);
    }

    void warn(ElementId e, std::string message, Name attribute = {});
    // Takes up an edit of an element, if anybody wants to know.
    template <class Was, class Now>
    void edited(ElementId e, Was&& was, Now&& now) {
        if (options.edits)
            options.edits->push_back(
                {d.locate(e), d.path(e), std::string(std::forward<Was>(was)), std::string(std::forward<Now>(now))});
    }
    // "<mix name="a">" of an element.
    std::string tag(ElementId e) const;

    // A name that nothing in the scope has yet.
    std::string freeName(ElementId scope, std::string_view name);
    // A new node after `beside`, named after it, in the same namespace.
    ElementId addNode(ElementId beside, std::string_view category, std::string_view suffix, std::string_view type);
    ElementId addInput(ElementId node, std::string_view name, std::string_view type);
    void addValue(ElementId node, std::string_view name, std::string_view type, std::string_view value);
    void connect(ElementId node, std::string_view name, std::string_view type, ElementId from,
                 std::string_view output = {});
    // Lets a port read a node of its scope and nothing else.
    void redirect(ElementId port, ElementId node, std::string_view output = {});
    // Gives a port what another one beside it reads.
    void copyConnection(ElementId from, ElementId to);
    // What feeds one input, on another one: all attributes but the name. Returns the new one.
    ElementId copyInput(ElementId from, ElementId node, std::string_view name);
    // An element with all below it, below `parent` (last) or after `sibling`; none if too much was copied already.
    ElementId copyTree(ElementId from, ElementId parent, ElementId sibling, std::string_view name);
    // Changes an element's category; a node's definition is asked for anew.
    void become(ElementId e, std::string_view category);
    void renameInput(ElementId node, std::string_view from, std::string_view to);
    void renameAttribute(ElementId e, std::string_view from, std::string_view to);
    // Changes the type of an input: that of a value is what it is called; what is connected goes through a convert.
    void retype(ElementId node, std::string_view name, std::string_view from, std::string_view to);
    // The ports that read each node, output or graph input, as they are connected now.
    using Readers = std::unordered_map<ElementId, std::vector<ElementId>>;
    Readers readers() const;
    // Scopes' attributes that an element loses when it is taken out of where it stands.
    void keepScope(ElementId from, ElementId to);
};

// A change of nodes of one category in files before version 1.`before`.
struct NodeRule {
    std::string_view category;
    int before;
    void (*apply)(Upgrader& u, ElementId node);
};
std::span<const NodeRule> oldNodeRules();     // upgrade_nodes.cpp
std::span<const NodeRule> oldClosureRules();  // upgrade_closures.cpp

// Hands the backs of thin surfaces to their materials: upgrade_nodes.cpp.
void upgradeBacks(Upgrader& u);

// The versions of the files: see upgrade_version.cpp.
void findVersions(Upgrader& u);
// Elements and attributes of 1.22 to 1.36, and types: upgrade_words.cpp.
void upgradeWords(Upgrader& u);
void upgradeTypes(Upgrader& u);
// What reads the outputs of artistic_ior, which were vectors: upgrade_closures.cpp.
void upgradeIndices(Upgrader& u);
// <shader> and <material> of 1.22 to 1.37: upgrade_materials.cpp.
void upgradeMaterials(Upgrader& u);
// `channels` attributes, which become swizzle nodes, and these: upgrade_channels.cpp.
void upgradeChannels(Upgrader& u);
void upgradeSwizzle(Upgrader& u, ElementId node);
// thin_film_bsdf, which becomes inputs of the closures below it: upgrade_films.cpp.
void upgradeFilms(Upgrader& u);

}  // namespace shaderx::doc
