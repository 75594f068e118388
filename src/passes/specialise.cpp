#include "passes/specialise.h"

#include <algorithm>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

constexpr int kMaxDepth = 64;      // of calls in calls
constexpr std::size_t kSmall = 5;  // operations up to which a function is not worth a call

// What is known of an argument.
enum class Shape : std::uint32_t { Any, Constant, Filled };

// What an argument of a clone is, and its bits (or the payload of a text) where it is constant.
struct Argument {
    Shape shape = Shape::Any;
    Type type = Type::Void;
    std::vector<std::uint32_t> words;
    friend bool operator==(const Argument&, const Argument&) = default;
};

// Of which function a clone is, and for which arguments.
struct Clone {
    Name callee;
    std::vector<Argument> arguments;
};

// The results of a call, and how many expressions there were before it.
struct Tuple {
    std::uint32_t before = 0;
    std::vector<ExprId> results;
};

struct Specialiser {
    Module& module;
    const std::unordered_set<Name>& baked;
    Diagnostics& diagnostics;
    std::map<std::vector<std::uint32_t>, Name> clones{};
    std::unordered_map<Name, Clone> known{};  // clones made here: nothing is left to specialise in them
    int depth = 0;
    bool ok = true;

    bool run(Name entry) {
        Function* old = module.findOwn(entry);
        ensure(old, "no entry to specialise");
        Function fresh;
        fresh.name = entry;
        fresh.params = old->params;
        fresh.comment = old->comment;
        Builder b(module, fresh);
        std::vector<ExprId> arguments, results;
        for (std::uint32_t i = 0; i < fresh.params.size(); i++) arguments.push_back(b.param(i));
        expand(*old, b, arguments, results);
        for (std::size_t i = 0; i < results.size(); i++) b.addResult(old->results[i].name, results[i]);
        module.put(std::move(fresh));
        while (ok && share(entry)) {
        }
        return ok;
    }

    // Copies a function's expressions to where `b` builds, with arguments for parameters.
    void expand(const Function& from, Builder& b, std::span<const ExprId> arguments, std::vector<ExprId>& made) {
        Copy copy(from, b);
        std::vector<bool> live = reachable(from);
        std::map<std::uint32_t, Tuple> tuples;  // of calls with several results, by source expression
        for (std::uint32_t i = 0; i < from.exprs.size(); i++) {
            if (!live[i]) continue;
            ExprId id(i);
            const Expr& e = from.exprs[i];
            if (e.op == Op::Param) {
                copy.set(id, arguments[e.payload]);
            } else if (e.op == Op::Call) {
                std::uint32_t before = size(b);
                std::vector<ExprId> results = call(b, e, copy.operands(id));
                if (e.type != Type::Tuple) {
                    copy.set(id, results[0]);
                    name(b, results[0], from.hints[i], before);
                } else {
                    tuples[i] = {before, std::move(results)};
                }
            } else if (e.op == Op::Result && tuples.count(from.operand(id, 0).index)) {
                auto& [before, results] = tuples[from.operand(id, 0).index];
                copy.set(id, e.payload < results.size() ? results[e.payload] : b.null(e.type));
                name(b, copy[id], from.hints[i], before);
            } else if (e.op == Op::Known) {
                ExprId x = copy[from.operand(id, 0)];
                copy.set(id, b.function().isConstant(x) ? x : b.boolean(false));
            } else if (e.op == Op::Uniform && baked.count(Name(e.payload))) {
                copy.set(id, bake(b, Name(e.payload), e.type));
                if (from.hints[i]) b.hint(copy[id], from.hints[i]);
            } else {
                copy.one(id);
            }
        }
        made.clear();
        for (const ResultValue& r : from.results) made.push_back(copy[r.value]);
    }

    static std::uint32_t size(Builder& b) { return static_cast<std::uint32_t>(b.function().exprs.size()); }

    // A name that the caller gives to a result goes before the one that the value has inside the function called,
    // unless the value is older than the call.
    static void name(Builder& b, ExprId value, Name hint, std::uint32_t before) {
        if (!hint) return;
        if (value.index >= before)
            b.rename(value, hint);
        else
            b.hint(value, hint);
    }

    ExprId bake(Builder& b, Name name, Type type) {
        const Uniform* u = module.uniform(name);
        ensure(u != nullptr, "no such uniform");
        return b.constant(type, u->values);
    }

    // The results of a call, one for each of the callee's.
    std::vector<ExprId> call(Builder& b, const Expr& e, std::span<const ExprId> operands) {
        std::vector<ExprId> arguments(operands.begin(), operands.end()), results;
        const Function* callee = module.find(Name(e.payload));
        if (!callee || depth >= kMaxDepth || !ok) {  // after an error the rest is not worth the work
            std::string callName(module.names->text(Name(e.payload)));
            if (ok)
                diagnostics.error("bad-call", callee ? "calls nest too deeply in '" + callName + "'"
                                                     : "there is no function '" + callName + "'");
            ok = false;
            if (callee)
                for (const ResultValue& r : callee->results) results.push_back(b.null(r.type));
            else
                results.push_back(b.null(e.type == Type::Tuple ? Type::Float : e.type));
            return results;
        }
        depth++;
        if (mustExpand(*callee)) {
            expand(*callee, b, arguments, results);
        } else {
            const Function& clone = known.count(callee->name) ? *callee : cloneFor(b, *callee, arguments);
            if (isSmall(clone))
                expand(clone, b, arguments, results);
            else
                results = callClone(b, clone, arguments);
        }
        depth--;
        return results;
    }

    bool mustExpand(const Function& f) const {
        if (f.isInline) return true;
        for (const Param& p : f.params)
            if (isClosure(p.type)) return true;
        for (const ResultValue& r : f.results)
            if (isClosure(r.type)) return true;
        for (const Expr& e : f.exprs)
            if (e.op == Op::Ddx || e.op == Op::Ddy) return true;
        return false;
    }

    bool isSmall(const Function& f) const {
        std::size_t operations = 0;
        std::vector<bool> live = reachable(f);
        for (std::size_t i = 0; i < f.exprs.size(); i++) {
            if (!live[i]) continue;
            Op op = f.exprs[i].op;
            if (op == Op::Loop || op == Op::Lights) return false;
            if (op > Op::Uniform && op != Op::Swizzle && op != Op::Retype && op != Op::Result) operations++;
        }
        return operations <= kSmall;
    }

    ExprId filler(const Builder& b, ExprId e) const {
        const Expr& x = b.function()[e];
        if (x.op != Op::Make || x.operandCount != 1 || !isVector(x.type)) return {};
        return b.function().operand(e, 0);
    }

    Argument argumentOf(const Function& caller, Builder& b, ExprId e) const {
        const Expr& x = caller[e];
        if (x.op == Op::Constant) {
            Argument a{Shape::Constant, x.type, {}};
            if (componentCount(x.type)) {
                auto words = caller.constantWords(e);
                a.words.assign(words.begin(), words.end());
            } else {
                a.words.push_back(x.payload);
            }
            return a;
        }
        return {filler(b, e) ? Shape::Filled : Shape::Any, x.type, {}};
    }

    // Finds or makes the clone for these arguments; leaves in `arguments` those that the clone still takes.
    const Function& cloneFor(Builder& b, const Function& callee, std::vector<ExprId>& arguments) {
        Clone clone{callee.name, {}};
        std::vector<ExprId> kept;
        for (ExprId& e : arguments) {
            clone.arguments.push_back(argumentOf(b.function(), b, e));
            Shape shape = clone.arguments.back().shape;
            if (shape != Shape::Constant) kept.push_back(shape == Shape::Filled ? filler(b, e) : e);
        }
        arguments = std::move(kept);
        return *module.findOwn(nameOf(callee, clone));
    }

    // The name of a clone, which is made if it is new.
    Name nameOf(const Function& callee, const Clone& clone) {
        std::vector<std::uint32_t> key{clone.callee.index};
        for (const Argument& a : clone.arguments) {
            key.push_back(static_cast<std::uint32_t>(a.shape));
            key.insert(key.end(), a.words.begin(), a.words.end());
        }
        auto found = clones.find(key);
        if (found == clones.end()) found = clones.emplace(key, make(callee, clone)).first;
        return found->second;
    }

    Name make(const Function& callee, const Clone& how) {
        std::string_view stem = module.names->text(callee.name);
        stem = stem.substr(0, stem.find('@'));
        Function clone;
        int number = 0;
        do clone.name = module.names->intern(fmt::format("{}@{}", stem, number++));
        while (module.findOwn(clone.name));
        module.add(clone.name);  // takes the name: making the body may make further clones
        for (std::size_t i = 0; i < how.arguments.size(); i++) {
            Shape shape = how.arguments[i].shape;
            if (shape == Shape::Constant) continue;
            clone.params.push_back(
                {callee.params[i].name, shape == Shape::Filled ? Type::Float : callee.params[i].type});
        }
        clone.comment = callee.comment;
        Builder b(module, clone);
        std::vector<ExprId> values, results;
        std::uint32_t next = 0;
        for (std::size_t i = 0; i < how.arguments.size(); i++) {
            const Argument& a = how.arguments[i];
            if (a.shape == Shape::Filled)
                values.push_back(b.make(callee.params[i].type, {b.param(next++)}));
            else if (a.shape == Shape::Any)
                values.push_back(b.param(next++));
            else if (componentCount(a.type))
                values.push_back(b.constant(a.type, a.words));
            else
                values.push_back(b.emit(Op::Constant, a.type, {}, a.words[0]));
        }
        expand(callee, b, values, results);
        for (std::size_t i = 0; i < results.size(); i++) b.addResult(callee.results[i].name, results[i]);
        Name name = clone.name;
        module.put(std::move(clone));
        known[name] = how;
        return name;
    }

    // Clones of one function that do the same work on different numbers become one that takes the numbers: less text
    // for the same speed. True if two did; then others may.
    bool share(Name entry) {
        std::vector<Name> live = liveClones(entry);
        for (std::size_t i = 0; i < live.size(); i++)
            for (std::size_t j = i + 1; j < live.size(); j++)
                if (Clone common; haveCommon(known[live[i]], known[live[j]], common)) {
                    const Function* callee = module.find(common.callee);
                    Name merged = nameOf(*callee, common);
                    std::size_t apart = std::min(workOf(live[i]), workOf(live[j]));
                    if (workOf(merged) > apart + apart / 8 + 2) continue;
                    redirect(entry, live[i], merged);
                    redirect(entry, live[j], merged);
                    return true;
                }
        return false;
    }

    // The clones that the entry reaches, callers before callees, as far as calls are needed.
    std::vector<Name> liveClones(Name entry) {
        std::vector<Name> order{entry};
        for (std::size_t i = 0; i < order.size(); i++) {
            const Function& f = *module.findOwn(order[i]);
            std::vector<bool> live = reachable(f);
            for (std::size_t k = 0; k < f.exprs.size(); k++) {
                Name callee(f.exprs[k].payload);
                if (live[k] && f.exprs[k].op == Op::Call &&
                    std::find(order.begin(), order.end(), callee) == order.end())
                    order.push_back(callee);
            }
        }
        std::vector<Name> found;
        for (Name n : order)
            if (known.count(n)) found.push_back(n);
        return found;
    }

    // The arguments under which one clone serves both: what differs in numbers is taken as a parameter.
    bool haveCommon(const Clone& x, const Clone& y, Clone& common) const {
        if (x.callee != y.callee) return false;
        common.callee = x.callee;
        for (std::size_t i = 0; i < x.arguments.size(); i++) {
            const Argument &a = x.arguments[i], &b = y.arguments[i];
            if (a == b) {
                common.arguments.push_back(a);
                continue;
            }
            if (info(a.type).scalar != Scalar::Float) return false;  // a truth, count or text decides too much
            // A vector of one number stays one: what is known of it in a function must hold in those that it calls.
            Shape shape = shared(a);
            if (shape != shared(b)) return false;
            common.arguments.push_back({shape, a.type, {}});
        }
        return true;
    }

    // How a constant is taken when it becomes a parameter: a vector that repeats one number, as that number.
    static Shape shared(const Argument& a) {
        if (a.shape != Shape::Constant || !isVector(a.type)) return a.shape == Shape::Constant ? Shape::Any : a.shape;
        return std::equal(a.words.begin() + 1, a.words.end(), a.words.begin()) ? Shape::Filled : Shape::Any;
    }

    // Operations of a function with all that it calls.
    std::size_t workOf(Name name) const {
        const Function& f = *module.findOwn(name);
        std::size_t work = 0;
        std::vector<bool> live = reachable(f);
        for (std::size_t i = 0; i < f.exprs.size(); i++) {
            const Expr& e = f.exprs[i];
            if (!live[i] || e.op <= Op::Uniform || e.op == Op::Result || e.op == Op::Retype) continue;
            work += 1 + (e.op == Op::Call ? workOf(Name(e.payload)) : 0);
        }
        return work;
    }

    // Makes every live call of `from` one of `to`, which takes more arguments.
    void redirect(Name entry, Name from, Name to) {
        std::vector<Name> callers = liveClones(entry);
        callers.push_back(entry);
        for (Name name : callers) {
            Function* f = module.findOwn(name);
            bool calls = false;
            for (const Expr& e : f->exprs) calls = calls || (e.op == Op::Call && Name(e.payload) == from);
            if (!calls) continue;
            Function fresh;
            fresh.name = f->name;
            fresh.params = f->params;
            fresh.comment = f->comment;
            Builder b(module, fresh);
            Copy copy(*f, b);
            std::vector<bool> live = reachable(*f);
            for (std::uint32_t i = 0; i < f->exprs.size(); i++) {
                if (!live[i]) continue;
                const Expr& e = f->exprs[i];
                if (e.op != Op::Call || Name(e.payload) != from) {
                    copy.one(ExprId(i));
                    continue;
                }
                copy.set(ExprId(i), b.call(to, e.type, widened(b, copy.operands(ExprId(i)), known[from], known[to])));
                if (f->hints[i]) b.hint(copy[ExprId(i)], f->hints[i]);
            }
            for (const ResultValue& r : f->results) b.addResult(r.name, copy[r.value]);
            *f = std::move(fresh);
        }
    }

    std::vector<ExprId> widened(Builder& b, std::span<const ExprId> old, const Clone& from, const Clone& to) {
        std::vector<ExprId> arguments;
        std::size_t next = 0;
        for (std::size_t i = 0; i < to.arguments.size(); i++) {
            const Argument& a = from.arguments[i];
            ExprId given = a.shape == Shape::Constant ? ExprId() : old[next++];
            Shape wanted = to.arguments[i].shape;
            if (wanted == Shape::Constant) continue;
            if (given && a.shape == Shape::Filled && wanted == Shape::Any)
                given = b.make(a.type, {given});
            else if (!given && wanted == Shape::Filled)
                given = b.constant(Type::Float, std::span(a.words).first(1));
            else if (!given)
                given = b.constant(a.type, a.words);
            arguments.push_back(given);
        }
        return arguments;
    }

    // A call of a clone; results that are constants or arguments need no call.
    std::vector<ExprId> callClone(Builder& b, const Function& clone, const std::vector<ExprId>& arguments) {
        std::vector<ExprId> results;
        Type type = clone.results.size() == 1 ? clone.results[0].type : Type::Tuple;
        ExprId made = b.call(clone.name, type, arguments);
        for (std::uint32_t i = 0; i < clone.results.size(); i++) {
            ExprId value = clone.results[i].value;
            const Expr& x = clone[value];
            if (x.op == Op::Constant && componentCount(x.type))
                results.push_back(b.constant(x.type, clone.constantWords(value)));
            else if (x.op == Op::Param)
                results.push_back(arguments[x.payload]);
            else
                results.push_back(type == Type::Tuple ? b.result(made, i, x.type) : made);
        }
        return results;
    }
};

}  // namespace

bool specialise(Module& module, Name entry, const std::unordered_set<Name>& baked, Diagnostics& diagnostics) {
    return Specialiser{module, baked, diagnostics}.run(entry);
}

}  // namespace shaderx::passes
