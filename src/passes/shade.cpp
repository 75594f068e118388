#include "passes/shade.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "passes/copy.h"
#include "passes/gather.h"

namespace shaderx::passes {

using namespace ir;

namespace {

// Light that leaves the surface, before opacity, the opacity, and what shines through from behind (where it is asked
// for).
struct Lit {
    ExprId color, opacity, clear{};
};

// What the functions of a leaf give.
struct LeafLight {
    ExprId radiance, albedo;
};

struct Shader {
    Module& module;
    const Function& from;
    const ShadeOptions& options;
    Diagnostics& diagnostics;
    Function fresh{};
    Builder b{module, fresh};
    Copy copy{from, b};
    std::vector<bool> live = reachable(from);
    std::vector<ExprId> throughput = std::vector<ExprId>(from.exprs.size());
    std::map<std::uint32_t, LeafLight> leaves{};
    std::vector<ExprId> shares = std::vector<ExprId>(from.exprs.size());  // see share
    // What leaves' functions and nodes call their inputs.
    Name weight = name("weight"), normalName = name("normal"), tangent = name("tangent");
    Name V = name("V"), N = name("N"), X = name("X");
    ExprId view{};
    bool ok = true, warnedVolume = false;

    Name name(std::string_view text) const { return module.names->intern(text); }
    ExprId one() { return b.number(1); }

    void run(Name output) {
        fresh.name = from.name;
        fresh.params = from.params;
        fresh.comment = from.comment;
        for (std::uint32_t i = 0; i < from.exprs.size(); i++)
            if (live[i] && !isClosure(from.exprs[i].type)) copy.raw(ExprId(i));  // as simple as it was
        beginLight();
        ExprId result = from.results[0].value;
        Type type = from.results[0].type;
        ExprId pixel;
        if (type == Type::SurfaceShader || type == Type::Material) {
            Lit lit = surface(result);
            ExprId alpha = options.transparency ? alphaOf(lit.clear) : one();
            pixel = b.make(Type::Vector4, {product(lit.color, lit.opacity), alpha});
            b.addResult(output, pixel);
            if (options.transparency)
                b.addResult(name("discarded"), b.op(Op::Less, {alpha, b.context(Context::AlphaThreshold)}));
            return;
        } else if (type == Type::BSDF) {
            pixel = b.make(Type::Vector4, {environment(result), one()});
        } else if (type == Type::EDF) {
            pixel = b.make(Type::Vector4, {emission(result), one()});
        } else if (isClosure(type)) {
            pixel = b.constant(Type::Vector4, {0, 0, 0, 1});
        } else {
            pixel = asColor(copy[result]);
        }
        b.addResult(output, pixel);
    }

    ExprId alphaOf(ExprId clear) {
        ExprId sum =
            b.op(Op::Add, {b.op(Op::Add, {b.component(clear, 0), b.component(clear, 1)}), b.component(clear, 2)});
        ExprId alpha = b.op(Op::Sub, {one(), product(b.number(0.3333f), sum)});
        alpha = b.op(Op::Clamp, {alpha, b.number(0), one()});
        b.hint(alpha, name("alpha"));
        return alpha;
    }

    ExprId asColor(ExprId v) {
        Type t = b.type(v);
        if (isMatrix(t) || componentCount(t) == 0) return b.constant(Type::Vector4, {0, 0, 0, 1});
        switch (componentCount(t)) {
            case 1: {
                ExprId x = b.convert(v, Type::Float);
                return b.make(Type::Vector4, {x, x, x, one()});
            }
            case 2:
                return b.make(Type::Vector4, {v, b.number(0), one()});
            case 3:
                return b.make(Type::Vector4, {v, one()});
            default:
                return b.convert(v, Type::Vector4);
        }
    }

    ExprId product(ExprId a, ExprId c) { return b.op(Op::Mul, {a, c}); }
    bool isZero(ExprId e) const { return isZero(b.function(), e); }
    static bool isZero(const Function& f, ExprId e) {
        if (!f.isConstant(e)) return false;
        auto words = f.constantWords(e);
        return std::all_of(words.begin(), words.end(), [](std::uint32_t w) { return w == 0; });
    }
    ExprId black() { return b.constant(Type::Color3, {0.0f}); }

    // Surface shaders nest only by mixing; the nest is walked with a stack in the order of the arena.
    Lit surface(ExprId root) {
        std::vector<Lit> lit(from.exprs.size());
        for (std::uint32_t i = 0; i <= root.index; i++) {
            if (!live[i] || (from.exprs[i].type != Type::SurfaceShader && from.exprs[i].type != Type::Material))
                continue;
            auto o = from.operandsOf(from.exprs[i]);
            switch (from.exprs[i].op) {
                case Op::Surface:
                    lit[i] = {surfaceColor(o[0], o[1]), copy[o[2]], black()};
                    if (options.transparency)
                        lit[i].clear = b.convert(b.op(Op::Sub, {one(), copy[o[2]]}), Type::Color3);
                    break;
                case Op::SurfaceUnlit:
                    lit[i] = {copy[o[0]], copy[o[2]], black()};
                    if (options.transparency)
                        lit[i].clear = b.op(Op::Mix, {b.constant(Type::Color3, {1.0f}), copy[o[1]], copy[o[2]]});
                    break;
                case Op::ClosureMix: {
                    ExprId t = copy[o[2]];
                    Lit x = lit[o[0].index], y = lit[o[1].index];
                    ExprId color = b.op(Op::Mix, {product(x.color, x.opacity), product(y.color, y.opacity), t});
                    lit[i] = {color, one(), options.transparency ? b.op(Op::Mix, {x.clear, y.clear, t}) : black()};
                    break;
                }
                case Op::ClosureAdd: {
                    Lit x = lit[o[0].index], y = lit[o[1].index];
                    lit[i] = {b.op(Op::Add, {product(x.color, x.opacity), product(y.color, y.opacity)}), one(),
                              options.transparency ? both(x.clear, y.clear) : black()};
                    break;
                }
                case Op::ClosureScale:
                    lit[i] = lit[o[0].index];
                    lit[i].color = product(lit[i].color, copy[o[1]]);
                    break;
                case Op::Retype: {  // a shader as a material; that of a volume gives no light here
                    const Lit of = lit[o[0].index];
                    lit[i] = of.color ? of : Lit{black(), one(), black()};
                    break;
                }
                default:
                    lit[i] = {black(), one(), black()};  // nothing that gives light
            }
        }
        return lit[root.index];
    }

    // What two sheets let through that share a surface: what neither stops.
    ExprId both(ExprId x, ExprId y) {
        ExprId sum = b.op(Op::Sub, {b.op(Op::Add, {x, y}), one()});
        return b.op(Op::Max, {sum, b.number(0)});
    }

    ExprId surfaceColor(ExprId bsdf, ExprId edf) {
        ExprId reflected = environment(bsdf);
        return b.op(Op::Add, {reflected, emission(edf)});
    }

    // Weights of all closures below a root, by expression: how much of each the root contains.
    std::vector<ExprId> weigh(ExprId root, Type kind) {
        std::vector<ExprId> w(from.exprs.size());
        auto give = [&](ExprId to, ExprId x) {
            ExprId& sum = w[to.index];
            sum = sum ? b.op(Op::Add, {sum, x}) : x;
        };
        w[root.index] = one();
        for (std::uint32_t i = root.index + 1; i-- > 0;) {
            if (!w[i]) continue;
            const Expr& e = from.exprs[i];
            auto o = from.operandsOf(e);
            switch (e.op) {
                case Op::ClosureMix: {
                    ExprId t = copy[o[2]];
                    give(o[0], product(w[i], b.op(Op::Sub, {one(), t})));
                    give(o[1], product(w[i], t));
                    break;
                }
                case Op::ClosureAdd:
                    give(o[0], w[i]);
                    give(o[1], w[i]);
                    break;
                case Op::ClosureScale:
                    give(o[0], product(w[i], copy[o[1]]));
                    break;
                case Op::ClosureLayer:
                    give(o[0], w[i]);
                    if (from[o[1]].type == kind) {
                        ExprId below = product(w[i], passed(o[0]));
                        b.hint(below, name("passed"));
                        give(o[1], below);
                    } else if (!isEmpty(o[1])) {
                        ignoreVolume();
                    }
                    break;
                default:
                    break;  // leaves keep what they have
            }
        }
        return w;
    }

    // Whether a volume neither absorbs nor scatters, whatever comes.
    bool isEmpty(ExprId volume) const {
        if (from[volume].op != Op::Leaf) return false;
        auto parameters = from.operandsOf(from[volume]);
        return std::all_of(parameters.begin(), parameters.end(),
                           [&](ExprId p) { return from[p].type != Type::Vector3 || isZero(from, p); });
    }

    void ignoreVolume() {
        if (warnedVolume || !ok) return;
        warnedVolume = true;
        diagnostics.warning("ignored-volume", "a volume below a surface is not drawn on rasters");
    }

    // What a closure lets through to the layer below it; all that it depends on, in the order of the arena.
    ExprId passed(ExprId root) {
        std::vector<bool> needed(root.index + 1);
        needed[root.index] = true;
        for (std::uint32_t i = root.index + 1; i-- > 0;)
            if (needed[i] && !throughput[i])
                for (ExprId o : from.operandsOf(from.exprs[i]))
                    if (from[o].type == from[root].type) needed[o.index] = true;  // a volume below is not in the way
        for (std::uint32_t i = 0; i <= root.index; i++)
            if (needed[i] && !throughput[i]) throughput[i] = passedBy(ExprId(i));
        return throughput[root.index];
    }

    ExprId passedBy(ExprId id) {
        const Expr& e = from[id];
        auto o = from.operandsOf(e);
        auto of = [&](std::size_t k) { return throughput[o[k].index]; };
        switch (e.op) {
            case Op::Leaf:
                if (isZero(weightOf(id))) return one();
                return b.op(Op::Sub, {one(), product(weightOf(id), leaf(id).albedo)});
            case Op::ClosureMix:
                return b.op(Op::Mix, {of(0), of(1), copy[o[2]]});
            case Op::ClosureLayer:
                return from[o[1]].type == e.type ? product(of(0), of(1)) : of(0);
            case Op::ClosureAdd:
                return both(of(0), of(1));
            case Op::ClosureScale:
                return of(0);
            default:
                return one();  // nothing is in the way
        }
    }

    // The leaf's input of a name, or none.
    ExprId input(ExprId id, Name wanted) {
        const LeafInfo* info = module.leaf(Name(from[id].payload));
        for (std::size_t k = 0; info && k < info->params.size(); k++)
            if (info->params[k].name == wanted) return copy[from.operand(id, k)];
        return {};
    }
    ExprId weightOf(ExprId id) {
        ExprId w = input(id, weight);
        return w ? w : one();
    }

    ExprId toViewer() {
        if (!view) {
            ExprId d = b.op(Op::Sub, {b.convert(b.context(Context::ViewPosition), Type::Vector3),
                                      b.convert(b.context(Context::PositionWorld), Type::Vector3)});
            view = b.op(Op::Normalize, {d});
            b.hint(view, V);
        }
        return view;
    }

    // The value for a parameter of a leaf's function.
    ExprId bound(ExprId id, const Param& p) {
        ExprId value;
        if (p.name == V) return toViewer();
        if (p.name == N) {
            ExprId normal = input(id, normalName);
            if (!normal) normal = b.op(Op::Normalize, {b.context(Context::NormalWorld)});
            value = b.op(Op::Faceforward, {normal, b.op(Op::Neg, {toViewer()}), normal});
            if (Name old = b.function().hints[normal.index]; !old || old == N) b.rename(normal, normalName);
            b.rename(value, N);
            return value;
        }
        if (p.name == X) {
            value = input(id, tangent);
            if (!value) value = b.op(Op::Normalize, {b.context(Context::TangentWorld)});
            return value;
        }
        value = input(id, p.name);
        return value && b.type(value) != p.type ? b.convert(value, p.type) : value;
    }

    // Calls a function of a leaf; its results, or none if it can't be called.
    std::vector<ExprId> callLeaf(ExprId id, std::string_view suffix) {
        std::string leafName(module.names->text(Name(from[id].payload)));
        const Function* f = module.find(name(leafName + std::string(suffix)));
        std::vector<ExprId> arguments, results;
        for (std::size_t k = 0; f && k < f->params.size(); k++) {
            arguments.push_back(bound(id, f->params[k]));
            if (!arguments.back()) f = nullptr;
        }
        if (!f) {
            diagnostics.error(
                "leaf-without-function",
                fmt::format("there is no function '{}{}' that fits the inputs of its node", leafName, suffix));
            ok = false;
            return results;
        }
        bool single = f->results.size() == 1;
        begin(id);
        ExprId call = b.call(f->name, single ? f->results[0].type : Type::Tuple, arguments);
        for (std::uint32_t k = 0; k < f->results.size(); k++)
            results.push_back(single ? call : b.result(call, k, f->results[k].type));
        return results;
    }

    // What is made for a leaf comes from its node, and there from the part that has its name.
    void begin(ExprId id) {
        if (from.origins.empty()) return;
        std::string_view node = module.names->text(from.originOf(id)), part = module.names->text(from.hints[id.index]);
        bool isWhole = part.empty() || node == part || node.ends_with("/" + std::string(part));
        fresh.beginOrigin(isWhole ? from.originOf(id) : name(fmt::format("{}/{}", node, part)));
    }
    void beginLight() {
        if (!from.origins.empty()) fresh.beginOrigin({});
    }

    LeafLight leaf(ExprId id) {
        auto found = leaves.find(id.index);
        if (found != leaves.end()) return found->second;
        std::vector<ExprId> r = callLeaf(id, "_environment");
        LeafLight light = r.size() == 2 ? LeafLight{r[0], r[1]} : LeafLight{black(), black()};
        if (Name hint = from.hints[id.index]; hint && r.size() == 2) {
            b.hint(light.radiance, hint);
            b.hint(light.albedo, name(fmt::format("{}_albedo", module.names->text(hint))));
        }
        beginLight();
        return leaves[id.index] = ifUsed(id, light);
    }

    // Where a leaf's weight is certainly 0 its light and its albedo do not matter.
    LeafLight ifUsed(ExprId id, LeafLight light) {
        const Function* f = module.find(name(std::string(module.names->text(Name(from[id].payload))) + "_environment"));
        if (!options.skipsUnused || !shares[id.index] || !f || !leadsTo(module, *f, holdsLoop)) return light;
        ExprId isUsed = b.op(Op::NotEqual, {product(shares[id.index], weightOf(id)), b.number(0)});
        if (Name hint = from.hints[id.index]) b.hint(isUsed, hint);
        return {b.select(isUsed, light.radiance, black()), b.select(isUsed, light.albedo, black())};
    }

    // How much of each closure the root contains at most, as one number: all weights but what layers let through and
    // what colours leave.
    void share(ExprId root) {
        auto give = [&](ExprId to, ExprId x) {
            ExprId& sum = shares[to.index];
            sum = sum ? b.op(Op::Add, {sum, x}) : x;
        };
        shares.assign(from.exprs.size(), {});
        shares[root.index] = one();
        for (std::uint32_t i = root.index + 1; i-- > 0;) {
            if (ExprId w = shares[i]; w && isClosure(from.exprs[i].type)) {
                auto o = from.operandsOf(from.exprs[i]);
                switch (from.exprs[i].op) {
                    case Op::ClosureMix:
                        give(o[0], product(w, b.op(Op::Sub, {one(), copy[o[2]]})));
                        give(o[1], product(w, copy[o[2]]));
                        break;
                    case Op::ClosureAdd:
                    case Op::ClosureLayer:
                        give(o[0], w);
                        give(o[1], w);
                        break;
                    case Op::ClosureScale:
                        give(o[0], b.type(copy[o[1]]) == Type::Float ? product(w, copy[o[1]]) : w);
                        break;
                    default:
                        break;  // leaves keep what they have
                }
            }
        }
    }

    ExprId environment(ExprId bsdf) {
        if (!options.environment) return black();
        if (options.skipsUnused) share(bsdf);
        std::vector<ExprId> w = weigh(bsdf, Type::BSDF);
        // From the outermost lobe inwards. Lobes that differ only in weight are one.
        std::vector<std::pair<ExprId, ExprId>> lobes;  // radiance and weight
        for (std::uint32_t i = bsdf.index + 1; i-- > 0;) {
            if (!w[i] || from.exprs[i].op != Op::Leaf) continue;
            ExprId share = product(w[i], weightOf(ExprId(i)));
            if (isZero(share)) continue;
            ExprId radiance = leaf(ExprId(i)).radiance;
            auto same = std::find_if(lobes.begin(), lobes.end(), [&](const auto& l) { return l.first == radiance; });
            if (same == lobes.end())
                lobes.emplace_back(radiance, share);
            else
                same->second = b.op(Op::Add, {same->second, share});
        }
        ExprId sum;
        for (auto [radiance, share] : lobes) {
            ExprId lobe = product(share, radiance);
            sum = sum ? b.op(Op::Add, {sum, lobe}) : lobe;
        }
        if (sum) b.hint(sum, name("light"));
        return sum ? product(sum, b.context(Context::EnvironmentIntensity)) : black();
    }

    ExprId emission(ExprId edf) {
        std::vector<ExprId> w = weigh(edf, Type::EDF);
        ExprId sum;
        for (std::uint32_t i = 0; i <= edf.index; i++) {
            if (!w[i] || from.exprs[i].op != Op::Leaf) continue;
            std::vector<ExprId> r = callLeaf(ExprId(i), "_emission");
            beginLight();
            if (r.size() != 1) continue;
            ExprId lobe = product(w[i], r[0]);
            sum = sum ? b.op(Op::Add, {sum, lobe}) : lobe;
        }
        return sum ? sum : black();
    }
};

}  // namespace

bool shade(Module& module, Name entry, Name output, const ShadeOptions& options, Diagnostics& diagnostics) {
    Function* f = module.findOwn(entry);
    ensure(f && f->results.size() == 1, "an entry has one result");
    Shader s{module, *f, options, diagnostics};
    s.run(output);
    bool ok = s.ok;
    module.put(std::move(s.fresh));
    return ok;
}

}  // namespace shaderx::passes
