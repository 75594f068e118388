#include "passes/cost.h"

#include <algorithm>
#include <map>

#include "ir/builder.h"

namespace shaderx::passes {

using namespace ir;

Work& Work::operator+=(const Work& other) {
    instructions += other.instructions;
    environmentReads += other.environmentReads;
    textureReads += other.textureReads;
    return *this;
}

namespace {

Work times(const Work& w, std::uint32_t n) { return {w.instructions * n, w.environmentReads * n, w.textureReads * n}; }

// How often an expression is computed.
struct Turns {
    std::uint32_t count = 1;
    bool perSample = false;
};

struct Cost {
    Work fixed, perSample;
    void add(const Cost& c, Turns turns) {
        Work f = times(c.fixed, turns.count);
        (turns.perSample ? perSample : fixed) += f;
        perSample += times(c.perSample, turns.count);
    }
};

struct Accountant {
    const Module& module;
    // By function and which of its parameters are maps of the environment.
    std::map<std::pair<Name, std::uint64_t>, Cost> known{};

    static bool isCounted(Op op) {
        switch (op) {
            case Op::Constant:
            case Op::Param:
            case Op::Context:
            case Op::Attribute:
            case Op::Uniform:
            case Op::Retype:
            case Op::Result:
            case Op::LoopArg:
            case Op::Call:
                return false;
            default:
                return true;
        }
    }

    static bool isMap(const Function& f, ExprId texture, std::uint64_t maps) {
        const Expr& e = f[texture];
        return e.op == Op::Context || (e.op == Op::Param && e.payload < 64 && maps >> e.payload & 1);
    }

    // How often each expression is computed, by the loops around it.
    static std::vector<Turns> turnsOf(const Function& f) {
        std::vector<std::uint32_t> loop = loopsOf(f);
        std::vector<std::uint32_t> at(f.loops, kNoLoop);  // the expression of a loop
        for (std::uint32_t i = 0; i < f.exprs.size(); i++)
            if (f.exprs[i].op == Op::Loop) at[f.exprs[i].payload] = i;
        std::vector<Turns> turns(f.exprs.size());
        // A loop stands after what is in it, and belongs to the loop around it: from the end on, outer ones come first.
        for (std::uint32_t i = static_cast<std::uint32_t>(f.exprs.size()); i-- > 0;) {
            if (loop[i] == kNoLoop || at[loop[i]] == kNoLoop) continue;
            std::uint32_t around = at[loop[i]];
            ExprId count = f.operand(ExprId(around), 0);
            turns[i] = turns[around];
            if (f.isConstant(count))
                turns[i].count *= std::max(f.constantWords(count)[0], 1u);
            else if (f[count].op == Op::Context && Context(f[count].payload) == Context::EnvironmentSamples)
                turns[i].perSample = true;
        }
        return turns;
    }

    Cost of(const Function& f, ExprId id, std::uint64_t maps) {
        const Expr& e = f[id];
        Cost c;
        if (isCounted(e.op)) c.fixed.instructions = 1;
        if (e.op == Op::TextureLevel || e.op == Op::TextureGrad)
            (isMap(f, f.operand(id, 0), maps) ? c.fixed.environmentReads : c.fixed.textureReads) = 1;
        if (e.op == Op::Call) {
            std::uint64_t given = 0;
            auto arguments = f.operandsOf(e);
            for (std::size_t k = 0; k < arguments.size() && k < 64; k++)
                if (f[arguments[k]].type == Type::Texture2D && isMap(f, arguments[k], maps)) given |= 1ull << k;
            c = of(*module.findOwn(Name(e.payload)), given);
        }
        return c;
    }

    Cost of(const Function& f, std::uint64_t maps) {
        auto found = known.find({f.name, maps});
        if (found != known.end()) return found->second;
        Cost sum;
        std::vector<bool> live = reachable(f);
        std::vector<Turns> turns = turnsOf(f);
        for (std::uint32_t i = 0; i < f.exprs.size(); i++)
            if (live[i]) sum.add(of(f, ExprId(i), maps), turns[i]);
        return known[{f.name, maps}] = sum;
    }

    std::vector<NodeCost> byNode(const Function& f) {
        std::vector<NodeCost> all;
        std::vector<bool> live = reachable(f);
        std::vector<Turns> turns = turnsOf(f);
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            if (!live[i]) continue;
            Cost c;
            c.add(of(f, ExprId(i), 0), turns[i]);
            if (c.fixed.instructions + c.perSample.instructions == 0) continue;
            std::string_view node = module.names->text(f.originOf(ExprId(i)));
            auto same = std::find_if(all.begin(), all.end(), [&](const NodeCost& n) { return n.node == node; });
            if (same == all.end()) same = all.insert(all.end(), NodeCost{std::string(node), {}, {}});
            same->fixed += c.fixed;
            same->perSample += c.perSample;
        }
        return all;
    }
};

}  // namespace

std::vector<NodeCost> costsByNode(const Module& module, Name entry) {
    return Accountant{module}.byNode(*module.findOwn(entry));
}

}  // namespace shaderx::passes
