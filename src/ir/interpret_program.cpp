#include "ir/interpret_program.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include "ir/builder.h"
#include "ir/text.h"

namespace shaderx::ir {

std::uint32_t frameWords(Type type) {
    return type == Type::Texture2D ? 2 : static_cast<std::uint32_t>(componentCount(type));
}

bool takesDerivatives(const Module& module, const Function& function) {
    std::vector<const Function*> stack{&function};
    std::unordered_set<const Function*> seen{&function};
    while (!stack.empty()) {
        const Function& f = *stack.back();
        stack.pop_back();
        for (const Expr& e : f.exprs) {
            if (e.op == Op::Ddx || e.op == Op::Ddy) return true;
            if (e.op != Op::Call) continue;
            const Function* callee = module.find(Name(e.payload));
            if (callee && seen.insert(callee).second) stack.push_back(callee);
        }
    }
    return false;
}

namespace {

bool isLoop(const Expr& e) { return e.op == Op::Loop || e.op == Op::Lights; }
std::size_t beforeCarried(const Expr& e) { return e.op == Op::Loop ? 1 : 0; }
std::size_t carriedCount(const Expr& e) { return (e.operandCount - beforeCarried(e)) / 2; }

// A part of the program that runs or not as a whole: the function, a side of a select, the body of a loop. Each
// expression belongs to the smallest one that has all its users, but to none inside a loop that it does not vary with.
struct Region {
    std::uint32_t parent = 0, depth = 0;
    std::uint32_t loop = kNoLoop;  // the innermost around
    std::vector<ExprId> exprs = {};
};

struct Translator {
    const Module& module;
    const Function& f;
    Diagnostics& diagnostics;
    Program& p;

    std::vector<bool> needed = {};
    std::vector<std::uint32_t> loops = {};
    std::vector<Region> regions = {};
    static constexpr std::uint32_t kNoRegion = 0xffffffffu;
    std::vector<std::uint32_t> home = {};   // region by expression
    std::vector<std::uint32_t> inner = {};  // first region of a select or loop, by expression
    std::vector<Slot> slots = {};           // by expression
    std::vector<Slot> loopSlots = {};       // index, then carried values, by loop number
    std::vector<std::vector<Slot>> carriedSlots = {};
    std::unordered_map<Name, std::uint32_t> uniforms = {};
    std::unordered_map<const Function*, bool> derivatives = {};

    bool refuse(ExprId e, std::string message) {
        Diagnostic& d = diagnostics.error("cannot-interpret", std::move(message));
        d.notes.push_back({{}, fmt::format("in {}:\n    {}", module.names->text(f.name), printExpr(module, f, e))});
        return false;
    }

    // ---- What is needed, and whether it can be had ----

    bool isSkipped(ExprId e) const { return f[e].op == Op::Known; }  // its operand is not computed

    void markNeeded() {
        needed.assign(f.exprs.size(), false);
        for (const ResultValue& r : f.results) needed[r.value.index] = true;
        for (std::uint32_t i = static_cast<std::uint32_t>(f.exprs.size()); i-- > 0;)
            if (needed[i] && !isSkipped(ExprId(i)))
                for (ExprId o : f.operandsOf(ExprId(i))) needed[o.index] = true;
    }

    bool canRun() {
        bool can = true;
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            const Expr& e = f.exprs[i];
            if (!needed[i]) continue;
            const bool isTuple = e.type == Type::Tuple && (e.op == Op::Call || isLoop(e));
            if ((isTuple || frameWords(e.type) > 0) && e.op != Op::ExternText) continue;
            can = refuse(ExprId(i),
                         fmt::format("the interpreter does not run '{}' of {}", info(e.op).name, info(e.type).name));
        }
        return can;
    }

    // ---- Regions ----

    std::uint32_t addRegion(std::uint32_t parent, std::uint32_t loop) {
        regions.push_back({parent, regions[parent].depth + 1, loop});
        return static_cast<std::uint32_t>(regions.size() - 1);
    }

    std::uint32_t common(std::uint32_t a, std::uint32_t b) const {
        if (a == kNoRegion) return b;
        while (a != b) {
            std::uint32_t& deeper = regions[a].depth >= regions[b].depth ? a : b;
            deeper = regions[deeper].parent;
        }
        return a;
    }

    void useIn(ExprId e, std::uint32_t region) { home[e.index] = common(home[e.index], region); }

    bool takesDerivatives(const Expr& e) {
        if (e.op == Op::Ddx || e.op == Op::Ddy) return true;
        const Function* callee = e.op == Op::Call ? module.find(Name(e.payload)) : nullptr;
        if (!callee) return false;
        const auto [it, isNew] = derivatives.emplace(callee, false);
        if (isNew) it->second = ir::takesDerivatives(module, *callee);
        return it->second;
    }

    // Users before operands, so that an expression's region is known when it hands it on.
    void findRegions() {
        regions.assign(1, {});
        home.assign(f.exprs.size(), kNoRegion);
        inner.assign(f.exprs.size(), kNoRegion);
        for (const ResultValue& r : f.results) useIn(r.value, 0);
        for (std::uint32_t i = static_cast<std::uint32_t>(f.exprs.size()); i-- > 0;) {
            if (!needed[i]) continue;
            const ExprId id(i);
            const Expr& e = f.exprs[i];
            while (regions[home[i]].loop != loops[i] && home[i] != 0) home[i] = regions[home[i]].parent;
            // All pixels of a quad must come by: at the entry of the function.
            if (loops[i] == kNoLoop && takesDerivatives(e)) home[i] = 0;
            if (isSkipped(id)) continue;
            if (e.op == Op::Select) {
                inner[i] = addRegion(home[i], regions[home[i]].loop);
                addRegion(home[i], regions[home[i]].loop);
                useIn(f.operand(id, 0), home[i]);
                useIn(f.operand(id, 1), inner[i]);
                useIn(f.operand(id, 2), inner[i] + 1);
                continue;
            }
            const std::size_t outside = isLoop(e) ? beforeCarried(e) + carriedCount(e) : e.operandCount;
            if (isLoop(e)) inner[i] = addRegion(home[i], e.payload);
            for (std::size_t k = 0; k < e.operandCount; k++) useIn(f.operand(id, k), k < outside ? home[i] : inner[i]);
        }
        for (std::uint32_t i = 0; i < f.exprs.size(); i++)
            if (needed[i]) regions[home[i]].exprs.push_back(ExprId(i));
    }

    // ---- Slots ----

    Slot allocate(std::uint32_t words) {
        const Slot at = p.frameWords;
        p.frameWords += words;
        return at;
    }

    Slot constant(std::span<const std::uint32_t> words) {
        const Slot at = kConstantSlot | static_cast<Slot>(p.constants.size());
        p.constants.insert(p.constants.end(), words.begin(), words.end());
        return at;
    }
    Slot constant(std::uint32_t word) { return constant(std::span<const std::uint32_t>(&word, 1)); }

    void allocateLoop(ExprId id) {
        const Expr& e = f[id];
        loopSlots[e.payload] = allocate(1);
        for (std::size_t k = 0; k < carriedCount(e); k++)
            carriedSlots[e.payload].push_back(allocate(frameWords(f[f.operand(id, beforeCarried(e) + k)].type)));
    }

    Slot constantSlot(ExprId id) {
        if (f[id].type != Type::Texture2D) return constant(f.constantWords(id));
        const std::uint32_t none[2] = {2, 0};  // TextureRef::Kind::None
        return constant(none);
    }

    Slot resultSlot(ExprId id) const {
        const ExprId from = f.operand(id, 0);
        const std::uint32_t k = f[id].payload;
        if (isLoop(f[from])) return carriedSlots[f[from].payload][k];
        Slot at = slots[from.index];
        const Function* callee = module.find(Name(f[from].payload));
        for (std::uint32_t i = 0; i < k; i++) at += frameWords(callee->results[i].type);
        return at;
    }

    std::uint32_t tupleWords(const Expr& e) const {
        if (e.op != Op::Call || e.type != Type::Tuple) return frameWords(e.type);
        std::uint32_t words = 0;
        for (const ResultValue& r : module.find(Name(e.payload))->results) words += frameWords(r.type);
        return words;
    }

    Slot slotOf(ExprId id, std::span<const Slot> params) {
        const Expr& e = f[id];
        if (e.op == Op::Constant) return constantSlot(id);
        if (e.op == Op::Param) return params[e.payload];
        if (e.op == Op::LoopArg) {
            const std::uint32_t loop = e.payload >> 8, k = e.payload & 255;
            return k == 0 ? loopSlots[loop] : carriedSlots[loop][k - 1];
        }
        if (e.op == Op::Known) return f.isConstant(f.operand(id, 0)) ? constantSlot(f.operand(id, 0)) : constant(0);
        if (e.op == Op::Result) return resultSlot(id);
        if (isLoop(e)) return carriedSlots[e.payload].empty() ? 0 : carriedSlots[e.payload][0];
        return allocate(tupleWords(e));
    }

    void allocateSlots() {
        std::vector<Slot> params;
        for (const Param& param : f.params) params.push_back(allocate(frameWords(param.type)));
        slots.assign(f.exprs.size(), 0);
        loopSlots.assign(f.loops, 0);
        carriedSlots.assign(f.loops, {});
        for (std::uint32_t i = 0; i < f.exprs.size(); i++)
            if (needed[i] && isLoop(f.exprs[i])) allocateLoop(ExprId(i));
        for (std::uint32_t i = 0; i < f.exprs.size(); i++)
            if (needed[i]) slots[i] = slotOf(ExprId(i), params);
    }

    // ---- Instructions ----

    std::uint32_t here() const { return static_cast<std::uint32_t>(p.code.size()); }
    Source source(ExprId e) const { return {f[e].type, slots[e.index]}; }

    Instruction& add(Code code, ExprId e, std::span<const Source> sources) {
        Instruction in;
        in.code = code;
        in.op = f[e].op;
        in.type = f[e].type;
        in.destination = slots[e.index];
        in.firstSource = static_cast<std::uint32_t>(p.sources.size());
        in.sourceCount = static_cast<std::uint32_t>(sources.size());
        in.payload = f[e].payload;
        in.expr = e;
        p.sources.insert(p.sources.end(), sources.begin(), sources.end());
        return p.code.emplace_back(in);
    }
    Instruction& add(Code code, ExprId e, std::initializer_list<Source> sources) {
        return add(code, e, std::span(sources.begin(), sources.size()));
    }

    void copy(ExprId why, Slot to, Source from) {
        if (from.slot == to) return;
        Instruction& in = add(Code::Copy, why, {from});
        in.destination = to;
        in.target = frameWords(from.type);
    }

    void simple(Code code, ExprId id) {
        std::vector<Source> sources;
        for (ExprId o : f.operandsOf(id)) sources.push_back(source(o));
        Instruction& in = add(code, id, sources);
        if (f[id].op == Op::Uniform) in.target = uniforms.at(Name(f[id].payload));
    }

    enum class Step : std::uint8_t { Region, AfterThen, AfterElse, AfterLoop };
    struct Task {
        Step step = Step::Region;
        ExprId expr = {};
        std::uint32_t region = 0;
        std::size_t next = 0;
        std::uint32_t patch = 0;  // the instruction that jumps over what comes before this step
    };
    std::vector<Task> tasks = {};

    // Emits the code of a region and, by pushing tasks, of those inside it.
    void emitAll() {
        tasks.push_back({});
        while (!tasks.empty()) {
            const Task task = tasks.back();
            switch (task.step) {
                case Step::Region:
                    if (task.next == regions[task.region].exprs.size()) {
                        tasks.pop_back();
                    } else {
                        tasks.back().next++;
                        emit(regions[task.region].exprs[task.next]);
                    }
                    break;
                case Step::AfterThen:
                    afterThen(task);
                    break;
                case Step::AfterElse:
                    tasks.pop_back();
                    copy(task.expr, slots[task.expr.index], source(f.operand(task.expr, 2)));
                    p.code[task.patch].target = here();
                    break;
                case Step::AfterLoop:
                    tasks.pop_back();
                    afterLoop(task);
                    break;
            }
        }
    }

    void afterThen(const Task& task) {
        copy(task.expr, slots[task.expr.index], source(f.operand(task.expr, 1)));
        const std::uint32_t jump = here();
        add(Code::Jump, task.expr, {});
        p.code[task.patch].target = here();
        tasks.back() = {Step::AfterElse, task.expr, 0, 0, jump};
        tasks.push_back({Step::Region, {}, inner[task.expr.index] + 1});
    }

    void emit(ExprId id) {
        const Expr& e = f[id];
        if (isLoop(e)) return loop(id);
        if (e.op == Op::Select) return select(id);
        const bool isStored =
            e.op == Op::Constant || e.op == Op::Param || e.op == Op::LoopArg || e.op == Op::Known || e.op == Op::Result;
        if (isStored) return;
        Code code = Code::Execute;
        if (e.op == Op::Context || e.op == Op::Attribute || e.op == Op::Uniform) code = Code::Fetch;
        if (e.op == Op::TextureLevel || e.op == Op::TextureGrad || e.op == Op::TextureSize) code = Code::Texture;
        if (e.op == Op::Ddx || e.op == Op::Ddy) code = Code::Derivative;
        if (e.op == Op::Call) code = Code::Call;
        simple(code, id);
    }

    void select(ExprId id) {
        const std::uint32_t sides = inner[id.index];
        const bool isCheap = regions[sides].exprs.empty() && regions[sides + 1].exprs.empty();
        if (isCheap && f[id].type != Type::Texture2D) return simple(Code::Execute, id);
        const std::uint32_t jump = here();
        add(Code::JumpIfFalse, id, {source(f.operand(id, 0))});
        tasks.push_back({Step::AfterThen, id, 0, 0, jump});
        tasks.push_back({Step::Region, {}, sides});
    }

    void loop(ExprId id) {
        const Expr& e = f[id];
        const std::size_t first = beforeCarried(e), carried = carriedCount(e);
        const Slot index = loopSlots[e.payload];
        Source count;
        if (e.op == Op::Loop) {
            count = source(f.operand(id, 0));
        } else {
            count = {Type::Integer, allocate(1)};
            Instruction& in = add(Code::Fetch, id, {});
            in.op = Op::Context;
            in.type = Type::Integer;
            in.payload = static_cast<std::uint32_t>(Context::ActiveLights);
            in.destination = count.slot;
        }
        for (std::size_t k = 0; k < carried; k++)
            copy(id, carriedSlots[e.payload][k], source(f.operand(id, first + k)));
        copy(id, index, {Type::Integer, constant(0)});
        const std::uint32_t test = here();
        add(Code::LoopTest, id, {{Type::Integer, index}, count});
        tasks.push_back({Step::AfterLoop, id, 0, 0, test});
        tasks.push_back({Step::Region, {}, inner[id.index]});
    }

    // The carried values take the next ones, all at once.
    void afterLoop(const Task& task) {
        const Expr& e = f[task.expr];
        const std::size_t first = beforeCarried(e), carried = carriedCount(e);
        const auto& to = carriedSlots[e.payload];
        std::vector<Source> next;
        bool overlaps = false;
        for (std::size_t k = 0; k < carried; k++) {
            next.push_back(source(f.operand(task.expr, first + carried + k)));
            for (std::size_t j = 0; j < k; j++) overlaps = overlaps || next[k].slot == to[j];
        }
        if (overlaps)
            for (Source& s : next) {
                const Slot temporary = allocate(frameWords(s.type));
                copy(task.expr, temporary, s);
                s.slot = temporary;
            }
        for (std::size_t k = 0; k < carried; k++) copy(task.expr, to[k], next[k]);
        Instruction& in = add(Code::LoopNext, task.expr, {});
        in.destination = loopSlots[e.payload];
        in.target = task.patch;
        p.code[task.patch].target = here();
    }

    bool run() {
        p.function = &f;
        markNeeded();
        if (!canRun()) return false;
        for (std::uint32_t i = 0; i < module.uniforms.size(); i++) uniforms.emplace(module.uniforms[i].name, i);
        loops = loopsOf(f);
        findRegions();
        allocateSlots();
        emitAll();
        p.code.emplace_back();
        for (const ResultValue& r : f.results) p.results.push_back(source(r.value));
        p.callees.assign(p.code.size(), nullptr);
        return true;
    }
};

}  // namespace

bool translate(const Module& module, const Function& function, Diagnostics& diagnostics, Program& program) {
    return Translator{module, function, diagnostics, program}.run();
}

}  // namespace shaderx::ir
