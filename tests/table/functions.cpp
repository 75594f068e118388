#include "table/functions.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>

#include "base/numbers.h"
#include "ir/builder.h"
#include "passes/specialise.h"
#include "support.h"

namespace shaderx::table {

using namespace ir;

namespace {

// Ranges that parameters mean, by their names; inputs of nodes may say it themselves.
struct NamedDomain {
    std::string_view name;
    Domain domain;
};
const NamedDomain kNamed[] = {
    {"N", {-3.2f, 3.2f, {0}, 0.4f}},
    {"V", {-3.2f, 3.2f, {0}, 2}},
    {"L", {-3.2f, 3.2f, {0}, 2}},
    {"X", {-3.2f, 3.2f, {}, 1000}},
    {"H", {-3.2f, 3.2f, {0}, 1}},
    {"d", {-3.2f, 3.2f, {}, 50}},
    {"normal", {-3.2f, 3.2f, {0}, 0.4f}},
    {"tangent", {-3.2f, 3.2f, {}, 1000}},
    {"bitangent", {-3.2f, 3.2f, {}, 1000}},
    {"viewdir", {-3.2f, 3.2f, {}, 50}},
    {"direction", {-3.2f, 3.2f, {}, 50}},
    {"view_direction", {-3.2f, 3.2f, {0}, 2}},
    {"c", {0.02f, 1, {1}}},
    {"u", {0, 1, {0}}},
    {"roughness", {0.05f, 1, {1}}},
    {"ior", {1.1f, 3, {1.5f}}},
    {"thinfilm_ior", {1.1f, 2, {1.5f}}},
    {"film_ior", {1.1f, 2, {1.5f}}},
    {"thickness", {0, 800, {0}}},
    {"thinfilm_thickness", {0, 800, {0}}},
    {"n", {0.2f, 3, {1}}},
    {"k", {0, 4, {0}}},
    {"base", {0, 1, {0, 1}}},
    {"exponent", {0.5f, 8, {5}}},
    {"gamma", {0.2f, 3, {1}}},
    {"roughness_R", {0.05f, 1, {1}}},
    {"roughness_TT", {0.05f, 1, {1}}},
    {"roughness_TRT", {0.05f, 1, {1}}},
    {"rotationrange", {0, 90, {0}}},
    {"scalerange", {0.5f, 2, {1}}},
};

// Functions that lose digits on the way from inputs that are exact, which moving the inputs does not show.
struct Loose {
    std::string_view name;
    double tolerance;
};
const Loose kLoose[] = {
    // turn their lattice by up to 250 turns, given in degrees
    {"unified_noise_2d", 0.02},
    {"unified_noise_3d", 0.02},
    {"ND_unifiednoise2d_float", 0.02},
    {"ND_unifiednoise3d_float", 0.02},
    // reads an image where logarithms and angles say
    {"hair_seen", 0.01},
    // take the fraction of products of some thousands as random numbers
    {"hex_random", 0.02},
    {"hex_texel", 0.1},
    {"hex_tiled", 0.1},
    {"hex_tiled_normal", 0.1},
    {"ND_hextiledimage_color3", 0.1},
    {"ND_hextiledimage_color4", 0.1},
    {"ND_hextilednormalmap_vector3", 0.1},
};

struct Maker {
    NodeLibrary& nodes;
    Module& program;
    std::vector<std::string>& names;
    std::vector<Exempt>& exempt;
    std::vector<Subject> made = {};

    std::string_view text(Name n) const { return program.names->text(n); }

    // The input of a node that a parameter is, none for functions of the sources.
    static doc::ElementRef inputOf(const doc::Definitions& definitions, doc::NodeDef def, Name param) {
        const doc::Port* port = def ? definitions.input(def, param) : nullptr;
        return port ? definitions.element(def, *port) : doc::ElementRef();
    }

    std::string_view attribute(doc::ElementRef element, std::string_view name) const {
        return element ? element.attributeText(program.names->intern(name)) : std::string_view();
    }

    // The first number of a list, as `fallback` where there is none.
    static float number(std::string_view list, float fallback) {
        return parseFloat(list.substr(0, list.find(','))).value_or(fallback);
    }

    Domain domainOf(const Param& p, doc::ElementRef input) const {
        Domain d;
        if (info(p.type).scalar == Scalar::Integer) d.low = -1, d.high = 4;
        for (const NamedDomain& n : kNamed)
            if (n.name == text(p.name) &&
                (n.domain.cone > 0 ? componentCount(p.type) == 3 : info(p.type).scalar == Scalar::Float))
                return n.domain;
        const std::string_view low = attribute(input, "uimin"), high = attribute(input, "uimax");
        if (!low.empty()) d.low = number(low, d.low);
        if (!high.empty()) d.high = number(high, d.high);
        if (d.high <= d.low) d.high = d.low + 4;
        if (d.low != -2) d.edges = {d.low, d.high};
        return d;
    }

    // What to give a parameter that is a string.
    std::vector<std::string> strings(const Function& f, const Param& p, doc::ElementRef input) const {
        std::vector<std::string> out;
        std::string_view list = attribute(input, "enum");
        while (!list.empty()) {
            const std::size_t comma = std::min(list.find(','), list.size());
            std::string_view one = list.substr(0, comma);
            while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
            out.emplace_back(one);
            list.remove_prefix(std::min(comma + 1, list.size()));
        }
        if (!out.empty()) return out;
        if (text(p.name).find("space") != std::string_view::npos) return {"world", "object", "model"};
        if (text(p.name) == "scatter_mode") return {"R", "T", "RT"};
        if (text(p.name) == "mode") return {"conty_kulla", "zeltner"};
        if (text(p.name) == "geomprop") return {fmt::format("table_{}", info(f.results[0].type).name)};
        return {std::string(attribute(input, "value"))};
    }

    // Why a function is not one of numbers, empty where it is.
    static std::string obstacle(const Function& f) {
        for (const Param& p : f.params)
            if (isClosure(p.type)) return fmt::format("takes a {}", info(p.type).name);
        for (const ResultValue& r : f.results)
            if (componentCount(r.type) == 0) return fmt::format("gives a {}", info(r.type).name);
        return {};
    }

    void add(const Function& f, doc::NodeDef def) {
        std::string name(text(f.name));
        names.push_back(name);
        if (std::string why = obstacle(f); !why.empty()) {
            exempt.push_back({name, why});
            return;
        }
        Subject s;
        s.name = s.covers = name;
        s.function = f.name;
        for (const Loose& l : kLoose)
            if (l.name == name) s.tolerance = l.tolerance;
        std::vector<std::vector<std::string>> choices;
        for (const Param& p : f.params) {
            const doc::ElementRef input = inputOf(nodes.definitions, def, p.name);
            if (p.type == Type::String)
                choices.push_back(strings(f, p, input));
            else
                s.domains.push_back(domainOf(p, input));
        }
        // The interpreter knows no strings, which specialising folds away.
        const bool hasStrings =
            anyOperation(program, f, [](const Function&, const Expr& e) { return e.type == Type::String; });
        if (choices.empty() && !hasStrings)
            made.push_back(std::move(s));
        else
            variants(f, s, choices);
    }

    // All combinations where they are few; otherwise every choice of one while the others have their first.
    void variants(const Function& f, const Subject& s, const std::vector<std::vector<std::string>>& choices) {
        constexpr std::size_t kMost = 9;
        std::size_t count = 1;
        for (const auto& c : choices) count *= c.size();
        std::set<std::vector<std::size_t>> picked;
        for (std::size_t code = 0; code < count && count <= kMost; code++) {
            std::vector<std::size_t> one;
            std::size_t rest = code;
            for (const auto& c : choices) one.push_back(rest % c.size()), rest /= c.size();
            picked.insert(one);
        }
        for (std::size_t k = 0; k < choices.size() && count > kMost; k++)
            for (std::size_t i = 0; i < choices[k].size(); i++) {
                std::vector<std::size_t> one(choices.size());
                one[k] = i;
                picked.insert(one);
            }
        for (const std::vector<std::size_t>& one : picked) {
            std::vector<std::string> given;
            for (std::size_t k = 0; k < one.size(); k++) given.push_back(choices[k][one[k]]);
            variant(f, s, given);
        }
    }

    // A function of its own that gives the strings. The interpreter knows none, so it is specialised.
    void variant(const Function& f, Subject s, const std::vector<std::string>& given) {
        Module own(*program.names);
        own.sources = {nodes.bodies.get(), nodes.library.get()};
        if (given.empty()) s.name += " with its strings";
        for (const std::string& g : given) s.name += fmt::format(" \"{}\"", g);
        Function w;
        w.name = program.names->intern(s.name);
        for (const Param& p : f.params)
            if (p.type != Type::String) w.params.push_back(p);
        Builder b(own, w);
        std::vector<ExprId> arguments;
        std::uint32_t numbers = 0;
        for (const Param& p : f.params)
            arguments.push_back(p.type == Type::String ? b.string(own.names->intern(given[arguments.size() - numbers]))
                                                       : b.param(numbers++));
        const bool single = f.results.size() == 1;
        ExprId call = b.call(f.name, single ? f.results[0].type : Type::Tuple, arguments);
        for (std::uint32_t k = 0; k < f.results.size(); k++)
            b.addResult(f.results[k].name, single ? call : b.result(call, k, f.results[k].type));
        own.put(std::move(w));
        s.function = program.names->intern(s.name);
        if (!passes::specialise(own, s.function, {}, nodes.diagnostics)) return;
        adopt(own, s.function);
        made.push_back(std::move(s));
    }

    // Takes over what specialising made. Later runs number their clones anew, so these get names that no run gives.
    void adopt(Module& own, Name entry) {
        std::unordered_map<Name, Name> renamed;
        for (const auto& f : own.functions)
            if (f->name != entry)
                renamed[f->name] = program.names->intern(
                    fmt::format("{}@table{}", text(f->name), program.functions.size() + renamed.size()));
        for (auto& f : own.functions) {
            for (Expr& e : f->exprs)
                if (auto to = renamed.find(Name(e.payload)); e.op == Op::Call && to != renamed.end())
                    e.payload = to->second.index;
            if (auto to = renamed.find(f->name); to != renamed.end()) f->name = to->second;
            program.put(std::move(*f));
        }
    }
};

}  // namespace

NodeLibrary::NodeLibrary(NameTable& nameTable) {
    std::vector<LibraryFile> files;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(SHADERX_SOURCE_DIR) / "nodes"))
        if (entry.is_regular_file()) files.push_back({entry.path().filename().string(), tests::fileText(entry.path())});
    library = makeLibrary(nameTable, std::move(files), {}, diagnostics);
    if (!library) return;
    definitions.add(library->document(), library->index());
    bodies = std::make_unique<NodeBodies>(nameTable, definitions, std::vector<Library*>{library.get()});
}

std::vector<Subject> functions(NodeLibrary& nodes, Module& program, std::vector<std::string>& names,
                               std::vector<Exempt>& exempt) {
    Maker m{nodes, program, names, exempt};
    for (const Function* f : nodes.library->functions()) m.add(*f, {});
    for (const doc::NodeDefRow& row : nodes.library->index().nodedefs) {
        const doc::NodeDef def = nodes.definitions.byName(row.name);
        const bool hasBody = static_cast<bool>(nodes.definitions.implementation(def));
        const Name body = hasBody ? nodes.bodies->functionOf(def, nodes.diagnostics) : Name();
        if (const Function* f = body ? program.find(body) : nullptr) {
            m.add(*f, def);
            continue;
        }
        names.emplace_back(program.names->text(row.name));
        if (!hasBody) exempt.push_back({names.back(), "has no implementation"});
    }
    return std::move(m.made);
}

}  // namespace shaderx::table
