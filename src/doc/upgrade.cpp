#include "doc/upgrade.h"

#include <algorithm>

#include "doc/upgrade_rules.h"

namespace shaderx::doc {

void Upgrader::warn(ElementId e, std::string message, Name attribute) {
    Diagnostic& out = diagnostics.warning("cannot-upgrade", std::move(message));
    out.where = d.locate(e, attribute);
    out.path = d.path(e);
}

std::string Upgrader::tag(ElementId e) const {
    if (!d[e].name) return fmt::format("<{}>", category(e));
    return fmt::format("<{} name=\"{}\">", category(e), text(d[e].name));
}

std::string Upgrader::freeName(ElementId scope, std::string_view name) {
    std::string out(name);
    if (!d.child(scope, out)) return out;
    int& number = numbers.try_emplace(std::uint64_t{scope.index} << 32 | d.names().intern(name).index, 2).first->second;
    do out = fmt::format("{}{}", name, number++);
    while (d.child(scope, out));
    return out;
}

ElementId Upgrader::addNode(ElementId beside, std::string_view nodeCategory, std::string_view suffix,
                            std::string_view nodeType) {
    std::string name = freeName(d[beside].parent, fmt::format("{}_{}", text(d[beside].name), suffix));
    ElementId node = d.insertAfter(beside, nodeCategory, name);
    d.set(node, "type", nodeType);
    d.setOrigin(node, beside);
    keepScope(beside, node);
    edited(node, "", tag(node));
    return node;
}

ElementId Upgrader::addInput(ElementId node, std::string_view name, std::string_view inputType) {
    ElementId in = d.append(node, "input", name);
    d.set(in, "type", inputType);
    d.setOrigin(in, node);
    return in;
}

void Upgrader::addValue(ElementId node, std::string_view name, std::string_view inputType, std::string_view text) {
    d.set(addInput(node, name, inputType), "value", text);
}

void Upgrader::connect(ElementId node, std::string_view name, std::string_view inputType, ElementId from,
                       std::string_view output) {
    redirect(addInput(node, name, inputType), from, output);
}

void Upgrader::redirect(ElementId port, ElementId node, std::string_view output) {
    for (Name attr : {k.nodegraph, k.output, k.interfacename, k.value}) d.unset(port, attr);
    d.set(port, k.nodename, d[node].name);
    if (!output.empty()) d.set(port, "output", output);
}

void Upgrader::copyConnection(ElementId from, ElementId to) {
    for (Name attr : {k.nodename, k.nodegraph, k.output, k.interfacename}) {
        Name given = d.attribute(from, attr);
        if (given)
            d.set(to, attr, given);
        else
            d.unset(to, attr);
    }
}

ElementId Upgrader::copyInput(ElementId from, ElementId node, std::string_view name) {
    ElementId to = d.append(node, "input", name);
    d.setOrigin(to, d[from].source == d[node].source ? from : node);
    std::vector<Attribute> all(d.attributes(from).begin(), d.attributes(from).end());
    for (const Attribute& a : all)
        if (a.name != k.name && a.name != k.nodedef) d.set(to, a.name, a.value);
    return to;
}

ElementId Upgrader::copyTree(ElementId from, ElementId parent, ElementId sibling, std::string_view name) {
    ElementId top;
    std::vector<std::pair<ElementId, ElementId>> left{{from, parent}};  // what to copy, and below what
    while (!left.empty()) {
        auto [at, below] = left.back();
        left.pop_back();
        if (!copiesLeft) return {};
        copiesLeft--;
        std::string categoryText(category(at));
        ElementId copy = top || !sibling ? d.append(below, categoryText) : d.insertAfter(sibling, categoryText);
        std::vector<Attribute> all(d.attributes(at).begin(), d.attributes(at).end());
        for (const Attribute& a : all) d.set(copy, a.name, a.value);
        ElementId place = top || !sibling ? below : sibling;  // a part of another file is no part of this one
        d.setOrigin(copy, d[at].source == d[place].source ? at : place);
        if (!top) {
            top = copy;
            d.rename(copy, name);
        }
        std::size_t first = left.size();
        for (ElementId c : children(d, at)) left.push_back({c, copy});
        std::reverse(left.begin() + static_cast<std::ptrdiff_t>(first), left.end());
    }
    return top;
}

void Upgrader::become(ElementId e, std::string_view newCategory) {
    std::string was = options.edits ? tag(e) : std::string();
    d.setCategory(e, newCategory);
    d.unset(e, k.nodedef);
    if (options.edits) edited(e, std::move(was), tag(e));
}

void Upgrader::renameInput(ElementId node, std::string_view from, std::string_view to) {
    ElementId in = input(node, from);
    if (!in) return;
    d.rename(in, to);
    edited(in, fmt::format("input '{}'", from), fmt::format("input '{}'", to));
}

void Upgrader::renameAttribute(ElementId e, std::string_view from, std::string_view to) {
    Name old = d.names().find(from), given = old ? d.attribute(e, old) : Name();
    if (!given) return;
    edited(e, fmt::format("attribute '{}'", from), fmt::format("attribute '{}'", to));
    d.unset(e, old);
    d.set(e, d.names().intern(to), given);
}

void Upgrader::retype(ElementId node, std::string_view name, std::string_view from, std::string_view to) {
    ElementId in = input(node, name);
    if (!in || type(in) != from) return;
    if (isConnected(in)) {
        ElementId between = addNode(node, "convert", fmt::format("{}_{}", name, to), to);
        copyInput(in, between, "in");
        redirect(in, between);
    }
    d.set(in, "type", to);
    edited(in, fmt::format("type '{}'", from), fmt::format("type '{}'", to));
}

Upgrader::Readers Upgrader::readers() const {
    Readers all;
    for (std::uint32_t i = 0; i < d.size(); i++) {
        ElementId port(i);
        if (d[port].category != k.input && d[port].category != k.output) continue;
        if (ElementId target = connection(d, port).target) all[target].push_back(port);
    }
    return all;
}

void Upgrader::keepScope(ElementId from, ElementId to) {
    for (Name attr : {k.namespaceName, k.colorspace, k.fileprefix}) {
        Name given = d.attribute(from, attr);
        if (given && !d.attribute(to, attr)) d.set(to, attr, given);
    }
}

namespace {

struct ActiveRule {
    Name category;
    const NodeRule* rule;
};

void upgradeNodes(Upgrader& u) {
    std::vector<ActiveRule> active;  // those whose category occurs at all
    for (std::span<const NodeRule> rules : {oldNodeRules(), oldClosureRules()})
        for (const NodeRule& rule : rules)
            if (Name name = u.d.names().find(rule.category); name && u.oldest < rule.before)
                active.push_back({name, &rule});
    u.each(kNewestMinor, [&](ElementId e) {
        for (const ActiveRule& a : active)
            if (u.d[e].category == a.category && u.minorAt(e) < a.rule->before && isNode(u.d, e)) {
                a.rule->apply(u, e);
                return;
            }
    });
}

void setVersion(Upgrader& u) {
    Document& d = u.d;
    Name now = d.names().intern("1.39"), was = d.attribute(d.root(), u.k.version);
    for (std::uint32_t s = 0; s < u.minors.size(); s++)
        if (u.minors[s] < kNewestMinor) d.setSourceVersion(s, now);
    bool none = u.text(was).empty();
    if (u.rootMinor >= kNewestMinor && !(none && !d.sources().empty())) return;
    d.set(d.root(), u.k.version, now);
    u.edited(d.root(), none ? "no version" : fmt::format("version '{}'", u.text(was)), "version '1.39'");
}

}  // namespace

void upgrade(Document& document, Diagnostics& diagnostics, const UpgradeOptions& options) {
    Upgrader u{document, diagnostics, options, document.known()};
    findVersions(u);
    u.copiesLeft = (std::size_t{1} << 20) + 4 * document.size();
    if (u.oldest < kNewestMinor) {
        upgradeWords(u);
        upgradeMaterials(u);
        upgradeTypes(u);
        upgradeChannels(u);
        upgradeIndices(u);
        upgradeNodes(u);
        upgradeBacks(u);
        upgradeFilms(u);
    }
    setVersion(u);
}

}  // namespace shaderx::doc
