// Parts of colors and vectors: `channels` attributes and swizzle nodes, which 1.39 says by separate, combine, extract.
#include <optional>

#include "doc/upgrade_rules.h"
#include "doc/values.h"

namespace shaderx::doc {

namespace {

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

void combineParts(Upgrader& u, ElementId e, ElementId in, std::string_view letters) {
    Document& d = u.d;
    std::string from(u.type(in));
    std::uint32_t have = componentCount(from);
    bool color = from.starts_with("color");
    ElementId split;
    u.become(e, fmt::format("combine{}", letters.size()));
    for (std::size_t i = 0; i < letters.size(); i++) {
        std::string name = fmt::format("in{}", i + 1);
        std::optional<std::uint32_t> c = componentOf(letters[i]);
        if (!c) {
            u.addValue(e, name, "float", letters.substr(i, 1));
        } else if (have == 1) {
            u.copyInput(in, e, name);
        } else {
            if (!split) {
                split = u.addNode(e, fmt::format("separate{}", have), "separate", "multioutput");
                u.copyInput(in, split, "in");
            }
            u.connect(e, name, "float", split, fmt::format("out{}", (color ? "rgba" : "xyzw")[*c]));
        }
    }
    d.remove(in);
}

// A swizzle of nothing: 0 wherever it does not say 1.
void constantParts(Upgrader& u, ElementId e, ElementId channelsInput, std::string_view letters) {
    std::string to(u.type(e)), all;
    for (std::uint32_t i = 0; i < componentCount(to); i++)
        all.append(i ? ", " : "").append(i < letters.size() && letters[i] == '1' ? "1" : "0");
    u.become(e, "constant");
    if (channelsInput) u.d.remove(channelsInput);
    u.addValue(e, "value", to, all);
}

// A port with the attribute `channels` reads a swizzle in between.
void channels(Upgrader& u, ElementId port) {
    Document& d = u.d;
    Name letters = d.attribute(port, u.k.channels);
    if (u.text(letters).empty()) return d.unset(port, u.k.channels);
    Connection c = connection(d, port);
    std::string from;
    if (c.target) from = u.type(c.target);
    if (from == "multioutput") from = u.category(c.target).starts_with("separate") ? "float" : "";
    if (!componentCount(from))
        return u.warn(
            port,
            fmt::format("the channels '{}' cannot be upgraded: what they are taken from is not known", u.text(letters)),
            u.k.channels);
    bool isOutput = d[port].category == u.k.output;
    ElementId beside = isOutput ? port : d[port].parent;
    u.edited(port, fmt::format("channels '{}'", u.text(letters)), "a node that takes these");
    std::string suffix = isOutput ? "channels" : fmt::format("{}_channels", u.text(d[port].name));
    ElementId node = u.addNode(beside, "swizzle", suffix, std::string(u.type(port)));
    if (d[port].source < u.minors.size() && d.namespaceOf(port)) d.set(node, u.k.namespaceName, d.namespaceOf(port));
    ElementId in = u.addInput(node, "in", from);
    u.copyConnection(port, in);
    u.addValue(node, "channels", "string", u.text(letters));
    d.unset(port, u.k.channels);
    u.redirect(port, node);
    upgradeSwizzle(u, node);
}

}  // namespace

// A swizzle node becomes dot, convert, extract, constant, or a combine of what a separate gives. Its name stays, so
// that whatever reads it goes on to.
void upgradeSwizzle(Upgrader& u, ElementId e) {
    Document& d = u.d;
    ElementId in = u.input(e, "in"), channelsInput = u.input(e, "channels");
    std::string letters(channelsInput ? u.value(channelsInput) : std::string_view());
    if (!in) return constantParts(u, e, channelsInput, letters);
    std::string from(u.type(in)), to(u.type(e));
    std::uint32_t have = componentCount(from), want = componentCount(to);
    bool valid = have && want && letters.size() == want, identity = true;
    for (std::uint32_t i = 0; i < letters.size(); i++) {
        std::optional<std::uint32_t> c = componentOf(letters[i]);
        identity &= c == i;
        valid &= c ? *c < have : letters[i] == '0' || letters[i] == '1';
    }
    if (!valid)
        return u.warn(e, fmt::format("the swizzle of the channels '{}' from {} to {} has no counterpart in 1.39",
                                     letters, from, to));
    d.remove(channelsInput);
    if (identity && (from == to || want > 1)) return u.become(e, from == to ? "dot" : "convert");
    if (want > 1) return combineParts(u, e, in, letters);
    if (std::optional<std::uint32_t> c = componentOf(letters[0])) {
        u.become(e, "extract");
        u.addValue(e, "index", "integer", fmt::format("{}", *c));
    } else {
        u.become(e, "constant");
        d.remove(in);
        u.addValue(e, "value", "float", letters);
    }
}

void upgradeChannels(Upgrader& u) {
    if (!u.d.names().find("channels")) return;
    u.each(kNewestMinor, [&](ElementId e) {
        if (u.d.attribute(e, u.k.channels) && (u.d[e].category == u.k.input || u.d[e].category == u.k.output))
            channels(u, e);
    });
}

}  // namespace shaderx::doc
