#include "passes/topology.h"

#include <algorithm>
#include <bit>

#include "ir/evaluate.h"

namespace shaderx::passes {

using namespace ir;

namespace {

struct Topology {
    const Module& module;
    const Function& f;
    std::vector<Value> values = std::vector<Value>(f.exprs.size());  // by the defaults; Void where not known
    std::vector<bool> decides = std::vector<bool>(f.exprs.size());   // its value is why something vanishes
    std::unordered_set<Name> found = {};
    bool onlyAttributes = false;  // whether choices between attributes are all that matters

    void evaluateAll() {
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) evaluateOne(ExprId(i));
    }

    void run() {
        evaluateAll();
        // Users stand after their operands, so one pass from the end meets every reason after what it is a reason for.
        for (std::uint32_t i = static_cast<std::uint32_t>(f.exprs.size()); i-- > 0;) {
            onlyAttributes ? seedAttributes(ExprId(i)) : seed(ExprId(i));
            if (decides[i]) follow(ExprId(i));
        }
    }

    bool all(ExprId e, float v) const {
        const Value& x = values[e.index];
        if (x.type == Type::Void) return false;
        std::uint32_t bits = info(x.type).scalar == Scalar::Float ? std::bit_cast<std::uint32_t>(v)
                                                                  : static_cast<std::uint32_t>(static_cast<int>(v));
        for (int i = 0; i < componentCount(x.type); i++)
            if (x.words[i] != bits) return false;
        return true;
    }

    void evaluateOne(ExprId id) {
        const Expr& e = f[id];
        Value& out = values[id.index];
        if (e.op == Op::Constant && componentCount(e.type)) {
            out.type = e.type;
            std::copy_n(f.constantWords(id).begin(), componentCount(e.type), out.words);
        } else if (e.op == Op::Uniform && componentCount(e.type)) {
            if (const Uniform* u = module.uniform(Name(e.payload))) {
                out.type = e.type;
                std::copy_n(u->values.begin(), componentCount(e.type), out.words);
            }
        } else {
            compute(id, out);
        }
    }

    void compute(ExprId id, Value& out) {
        const Expr& e = f[id];
        if (e.operandCount == 0 || e.operandCount > 8 || componentCount(e.type) == 0) return;
        if (e.op == Op::Mul && (all(f.operand(id, 0), 0) || all(f.operand(id, 1), 0))) {
            out.type = e.type;  // whatever the other factor is
            return;
        }
        Value operands[8];
        for (std::size_t k = 0; k < e.operandCount; k++) {
            operands[k] = values[f.operand(id, k).index];
            if (operands[k].type == Type::Void) return;
        }
        Value result;
        if (evaluate(e.op, e.type, std::span(operands, e.operandCount), e.payload, result)) out = result;
    }

    void seedAttributes(ExprId id) {
        if (f[id].op != Op::Select || values[f.operand(id, 0).index].type == Type::Void) return;
        if (f[f.operand(id, 1)].op == Op::Attribute || f[f.operand(id, 2)].op == Op::Attribute)
            decides[f.operand(id, 0).index] = true;
    }

    // What vanishes by the value of an operand.
    void seed(ExprId id) {
        const Expr& e = f[id];
        auto because = [&](ExprId o) { decides[o.index] = true; };
        switch (e.op) {
            case Op::Uniform:
                if (info(e.type).scalar == Scalar::Boolean) found.insert(Name(e.payload));
                return;
            case Op::ClosureMix:
                if (all(f.operand(id, 2), 0) || all(f.operand(id, 2), 1)) because(f.operand(id, 2));
                return;
            case Op::ClosureScale:
                if (all(f.operand(id, 1), 0)) because(f.operand(id, 1));
                return;
            case Op::Leaf:
                return seedLeaf(id);
            case Op::Select:
                if (values[f.operand(id, 0).index].type != Type::Void) because(f.operand(id, 0));
                return;
            case Op::Loop:
                if (values[f.operand(id, 0).index].type != Type::Void) because(f.operand(id, 0));
                return;
            default:
                return;  // nothing vanishes
        }
    }

    // A leaf of weight 0 goes, and light of colour 0; any other number among its inputs that is exactly 0 may spare its
    // functions a branch, as does a roughness that is the same in all directions.
    void seedLeaf(ExprId id) {
        bool light = f[id].type == Type::EDF;
        for (ExprId o : f.operandsOf(id)) {
            bool number = isScalar(f[o].type) || (light && isVector(f[o].type));
            if ((number && all(o, 0)) || sameComponents(o)) decides[o.index] = true;
        }
    }

    // A vector of equal components by its defaults: an isotropic roughness.
    bool sameComponents(ExprId e) const {
        const Value& v = values[e.index];
        if (v.type != Type::Vector2) return false;
        return v.words[0] == v.words[1] && f[e].op == Op::Make && f[e].operandCount > 1;
    }

    // The operands that are the reason for a value.
    void follow(ExprId id) {
        const Expr& e = f[id];
        if (e.op == Op::Uniform) {
            const Value& v = values[id.index];
            bool bound = info(e.type).scalar == Scalar::Integer;
            bool settled = bound || (!onlyAttributes && (all(id, 0) || all(id, 1)));
            if (v.type != Type::Void && settled) found.insert(Name(e.payload));
            return;
        }
        auto operands = f.operandsOf(id);
        bool product = e.op == Op::Mul && all(id, 0);
        for (ExprId o : operands)
            if (!product || all(o, 0)) decides[o.index] = true;
    }
};

}  // namespace

std::unordered_set<Name> topologyUniforms(const Module& module, const Function& entry) {
    Topology t{module, entry};
    t.run();
    return t.found;
}

std::unordered_set<Name> attributeUniforms(const Module& module, const Function& entry) {
    Topology t{module, entry};
    t.onlyAttributes = true;
    t.run();
    return t.found;
}

std::vector<Value> valuesByDefault(const Module& module, const Function& f) {
    Topology t{module, f};
    t.evaluateAll();
    return std::move(t.values);
}

}  // namespace shaderx::passes
