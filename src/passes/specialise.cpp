#include "passes/specialise.h"

#include <algorithm>
#include <bit>
#include <deque>
#include <string>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

constexpr std::uint32_t kNameless = 0x80000000u;  // names from here on have no text: those of clones
constexpr std::uint32_t kOwn = 0x40000000u;       // after these, of clones of the module's own functions
constexpr std::size_t kSmall = 5;                 // operations up to which a function is not worth a call

// What is known of an argument.
enum class Shape : std::uint32_t { Any, Constant, Filled };

// What an argument of a clone is, and its bits (or the payload of a text) where it is constant.
struct Argument {
    Shape shape = Shape::Any;
    Type type = Type::Void;
    std::span<const std::uint32_t> words;

    bool isSame(const Argument& other) const {
        return shape == other.shape && type == other.type &&
               std::equal(words.begin(), words.end(), other.words.begin(), other.words.end());
    }
};

// One word for the function's name, for each argument one for its shape and type and then the words that it has.
using Key = Specialisations::Key;

void addArgument(Key& key, const Argument& a) {
    key.push_back(static_cast<std::uint32_t>(a.shape) << 16 | static_cast<std::uint32_t>(a.type));
    key.insert(key.end(), a.words.begin(), a.words.end());
}

// Calls visit(i, argument) for each argument of a key, in order.
template <class F>
void eachArgument(const Key& key, F&& visit) {
    std::size_t at = 1;
    for (std::uint32_t i = 0; at < key.size(); i++) {
        Argument a{static_cast<Shape>(key[at] >> 16), static_cast<Type>(key[at] & 0xffff), {}};
        at++;
        if (a.shape == Shape::Constant) {
            const std::size_t n = static_cast<std::size_t>(std::max(componentCount(a.type), 1));
            a.words = std::span(key).subspan(at, n);
            at += n;
        }
        visit(i, a);
    }
}

// The results of a call of several: how many expressions there were before it, and where its results are.
struct Tuple {
    std::uint32_t call, before;
    std::size_t first, count;
};

// What one call on the way works with; kept for the next call of that depth, for its memory.
struct Frame {
    Key key;
    std::vector<ExprId> arguments, values, results;
};

struct Specialiser;
using Clone = Specialisations::Clone;
using Clones = Specialisations;

// Which expressions of a function its results need, for given arguments: of a choice whose condition is known, only the
// side that is taken, so that nothing is made of the other.
class Demand {
  public:
    Demand(const Function& from, Copy& copy, Builder& b, std::span<const ExprId> arguments, Specialiser& owner)
        : from_(from), copy_(copy), b_(b), arguments_(arguments), owner_(owner), state_(from.exprs.size()) {
        first_ = static_cast<std::uint32_t>(state_.size());
        for (const ResultValue& r : from_.results) need(r.value);
        for (std::uint32_t i = static_cast<std::uint32_t>(state_.size()); i-- > 0;) {
            if (!(state_[i] & kNeeded)) continue;
            first_ = i;
            visit(ExprId(i));
        }
    }
    bool needs(ExprId e) const { return state_[e.index] & kNeeded; }
    // The first one that is needed.
    std::uint32_t first() const { return first_; }
    // The operand that the expression is, none where both may be.
    ExprId chosen(ExprId e) const {
        const std::uint8_t side = state_[e.index] & kSide;
        return side ? from_.operand(e, side - 1u) : ExprId();
    }

  private:
    enum : std::uint8_t { kSide = 3, kNeeded = 4, kNotConstant = 8, kNotMade = 16 };  // kSide: operand + 1
    static constexpr int kMaxDepth = 24;  // of a condition that is worth a look

    void need(ExprId e) { state_[e.index] |= kNeeded; }

    void choose(ExprId e, std::size_t operand) {
        state_[e.index] |= static_cast<std::uint8_t>(operand + 1);
        need(from_.operand(e, operand));
    }

    void visit(ExprId id) {
        const Expr& e = from_[id];
        if (e.op == Op::Select) {
            if (ExprId c = constant(from_.operand(id, 0), 0))
                return choose(id, b_.function().constantWords(c)[0] ? 1 : 2);
        } else if (e.op == Op::ClosureMix) {
            ExprId t = constant(from_.operand(id, 2), 0);
            if (t && isAll(t, 0.0f)) return choose(id, 0);
            if (t && isAll(t, 1.0f)) return choose(id, 1);
        }
        const ExprId* operands = from_.operands.data() + e.firstOperand;
        std::uint8_t* state = state_.data();
        for (std::uint32_t k = 0; k < e.operandCount; k++) state[operands[k].index] |= kNeeded;
    }

    bool isAll(ExprId e, float v) const {
        for (std::uint32_t w : b_.function().constantWords(e))
            if (w != std::bit_cast<std::uint32_t>(v)) return false;
        return true;
    }

    // The copy of an expression that is constant for these arguments, made on the spot; none where it is not.
    ExprId constant(ExprId id, int depth);
    // Makes an expression that needs no call or loop; false where it does, or is too deep.
    bool make(ExprId id, int depth);

    const Function& from_;
    Copy& copy_;
    Builder& b_;
    std::span<const ExprId> arguments_;
    Specialiser& owner_;
    std::vector<std::uint8_t> state_;
    std::uint32_t first_;
};

struct Specialiser {
    Module& module;
    const std::unordered_set<Name>& baked;
    Diagnostics& diagnostics;
    bool isPartial;                                // only expands; what is known of arguments is asked later
    Clones& shared;                                // of functions of libraries
    Clones own{};                                  // of functions of the module, which are what a pass has left of them
    std::unordered_map<Name, Name> placed{};       // the module's copies of clones
    std::unordered_map<Name, const Key*> known{};  // of these: nothing is left to specialise in them
    std::deque<Frame> frames{};                    // by depth
    ExpansionLimits limits{};
    std::size_t depth = 0;
    std::size_t copied = 0;  // expressions of functions called
    bool ok = true;

    bool run(Name entry) {
        Function* old = module.findOwn(entry);
        ensure(old, "no entry to specialise");
        Function fresh;
        fresh.name = entry;
        fresh.params = old->params;
        fresh.comment = old->comment;
        rebuild(*old, fresh);
        place(module.put(std::move(fresh)));
        if (ok) share(entry);
        if (!ok) shared.clear();  // what was made after an error is not what it should be
        return ok;
    }

    // The clone of a name, none if the name is no clone's.
    const Clone* cloneOf(Name name) const {
        if (!name || name.index < kNameless) return nullptr;
        const std::uint32_t i = name.index - kNameless;
        return i < kOwn ? shared.named[i] : own.named[i - kOwn];
    }

    // Gives the module a copy of every clone that a function of it calls.
    void place(Function& caller) {
        for (Expr& e : caller.exprs)
            if (e.op == Op::Call)
                if (const Clone* c = cloneOf(Name(e.payload))) e.payload = placeOne(*c).index;
    }

    Name placeOne(const Clone& clone) {
        Name& name = placed[clone.function.name];
        if (name) return name;
        std::string_view stem = module.names->text(clone.stem);
        std::string numbered(stem.substr(0, stem.find('@')));
        numbered += '@';
        const std::size_t end = numbered.size();
        Name fresh;
        for (int number = 0; !fresh || module.findOwn(fresh); number++)
            fresh = module.names->intern(numbered.replace(end, std::string::npos, std::to_string(number)));
        name = fresh;
        known[fresh] = clone.key;
        Function& copy = module.add(fresh);
        copy = clone.function;
        copy.name = fresh;
        place(copy);
        return fresh;
    }

    // Fills a function that has the parameters of another one with the other's results.
    void rebuild(const Function& old, Function& fresh) {
        Builder b(module, fresh);
        b.reserve(old.exprs.size());
        std::vector<ExprId> arguments, results;
        for (std::uint32_t i = 0; i < fresh.params.size(); i++) arguments.push_back(b.param(i));
        expand(old, b, arguments, results);
        for (std::size_t i = 0; i < results.size(); i++) b.addResult(old.results[i].name, results[i]);
        compact(fresh);
    }

    // Copies what a function's results need to where `b` builds, with arguments for parameters.
    void expand(const Function& from, Builder& b, std::span<const ExprId> arguments, std::vector<ExprId>& made) {
        Copy copy(from, b);
        Demand demand(from, copy, b, arguments, *this);
        std::vector<Tuple> tuples;
        std::vector<ExprId> tupleResults;
        for (std::uint32_t i = demand.first(); i < from.exprs.size(); i++) {
            ExprId id(i);
            if (!demand.needs(id) || copy[id]) continue;
            const Expr& e = from.exprs[i];
            if (e.op == Op::Call) {
                std::uint32_t before = size(b);
                copy.follow(id);
                const std::vector<ExprId>& results = call(b, e, copy.operands(id));
                if (e.type != Type::Tuple) {
                    copy.set(id, results[0]);
                    name(b, results[0], from.hints[i], before);
                } else {
                    tuples.push_back({i, before, tupleResults.size(), results.size()});
                    tupleResults.insert(tupleResults.end(), results.begin(), results.end());
                }
            } else if (e.op == Op::Result && from[from.operand(id, 0)].op == Op::Call) {
                const std::uint32_t callee = from.operand(id, 0).index;
                auto t = std::find_if(tuples.rbegin(), tuples.rend(), [&](const Tuple& x) { return x.call == callee; });
                const bool isKnown = t != tuples.rend() && e.payload < t->count;
                copy.set(id, isKnown ? tupleResults[t->first + e.payload] : b.null(e.type));
                if (isKnown) name(b, copy[id], from.hints[i], t->before);
            } else {
                plain(copy, b, from, id, arguments, demand.chosen(id));
            }
        }
        made.clear();
        for (const ResultValue& r : from.results) made.push_back(copy[r.value]);
    }

    // Copies an expression that calls nothing; `chosen` is the operand that it is, where that is known.
    void plain(Copy& copy, Builder& b, const Function& from, ExprId id, std::span<const ExprId> arguments,
               ExprId chosen) {
        const Expr& e = from[id];
        if (e.op == Op::Param) return copy.set(id, arguments[e.payload]);
        if (chosen) {
            copy.set(id, copy[chosen]);
        } else if (e.op == Op::Known && !isPartial) {
            ExprId x = copy[from.operand(id, 0)];
            copy.set(id, b.function().isConstant(x) ? x : b.boolean(false));
        } else if (e.op == Op::Uniform && !baked.empty() && baked.count(Name(e.payload))) {
            copy.set(id, bake(b, Name(e.payload), e.type));
        } else {
            copy.one(id);
            return;
        }
        if (from.hints[id.index]) b.hint(copy[id], from.hints[id.index]);
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

    // The results of a call, one for each of the callee's; valid until the next call of this depth.
    const std::vector<ExprId>& call(Builder& b, const Expr& e, std::span<const ExprId> operands) {
        if (frames.size() <= depth) frames.emplace_back();
        Frame& frame = frames[depth];
        frame.arguments.assign(operands.begin(), operands.end());
        frame.results.clear();
        const Clone* made = cloneOf(Name(e.payload));  // nothing is left to specialise in it
        const Function* callee = made ? &made->function : module.find(Name(e.payload));
        if (callee) copied += callee->exprs.size();
        if (!callee || depth >= limits.depth || copied > limits.expressions ||
            !ok) {  // after an error the rest is not worth the work
            refuse(b, e, callee, frame.results);
            return frame.results;
        }
        depth++;
        if (isExpanded(*callee)) {
            expand(*callee, b, frame.arguments, frame.results);
        } else if (isPartial) {
            keepCall(b, e, *callee, frame);
        } else {
            const Function& clone = made ? *callee : cloneFor(b, *callee, frame);
            if (isSmall(clone))
                expand(clone, b, frame.arguments, frame.results);
            else
                callClone(b, clone, frame);
        }
        depth--;
        return frame.results;
    }

    static void keepCall(Builder& b, const Expr& e, const Function& callee, Frame& frame) {
        ExprId made = b.call(callee.name, e.type, frame.arguments);
        for (std::uint32_t k = 0; k < callee.results.size(); k++)
            frame.results.push_back(e.type == Type::Tuple ? b.result(made, k, callee.results[k].type) : made);
    }

    void refuse(Builder& b, const Expr& e, const Function* callee, std::vector<ExprId>& results) {
        std::string_view name = module.names->text(Name(e.payload));
        if (ok && !callee)
            diagnostics.error("bad-call", fmt::format("there is no function '{}'", name));
        else if (ok && depth >= limits.depth)
            diagnostics.error("limit", fmt::format("'{}' is used within more than {} nodes and functions that are "
                                                   "made of others",
                                                   name, limits.depth));
        else if (ok)
            diagnostics.error("limit", fmt::format("the nodes and functions in use expand to more than {} expressions",
                                                   limits.expressions));
        ok = false;
        if (callee)
            for (const ResultValue& r : callee->results) results.push_back(b.null(r.type));
        else
            results.push_back(b.null(e.type == Type::Tuple ? Type::Float : e.type));
    }

    static bool isExpanded(const Function& f) { return !f.isApart && (mustExpand(f) || isSmall(f)); }

    static bool mustExpand(const Function& f) {
        if (f.isInline) return true;
        for (const Param& p : f.params)
            if (isClosure(p.type)) return true;
        for (const ResultValue& r : f.results)
            if (isClosure(r.type)) return true;
        for (const Expr& e : f.exprs)
            if (e.op == Op::Ddx || e.op == Op::Ddy) return true;
        return false;
    }

    static bool isSmall(const Function& f) {
        std::size_t operations = 0;
        for (const Expr& e : f.exprs) {
            if (e.op == Op::Loop || e.op == Op::Lights) return false;
            operations += isWork(e.op) && e.op != Op::Swizzle;
            if (operations > kSmall) return false;
        }
        return true;
    }
    static bool isWork(Op op) { return op > Op::Uniform && op != Op::Result && op != Op::Retype; }

    static ExprId filler(const Function& f, ExprId e) {
        const Expr& x = f[e];
        if (x.op != Op::Make || x.operandCount != 1 || !isVector(x.type)) return {};
        return f.operand(e, 0);
    }

    static Argument argumentOf(const Function& caller, ExprId e) {
        const Expr& x = caller[e];
        if (x.op != Op::Constant) return {filler(caller, e) ? Shape::Filled : Shape::Any, x.type, {}};
        if (componentCount(x.type)) return {Shape::Constant, x.type, caller.constantWords(e)};
        return {Shape::Constant, x.type, std::span(&x.payload, 1)};
    }

    // Finds or makes the clone for these arguments; leaves in the frame those that the clone still takes.
    const Function& cloneFor(Builder& b, const Function& callee, Frame& frame) {
        frame.key.assign(1, callee.name.index);
        std::size_t kept = 0;
        for (ExprId e : frame.arguments) {
            Argument a = argumentOf(b.function(), e);
            addArgument(frame.key, a);
            if (a.shape != Shape::Constant)
                frame.arguments[kept++] = a.shape == Shape::Filled ? filler(b.function(), e) : e;
        }
        frame.arguments.resize(kept);
        return clone(callee, frame).function;
    }

    // The clone of the frame's key, which is made if it is new.
    const Clone& clone(const Function& callee, Frame& frame) {
        Clones& all = module.findOwn(callee.name) ? own : shared;
        auto [found, isNew] = all.byKey.try_emplace(frame.key);
        Clone& made = found->second;
        if (!isNew) return made;
        made.key = &found->first;
        if (!takeWhole(callee, found->first, made.function)) make(callee, found->first, frame, made.function);
        if (isSmall(made.function)) return made;  // is expanded where it is called and needs no name
        made.function.isApart = true;
        // A name that no text has; the module's copy gets one that does.
        const std::uint32_t first = &all == &own ? kNameless + kOwn : kNameless;
        made.function.name = Name(first + static_cast<std::uint32_t>(all.named.size()));
        made.stem = callee.name;
        all.named.push_back(&made);
        return made;
    }

    // A function in which there is nothing to expand, and of whose arguments nothing is known, stays as it is, but that
    // it calls clones. False where it does not.
    bool takeWhole(const Function& callee, const Key& key, Function& whole) {
        bool isOpen = callee.isApart && !isPartial;
        eachArgument(key, [&](std::uint32_t, const Argument& a) { isOpen = isOpen && a.shape == Shape::Any; });
        for (std::size_t i = 0; isOpen && i < callee.exprs.size(); i++) isOpen = staysAsItIs(callee, callee.exprs[i]);
        if (!isOpen) return false;
        whole = callee;
        whole.name = Name();
        for (Expr& e : whole.exprs) {
            if (e.op != Op::Call) continue;
            const Function& inner = *module.find(Name(e.payload));
            if (depth >= limits.depth || copied + inner.exprs.size() > limits.expressions || !ok) return false;
            if (frames.size() <= depth) frames.emplace_back();
            Frame& frame = frames[depth];
            frame.key.assign(1, inner.name.index);
            for (const Param& p : inner.params) addArgument(frame.key, {Shape::Any, p.type, {}});
            depth++;
            const Function& clone = this->clone(inner, frame).function;
            depth--;
            if (isSmall(clone)) return false;
            copied += inner.exprs.size();
            e.payload = clone.name.index;
        }
        return true;
    }

    bool staysAsItIs(const Function& f, const Expr& e) const {
        if (e.op == Op::Known || (e.op == Op::Uniform && !baked.empty())) return false;
        if (e.op != Op::Call) return true;
        const Function* inner = cloneOf(Name(e.payload)) ? nullptr : module.find(Name(e.payload));
        return inner && inner->isApart && std::all_of(f.operandsOf(e).begin(), f.operandsOf(e).end(), [&](ExprId o) {
                   return argumentOf(f, o).shape == Shape::Any;
               });
    }

    void make(const Function& callee, const Key& key, Frame& frame, Function& clone) {
        clone = {};  // what was begun as a whole
        eachArgument(key, [&](std::uint32_t i, const Argument& a) {
            if (a.shape == Shape::Constant) return;
            clone.params.push_back(
                {callee.params[i].name, a.shape == Shape::Filled ? Type::Float : callee.params[i].type});
        });
        clone.comment = callee.comment;
        Builder b(module, clone);
        b.reserve(callee.exprs.size());
        frame.values.clear();
        std::uint32_t next = 0;
        eachArgument(key, [&](std::uint32_t i, const Argument& a) {
            if (a.shape == Shape::Filled)
                frame.values.push_back(b.make(callee.params[i].type, {b.param(next++)}));
            else if (a.shape == Shape::Any)
                frame.values.push_back(b.param(next++));
            else
                frame.values.push_back(constant(b, a));
        });
        expand(callee, b, frame.values, frame.results);
        for (std::size_t i = 0; i < frame.results.size(); i++) b.addResult(callee.results[i].name, frame.results[i]);
        compact(clone);
    }

    static ExprId constant(Builder& b, const Argument& a) {
        return componentCount(a.type) ? b.constant(a.type, a.words) : b.emit(Op::Constant, a.type, {}, a.words[0]);
    }

    // What sharing asks of a function.
    struct Summary {
        std::vector<Name> calls;  // of each call, the callee
        std::size_t work = 0;     // operations of its own, a call being one
        std::size_t total = 0;    // with all that it calls, as it was when `instead` had so many entries less one
        std::size_t totalAt = 0;
        std::size_t visit = 0;  // the walk that came by last
    };
    std::size_t visits = 0;
    std::unordered_map<Name, Summary> summaries{};
    std::unordered_map<Name, Name> instead{};  // of clones, those that serve for them

    Summary& summaryOf(Name name) {
        auto [found, isNew] = summaries.try_emplace(name);
        Summary& s = found->second;
        if (!isNew) return s;
        for (const Expr& e : module.findOwn(name)->exprs) {
            s.work += isWork(e.op);
            if (e.op == Op::Call) s.calls.push_back(Name(e.payload));
        }
        return s;
    }

    Name resolved(Name name) const {
        for (auto found = instead.find(name); found != instead.end(); found = instead.find(name)) name = found->second;
        return name;
    }

    // Clones of one function that do the same work on different numbers become one that takes the numbers: less text
    // for the same speed.
    void share(Name entry) {
        if (known.size() < 2) return;
        std::vector<LiveClone> live = liveClones(entry);
        constexpr std::size_t kMostShared = 256;  // each is compared with each: beyond, the text may be longer
        if (live.size() < 2 || live.size() > kMostShared) return;
        while (sharesTwo(live)) live = liveClones(entry);
        if (instead.empty()) return;
        redirect(*module.findOwn(entry));
        for (const LiveClone& c : live) redirect(*module.findOwn(c.name));
    }

    struct LiveClone {
        Name name;
        const Key* key;
    };

    // True if two of them did; then others may.
    bool sharesTwo(const std::vector<LiveClone>& live) {
        for (std::size_t i = 0; i < live.size(); i++)
            for (std::size_t j = i + 1; j < live.size(); j++)
                if ((*live[i].key)[0] == (*live[j].key)[0] && mergedBoth(live[i], live[j])) return true;
        return false;
    }

    bool mergedBoth(const LiveClone& x, const LiveClone& y) {
        if (frames.empty()) frames.emplace_back();
        if (!haveCommon(*x.key, *y.key, frames[0].key)) return false;
        const Function* callee = module.find(Name(frames[0].key[0]));
        depth = 1;
        const Clone& common = clone(*callee, frames[0]);
        depth = 0;
        if (!common.function.name) return false;
        const Name merged = placeOne(common);
        const std::size_t apart = std::min(workOf(x.name), workOf(y.name));
        if (workOf(merged) > apart + apart / 8 + 2) return false;
        if (x.name != merged) instead[x.name] = merged;
        if (y.name != merged) instead[y.name] = merged;
        return true;
    }

    // The clones that the entry reaches, callers before callees.
    std::vector<LiveClone> liveClones(Name entry) {
        visits++;
        std::vector<LiveClone> found;
        std::vector<Name> order{entry};
        for (std::size_t i = 0; i < order.size(); i++) {
            if (auto clone = known.find(order[i]); clone != known.end()) found.push_back({order[i], clone->second});
            for (Name callee : summaryOf(order[i]).calls) {
                callee = resolved(callee);
                if (std::exchange(summaryOf(callee).visit, visits) != visits) order.push_back(callee);
            }
        }
        return found;
    }

    // Operations of a function with all that it calls.
    std::size_t workOf(Name name) {
        Summary& s = summaryOf(name);
        if (s.totalAt == instead.size() + 1) return s.total;
        std::size_t work = s.work;
        for (Name callee : s.calls) work += workOf(resolved(callee));
        s.totalAt = instead.size() + 1;
        return s.total = work;
    }

    // The arguments under which one clone serves both: what differs in numbers is taken as a parameter.
    static bool haveCommon(const Key& x, const Key& y, Key& common) {
        if (x[0] != y[0]) return false;
        std::vector<Argument> other;
        eachArgument(y, [&](std::uint32_t, const Argument& a) { other.push_back(a); });
        bool can = true;
        common.assign(1, x[0]);
        eachArgument(x, [&](std::uint32_t i, const Argument& a) {
            if (a.isSame(other[i])) return addArgument(common, a);
            // A truth, count or text decides too much. A vector of one number stays one: what is known of it in a
            // function must hold in those that it calls.
            can = can && info(a.type).scalar == Scalar::Float && widerShape(a) == widerShape(other[i]);
            addArgument(common, {widerShape(a), a.type, {}});
        });
        return can;
    }

    // How a constant is taken when it becomes a parameter: a vector that repeats one number, as that number.
    static Shape widerShape(const Argument& a) {
        if (a.shape != Shape::Constant || !isVector(a.type)) return a.shape == Shape::Constant ? Shape::Any : a.shape;
        return std::equal(a.words.begin() + 1, a.words.end(), a.words.begin()) ? Shape::Filled : Shape::Any;
    }

    // Makes calls of clones that others serve for calls of these, which take more arguments.
    void redirect(Function& f) {
        auto isOther = [&](const Expr& e) { return e.op == Op::Call && instead.count(Name(e.payload)); };
        if (std::none_of(f.exprs.begin(), f.exprs.end(), isOther)) return;
        Function fresh;
        fresh.name = f.name;
        fresh.params = f.params;
        fresh.comment = f.comment;
        fresh.loops = f.loops;
        Appender to(fresh);
        to.reserve(f);
        std::vector<ExprId> at(f.exprs.size()), arguments;
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            const Expr& e = f.exprs[i];
            if (!f.origins.empty()) fresh.beginOrigin(f.originOf(ExprId(i)));
            if (e.op == Op::Constant && componentCount(e.type)) {
                at[i] = to.constant(e.type, f.constantWords(ExprId(i)), f.hints[i]);
                continue;
            }
            arguments.clear();
            for (ExprId o : f.operandsOf(e)) arguments.push_back(at[o.index]);
            Name callee(e.payload);
            if (isOther(e)) {
                callee = resolved(callee);
                arguments = widened(to, arguments, *known[Name(e.payload)], *known[callee]);
            }
            at[i] = to.append(e.op, e.type, arguments, callee.index, f.hints[i]);
        }
        for (const ResultValue& r : f.results) fresh.results.push_back({r.name, r.type, at[r.value.index]});
        f = std::move(fresh);
    }

    // The arguments of a call of the clone `from` as those of the clone `to`, which knows less of some.
    static std::vector<ExprId> widened(Appender& appender, std::span<const ExprId> old, const Key& from,
                                       const Key& to) {
        std::vector<Argument> wanted;
        eachArgument(to, [&](std::uint32_t, const Argument& a) { wanted.push_back(a); });
        std::vector<ExprId> arguments;
        std::size_t next = 0;
        eachArgument(from, [&](std::uint32_t i, const Argument& a) {
            ExprId given = a.shape == Shape::Constant ? ExprId() : old[next++];
            Shape shape = wanted[i].shape;
            if (shape == Shape::Constant) return;
            if (given && a.shape == Shape::Filled && shape == Shape::Any)
                given = appender.append(Op::Make, a.type, {given});
            else if (!given && shape == Shape::Filled)
                given = appender.constant(Type::Float, a.words.first(1));
            else if (!given)
                given = appender.constant(a.type, a.words);
            arguments.push_back(given);
        });
        return arguments;
    }

    // A call of a clone; results that are constants or arguments need no call.
    static void callClone(Builder& b, const Function& clone, Frame& frame) {
        Type type = clone.results.size() == 1 ? clone.results[0].type : Type::Tuple;
        ExprId made = b.call(clone.name, type, frame.arguments);
        frame.results.clear();
        for (std::uint32_t i = 0; i < clone.results.size(); i++) {
            ExprId value = clone.results[i].value;
            const Expr& x = clone[value];
            if (x.op == Op::Constant && componentCount(x.type))
                frame.results.push_back(b.constant(x.type, clone.constantWords(value)));
            else if (x.op == Op::Param)
                frame.results.push_back(frame.arguments[x.payload]);
            else
                frame.results.push_back(type == Type::Tuple ? b.result(made, i, x.type) : made);
        }
    }
};

ExprId Demand::constant(ExprId id, int depth) {
    std::uint8_t& state = state_[id.index];
    if (!copy_[id] && !(state & kNotConstant)) {
        const Expr& e = from_[id];
        bool can = depth < kMaxDepth && e.op != Op::Call && e.op != Op::Result && e.op != Op::Loop &&
                   e.op != Op::Lights && e.op != Op::LoopArg && e.op != Op::Context && e.op != Op::Attribute &&
                   !isClosure(e.type);
        if (e.op == Op::Param) can = can && b_.function().isConstant(arguments_[e.payload]);
        if (e.op == Op::Uniform) can = can && owner_.baked.count(Name(e.payload));
        if (e.op == Op::Known) can = can && !owner_.isPartial && make(from_.operand(id, 0), depth + 1);
        for (std::size_t k = 0; can && e.op != Op::Known && k < e.operandCount; k++)
            can = static_cast<bool>(constant(from_.operand(id, k), depth + 1));
        if (can) owner_.plain(copy_, b_, from_, id, arguments_, {});
    }
    if (copy_[id] && b_.function().isConstant(copy_[id])) return copy_[id];
    state |= kNotConstant;
    return {};
}

bool Demand::make(ExprId id, int depth) {
    if (copy_[id]) return true;
    const Expr& e = from_[id];
    std::uint8_t& state = state_[id.index];
    bool can = !(state & kNotMade) && depth < kMaxDepth && e.op != Op::Call && e.op != Op::Result && e.op != Op::Loop &&
               e.op != Op::Lights && e.op != Op::Known && !isClosure(e.type);
    for (std::size_t k = 0; can && k < e.operandCount; k++) can = make(from_.operand(id, k), depth + 1);
    if (!can) {
        state |= kNotMade;
        return false;
    }
    owner_.plain(copy_, b_, from_, id, arguments_, {});
    return true;
}

}  // namespace

bool specialise(Module& module, Name entry, const std::unordered_set<Name>& baked, Specialisations& made,
                Diagnostics& diagnostics, const ExpansionLimits& limits) {
    Specialiser s{module, baked, diagnostics, false, made};
    s.limits = limits;
    return s.run(entry);
}

bool specialise(Module& module, Name entry, const std::unordered_set<Name>& baked, Diagnostics& diagnostics) {
    Specialisations made;
    return specialise(module, entry, baked, made, diagnostics);
}

void flatten(Module& module, Function& function) {
    Diagnostics ignored;  // a call of what is missing stays
    const std::unordered_set<Name> none;
    Specialisations made;
    Specialiser s{module, none, ignored, true, made};
    s.limits.expressions = 1u << 14;  // beyond, it is left to the materials that use it
    Function fresh = headOf(function);
    s.rebuild(function, fresh);
    if (!s.ok) return;
    function = std::move(fresh);
    function.isInline = Specialiser::isExpanded(function);
    function.isApart = !function.isInline;
}

}  // namespace shaderx::passes
