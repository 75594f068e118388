#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <fmt/format.h>

#include "base/diagnostics.h"
#include "base/numbers.h"
#include "targets/glsl/glsl.h"
#include "targets/glsl/names.h"
#include "targets/glsl/printer.h"

namespace shaderx::glsl {

using namespace ir;

FunctionPrinter::FunctionPrinter(Stage& stage, const Function& function, bool isEntry)
    : stage_(stage), f_(function), isEntry_(isEntry), names_(function.exprs.size()) {
    stage_.namer.enterFunction();
    for (const Param& p : f_.params) params_.push_back(stage_.namer.local(stage_.module.names->text(p.name)));
    // A value without a name is called as the first function that takes it calls it.
    asked_.resize(f_.exprs.size());
    uses_.resize(f_.exprs.size());
    for (ExprId o : f_.operands) uses_[o.index]++;
    for (std::uint32_t i = 0; i < f_.exprs.size(); i++) {
        const Expr& e = f_.exprs[i];
        if (e.op == Op::Result) resultsOf_[f_.operand(ExprId(i), 0).index].push_back(i);
        if (e.op == Op::LoopArg) argumentsOf_[e.payload >> 8].push_back(i);
        const Function* callee = e.op == Op::Call ? stage_.module.findOwn(Name(e.payload)) : nullptr;
        for (std::size_t k = 0; callee && k < e.operandCount; k++) {
            Name& name = asked_[f_.operandsOf(e)[k].index];
            if (!name) name = callee->params[k].name;
        }
    }
}

void FunctionPrinter::print() {
    ensure(!f_.body.blocks.empty(), "a function that is not placed");
    if (!isEntry_) stage_.out.comment(text::Writer::firstSentence(f_.comment));
    stage_.out.open(signature());
    atEntryLevel_ = true;
    block(BlockId(0));
    isEntry_ ? entryResults() : functionResults();
    stage_.out.close();
}

std::string FunctionPrinter::signature() {
    if (isEntry_) return "void main()";
    std::string text(typeName(f_.results[0].type));
    text.append(" ").append(stage_.globals.at(f_.name)).append("(");
    std::string_view between;
    auto parameter = [&](std::string_view kind, Type type, const std::string& name) {
        text.append(between).append(kind).append(typeName(type)).append(" ").append(name);
        between = ", ";
    };
    for (std::size_t i = 0; i < params_.size(); i++) parameter("", f_.params[i].type, params_[i]);
    for (std::size_t k = 1; k < f_.results.size(); k++) {
        outs_.push_back(stage_.namer.local(stage_.module.names->text(f_.results[k].name)));
        parameter("out ", f_.results[k].type, outs_.back());
    }
    return text + ")";
}

void FunctionPrinter::entryResults() {
    for (std::size_t k = 0; k < f_.results.size(); k++) {
        std::string name = stage_.output;
        if (stage_.isPixel && k == 1) {  // see passes/shade.h
            stage_.out.line(fmt::format("if ({})", textOf(f_.results[k].value)));
            stage_.out.line("\tdiscard;");
            continue;
        }
        if (!stage_.isPixel) name = k == 0 ? "gl_Position" : "vd." + stage_.members.at(f_.results[k].name);
        stage_.out.line({name, " = ", textOf(f_.results[k].value), ";"});
    }
}

void FunctionPrinter::functionResults() {
    for (std::size_t k = 1; k < f_.results.size(); k++)
        if (names_[f_.results[k].value.index] != outs_[k - 1])
            stage_.out.line({outs_[k - 1], " = ", textOf(f_.results[k].value), ";"});
    stage_.out.line({"return ", textOf(f_.results[0].value), ";"});
}

void FunctionPrinter::block(BlockId id) {
    for (const Stmt& s : f_.body.blocks[id.index]) switch (s.kind) {
            case StmtKind::Let:
                let(s);
                break;
            case StmtKind::If:
                branch(s);
                break;
            case StmtKind::Loop:
                loop(s);
                break;
        }
}

void FunctionPrinter::let(const Stmt& s) {
    if (f_[s.expr].type == Type::Tuple) return letTuple(s);
    std::string name = variableFor(s.expr);
    std::string& line = stage_.out.begin();
    line.append(typeName(f_[s.expr].type)).append(" ").append(name).append(" = ");
    write(line, s.expr);
    stage_.out.end(";");
    names_[s.expr.index] = std::move(name);
}

// The `out` parameter that a value becomes, where it becomes nothing else.
std::string* FunctionPrinter::outFor(ExprId e) {
    std::string* found = nullptr;
    int uses = uses_[e.index];
    for (std::size_t k = 0; k < f_.results.size(); k++) {
        if (f_.results[k].value != e) continue;
        uses++;
        if (k > 0 && !isEntry_ && atEntryLevel_) found = &outs_[k - 1];
    }
    return uses == 1 ? found : nullptr;
}

// The first result is what the function returns, the others are its `out` parameters.
void FunctionPrinter::letTuple(const Stmt& s) {
    const Function* callee = stage_.module.findOwn(Name(f_[s.expr].payload));
    std::vector<std::string> results(callee->results.size());
    std::vector<bool> isOut(results.size());  // written straight to an `out` parameter of this function
    if (auto parts = resultsOf_.find(s.expr.index); parts != resultsOf_.end())
        for (std::uint32_t i : parts->second) {
            std::string& name = results[f_.exprs[i].payload];
            if (std::string* out = outFor(ExprId(i)); out && f_.exprs[i].payload > 0 && name.empty()) {
                name = *out;
                isOut[f_.exprs[i].payload] = true;
            } else if (name.empty()) {
                bool hinted = static_cast<bool>(f_.hints[i]);
                std::string_view own = stage_.module.names->text(callee->results[f_.exprs[i].payload].name);
                name = hinted || own.empty() ? variableFor(ExprId(i)) : stage_.namer.local(own);
            }
            names_[i] = name;
        }
    std::string arguments;
    for (ExprId o : f_.operandsOf(s.expr)) arguments += (arguments.empty() ? "" : ", ") + textOf(o, 1);
    for (std::size_t k = 0; k < results.size(); k++) {
        if (results[k].empty()) results[k] = stage_.namer.local(stage_.module.names->text(callee->results[k].name));
        if (k == 0) continue;
        if (!isOut[k]) stage_.out.line({typeName(callee->results[k].type), " ", results[k], ";"});
        arguments += (arguments.empty() ? "" : ", ") + results[k];
    }
    stage_.out.line({typeName(callee->results[0].type), " ", results[0], " = ", stage_.globals.at(callee->name), "(",
                     arguments, ");"});
}

void FunctionPrinter::branch(const Stmt& s) {
    std::span<const ExprId> phis(f_.body.phis.data() + s.firstPhi, s.phiCount);
    // A branch without statements of its own is an expression.
    if (f_.body.blocks[s.body.index].empty() && f_.body.blocks[s.orElse.index].empty()) {
        for (ExprId phi : phis) {
            std::string value = textOf(phi), name = variableFor(phi);
            stage_.out.line({typeName(f_[phi].type), " ", name, " = ", value, ";"});
            names_[phi.index] = name;
        }
        return;
    }
    std::vector<std::string> names;
    for (ExprId phi : phis) {
        names.push_back(variableFor(phi));
        stage_.out.line({typeName(f_[phi].type), " ", names.back(), ";"});
    }
    std::string condition = textOf(s.expr);
    bool level = std::exchange(atEntryLevel_, false);
    stage_.out.open("if (" + condition + ")");
    for (std::size_t side = 1; side <= 2; side++) {
        block(side == 1 ? s.body : s.orElse);
        for (std::size_t k = 0; k < phis.size(); k++)
            stage_.out.line({names[k], " = ", textOf(f_.operand(phis[k], side)), ";"});
        stage_.out.close();
        if (side == 1) stage_.out.open("else");
    }
    atEntryLevel_ = level;
    for (std::size_t k = 0; k < phis.size(); k++) names_[phis[k].index] = names[k];
}

void FunctionPrinter::nameLoopValues(ExprId loop, std::size_t carried, std::vector<std::string>& names,
                                     std::string& index) {
    std::uint32_t number = f_[loop].payload;
    std::vector<Name> hints(carried);
    Name indexHint;
    for (std::uint32_t i : argumentsOf_[number]) {
        std::uint32_t k = f_.exprs[i].payload & 255;
        (k ? hints[k - 1] : indexHint) = f_.hints[i];
    }
    index = stage_.namer.local(indexHint ? stage_.module.names->text(indexHint) : "i");
    const std::vector<std::uint32_t>& results = resultsOf_[loop.index];
    for (std::uint32_t i : results)
        if (Name& hint = hints[f_.exprs[i].payload]; !hint) hint = f_.hints[i];
    for (std::size_t k = 0; k < carried; k++)
        names.push_back(stage_.namer.local(hints[k] ? stage_.module.names->text(hints[k]) : "sum"));
    for (std::uint32_t i : argumentsOf_[number]) {
        std::uint32_t k = f_.exprs[i].payload & 255;
        names_[i] = k ? names[k - 1] : index;
    }
    for (std::uint32_t i : results) names_[i] = names[f_.exprs[i].payload];
}

void FunctionPrinter::loop(const Stmt& s) {
    ensure(f_[s.expr].op == Op::Loop, "a light loop that is not lowered");
    auto o = f_.operandsOf(s.expr);
    std::size_t carried = (o.size() - 1) / 2;
    std::vector<std::string> first, names;
    for (std::size_t k = 0; k < carried; k++) first.push_back(textOf(o[1 + k]));
    std::string count = textOf(o[0], 10), index;
    nameLoopValues(s.expr, carried, names, index);
    for (std::size_t k = 0; k < carried; k++)
        stage_.out.line({typeName(f_[o[1 + k]].type), " ", names[k], " = ", first[k], ";"});
    bool level = std::exchange(atEntryLevel_, false);
    stage_.out.open("for (int " + index + " = 0; " + index + " < " + count + "; " + index + "++)");
    block(s.body);
    nextValues(s.expr, carried, 1 + carried, names);
    stage_.out.close();
    atEntryLevel_ = level;
}

// All carried values change at once: one is assigned when no other still has to read it; where they read each other in
// a ring, one goes through a variable of its own.
void FunctionPrinter::nextValues(ExprId loop, std::size_t carried, std::size_t firstNext,
                                 const std::vector<std::string>& names) {
    auto self = [&](std::size_t k) { return f_[loop].payload << 8 | static_cast<std::uint32_t>(k + 1); };
    std::vector<std::size_t> pending;
    std::vector<std::string> saved(carried);
    for (std::size_t k = 0; k < carried; k++) {
        const Expr& next = f_[f_.operand(loop, firstNext + k)];
        if (!(next.op == Op::LoopArg && next.payload == self(k))) pending.push_back(k);
    }
    while (!pending.empty()) {
        std::size_t chosen = pending.size();
        for (std::size_t p = 0; p < pending.size() && chosen == pending.size(); p++) {
            bool read = false;
            for (std::size_t other : pending)
                if (other != pending[p] && saved[other].empty())
                    read = read || readsInline(f_.operand(loop, firstNext + other), self(pending[p]));
            if (!read) chosen = p;
        }
        if (chosen == pending.size()) {  // a ring
            std::size_t k =
                *std::find_if(pending.begin(), pending.end(), [&](std::size_t p) { return saved[p].empty(); });
            ExprId next = f_.operand(loop, firstNext + k);
            saved[k] = stage_.namer.local("next");
            stage_.out.line({typeName(f_[next].type), " ", saved[k], " = ", textOf(next), ";"});
            continue;
        }
        std::size_t k = pending[chosen];
        if (saved[k].empty())
            assign(names[k], f_.operand(loop, firstNext + k), ExprId(self(k)));
        else
            stage_.out.line({names[k], " = ", saved[k], ";"});
        pending.erase(pending.begin() + static_cast<std::ptrdiff_t>(chosen));
    }
}

// Whether an expression's own text, up to values that have a name, reads a loop argument.
bool FunctionPrinter::readsInline(ExprId value, std::uint32_t payload) const {
    std::vector<ExprId> todo{value};
    while (!todo.empty()) {
        ExprId e = todo.back();
        todo.pop_back();
        if (f_[e].op == Op::LoopArg) {
            if (f_[e].payload == payload) return true;
            continue;
        }
        if (!names_[e.index].empty()) continue;
        for (ExprId o : f_.operandsOf(e)) todo.push_back(o);
    }
    return false;
}

// `self` holds the payload of the loop argument that the target is, so that x = x + y prints as x += y.
void FunctionPrinter::assign(const std::string& target, ExprId value, ExprId self) {
    const Expr& v = f_[value];
    auto isSelf = [&](ExprId e) { return f_[e].op == Op::LoopArg && f_[e].payload == self.index; };
    bool sum = v.op == Op::Add || (v.op == Op::Mul && !isMatrix(v.type)), difference = v.op == Op::Sub;
    if (names_[value.index].empty() && (sum || difference)) {
        auto o = f_.operandsOf(value);
        std::string_view op = operatorOf(v.op).text;
        if (isSelf(o[0])) return stage_.out.line({target, " ", op, "= ", textOf(o[1]), ";"});
        if (sum && isSelf(o[1])) return stage_.out.line({target, " ", op, "= ", textOf(o[0]), ";"});
    }
    if (names_[value.index].empty() && v.op == Op::Select && isSelf(f_.operand(value, 2)))
        return stage_.out.line(
            {"if (", textOf(f_.operand(value, 0)), ") ", target, " = ", textOf(f_.operand(value, 1)), ";"});
    stage_.out.line({target, " = ", textOf(value), ";"});
}

namespace {

// A uniform up to its value.
std::string& beginUniform(Stage& stage, Type type, const std::string& name) {
    std::string& line = stage.out.begin().append("uniform ");
    line.append(typeName(type)) += ' ';
    return line.append(name);
}

// The same in every shader, and some of them are matrices.
const std::string& defaultText(Context c) {
    static const std::array<std::string, kContexts> texts = [] {
        std::array<std::string, kContexts> all;
        for (std::size_t i = 0; i < all.size(); i++) {
            const Context context = static_cast<Context>(i);
            const Type type = info(context).type;
            if (componentCount(type)) writeConstant(all[i], type, passes::defaultOf(context).data());
        }
        return all;
    }();
    return texts[static_cast<std::size_t>(c)];
}

// One uniform block; its members need no prefix. Values that the host has not set are undefined.
void openBlock(Stage& stage, std::string_view name, int index) {
    int base = stage.interface.bindingBase;
    std::string binding = base < 0 ? "" : fmt::format(", binding = {}", base + index);
    stage.out.open(fmt::format("layout(std140{}) uniform {}", binding, name));
}

void samplerLine(Stage& stage, const std::string& name, int& index) {
    int base = stage.interface.bindingBase;
    std::string layout = base < 0 ? "" : fmt::format("layout(binding = {}) ", base + index++);
    stage.out.line(fmt::format("{}uniform sampler2D {};", layout, name));
}

// Both stages declare the same block of contexts, so that one buffer serves both.
void blocks(Stage& stage, const passes::StageUniforms& used) {
    auto member = [&](Type type, const std::string& name) {
        stage.out.line(fmt::format("{} {};", typeName(type), name));
    };
    bool readsContexts = false;
    for (Context c : used.contexts) readsContexts = readsContexts || info(c).type != Type::Texture2D;
    std::vector<Context> contexts = passes::blockContexts(stage.interface);
    if (readsContexts) {
        openBlock(stage, "PrivateUniforms", 0);
        for (Context c : contexts) member(info(c).type, stage.namer.global(info(c).host));
        stage.out.close("};");
        stage.out.line();
    }
    int index = contexts.empty() ? 0 : 1;
    std::vector<Name> values = passes::blockUniforms(stage.module, stage.interface);
    if (stage.isPixel && !values.empty()) {
        openBlock(stage, "PublicUniforms", index++);
        for (Name name : values) {
            stage.globals[name] = stage.namer.global(stage.module.names->text(name));
            member(stage.module.uniform(name)->type, stage.globals[name]);
        }
        stage.out.close("};");
        stage.out.line();
    }
    for (Context c : used.contexts)
        if (info(c).type == Type::Texture2D) samplerLine(stage, stage.namer.global(info(c).host), index);
    for (Name name : used.uniforms)
        if (const Uniform* u = stage.module.uniform(name); u && u->type == Type::Texture2D) {
            stage.globals[name] = stage.namer.global(stage.module.names->text(name));
            samplerLine(stage, stage.globals[name], index);
        }
    if (stage.isPixel) stage.out.line();
}

void uniforms(Stage& stage, const passes::StageUniforms& used) {
    if (stage.interface.usesBlocks) return blocks(stage, used);
    int index = 0;
    for (Context c : used.contexts) {
        const std::string& name = stage.namer.global(info(c).host);
        if (info(c).type == Type::Texture2D) {
            samplerLine(stage, name, index);
            continue;
        }
        beginUniform(stage, info(c).type, name).append(" = ").append(defaultText(c));
        stage.out.end(";");
    }
    if (!used.contexts.empty() && !used.uniforms.empty()) stage.out.line();
    for (Name name : used.uniforms)
        if (const Uniform* u = stage.module.uniform(name)) {
            std::string& spelled = stage.globals[name] = stage.namer.global(stage.module.names->text(name));
            if (u->type == Type::Texture2D) {
                samplerLine(stage, spelled, index);
                continue;
            }
            std::string& line = beginUniform(stage, u->type, spelled);
            const std::size_t value = line.size();
            writeConstant(line.append(" = "), u->type, u->values.data());
            stage.out.end(";");
            stage.apart.emplace_back(value, stage.out.size());
        }
    if (!used.contexts.empty() || !used.uniforms.empty()) stage.out.line();
}

// Numbers of bindings came with 4.20.
void version(Stage& stage) { stage.out.line(stage.interface.bindingBase < 0 ? "#version 400" : "#version 420"); }

void vertexData(Stage& stage, std::string_view direction) {
    if (stage.interface.varyings.empty()) return;
    stage.out.open(std::string(direction) + " VertexData");
    text::Namer members(reservedWords());  // both stages come to the same names
    for (const passes::Varying& v : stage.interface.varyings) {
        stage.members[v.name] = members.global(stage.module.names->text(v.name));
        stage.out.line({typeName(v.type), " ", stage.members[v.name], ";"});
    }
    stage.out.close("} vd;");
    stage.out.line();
}

// What a reader should know of an attribute that a mesh may lack.
std::string usualValue(const passes::VertexInput& in) {
    if (in.value.empty()) return {};
    std::string text = "  // ";
    for (std::size_t i = 0; i < in.value.size(); i++) {
        if (i) text += ", ";
        text += info(in.type).scalar == Scalar::Float ? formatFloat(std::bit_cast<float>(in.value[i]))
                                                      : std::to_string(static_cast<int>(in.value[i]));
    }
    return text + " where a mesh has none";
}

void vertexStage(const Module& module, const passes::ShaderInterface& interface, Sources& sources) {
    Stage stage{module, interface, false, text::Namer(reservedWords())};
    version(stage);
    stage.out.line();
    uniforms(stage, interface.vertexUniforms);
    for (const passes::VertexInput& in : interface.inputs) {
        stage.inputs[in.name] = stage.namer.global(module.names->text(in.name));
        stage.out.line({"in ", typeName(in.type), " ", stage.inputs[in.name], ";", usualValue(in)});
    }
    stage.out.line();
    vertexData(stage, "out");
    FunctionPrinter(stage, *module.findOwn(interface.vertex), true).print();
    sources.vertex = stage.out.take();
    sources.names.insert(stage.inputs.begin(), stage.inputs.end());
}

// All that decides the text of a function whose content has this number: how what it refers to is spelled.
std::string keyOf(const Stage& stage, const Function& f, std::uint32_t number) {
    std::string key(reinterpret_cast<const char*>(&number), sizeof(number));
    key += stage.globals.at(f.name);
    for (const Expr& e : f.exprs) {
        if (e.op == Op::Call || e.op == Op::Uniform) key.append("\n").append(stage.globals.at(Name(e.payload)));
        if (e.op == Op::Attribute) key.append("\n").append(stage.members.at(Name(e.payload)));
    }
    return key;
}

void printFunction(Stage& stage, const Function& f, text::FunctionTexts* texts) {
    if (!texts) return FunctionPrinter(stage, f, false).print();
    const std::string key = keyOf(stage, f, texts->numbers->at(f.name));
    if (auto found = texts->known.find(key); found != texts->known.end()) {
        const std::vector<std::string>& locals = found->second.locals;
        if (std::none_of(locals.begin(), locals.end(), [&](const auto& l) { return stage.namer.isGlobal(l); }))
            return stage.out.raw(found->second.text);
    }
    const std::size_t start = stage.out.size();
    FunctionPrinter(stage, f, false).print();
    if (stage.namer.gaveWay()) return;
    text::FunctionTexts::Text& kept = texts->known[key];
    kept.text = stage.out.since(start);
    for (std::size_t k = 0; k < stage.namer.locals().size(); k++) kept.locals.emplace_back(stage.namer.locals()[k]);
}

void pixelStage(const Module& module, const passes::ShaderInterface& interface, std::string_view title,
                text::FunctionTexts* texts, Sources& sources) {
    Stage stage{module, interface, true, text::Namer(reservedWords())};
    version(stage);
    stage.out.line();
    if (!title.empty()) {
        std::size_t start = stage.out.size();
        stage.out.comment(title);
        stage.apart.emplace_back(start, stage.out.size());
        stage.out.line();
    }
    uniforms(stage, interface.pixelUniforms);
    vertexData(stage, "in");
    const Function& entry = *module.findOwn(interface.pixel);
    stage.output = stage.namer.global(module.names->text(entry.results[0].name));
    stage.out.line({"out vec4 ", stage.output, ";"});
    stage.out.line();
    for (const auto& f : module.functions) {
        if (f->name == interface.pixel || f->name == interface.vertex) continue;
        std::string_view name = module.names->text(f->name);
        stage.globals[f->name] = stage.namer.global(name.substr(0, name.find('@')));
    }
    for (const auto& f : module.functions) {
        if (f->name == interface.pixel || f->name == interface.vertex) continue;
        printFunction(stage, *f, texts);
        stage.out.line();
    }
    FunctionPrinter(stage, entry, true).print();
    sources.pixel = stage.out.take();
    sources.output = stage.output;
    sources.apart = std::move(stage.apart);
    for (Name name : interface.pixelUniforms.uniforms) sources.names[name] = stage.globals.at(name);
}

}  // namespace

Sources print(const Module& module, const passes::ShaderInterface& interface, std::string_view title,
              text::FunctionTexts* texts) {
    Sources sources;
    vertexStage(module, interface, sources);
    pixelStage(module, interface, title, texts, sources);
    return sources;
}

}  // namespace shaderx::glsl
