#include "passes/lobes.h"

#include <algorithm>

#include "ir/builder.h"
#include "passes/formula.h"
#include "passes/topology.h"

namespace shaderx::passes {

using namespace ir;

namespace {

constexpr std::size_t kMostTerms = 8, kMostFactors = 32, kMostInputs = 8, kLongest = 300;

// One factor of a weight: an expression, 1 less an expression, or what a closure lets through.
struct Factor {
    enum class Kind : std::uint8_t { Value, Rest, Passed } kind;
    ExprId e;
};
using Term = std::vector<Factor>;

// Why a closure is not there: the operand that decides it.
struct Cut {
    Removal::Kind kind;
    ExprId by;
    friend bool operator==(const Cut&, const Cut&) = default;
};

struct Finder {
    const Module& module;
    const Function& f;
    std::vector<Value> values = valuesByDefault(module, f);
    std::vector<bool> isAlive = std::vector<bool>(f.exprs.size());  // some leaf in it has a weight
    // By closure: how much of it the material has, as a sum; no terms where it has none, and then why.
    std::vector<std::vector<Term>> terms = std::vector<std::vector<Term>>(f.exprs.size());
    std::vector<std::vector<Cut>> cuts = std::vector<std::vector<Cut>>(f.exprs.size());
    std::vector<bool> isReached = std::vector<bool>(f.exprs.size());

    bool isKnown(ExprId e) const { return values[e.index].type != Type::Void; }
    bool isAll(ExprId e, float wanted) const {
        const Value& v = values[e.index];
        if (v.type == Type::Void) return false;
        for (int i = 0; i < componentCount(v.type); i++)
            if ((info(v.type).scalar == Scalar::Float ? v.f(i) : static_cast<float>(v.i(i))) != wanted) return false;
        return true;
    }

    // What multiplies a leaf: its weight, of light its colour.
    ExprId weightOf(ExprId leaf) const {
        std::string_view wanted = f[leaf].type == Type::EDF ? "color" : "weight";
        const LeafInfo* leafInfo = module.leaf(Name(f[leaf].payload));
        for (std::size_t k = 0; leafInfo && k < leafInfo->params.size(); k++)
            if (module.names->text(leafInfo->params[k].name) == wanted) return f.operand(leaf, k);
        return {};
    }

    void markAlive() {
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            ExprId id(i);
            if (!isClosure(f[id].type)) continue;
            if (f[id].op == Op::Leaf) {
                ExprId w = weightOf(id);
                isAlive[i] = !w || !isAll(w, 0);
            }
            for (ExprId o : f.operandsOf(id)) isAlive[i] = isAlive[i] || (isClosure(f[o].type) && isAlive[o.index]);
        }
    }

    // Hands on what `from` has of the material to a closure in it, times factors.
    void give(ExprId from, ExprId to, std::initializer_list<Factor> factors) {
        isReached[to.index] = true;
        for (const Term& term : terms[from.index]) {
            if (terms[to.index].size() > kMostTerms) break;  // one more than are shown
            Term longer = term;
            if (term.size() < kMostFactors) longer.insert(longer.end(), factors.begin(), factors.end());
            terms[to.index].push_back(std::move(longer));
        }
        for (const Cut& cut : cuts[from.index]) add(to, cut);
    }
    void add(ExprId to, Cut cut) {
        if (std::find(cuts[to.index].begin(), cuts[to.index].end(), cut) == cuts[to.index].end())
            cuts[to.index].push_back(cut);
    }
    // Takes the way from `from` to `to` away; if there was one, this is why there is none.
    void take(ExprId from, ExprId to, Cut cut) {
        isReached[to.index] = true;
        if (!terms[from.index].empty()) return add(to, cut);
        for (const Cut& c : cuts[from.index]) add(to, c);
    }

    void mix(ExprId id, ExprId bg, ExprId fg, ExprId t) {
        if (isAll(t, 1))
            take(id, bg, {Removal::Kind::Mix, t});
        else if (isAll(t, 0))
            give(id, bg, {});
        else
            give(id, bg, {{Factor::Kind::Rest, t}});
        if (isAll(t, 0))
            take(id, fg, {Removal::Kind::Mix, t});
        else if (isAll(t, 1))
            give(id, fg, {});
        else
            give(id, fg, {{Factor::Kind::Value, t}});
    }

    void scale(ExprId id, ExprId closure, ExprId by) {
        if (isAll(by, 0))
            take(id, closure, {Removal::Kind::Weight, by});
        else if (isAll(by, 1) && f[by].op == Op::Constant)
            give(id, closure, {});
        else
            give(id, closure, {{Factor::Kind::Value, by}});
    }

    void choose(ExprId id) {
        auto o = f.operandsOf(id);
        for (bool side : {true, false}) {
            ExprId closure = o[side ? 1 : 2];
            if (isKnown(o[0]) && (values[o[0].index].words[0] != 0) != side)
                take(id, closure, {Removal::Kind::Condition, o[0]});
            else
                give(id, closure, {});
        }
    }

    void layer(ExprId id, ExprId top, ExprId base) {
        give(id, top, {});
        if (f[base].type != f[top].type)
            take(id, base, {Removal::Kind::Volume, {}});
        else if (isAlive[top.index])
            give(id, base, {{Factor::Kind::Passed, top}});
        else
            give(id, base, {});
    }

    void descend(ExprId id) {
        const Expr& e = f[id];
        auto o = f.operandsOf(e);
        switch (e.op) {
            case Op::ClosureMix:
                return mix(id, o[0], o[1], o[2]);
            case Op::ClosureScale:
                return scale(id, o[0], o[1]);
            case Op::ClosureLayer:
                return layer(id, o[0], o[1]);
            case Op::Select:
                return choose(id);
            case Op::Surface:  // its opacity is the surface's, not a lobe's, unless it leaves nothing
                for (ExprId closure : {o[0], o[1]})
                    isAll(o[2], 0) ? take(id, closure, {Removal::Kind::Weight, o[2]}) : give(id, closure, {});
                return;
            default:
                for (ExprId x : o)
                    if (isClosure(f[x].type)) give(id, x, {});
        }
    }

    std::string nameOf(ExprId closure) const {
        Name hint = f.hints[closure.index];
        if (!hint && f[closure].op == Op::Leaf) hint = Name(f[closure].payload);
        return hint ? std::string(module.names->text(hint)) : std::string(info(f[closure].op).name);
    }

    std::string textOfFactor(const Factor& x) const {
        switch (x.kind) {
            case Factor::Kind::Value:
                return formula(module, f, x.e, 2);
            case Factor::Kind::Rest:
                return "(1 - " + formula(module, f, x.e, 2) + ")";
            case Factor::Kind::Passed:
                return "passed(" + nameOf(x.e) + ")";
        }
        return {};
    }

    // The value of a factor; none where it depends on the pixel, or differs by component.
    const float* number(const Factor& x, float& v) const {
        if (x.kind == Factor::Kind::Passed) return nullptr;
        const Value& known = values[x.e.index];
        if (known.type == Type::Void || info(known.type).scalar != Scalar::Float) return nullptr;
        for (int i = 1; i < componentCount(known.type); i++)
            if (known.words[i] != known.words[0]) return nullptr;
        v = x.kind == Factor::Kind::Rest ? 1 - known.f(0) : known.f(0);
        return &v;
    }

    void weigh(ExprId id, Lobe& lobe) const {
        std::vector<Term> sum = terms[id.index];
        if (ExprId own = weightOf(id); own && !(isAll(own, 1) && f[own].op == Op::Constant))
            for (Term& term : sum) term.push_back({Factor::Kind::Value, own});
        float total = 0;
        bool isNumber = true;
        for (std::size_t k = 0; k < sum.size(); k++) {
            if (k == kMostTerms) {
                lobe.weight += " + …";
                isNumber = false;
                break;
            }
            float product = 1, v = 0;
            std::string text;
            for (const Factor& x : sum[k]) {
                if (text.size() > kLongest) {
                    text += " * …";
                    isNumber = false;
                    break;
                }
                text += (text.empty() ? "" : " * ") + textOfFactor(x);
                isNumber = isNumber && number(x, v);
                product *= v;
            }
            lobe.weight += (k ? " + " : "") + (text.empty() ? "1" : text);
            total += product;
        }
        Value value;
        value.type = Type::Float;
        value.set(0, total);
        if (isNumber) lobe.value = textOf(value);
    }

    // The values of the document because of which an expression is what it is: of a product that is 0, factors that
    // are.
    std::vector<Decision> inputsOf(ExprId e) const {
        std::vector<Decision> found;
        std::vector<bool> needed(e.index + 1);
        needed[e.index] = true;
        for (std::uint32_t i = e.index + 1; i-- > 0;) {
            if (!needed[i]) continue;
            ExprId id(i);
            if (f[id].op == Op::Uniform) {
                const Uniform* u = module.uniform(Name(f[id].payload));
                if (u && isKnown(id)) found.push_back({u->path, textOf(values[i])});
            }
            bool product = f[id].op == Op::Mul && isAll(id, 0);
            for (ExprId o : f.operandsOf(id))
                if (!product || isAll(o, 0)) needed[o.index] = true;
        }
        std::reverse(found.begin(), found.end());
        if (found.size() > kMostInputs) found.resize(kMostInputs);
        return found;
    }

    Removal removal(const Cut& cut) const {
        if (!cut.by) return {cut.kind, {}, {}, {}};
        return {cut.kind, formula(module, f, cut.by), textOf(values[cut.by.index]), inputsOf(cut.by)};
    }

    Lobe lobe(ExprId id) {
        Lobe made;
        made.node = module.names->text(f.originOf(id));
        made.name = nameOf(id);
        made.leaf = module.names->text(Name(f[id].payload));
        made.remains = isAlive[id.index] && !terms[id.index].empty();
        if (made.remains) {
            weigh(id, made);
            return made;
        }
        if (terms[id.index].empty())
            for (const Cut& cut : cuts[id.index]) made.removals.push_back(removal(cut));
        if (!isAlive[id.index]) made.removals.push_back(removal({Removal::Kind::Weight, weightOf(id)}));
        return made;
    }

    std::vector<Lobe> run() {
        ExprId root = f.results[0].value;
        std::vector<Lobe> all;
        if (!isClosure(f[root].type)) return all;
        markAlive();
        isReached[root.index] = true;
        terms[root.index].push_back({});
        for (std::uint32_t i = root.index + 1; i-- > 0;) {
            if (!isReached[i]) continue;
            if (f.exprs[i].op == Op::Leaf)
                all.push_back(lobe(ExprId(i)));
            else
                descend(ExprId(i));
        }
        return all;
    }
};

}  // namespace

std::vector<Lobe> lobesOf(const Module& module, Name entry) { return Finder{module, *module.findOwn(entry)}.run(); }

}  // namespace shaderx::passes
