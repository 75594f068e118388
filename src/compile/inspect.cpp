#include "compile/inspect.h"

#include <fmt/format.h>

#include "compile/json.h"

namespace shaderx {

using passes::Decision;
using passes::Lobe;
using passes::NodeCost;
using passes::Removal;
using passes::Work;

static std::string_view nameOf(Removal::Kind kind) {
    switch (kind) {
        case Removal::Kind::Weight:
            return "weight";
        case Removal::Kind::Mix:
            return "mix";
        case Removal::Kind::Condition:
            return "condition";
        case Removal::Kind::Volume:
            return "volume";
    }
    return {};
}

static std::string textOf(const Removal& r) {
    if (r.kind == Removal::Kind::Volume) return "a volume is not drawn on rasters";
    std::string text = fmt::format("{} {} = {}", nameOf(r.kind), r.expression, r.value);
    std::string_view separator = ", because ";
    for (const Decision& d : r.inputs) {
        if (d.path == r.expression) continue;
        text += fmt::format("{}{} = {}", separator, d.path, d.value);
        separator = ", ";
    }
    return text;
}

// "SR_gold/coat_bsdf", or the node alone where the lobe is the node.
static std::string whole(const Lobe& lobe) {
    bool same = lobe.node == lobe.name || lobe.node.ends_with("/" + lobe.name);
    return same ? lobe.node : lobe.node + "/" + lobe.name;
}

static void addLobes(std::string& text, const std::vector<Lobe>& lobes) {
    text += "  lobes that remain\n";
    for (const Lobe& lobe : lobes) {
        if (!lobe.remains) continue;
        text += fmt::format("    {} ({}): {}", whole(lobe), lobe.leaf, lobe.weight);
        text += lobe.value.empty() || lobe.value == lobe.weight ? "\n" : fmt::format(" = {}\n", lobe.value);
    }
    text += "  lobes that were removed\n";
    for (const Lobe& lobe : lobes) {
        if (lobe.remains) continue;
        text += fmt::format("    {} ({}): ", whole(lobe), lobe.leaf);
        std::string_view separator;
        for (const Removal& r : lobe.removals) {
            text.append(separator).append(textOf(r));
            separator = "; ";
        }
        text += '\n';
    }
}

static NodeCost sumOf(const std::vector<NodeCost>& costs) {
    NodeCost sum;
    for (const NodeCost& c : costs) {
        sum.fixed += c.fixed;
        sum.perSample += c.perSample;
    }
    return sum;
}

// A count, and what each sample of the environment adds.
static std::string count(std::uint32_t fixed, std::uint32_t perSample) {
    return perSample ? fmt::format("{} + {} n", fixed, perSample) : std::to_string(fixed);
}

static void addCosts(std::string& text, const std::vector<NodeCost>& costs) {
    auto line = [&](std::string_view node, const NodeCost& c) {
        text += fmt::format("    {:>14} {:>18} {:>9}  {}\n", count(c.fixed.instructions, c.perSample.instructions),
                            count(c.fixed.environmentReads, c.perSample.environmentReads),
                            count(c.fixed.textureReads, c.perSample.textureReads), node);
    };
    text += "  cost of a pixel with n samples\n";
    text += "      instructions  environment reads  textures  node\n";
    for (const NodeCost& c : costs) line(c.node.empty() ? "(light)" : c.node, c);
    line("(all)", sumOf(costs));
}

std::string inspectionText(std::span<const Inspection> found) {
    std::string text;
    for (const Inspection& i : found) {
        text += i.element + "\n";
        if (i.lobes) addLobes(text, *i.lobes);
        if (i.withoutEffect && !i.withoutEffect->empty()) {
            text += "  values without effect\n";
            for (const std::string& path : *i.withoutEffect) text += "    " + path + "\n";
        }
        if (i.costs) addCosts(text, *i.costs);
    }
    return text;
}

static void write(JsonWriter& json, const Removal& r) {
    json.openShortObject();
    json.member("by", nameOf(r.kind));
    json.member("expression", r.expression);
    json.member("value", r.value);
    json.key("inputs");
    json.openShortArray();
    for (const Decision& d : r.inputs) {
        json.openShortObject();
        json.member("path", d.path);
        json.member("value", d.value);
        json.closeObject();
    }
    json.closeArray();
    json.closeObject();
}

static void write(JsonWriter& json, const Lobe& lobe) {
    json.openShortObject();
    json.member("node", lobe.node);
    json.member("name", lobe.name);
    json.member("leaf", lobe.leaf);
    json.key("remains");
    json.boolean(lobe.remains);
    json.member("weight", lobe.weight);
    json.member("value", lobe.value);
    if (!lobe.remains) {
        json.key("removed");
        json.openShortArray();
        for (const Removal& r : lobe.removals) write(json, r);
        json.closeArray();
    }
    json.closeObject();
}

static void write(JsonWriter& json, std::string_view name, const Work& work) {
    json.key(name);
    json.openShortObject();
    json.key("instructions");
    json.integer(work.instructions);
    json.key("environment");
    json.integer(work.environmentReads);
    json.key("textures");
    json.integer(work.textureReads);
    json.closeObject();
}

static void write(JsonWriter& json, const NodeCost& c) {
    json.openShortObject();
    json.key("node");
    json.text(c.node);
    write(json, "fixed", c.fixed);
    write(json, "perSample", c.perSample);
    json.closeObject();
}

std::string inspectionJson(std::span<const Inspection> found) {
    JsonWriter json;
    json.openArray();
    for (const Inspection& i : found) {
        json.openObject();
        json.member("element", i.element);
        if (i.lobes) {
            json.key("lobes");
            json.openArray();
            for (const Lobe& lobe : *i.lobes) write(json, lobe);
            json.closeArray();
        }
        if (i.costs) {
            json.key("cost");
            json.openArray();
            for (const NodeCost& c : *i.costs) write(json, c);
            json.closeArray();
        }
        if (i.withoutEffect) {
            json.key("withoutEffect");
            json.openArray();
            for (const std::string& path : *i.withoutEffect) json.text(path);
            json.closeArray();
        }
        json.closeObject();
    }
    json.closeArray();
    return json.take();
}

}  // namespace shaderx
