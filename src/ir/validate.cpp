#include "ir/validate.h"

#include <algorithm>
#include <unordered_map>

#include <fmt/format.h>

#include "ir/builder.h"
#include "ir/evaluate.h"
#include "ir/text.h"

namespace shaderx::ir {
namespace {

constexpr std::size_t kMaxErrors = 20;  // of one function
constexpr std::uint32_t kMaxLoops = 1u << 24;

// Operands of a loop before the first values.
std::size_t beforeCarried(const Expr& e) { return e.op == Op::Loop ? 1 : 0; }
bool isLoop(const Expr& e) { return e.op == Op::Loop || e.op == Op::Lights; }

struct Validator {
    const Module& module;
    const Function& f;
    Diagnostics& diagnostics;
    std::size_t errors = 0;
    std::vector<bool> live = {};
    std::vector<ExprId> loopExprs = {};     // by loop number, those that results need
    std::vector<std::uint32_t> loops = {};  // see loopsOf
    std::unordered_map<Name, Type> uniforms = {};

    static constexpr int kWhole = -1, kAllOperands = -2;

    // ---- Reporting ----

    // A broken rule at an expression, or at one of its operands.
    void fail(ExprId e, int operand, std::string message) {
        if (errors++ >= kMaxErrors) return;
        std::vector<std::size_t> columns;
        const std::string line = printExpr(module, f, e, &columns);
        std::size_t from = 0, to = line.size();
        if (operand >= 0 && static_cast<std::size_t>(operand) < columns.size()) {
            from = columns[static_cast<std::size_t>(operand)];
            to = std::min(line.find_first_of(", ", from), line.size());
        } else if (operand == kAllOperands && !columns.empty()) {
            from = columns.front();
            to = std::min(line.find_first_of(", ", columns.back()), line.size());
        }
        Diagnostic& d = diagnostics.add(Severity::Internal, "invalid-ir", std::move(message));
        d.notes.push_back({{},
                           fmt::format("in {}:\n    {}\n    {}{}", module.names->text(f.name), line,
                                       std::string(from, ' '), std::string(std::max<std::size_t>(to - from, 1), '^'))});
    }

    // A broken rule of the function itself.
    void fail(std::string message) {
        if (errors++ >= kMaxErrors) return;
        Diagnostic& d = diagnostics.add(Severity::Internal, "invalid-ir", std::move(message));
        d.notes.push_back({{}, fmt::format("in {}", module.names->text(f.name))});
    }

    std::string typeName(Type t) const {
        const std::size_t i = static_cast<std::size_t>(t) - static_cast<std::size_t>(Type::FirstStruct);
        if (t < Type::FirstStruct) return std::string(info(t).name);
        return i < module.structs.size() ? std::string(module.names->text(module.structs[i].name)) : "no type";
    }
    bool isType(Type t) const {
        return static_cast<std::size_t>(t) < static_cast<std::size_t>(Type::FirstStruct) + module.structs.size();
    }
    bool isName(std::uint32_t payload) const { return payload < module.names->size(); }

    Type type(ExprId e) const { return f[e].type; }
    Type operandType(ExprId e, int k) const { return type(f.operand(e, static_cast<std::size_t>(k))); }

    void expectType(ExprId e, Type wanted) {
        if (type(e) != wanted)
            fail(e, kWhole, fmt::format("the type is {}, not {}", typeName(wanted), typeName(type(e))));
    }
    void expectOperand(ExprId e, int k, Type wanted) {
        const Type is = operandType(e, k);
        if (is != wanted) fail(e, k, fmt::format("operand {} is {}, not {}", k + 1, typeName(is), typeName(wanted)));
    }

    // ---- Arenas: what must hold before anything else may be looked at ----

    void arenas() {
        if (f.hints.size() != f.exprs.size()) fail("there is not one hint for each expression");
        if (f.loops > kMaxLoops) fail("there are more loops than a payload can number");
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) arena(ExprId(i));
        for (const Param& p : f.params)
            if (!isName(p.name.index) || !isType(p.type)) fail("a parameter has no name or no type");
        for (const ResultValue& r : f.results)
            if (r.value.index >= f.exprs.size() || !isName(r.name.index)) fail("a result has no name or no value");
    }

    void arena(ExprId id) {
        const Expr& e = f[id];
        if (static_cast<int>(e.op) >= kOps) return fail(id, kWhole, "no such operation");
        if (!isType(e.type) || e.type == Type::Void) return fail(id, kWhole, "no such type of a value");
        if (static_cast<std::size_t>(e.firstOperand) + e.operandCount > f.operands.size())
            return fail(id, kWhole, "the operands lie outside the arena");
        for (int k = 0; k < e.operandCount; k++)
            if (!(f.operand(id, static_cast<std::size_t>(k)) < id))
                return fail(id, k, fmt::format("operand {} does not stand before its user", k + 1));
        const int wanted = info(e.op).operands;
        if (wanted >= 0 && wanted != e.operandCount)
            return fail(id, kAllOperands,
                        fmt::format("{} takes {} operands, not {}", info(e.op).name, wanted, e.operandCount));
        if (e.op == Op::LoopArg && e.payload >> 8 >= f.loops) return fail(id, kWhole, "no such loop in the function");
        if (isLoop(e) && e.payload >= f.loops) return fail(id, kWhole, "no such loop in the function");
        if (isLoop(e) && (e.operandCount < beforeCarried(e) || (e.operandCount - beforeCarried(e)) % 2))
            return fail(id, kAllOperands, "a loop takes as many next values as first values");
        if (e.op == Op::Constant && e.payload + static_cast<std::size_t>(componentCount(e.type)) > f.words.size() &&
            componentCount(e.type) > 0)
            return fail(id, kWhole, "the words lie outside the arena");
    }

    // ---- Types ----

    void expr(ExprId id) {
        const Expr& e = f[id];
        const std::size_t before = errors;
        for (int k = 0; k < e.operandCount; k++)
            if (operandType(id, k) == Type::Tuple && e.op != Op::Result)
                fail(id, k, "only result reads the results of a call or loop");
        if (errors != before) return;
        special(id);
        if (errors != before || info(e.op).rule == TypeRule::Given) return;
        std::vector<Type> types;
        for (ExprId o : f.operandsOf(id)) types.push_back(type(o));
        const Type follows = resultType(e.op, types);
        if (follows != e.type)
            fail(id, kWhole, fmt::format("the type that follows is {}, not {}", typeName(follows), typeName(e.type)));
    }

    // The rules of single operations.
    void special(ExprId id) {
        const Expr& e = f[id];
        switch (e.op) {
            case Op::Constant:
                return constant(id);
            case Op::Param:
                if (e.payload >= f.params.size()) return fail(id, kWhole, "no such parameter");
                return expectType(id, f.params[e.payload].type);
            case Op::Context:
                if (e.payload >= static_cast<std::uint32_t>(kContexts)) return fail(id, kWhole, "no such context");
                return expectType(id, info(static_cast<Context>(e.payload)).type);
            case Op::Attribute:
                if (!isName(e.payload)) fail(id, kWhole, "an attribute without a name");
                return;
            case Op::Uniform:
                return uniform(id);
            case Op::GeomProp:
                return expectOperand(id, 0, Type::String);
            case Op::Member:
                return member(id);
            case Op::TextureLevel:
            case Op::TextureGrad:
            case Op::TextureSize:
                return texture(id);
            case Op::Ddx:
            case Op::Ddy:
                if (info(e.type).scalar != Scalar::Float) fail(id, 0, "only floats have derivatives");
                return;
            case Op::Call:
                return call(id);
            case Op::Result:
                return result(id);
            case Op::LoopArg:
                return;  // see loopArg
            case Op::Loop:
            case Op::Lights:
                return loop(id);
            case Op::ExternText:
                if (e.payload >= module.externs.size()) fail(id, kWhole, "no such text");
                return;
            case Op::Leaf:
                return leaf(id);
            case Op::ClosureMix:
            case Op::ClosureAdd:
            case Op::ClosureScale:
            case Op::ClosureLayer:
                return closure(id);
            case Op::Surface:
                return shader(id, Type::SurfaceShader, {Type::BSDF, Type::EDF, Type::Float, Type::Boolean});
            case Op::SurfaceUnlit:
                return shader(id, Type::SurfaceShader, {Type::Color3, Type::Color3, Type::Float});
            case Op::Volume:
                return shader(id, Type::VolumeShader, {Type::VDF, Type::EDF});
            case Op::Displacement:
                if (operandType(id, 0) != Type::Float) expectOperand(id, 0, Type::Vector3);
                expectOperand(id, 1, Type::Float);
                return expectType(id, Type::DisplacementShader);
            case Op::Equal:
            case Op::NotEqual:
                if (operandType(id, 0) == Type::String) return expectOperand(id, 1, Type::String);
                return executable(id);
            case Op::Select:
                expectOperand(id, 0, Type::Boolean);
                expectOperand(id, 1, e.type);
                return expectOperand(id, 2, e.type);
            case Op::Neg:
            case Op::Add:
            case Op::Sub:
            case Op::Mul:
            case Op::Div:
            case Op::Mod:
            case Op::Min:
            case Op::Max:
            case Op::Pow:
            case Op::Atan2:
            case Op::Step:
            case Op::Clamp:
            case Op::Mix:
            case Op::Smoothstep:
            case Op::Abs:
            case Op::Sign:
            case Op::Floor:
            case Op::Ceil:
            case Op::Round:
            case Op::Fract:
            case Op::Exp:
            case Op::Exp2:
            case Op::Log:
            case Op::Log2:
            case Op::Sqrt:
            case Op::InverseSqrt:
            case Op::Sin:
            case Op::Cos:
            case Op::Tan:
            case Op::Asin:
            case Op::Acos:
            case Op::Atan:
            case Op::Radians:
            case Op::Degrees:
            case Op::Dot:
            case Op::Cross:
            case Op::Length:
            case Op::Distance:
            case Op::Normalize:
            case Op::Reflect:
            case Op::Refract:
            case Op::Faceforward:
            case Op::MulMatrix:
            case Op::Transpose:
            case Op::Inverse:
            case Op::Determinant:
            case Op::BitAnd:
            case Op::BitOr:
            case Op::BitXor:
            case Op::BitNot:
            case Op::ShiftLeft:
            case Op::ShiftRight:
            case Op::ShiftRightLogical:
            case Op::Less:
            case Op::LessEqual:
            case Op::And:
            case Op::Or:
            case Op::Not:
            case Op::Known:
            case Op::Make:
                if (isStruct(e.type)) return structure(id);
                return executable(id);
            case Op::Swizzle:
            case Op::Convert:
            case Op::Retype:
            case Op::Index:
                return executable(id);
        }
    }

    // Whether an operation can be executed on operands of these types.
    static bool fits(const Expr& e, std::span<const Type> types) {
        static constexpr std::uint32_t kZeros[16] = {};
        std::uint32_t out[16];
        std::vector<Operand> operands;
        for (Type t : types) operands.push_back({t, kZeros});
        return execute(e.op, e.type, operands, e.payload, out);
    }

    // What can be executed says itself which types it takes. The operand to blame is the first that would fit with
    // another type.
    void executable(ExprId id) {
        const Expr& e = f[id];
        std::vector<Type> types;
        for (ExprId o : f.operandsOf(id)) types.push_back(type(o));
        bool isShader = types.size() == 1 && (types[0] == Type::SurfaceShader || types[0] == Type::VolumeShader);
        if (e.op == Op::Retype && e.type == Type::Material && isShader) return;  // a material is its shader
        if (fits(e, types)) return;
        std::string said;
        for (Type t : types) said += fmt::format("{}{}", said.empty() ? "" : ", ", typeName(t));
        const std::string message = fmt::format("{} to {} does not take {}", info(e.op).name, typeName(e.type), said);
        for (std::size_t k = 0; k < types.size(); k++)
            for (int t = 0; t < kBuiltinTypes; t++) {
                std::vector<Type> other = types;
                other[k] = static_cast<Type>(t);
                if (fits(e, other)) return fail(id, static_cast<int>(k), message);
            }
        fail(id, kAllOperands, message);
    }

    void constant(ExprId id) {
        const Expr& e = f[id];
        if (e.type == Type::Tuple) return fail(id, kWhole, "a constant of this type");
        if (e.type == Type::String && !isName(e.payload)) return fail(id, kWhole, "a string that is no name");
        if (e.type == Type::Boolean && f.constantWords(id)[0] > 1) fail(id, kWhole, "a truth value is 0 or 1");
    }

    void uniform(ExprId id) {
        const auto it = uniforms.find(Name(f[id].payload));
        if (it == uniforms.end()) return fail(id, kWhole, "no such uniform");
        expectType(id, it->second);
    }

    void member(ExprId id) {
        const Type from = operandType(id, 0);
        if (from < Type::FirstStruct) return fail(id, 0, "only structures have members");
        const StructType& s = module.structs[structIndex(from)];
        if (f[id].payload >= s.members.size()) return fail(id, kWhole, "no such member");
        expectType(id, s.members[f[id].payload].type);
    }

    void structure(ExprId id) {
        const StructType& s = module.structs[structIndex(f[id].type)];
        if (s.members.size() != f[id].operandCount)
            return fail(id, kWhole, "not as many values as the structure has members");
        for (int k = 0; k < f[id].operandCount; k++) expectOperand(id, k, s.members[static_cast<std::size_t>(k)].type);
    }

    void texture(ExprId id) {
        const Expr& e = f[id];
        expectOperand(id, 0, Type::Texture2D);
        if (e.op == Op::TextureSize) return expectType(id, Type::Vector2);
        expectOperand(id, 1, Type::Vector2);
        expectOperand(id, 2, e.op == Op::TextureLevel ? Type::Float : Type::Vector2);
        if (e.op == Op::TextureGrad) expectOperand(id, 3, Type::Vector2);
        if (info(e.type).scalar != Scalar::Float || isMatrix(e.type))
            fail(id, kWhole, fmt::format("an image has no {}", typeName(e.type)));
    }

    void call(ExprId id) {
        const Expr& e = f[id];
        const Function* callee = isName(e.payload) ? module.find(Name(e.payload)) : nullptr;
        if (!callee) return fail(id, kWhole, "no such function");
        if (callee->params.size() != e.operandCount)
            return fail(id, kAllOperands,
                        fmt::format("the function takes {} values, not {}", callee->params.size(), e.operandCount));
        for (int k = 0; k < e.operandCount; k++) expectOperand(id, k, callee->params[static_cast<std::size_t>(k)].type);
        if (e.type == Type::Tuple) return;
        if (callee->results.size() != 1) return fail(id, kWhole, "the function does not have one result");
        expectType(id, callee->results[0].type);
    }

    void result(ExprId id) {
        const ExprId from = f.operand(id, 0);
        const Expr& e = f[from];
        const std::uint32_t k = f[id].payload;
        if (e.type != Type::Tuple) return fail(id, 0, "not the results of a call or loop");
        if (isLoop(e)) {
            if (k >= (e.operandCount - beforeCarried(e)) / 2) return fail(id, kWhole, "the loop has no such result");
            return expectType(id, type(f.operand(from, beforeCarried(e) + k)));
        }
        if (e.op == Op::ExternText) return;
        const Function* callee = e.op == Op::Call && isName(e.payload) ? module.find(Name(e.payload)) : nullptr;
        if (!callee) return fail(id, 0, "not the results of a call or loop");
        if (k >= callee->results.size()) return fail(id, kWhole, "the function has no such result");
        expectType(id, callee->results[k].type);
    }

    void loop(ExprId id) {
        const Expr& e = f[id];
        const std::size_t first = beforeCarried(e), carried = (e.operandCount - first) / 2;
        if (e.op == Op::Loop) expectOperand(id, 0, Type::Integer);
        if (carried > 255) fail(id, kWhole, "a loop carries 255 values at most");
        for (std::size_t i = 0; i < carried; i++)
            expectOperand(id, static_cast<int>(first + carried + i), type(f.operand(id, first + i)));
        if (e.type == Type::Tuple) return;
        if (carried != 1) return fail(id, kWhole, "a loop that does not carry one value has several results");
        expectType(id, operandType(id, static_cast<int>(first)));
    }

    void leaf(ExprId id) {
        const Expr& e = f[id];
        const LeafInfo* known = isName(e.payload) ? module.leaf(Name(e.payload)) : nullptr;
        if (!known) return fail(id, kWhole, "no such leaf");
        if (!isClosure(e.type)) fail(id, kWhole, "a leaf is a closure");
        if (known->params.size() != e.operandCount)
            return fail(id, kAllOperands,
                        fmt::format("the leaf takes {} values, not {}", known->params.size(), e.operandCount));
        for (int k = 0; k < e.operandCount; k++) expectOperand(id, k, known->params[static_cast<std::size_t>(k)].type);
    }

    void closure(ExprId id) {
        const Expr& e = f[id];
        if (!isClosure(e.type)) return fail(id, 0, "not a closure");
        if (e.op == Op::ClosureMix) expectOperand(id, 2, Type::Float);
        if (e.op == Op::ClosureMix || e.op == Op::ClosureAdd) return expectOperand(id, 1, e.type);
        if (e.op == Op::ClosureScale && operandType(id, 1) != Type::Float) return expectOperand(id, 1, Type::Color3);
        if (e.op == Op::ClosureLayer && operandType(id, 1) != Type::VDF) expectOperand(id, 1, Type::BSDF);
    }

    void shader(ExprId id, Type made, std::initializer_list<Type> wanted) {
        int k = 0;
        for (Type t : wanted) expectOperand(id, k++, t);
        expectType(id, made);
    }

    // ---- Loops ----

    void scopes() {
        live = reachable(f);
        loops = loopsOf(f);
        loopExprs.assign(f.loops, {});
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            if (!live[i] || !isLoop(f.exprs[i])) continue;
            ExprId& known = loopExprs[f.exprs[i].payload];
            if (known) fail(ExprId(i), kWhole, fmt::format("loop {} is closed twice", f.exprs[i].payload));
            known = ExprId(i);
        }
        for (std::uint32_t i = 0; i < f.exprs.size(); i++)
            if (live[i]) scope(ExprId(i));
        for (const ResultValue& r : f.results) {
            if (type(r.value) != r.type)
                fail(r.value, kWhole, fmt::format("the result is declared as {}", typeName(r.type)));
            if (r.type == Type::Tuple) fail(r.value, kWhole, "only result reads the results of a call or loop");
            if (loops[r.value.index] != kNoLoop)
                fail(r.value, kWhole,
                     fmt::format("a result depends on an argument of loop {} outside it", loops[r.value.index]));
        }
    }

    void scope(ExprId id) {
        const Expr& e = f[id];
        if (e.op == Op::LoopArg) return loopArg(id);
        if ((e.op == Op::Ddx || e.op == Op::Ddy) && loops[id.index] != kNoLoop)
            return fail(id, 0, "a derivative inside a loop");
        if (!isLoop(e)) return;
        const std::size_t outside = beforeCarried(e) + (e.operandCount - beforeCarried(e)) / 2;
        for (std::size_t k = 0; k < e.operandCount; k++) {
            const std::uint32_t in = loops[f.operand(id, k).index];
            if (in == kNoLoop || in < e.payload || (in == e.payload && k >= outside)) continue;
            fail(id, static_cast<int>(k),
                 fmt::format("operand {} depends on an argument of loop {} outside it", k + 1, in));
        }
    }

    void loopArg(ExprId id) {
        const std::uint32_t number = f[id].payload >> 8, k = f[id].payload & 255;
        const ExprId loopId = loopExprs[number];
        if (!loopId) return fail(id, kWhole, fmt::format("an argument of loop {}, which is never closed", number));
        const std::size_t first = beforeCarried(f[loopId]), carried = (f[loopId].operandCount - first) / 2;
        if (k == 0) return expectType(id, Type::Integer);
        if (k > carried) return fail(id, kWhole, fmt::format("loop {} carries {} values", number, carried));
        expectType(id, type(f.operand(loopId, first + k - 1)));
    }

    // ---- Body ----

    struct Frame {
        BlockId block;
        std::size_t next = 0, undo = 0;  // undo: names given before the block began
        bool inElse = false;
    };
    std::vector<bool> named = {};      // somewhere in the body
    std::vector<bool> available = {};  // at the statement under way
    std::vector<ExprId> given = {};    // names in the order in which they became available
    std::vector<bool> runs = {};       // loops around the statement under way
    std::vector<std::uint32_t> seen = {};
    std::uint32_t walk = 0;

    void give(ExprId e) {
        available[e.index] = true;
        given.push_back(e);
    }

    // Everything that computing e here needs must be named or computable here.
    void use(ExprId e, bool itsOperands = false) {
        walk++;
        std::vector<ExprId> stack;
        if (itsOperands)
            stack.assign(f.operandsOf(e).begin(), f.operandsOf(e).end());
        else
            stack.push_back(e);
        while (!stack.empty()) {
            const ExprId x = stack.back();
            stack.pop_back();
            if (available[x.index] || seen[x.index] == walk) continue;
            seen[x.index] = walk;
            if (isLoop(f[x])) {
                fail(x, kWhole, fmt::format("the loop has not run where %{} needs it", e.index));
            } else if (named[x.index]) {
                fail(x, kWhole, fmt::format("%{} is not computed where %{} needs it", x.index, e.index));
            } else if (f[x].op == Op::LoopArg && !runs[f[x].payload >> 8]) {
                fail(x, kWhole, fmt::format("%{} needs an argument of a loop outside it", e.index));
            } else {
                stack.insert(stack.end(), f.operandsOf(x).begin(), f.operandsOf(x).end());
            }
        }
    }

    // The tree of blocks: each block in one place, statements within their arenas.
    bool bodyArenas() {
        const Body& b = f.body;
        const std::size_t before = errors;
        std::vector<bool> used(b.blocks.size());
        used[0] = true;
        const auto nest = [&](BlockId id) {
            if (id.index >= b.blocks.size() || used[id.index])
                fail("a statement has a block that is not there or stands elsewhere too");
            else
                used[id.index] = true;
        };
        for (const auto& block : b.blocks)
            for (const Stmt& s : block) {
                if (s.expr.index >= f.exprs.size()) {
                    fail("a statement without an expression");
                    continue;
                }
                if (s.kind != StmtKind::Let) nest(s.body);
                if (s.kind == StmtKind::If && s.orElse) nest(s.orElse);
                if (s.kind == StmtKind::If) phiArena(s);
                if (s.kind == StmtKind::Let && isLoop(f[s.expr])) fail(s.expr, kWhole, "a loop is run, not named");
                if (s.kind == StmtKind::Loop && !isLoop(f[s.expr])) fail(s.expr, kWhole, "not a loop");
                if (s.kind == StmtKind::If && type(s.expr) != Type::Boolean)
                    fail(s.expr, kWhole, "a condition is boolean");
            }
        return errors == before;
    }

    void phiArena(const Stmt& s) {
        if (static_cast<std::size_t>(s.firstPhi) + s.phiCount > f.body.phis.size())
            return fail("the selects of a statement lie outside the arena");
        for (std::uint32_t i = 0; i < s.phiCount; i++) {
            const ExprId phi = f.body.phis[s.firstPhi + i];
            if (phi.index >= f.exprs.size()) return fail("a statement decides nothing");
            if (f[phi].op != Op::Select || f.operand(phi, 0) != s.expr)
                fail(phi, 0, fmt::format("not a select by %{}", s.expr.index));
        }
    }

    void body() {
        if (f.body.blocks.empty() || !bodyArenas()) return;
        named.assign(f.exprs.size(), false);
        available = named;
        runs.assign(f.loops, false);
        seen.assign(f.exprs.size(), 0);
        for (const auto& block : f.body.blocks)
            for (const Stmt& s : block)
                if (s.kind != StmtKind::If) named[s.expr.index] = true;
        for (ExprId phi : f.body.phis) named[phi.index] = true;

        std::vector<Frame> stack{{BlockId(0)}};
        while (errors < kMaxErrors) {
            Frame& frame = stack.back();
            const auto& block = f.body.blocks[frame.block.index];
            if (frame.next == block.size()) {
                if (stack.size() == 1) break;
                stack.pop_back();
                leave(stack, frame.undo);
            } else {
                enter(stack, block[frame.next]);
            }
        }
        for (const ResultValue& r : f.results) use(r.value);
    }

    void enter(std::vector<Frame>& stack, const Stmt& s) {
        if (s.kind == StmtKind::Let) {
            if (available[s.expr.index]) fail(s.expr, kWhole, "computed twice");
            use(s.expr, true);
            give(s.expr);
            stack.back().next++;
            return;
        }
        if (s.kind == StmtKind::If) {
            use(s.expr);
        } else {
            if (available[s.expr.index]) fail(s.expr, kWhole, "computed twice");
            const std::size_t outside = outsideOperands(s.expr);
            for (std::size_t k = 0; k < outside; k++) use(f.operand(s.expr, k));
            runs[f[s.expr].payload] = true;
        }
        stack.back().inElse = false;
        stack.push_back({s.body, 0, given.size()});
    }

    // Operands of a loop that are computed before it runs.
    std::size_t outsideOperands(ExprId e) const {
        return beforeCarried(f[e]) + (f[e].operandCount - beforeCarried(f[e])) / 2;
    }

    void forget(std::size_t undo) {
        for (; given.size() > undo; given.pop_back()) available[given.back().index] = false;
    }

    // At the end of a block inside the statement that `stack` ends in.
    void leave(std::vector<Frame>& stack, std::size_t undo) {
        Frame& outer = stack.back();
        const Stmt& s = f.body.blocks[outer.block.index][outer.next];
        if (s.kind == StmtKind::Loop) {
            for (std::size_t k = outsideOperands(s.expr); k < f[s.expr].operandCount; k++) use(f.operand(s.expr, k));
            runs[f[s.expr].payload] = false;
            forget(undo);
            give(s.expr);
            outer.next++;
            return;
        }
        const auto phis = std::span(f.body.phis).subspan(s.firstPhi, s.phiCount);
        for (ExprId phi : phis) use(f.operand(phi, outer.inElse ? 2 : 1));
        forget(undo);
        if (!outer.inElse && s.orElse) {
            outer.inElse = true;
            stack.push_back({s.orElse, 0, undo});
            return;
        }
        if (!outer.inElse)
            for (ExprId phi : phis) use(f.operand(phi, 2));
        for (ExprId phi : phis) give(phi);
        outer.next++;
    }

    bool run() {
        arenas();
        if (errors) return false;
        for (const Uniform& u : module.uniforms) uniforms.emplace(u.name, u.type);
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) expr(ExprId(i));
        if (errors) return false;
        scopes();
        if (errors) return false;
        body();
        return errors == 0;
    }
};

}  // namespace

bool validate(const Module& module, const Function& function, Diagnostics& diagnostics) {
    return Validator{module, function, diagnostics}.run();
}

bool validate(const Module& module, Diagnostics& diagnostics) {
    bool valid = true;
    for (const Uniform& u : module.uniforms) {
        const std::size_t wanted = static_cast<std::size_t>(componentCount(u.type));
        if (u.values.size() == wanted) continue;
        diagnostics.add(
            Severity::Internal, "invalid-ir",
            fmt::format("uniform '{}' has {} values, not {}", module.names->text(u.name), u.values.size(), wanted));
        valid = false;
    }
    for (const auto& f : module.functions) valid = validate(module, *f, diagnostics) && valid;
    return valid;
}

}  // namespace shaderx::ir
