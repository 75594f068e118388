// Lowering: statements and whole functions.
#include <algorithm>

#include "sl/lower_state.h"

namespace shaderx::sl {

Lowering::Flow Lowering::list(List l) {
    std::vector<Flow> parts;
    bool isOver = false, isTold = false;
    for (std::uint32_t i = 0; i < l.count; i++) {
        const Stmt& s = tree[tree.statementLists[l.first + i]];
        if (isOver && !isTold) report.warning(s.offset, "unreachable", "this is never reached");
        isTold = isOver;
        Flow f = statement(s);
        if (isOver || f.ends == Flow::Ends::Never) continue;
        isOver = f.ends == Flow::Ends::Always;
        parts.push_back(std::move(f));
    }
    return join(parts);
}

Lowering::Flow Lowering::statement(const Stmt& s) {
    switch (s.kind) {
        case StmtKind::Declare:
            declaration(s);
            return {};
        case StmtKind::Assign:
            assignment(s);
            return {};
        case StmtKind::Call:
            call(tree[s.value], true);
            return {};
        case StmtKind::If:
            return ifStatement(s);
        case StmtKind::For:
            loop(s);
            return {};
        case StmtKind::Return:
            return returns(s);
        case StmtKind::Block: {
            std::size_t outside = scope.size();
            enterBlock();
            Flow f = list(s.body);
            leaveBlock(outside);
            return f;
        }
    }
    return {};
}

void Lowering::declaration(const Stmt& s) {
    ExprId value;
    if (s.value) value = converted(expression(s.value), s.type, tree[s.value].offset, quoted(text(s.name)));
    std::uint32_t made = declare(s.name, s.type, s.offset);
    if (s.value) {
        Place whole;
        whole.variable = made;
        assign(whole, value);
    } else if (s.isConst) {
        report.error(s.offset, "not-assigned", fmt::format("the constant {} has no value", quoted(text(s.name))));
        set(made, {}, allBits(s.type));
    }
    if (s.isConst) variables[made].fixedAs = "a constant";
}

void Lowering::assignment(const Stmt& s) {
    auto place = placeOf(s.target, true);
    ExprId value = expression(s.value);
    if (!place) return;
    if (variables[place->variable].type == Type::Texture2D) {
        report.error(s.offset, "read-only", "a texture variable keeps its first value");
        return;
    }
    if (s.op != Operator::None) {
        ExprId before = read(*place, variables[place->variable], tree[s.target].offset);
        value = binaryValue(s.op, before, value, s.offset);
    }
    std::string what = place->isWhole ? quoted(text(variables[place->variable].name)) : "these components";
    assign(*place, converted(value, placeType(*place), tree[s.value].offset, what));
}

// Appends the outputs' values as they are where the function returns.
void Lowering::addOutputs(std::vector<ExprId>& results, std::uint32_t offset) {
    for (std::uint32_t o : outputs) {
        const Variable& v = variables[o];
        if (v.assigned != allBits(v.type)) {
            Diagnostic& d =
                report.error(offset, "not-assigned",
                             fmt::format("the output {} has no value here on every way", quoted(text(v.name))));
            d.notes.push_back({report.at(v.offset), "declared here"});
        }
        results.push_back(v.assigned == allBits(v.type) ? v.value : ExprId());
    }
}

Lowering::Flow Lowering::returns(const Stmt& s) {
    Flow flow;
    bool isVoid = function->result == Type::Void;
    ExprId value;
    if (s.value) value = expression(s.value);
    if (loops > 0) {
        report.error(s.offset, "return-in-loop", "a loop cannot return").hint =
            "keep the result in a variable and return it after the loop";
        return flow;
    }
    flow.ends = Flow::Ends::Always;
    if (isVoid && s.value)
        report.error(s.offset, "type-mismatch", fmt::format("{} returns no value", quoted(text(function->name))));
    else if (!isVoid && !s.value)
        report.error(s.offset, "missing-return", fmt::format("{} returns a value", quoted(text(function->name))));
    if (!isVoid)
        flow.results.push_back(s.value ? converted(value, function->result, tree[s.value].offset, "the result")
                                       : ExprId());
    addOutputs(flow.results, s.offset);
    return flow;
}

Lowering::Flow Lowering::ifStatement(const Stmt& s) {
    std::vector<Branch> list_;
    for (std::uint32_t i = 0; i < s.body.count; i++) {
        const Arm& arm = tree.arms[s.body.first + i];
        Branch branch;
        // A condition may write outputs of a call; it is asked only where those before it are false, but an output
        // written there is refused, so the values of variables are the same for all.
        if (arm.condition) branch.condition = condition(arm.condition);
        if (arm.condition && i > 0 && writes(arm.condition))
            report
                .error(tree[arm.condition].offset, "unsupported", "the condition of an 'else if' cannot write outputs")
                .hint = "call the function before the 'if'";
        std::size_t outside = scope.size();
        enterBlock();
        Mark mark = beginBranch();
        branch.flow = list(arm.body);
        branch.left = endBranch(mark);
        leaveBlock(outside);
        list_.push_back(std::move(branch));
    }
    if (tree.arms[s.body.first + s.body.count - 1].condition) list_.emplace_back();
    return merge(list_);
}

// ---- loops ----

void Lowering::scanTarget(NodeId target, Scan& into) {
    while (tree[target].kind == NodeKind::Member || tree[target].kind == NodeKind::Index)
        target = tree.child(tree[target], 0);
    const Node& n = tree[target];
    if (n.kind != NodeKind::Name) return;
    if (auto hidden = into.hidden.find(n.name); hidden != into.hidden.end() && hidden->second > 0) return;
    if (auto v = visible(n.name)) into.found.push_back(*v);
}

void Lowering::scanExpression(NodeId root, Scan& into) {
    if (!root) return;
    std::vector<NodeId> stack{root};
    while (!stack.empty()) {
        const Node& n = tree[stack.back()];
        stack.pop_back();
        bool mayWrite = n.kind == NodeKind::Call && n.type == Type::Void && program.functions.has(n.name);
        for (std::uint32_t k = 0; k < n.children.count; k++) {
            stack.push_back(tree.child(n, k));
            if (mayWrite && program.functions.mayWrite(n.name, n.children.count, k)) scanTarget(stack.back(), into);
        }
    }
}

void Lowering::scan(List l, Scan& into) {
    std::size_t outside = into.inner.size();
    auto hide = [&](Name name) {
        into.inner.push_back(name);
        into.hidden[name]++;
    };
    for (std::uint32_t i = 0; i < l.count; i++) {
        const Stmt& s = tree[tree.statementLists[l.first + i]];
        scanExpression(s.value, into);
        switch (s.kind) {
            case StmtKind::Declare:
                hide(s.name);
                break;
            case StmtKind::Assign:
                scanTarget(s.target, into);
                scanExpression(s.target, into);
                break;
            case StmtKind::Call:
            case StmtKind::Return:
                break;
            case StmtKind::If:
                for (std::uint32_t k = 0; k < s.body.count; k++) {
                    scanExpression(tree.arms[s.body.first + k].condition, into);
                    scan(tree.arms[s.body.first + k].body, into);
                }
                break;
            case StmtKind::For:
                scanExpression(tree[s.init].value, into);
                hide(tree[s.init].name);
                scan(s.body, into);
                into.hidden[tree[s.init].name]--;
                into.inner.pop_back();
                break;
            case StmtKind::Block:
                scan(s.body, into);
                break;
        }
    }
    for (; into.inner.size() > outside; into.inner.pop_back()) into.hidden[into.inner.back()]--;
}

// Variables from outside that the body assigns, in order.
std::vector<std::uint32_t> Lowering::assignedIn(const Stmt& s) {
    Scan into;
    Name index = tree[s.init].name;
    into.inner.push_back(index);
    into.hidden[index]++;
    scan(s.body, into);
    std::sort(into.found.begin(), into.found.end());
    into.found.erase(std::unique(into.found.begin(), into.found.end()), into.found.end());
    return std::move(into.found);
}

static constexpr std::string_view kLoopForm = "write 'for (int i = 0; i < count; i++)'";

ExprId Lowering::loopStep(const Stmt& s, Name index) {
    const Stmt& step = tree[s.step];
    bool isStep = step.kind == StmtKind::Assign && step.op == Operator::Add &&
                  tree[step.target].kind == NodeKind::Name && tree[step.target].name == index;
    if (!isStep) {
        report.error(step.offset, "loop-form", "a loop goes on by 'i++' or 'i += step'").hint = kLoopForm;
        return {};
    }
    ExprId value = expression(step.value);
    if (!value) return {};
    bool isFixed = b.function().isConstant(value) && b.type(value) == Type::Integer;
    if (!isFixed || static_cast<int>(b.function().constantWords(value)[0]) <= 0) {
        report.error(tree[step.value].offset, "loop-form", "the step of a loop is a constant integer above 0");
        return {};
    }
    return value;
}

// The count of turns for a step of 1 from 0: what the condition compares with, plus 1 for `<=`.
ExprId Lowering::loopBound(const Stmt& s, Name index, const std::vector<std::uint32_t>& carried) {
    const Node& n = tree[s.value];
    bool isBound = n.kind == NodeKind::Binary && (n.op == Operator::Less || n.op == Operator::LessEqual) &&
                   tree[tree.child(n, 0)].kind == NodeKind::Name && tree[tree.child(n, 0)].name == index;
    if (!isBound) {
        report.error(n.offset, "loop-form", "a loop goes on while its index is below a bound").hint = kLoopForm;
        return {};
    }
    NodeId bound = tree.child(n, 1);
    std::vector<Name> read;
    namesRead(tree, bound, read);
    for (Name name : read) {
        auto v = visible(name);
        bool changes_ = name == index || (v && std::binary_search(carried.begin(), carried.end(), *v));
        if (!changes_) continue;
        report
            .error(tree[bound].offset, "loop-form",
                   fmt::format("the bound reads {}, which changes in the loop", quoted(text(name))))
            .hint = "keep the bound in a variable of its own";
        return {};
    }
    ExprId value = converted(expression(bound), Type::Integer, tree[bound].offset, "the bound of a loop");
    if (value && n.op == Operator::LessEqual) value = b.op(Op::Add, {value, b.integer(1)});
    return value;
}

Lowering::LoopHead Lowering::loopHead(const Stmt& s, const std::vector<std::uint32_t>& carried) {
    const Stmt& init = tree[s.init];
    LoopHead head;
    head.index = init.name;
    if (init.type != Type::Integer) {
        report.error(init.offset, "loop-form", "the index of a loop is an int").hint = kLoopForm;
        return head;
    }
    if (!init.value) {
        report.error(init.offset, "loop-form", "the index of a loop has no first value").hint = kLoopForm;
        return head;
    }
    head.start = converted(expression(init.value), Type::Integer, tree[init.value].offset, quoted(text(init.name)));
    ExprId bound = loopBound(s, head.index, carried);
    head.step = loopStep(s, head.index);
    if (!head.start || !bound || !head.step) return head;
    // ceil((bound - start) / step); a negative count is none, and truncation makes it so.
    ExprId length = b.op(Op::Sub, {bound, head.start});
    ExprId rounding = b.op(Op::Sub, {head.step, b.integer(1)});
    head.count = b.op(Op::Div, {b.op(Op::Add, {length, rounding}), head.step});
    return head;
}

void Lowering::loop(const Stmt& s) {
    std::vector<std::uint32_t> changed = assignedIn(s), carried;
    LoopHead head = loopHead(s, changed);
    std::vector<ExprId> first, next;
    std::vector<std::uint32_t> bitsBefore;
    for (std::uint32_t v : changed) {
        bitsBefore.push_back(variables[v].assigned);
        if (!variables[v].value) continue;
        carried.push_back(v);
        first.push_back(variables[v].value);
    }
    bool isGood = static_cast<bool>(head.count);
    if (carried.size() > 254) {
        report.error(s.offset, "too-large", "a loop that changes more than 254 variables");
        isGood = false;
    }
    std::uint32_t id = isGood ? b.beginLoop() : 0;
    for (std::uint32_t k = 0; k < carried.size(); k++) {
        const Variable& v = variables[carried[k]];
        ExprId value = isGood ? b.loopCarried(id, k, v.type) : ExprId();
        if (value) b.hint(value, v.name);
        set(carried[k], value, v.assigned);
    }
    std::size_t outside = scope.size();
    enterBlock();
    ExprId index;
    if (isGood) {
        index = b.op(Op::Add, {head.start, b.op(Op::Mul, {b.loopIndex(id), head.step})});
        b.hint(index, head.index);
    }
    std::uint32_t i = declare(head.index, Type::Integer, tree[s.init].offset, "the index of a loop");
    set(i, index, allBits(Type::Integer));
    enterBlock();
    loops++;
    list(s.body);
    loops--;
    leaveBlock(outside + 1);
    leaveBlock(outside);
    for (std::uint32_t v : carried) {
        next.push_back(variables[v].value);
        isGood = isGood && next.back();
    }
    // After no turn at all a variable has what it had before.
    for (std::size_t k = 0; k < changed.size(); k++) set(changed[k], {}, bitsBefore[k]);
    if (!isGood || carried.empty()) return;
    ExprId made = b.endLoop(id, head.count, first, next);
    for (std::uint32_t k = 0; k < carried.size(); k++) {
        const Variable& v = variables[carried[k]];
        ExprId value = b.result(made, k, v.type);
        hint(value, v.name);
        set(carried[k], value, v.assigned);
    }
}

// ---- functions ----

void Lowering::body(const FunctionDecl& decl) {
    function = &decl;
    for (std::uint32_t k = 0; k < decl.params.size(); k++)
        set(declare(decl.params[k].name, decl.params[k].type, decl.params[k].offset), b.param(k),
            allBits(decl.params[k].type));
    for (const ParamDecl& p : decl.outputs) outputs.push_back(declare(p.name, p.type, p.offset));
    Flow flow = list(decl.body);
    if (flow.ends != Flow::Ends::Always) {
        if (decl.result != Type::Void) {
            report.error(decl.offset, "missing-return",
                         fmt::format("{} can end without returning a value", quoted(text(decl.name))));
            return;
        }
        Flow end;
        end.ends = Flow::Ends::Always;
        addOutputs(end.results, decl.offset);
        flow = flow.ends == Flow::Ends::Never ? end : join({flow, end});
    }
    for (ExprId r : flow.results)
        if (!r) return;  // its error is told
    std::size_t k = 0;
    if (decl.result != Type::Void) b.addResult(program.module.names->intern("out"), flow.results[k++]);
    for (const ParamDecl& p : decl.outputs) b.addResult(p.name, flow.results[k++]);
}

void lowerFunction(Program& program, std::uint32_t unit, const FunctionDecl& decl, ir::Function& out,
                   std::vector<CallSite>& calls) {
    Lowering l(program, unit, out);
    l.calls = &calls;
    l.body(decl);
}

void lowerInline(Program& program, std::uint32_t unit, std::span<const ir::Param> results, ir::Function& out) {
    Lowering l(program, unit, out);
    for (std::uint32_t k = 0; k < out.params.size(); k++)
        l.set(l.declare(out.params[k].name, out.params[k].type, 0), l.b.param(k),
              Lowering::allBits(out.params[k].type));
    for (std::size_t k = 0; k < results.size(); k++) {
        NodeId e = l.tree.expressions[k];
        ExprId value = l.converted(l.expression(e), results[k].type, l.tree[e].offset, "the result");
        if (value) l.b.addResult(results[k].name, value);
    }
}

void foldConstant(Program& program, Constant& constant) {
    ir::Function scratch;
    Lowering l(program, constant.unit, scratch);
    const ConstDecl& decl = l.tree.constants[constant.declaration];
    std::string what = quoted(l.text(decl.name));
    ExprId value = l.converted(l.expression(decl.value), decl.type, l.tree[decl.value].offset, what);
    if (!value) return;
    bool isText = decl.type == Type::String;
    if (!scratch.isConstant(value) || (!isText && ir::componentCount(decl.type) == 0)) {
        l.report.error(l.tree[decl.value].offset, "not-constant", fmt::format("the value of {} is not constant", what));
        return;
    }
    constant.isKnown = true;
    if (isText)
        constant.text = Name(scratch[value].payload);
    else
        constant.words.assign(scratch.constantWords(value).begin(), scratch.constantWords(value).end());
}

}  // namespace shaderx::sl
