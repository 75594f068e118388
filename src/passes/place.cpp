#include "passes/place.h"

#include <algorithm>
#include <unordered_map>

#include "ir/builder.h"

namespace shaderx::passes {

using namespace ir;

bool isFree(const Function& f, ExprId id) {
    const Expr& e = f[id];
    switch (e.op) {
        case Op::Constant:
        case Op::Param:
        case Op::Context:
        case Op::Attribute:
        case Op::Uniform:
        case Op::LoopArg:
        case Op::Result:
            return true;
        case Op::Retype:
        case Op::Neg:
        case Op::Swizzle:
        case Op::Member: {
            const Expr& of = f[f.operand(id, 0)];
            return of.op <= Op::Uniform || of.op == Op::LoopArg || of.op == Op::Result;
        }
        case Op::Make:
            // of one number
            return e.operandCount == 1 &&
                   (f[f.operand(id, 0)].op <= Op::Uniform || f[f.operand(id, 0)].op == Op::LoopArg);
        default:
            return false;  // everything that computes
    }
}

namespace {

constexpr int kMuchWork = 24;  // operations in one side of a select that are worth a branch
constexpr std::uint32_t kNone = 0xffffffffu;

struct Scope {
    std::uint32_t parent, depth;
    std::uint32_t loop;  // number of the loop whose body this is, else kNoLoop
};

// Selects of one condition, decided by one `if`.
struct Branch {
    ExprId condition;
    std::uint32_t scope, position, then, otherwise;  // position: the last of the selects
    std::vector<ExprId> phis;
};

// What is known of a value.
struct Value {
    std::uint32_t scope = kNone;     // where it is computed
    std::uint32_t useScope = kNone;  // common to all uses so far
    std::uint32_t firstUse = kNone;  // lowest user
    std::uint32_t uses = 0;
    std::uint32_t body = kNone;    // of loops
    std::uint32_t branch = kNone;  // of selects
    std::uint32_t users = 0;       // all operands that it is
    int work = 0;                  // operations below it, up to values that are used elsewhere too
    int length = 0;                // of its text
    bool live = false, named = false, conditional = false;
    bool free = false;  // see isFree
};

struct Placer {
    Function& f;
    const PlaceOptions& options;
    std::vector<std::uint32_t> loopOf = f.loops ? loopsOf(f) : std::vector<std::uint32_t>();
    std::size_t n = f.exprs.size();
    std::vector<Scope> scopes{{0, 0, kNoLoop}};
    std::vector<Branch> branches = {};
    std::unordered_map<std::uint64_t, std::uint32_t> latest = {};  // branch by condition and scope
    std::vector<Value> values = std::vector<Value>(n);             // by expression
    bool readsQuads = false;

    void run() {
        markLive();
        measureWork();
        for (const ResultValue& r : f.results) use(r.value, 0, static_cast<std::uint32_t>(n));
        for (std::uint32_t i = static_cast<std::uint32_t>(n); i-- > 0;)
            if (values[i].live && values[i].uses) schedule(ExprId(i));
        nameShared();
        dropEmptyBranches();
        nameLong();
        nameOfQuads();
        emit();
    }

    std::uint32_t loopAt(ExprId e) const { return loopOf.empty() ? kNoLoop : loopOf[e.index]; }
    bool isLoop(ExprId e) const { return f[e].op == Op::Loop || f[e].op == Op::Lights; }

    void markLive() {
        for (const ResultValue& r : f.results) values[r.value.index].live = true;
        for (std::size_t i = n; i-- > 0;) {
            if (!values[i].live) continue;
            values[i].free = isFree(f, ExprId(static_cast<std::uint32_t>(i)));
            for (ExprId o : f.operandsOf(f.exprs[i])) {
                values[o.index].live = true;
                values[o.index].users++;
            }
        }
    }

    // Values that a loop around does not change are not counted; a loop counts as much work.
    void measureWork() {
        for (std::uint32_t i = 0; i < n; i++) {
            Value& v = values[i];
            if (!v.live || v.free) {
                // The results of one loop or call are its work.
                if (v.live && f.exprs[i].op == Op::Result) v.work = values[f.operand(ExprId(i), 0).index].work;
                continue;
            }
            int sum = isLoop(ExprId(i)) ? kMuchWork : 1;
            for (ExprId o : f.operandsOf(f.exprs[i]))
                if ((values[o.index].users <= 1 || f[o].op == Op::Result) && loopAt(o) == loopAt(ExprId(i)))
                    sum += values[o.index].work;
            v.work = std::min(sum, 10000);
        }
    }

    std::uint32_t common(std::uint32_t a, std::uint32_t b) const {
        if (a == kNone) return b;
        while (a != b)
            (scopes[a].depth >= scopes[b].depth ? a : b) = scopes[scopes[a].depth >= scopes[b].depth ? a : b].parent;
        return a;
    }

    void use(ExprId e, std::uint32_t scope, std::uint32_t user) {
        values[e.index].useScope = common(values[e.index].useScope, scope);
        values[e.index].firstUse = std::min(values[e.index].firstUse, user);
        values[e.index].uses++;
    }

    std::uint32_t open(std::uint32_t parent, std::uint32_t loop) {
        scopes.push_back({parent, scopes[parent].depth + 1, loop});
        return static_cast<std::uint32_t>(scopes.size() - 1);
    }

    // The users of `e` are all placed: places it and tells its operands.
    void schedule(ExprId e) {
        const Expr& x = f[e];
        std::uint32_t i = e.index, scope = hoisted(values[i].useScope, loopAt(e));
        if (x.op == Op::Ddx || x.op == Op::Ddy) scope = 0;
        readsQuads = readsQuads || x.op == Op::Ddx || x.op == Op::Ddy || x.op == Op::TextureGrad;
        values[i].scope = scope;
        auto operands = f.operandsOf(e);
        if (isLoop(e)) {
            values[i].body = open(scope, isBranch(e) ? kNoLoop : x.payload);
            std::size_t carried = (operands.size() - (x.op == Op::Loop)) / 2, firstNext = operands.size() - carried;
            for (std::size_t k = 0; k < operands.size(); k++)
                use(operands[k], k < firstNext ? scope : values[i].body, i);
        } else if (x.op == Op::Select && (isMuch(operands[1], e) || isMuch(operands[2], e))) {
            const Branch& b = branchFor(e, scope);
            use(operands[0], scope, i);
            use(operands[1], b.then, i);
            use(operands[2], b.otherwise, i);
        } else {
            std::size_t count = operands.size();
            if (readsImplicitly(e)) count = 2;
            for (std::size_t k = 0; k < count; k++) use(operands[k], scope, i);
        }
    }

    bool isMuch(ExprId side, ExprId select) const {
        return values[side.index].work >= kMuchWork && loopAt(side) == loopAt(select);
    }

    bool readsImplicitly(ExprId e) const {
        if (!options.isEntry || f[e].op != Op::TextureGrad || values[e.index].scope != 0) return false;
        auto o = f.operandsOf(e);
        return f[o[2]].op == Op::Ddx && f.operand(o[2], 0) == o[1] && f[o[3]].op == Op::Ddy &&
               f.operand(o[3], 0) == o[1];
    }

    // A loop of at most one turn is a branch: what only it needs is not worth doing before it.
    bool isBranch(ExprId loop) const {
        if (f[loop].op != Op::Loop) return false;
        ExprId count = f.operand(loop, 0);
        return f[count].op == Op::Convert && f[f.operand(count, 0)].type == Type::Boolean;
    }

    // Out of every loop that the value does not change with.
    std::uint32_t hoisted(std::uint32_t scope, std::uint32_t loop) const {
        std::uint32_t best = scope;
        for (std::uint32_t s = scope; s != 0; s = scopes[s].parent) {
            if (scopes[s].loop == kNoLoop) continue;
            if (loop != kNoLoop && scopes[s].loop <= loop) break;
            best = scopes[s].parent;
        }
        return best;
    }

    // A branch decides a further select of its condition if nothing before the branch needs that select.
    const Branch& branchFor(ExprId e, std::uint32_t scope) {
        ExprId condition = f.operand(e, 0);
        std::uint64_t key = static_cast<std::uint64_t>(condition.index) << 32 | scope;
        if (auto known = latest.find(key);
            known != latest.end() && values[e.index].firstUse > branches[known->second].position) {
            branches[known->second].phis.push_back(e);
            values[e.index].branch = known->second;
            return branches[known->second];
        }
        latest[key] = static_cast<std::uint32_t>(branches.size());
        values[e.index].branch = static_cast<std::uint32_t>(branches.size());
        std::uint32_t then = open(scope, kNoLoop), otherwise = open(scope, kNoLoop);
        branches.push_back({condition, scope, e.index, then, otherwise, {e}});
        return branches.back();
    }

    bool isStatement(std::uint32_t i) const { return values[i].body != kNone || values[i].branch != kNone; }

    // Values used more than once, or computed further out than where they are used.
    void nameShared() {
        for (std::uint32_t i = 0; i < n; i++) {
            if (!values[i].live || !values[i].uses || isStatement(i)) continue;
            bool several = f.exprs[i].type == Type::Tuple;
            values[i].named = several || (!values[i].free && !isView(i) &&
                                          (values[i].uses > 1 || values[i].scope != values[i].useScope));
        }
        // What a loop counts to is asked every turn.
        for (std::uint32_t i = 0; i < n; i++)
            if (values[i].body != kNone && f.exprs[i].op == Op::Loop)
                if (ExprId count = f.operand(ExprId(i), 0); !values[count.index].free && !isStatement(count.index))
                    values[count.index].named = true;
    }

    // A branch with nothing to compute on either side is an expression after all. Images keep the branch they are read
    // in.
    void dropEmptyBranches() {
        if (branches.empty()) return;
        std::vector<bool> isBusy(scopes.size());
        for (std::uint32_t i = 0; i < n; i++)
            if (values[i].live && values[i].uses &&
                (values[i].named || values[i].body != kNone || f.exprs[i].op == Op::TextureGrad))
                isBusy[values[i].scope] = true;
        std::vector<std::uint32_t> now(scopes.size());
        for (std::uint32_t s = 0; s < scopes.size(); s++) now[s] = s;
        for (std::size_t k = branches.size(); k-- > 0;) {  // inner ones first
            Branch& b = branches[k];
            if (isBusy[b.then] || isBusy[b.otherwise]) {
                isBusy[b.scope] = true;
                continue;
            }
            now[b.then] = now[b.otherwise] = b.scope;
            for (ExprId phi : b.phis) {
                values[phi.index].branch = kNone;
                values[phi.index].named =
                    values[phi.index].uses > 1 || values[phi.index].scope != values[phi.index].useScope;
                if (values[phi.index].named) isBusy[b.scope] = true;
            }
            b.phis.clear();
        }
        for (Value& v : values)
            while (v.scope != kNone && now[v.scope] != v.scope) v.scope = now[v.scope];
    }

    // Characters in the text of a value that costs nothing to name again, roughly.
    int nameLength(Name name, int otherwise) const {
        return options.names && name ? static_cast<int>(options.names->text(name).size()) : otherwise;
    }
    // Of a function's name, without the number that clones have.
    int stemLength(Name name) const {
        if (!options.names) return 16;
        std::string_view text = options.names->text(name);
        return static_cast<int>(std::min(text.find('@'), text.size()));
    }
    int freeLength(const Expr& e) const {
        switch (e.op) {
            case Op::Constant:
                return 6 + (componentCount(e.type) > 1 ? 8 * componentCount(e.type) : 0);
            case Op::Context:
                return static_cast<int>(info(static_cast<Context>(e.payload)).host.size()) + 3;
            case Op::Uniform:
            case Op::Attribute:
                return nameLength(Name(e.payload), 16);
            case Op::Param:
                return nameLength(f.params[e.payload].name, 8);
            default:
                return 8;  // a name
        }
    }

    // A part, the negative or another role of a value that has a name.
    bool isView(std::uint32_t i) const {
        Op op = f.exprs[i].op;
        if (op != Op::Neg && op != Op::Swizzle && op != Op::Retype) return false;
        std::uint32_t of = f.operand(ExprId(i), 0).index;
        return values[of].named || isStatement(of);
    }

    // What a side of a select computes is named: written into the select, it makes a branch of that in most compilers
    // of shading languages.
    void nameSides(std::span<const ExprId> operands) {
        for (ExprId side : operands.subspan(1)) {
            Value& v = values[side.index];
            const Expr& e = f[side];
            const bool isSimple = v.free || v.work <= 1 || isView(side.index) || e.op == Op::Select;
            if (!isSimple && !isStatement(side.index) && e.op != Op::TextureGrad) v.named = true;
        }
    }

    // Splits long expressions: names the longest part, one with a name of its own before others.
    void nameLong() {
        constexpr int kName = 8, kOperation = 4;
        auto lengthOf = [&](ExprId o) {
            return values[o.index].named || isStatement(o.index) ? nameLength(f.hints[o.index], kName)
                                                                 : values[o.index].length;
        };
        for (std::uint32_t i = 0; i < n; i++) {
            if (!values[i].live || !values[i].uses) continue;
            if (values[i].free) {
                values[i].length = freeLength(f.exprs[i]);
                continue;
            }
            if (isStatement(i)) continue;  // its operands stand in lines of their own
            auto operands = f.operandsOf(f.exprs[i]);
            if (f.exprs[i].op == Op::Select) nameSides(operands);
            bool isCall = f.exprs[i].op == Op::Call;
            int own =
                isCall ? kOperation + stemLength(Name(f.exprs[i].payload)) + 2 * f.exprs[i].operandCount : kOperation;
            for (;;) {
                int sum = own;
                ExprId longest;
                int score = 3 * kName;
                for (ExprId o : operands) {
                    int l = lengthOf(o);
                    sum += l;
                    const Value& v = values[o.index];
                    if (v.named || isStatement(o.index) || v.free || f[o].type == Type::Tuple) continue;
                    int s = l + (f.hints[o.index] ? 2 * kName : 0);
                    if (s > score) {
                        score = s;
                        longest = o;
                    }
                }
                values[i].length = sum;
                const bool isPart = f.exprs[i].op == Op::Swizzle || f.exprs[i].op == Op::Retype;
                if (sum <= options.longestText || !longest || isPart) break;
                values[longest.index].named = true;
            }
        }
    }

    // What needs the neighbouring pixels must not stand where only some pixels come by: on one side of a select that is
    // an expression, after an `and` or `or`, in the bound of a loop.
    void nameOfQuads() {
        if (!readsQuads) return;
        for (std::uint32_t i = static_cast<std::uint32_t>(n); i-- > 0;) {
            if (!values[i].live || !values[i].uses) continue;
            Op op = f.exprs[i].op;
            if (values[i].conditional && (op == Op::Ddx || op == Op::Ddy || readsImplicitly(ExprId(i))))
                values[i].named = true;
            bool inherits = values[i].conditional && !values[i].named && !isStatement(i);
            auto operands = f.operandsOf(f.exprs[i]);
            for (std::size_t k = 0; k < operands.size(); k++) {
                bool side = (op == Op::Select && values[i].branch == kNone && k > 0) ||
                            ((op == Op::And || op == Op::Or) && k == 1) || (op == Op::Loop && k == 0);
                if (side || inherits) values[operands[k].index].conditional = true;
            }
        }
    }

    void emit() {
        Body& body = f.body;
        body = {};
        body.blocks.resize(scopes.size());
        std::vector<std::pair<std::uint32_t, Stmt>> all;  // with the position
        for (std::uint32_t i = 0; i < n; i++) {
            if (!values[i].live || !values[i].uses) continue;
            if (values[i].body != kNone)
                all.push_back({i, {StmtKind::Loop, ExprId(i), BlockId(values[i].body), {}, 0, 0}});
            else if (values[i].named)
                all.push_back({i, {StmtKind::Let, ExprId(i), {}, {}, 0, 0}});
        }
        for (Branch& b : branches) {
            if (b.phis.empty()) continue;
            std::sort(b.phis.begin(), b.phis.end());
            Stmt s{StmtKind::If,
                   b.condition,
                   BlockId(b.then),
                   BlockId(b.otherwise),
                   static_cast<std::uint32_t>(body.phis.size()),
                   static_cast<std::uint32_t>(b.phis.size())};
            body.phis.insert(body.phis.end(), b.phis.begin(), b.phis.end());
            all.push_back({b.position, s});
        }
        std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        for (auto& [position, s] : all) {
            std::uint32_t scope = s.kind == StmtKind::If ? scopes[s.body.index].parent : values[s.expr.index].scope;
            body.blocks[scope].push_back(s);
        }
    }
};

}  // namespace

void place(Function& function, const PlaceOptions& options) { Placer{function, options}.run(); }

}  // namespace shaderx::passes
