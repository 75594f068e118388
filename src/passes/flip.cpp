#include "passes/flip.h"

#include <set>
#include <utility>

#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

struct Flip {
    Module& module;
    std::set<std::pair<Name, std::uint32_t>> given{};  // parameters that get a texture of the document

    bool isOurs(const Function& f, ExprId texture) const {
        const Expr& e = f[texture];
        return e.op == Op::Uniform || (e.op == Op::Param && given.count({f.name, e.payload}));
    }

    // Follows textures through calls; true if a parameter was new.
    bool follow(const Function& f) {
        bool found = false;
        for (const Expr& e : f.exprs) {
            if (e.op != Op::Call) continue;
            auto arguments = f.operandsOf(e);
            for (std::uint32_t k = 0; k < arguments.size(); k++)
                if (f[arguments[k]].type == Type::Texture2D && isOurs(f, arguments[k]))
                    found = given.insert({Name(e.payload), k}).second || found;
        }
        return found;
    }

    static bool isRead(const Expr& e) { return e.op == Op::TextureLevel || e.op == Op::TextureGrad; }

    void rewrite(Function& f) {
        Function fresh = headOf(f);
        Builder b(module, fresh);
        Copy copy(f, b);
        std::vector<bool> live = reachable(f);
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            ExprId id(i);
            if (!live[i]) continue;
            if (isRead(f.exprs[i]) && isOurs(f, f.operand(id, 0)))
                copy.set(id, flipped(f, b, copy, id));
            else
                copy.one(id);
        }
        for (const ResultValue& r : f.results) b.addResult(r.name, copy[r.value]);
        compact(fresh);
        f = std::move(fresh);
    }

    ExprId flipped(const Function& f, Builder& b, Copy& copy, ExprId read) {
        ExprId old = f.operand(read, 1), uv = copy[old];
        ExprId at = b.make(Type::Vector2, {b.component(uv, 0), b.op(Op::Sub, {b.number(1), b.component(uv, 1)})});
        auto gradient = [&](std::size_t k) {
            ExprId g = f.operand(read, k);
            Op op = f[g].op;
            // The derivative of the coordinates stays one: the printer may then say so in fewer words.
            if ((op == Op::Ddx || op == Op::Ddy) && f.operand(g, 0) == old) return b.op(op, {at});
            ExprId d = copy[g];
            return b.make(Type::Vector2, {b.component(d, 0), b.op(Op::Neg, {b.component(d, 1)})});
        };
        const Expr& e = f[read];
        ExprId texture = copy[f.operand(read, 0)], made;
        if (e.op == Op::TextureLevel)
            made = b.emit(e.op, e.type, {texture, at, copy[f.operand(read, 2)]});
        else
            made = b.emit(e.op, e.type, {texture, at, gradient(2), gradient(3)});
        if (Name hint = f.hints[read.index]) b.hint(made, hint);
        return made;
    }

    void run() {
        for (bool more = true; more;) {
            more = false;
            for (const auto& f : module.functions) more = follow(*f) || more;
        }
        for (const auto& f : module.functions) {
            bool reads = false;
            for (std::uint32_t i = 0; i < f->exprs.size(); i++)
                reads = reads || (isRead(f->exprs[i]) && isOurs(*f, f->operand(ExprId(i), 0)));
            if (reads) rewrite(*f);
        }
    }
};

}  // namespace

void flipTextures(Module& module) { Flip{module}.run(); }

}  // namespace shaderx::passes
