#include "sl/compile.h"

#include <algorithm>
#include <unordered_set>

#include <fmt/format.h>

#include "sl/lower.h"
#include "sl/parser.h"

namespace shaderx::sl {

namespace {

constexpr std::size_t kInlineOperations = 8;

struct Compiler {
    ir::Module& module;
    const std::vector<Signature>& known;
    Diagnostics& diagnostics;

    struct Source {
        std::uint32_t unit, declaration;
    };
    std::deque<Unit> units = {};
    std::vector<Signature> signatures = {};
    std::vector<Source> sources = {};  // by signature
    std::vector<ir::Function> functions = {};
    std::unordered_map<Name, std::uint32_t> byName = {};  // in the IR
    std::vector<std::vector<CallSite>> calls = {};
    std::vector<std::vector<std::uint32_t>> callees = {};

    std::string_view text(Name n) const { return module.names->text(n); }
    const FunctionDecl& decl(std::uint32_t i) const {
        return units[sources[i].unit].tree.functions[sources[i].declaration];
    }
    Reporter& report(std::uint32_t i) { return units[sources[i].unit].report; }

    bool run(std::span<const SourceFile> files);
    void declare();
    void check(std::uint32_t i);
    void name();
    void collectConstants(Program& program);
    void foldConstants(Program& program);
    void lower(Program& program);
    void checkRecursion(const std::vector<std::vector<std::uint32_t>>& cycles);
    bool isExpression(const FunctionDecl& f, const Tree& tree) const;
    bool isSmall(const ir::Function& f) const;
};

std::string mangled(std::string_view name, const std::vector<ir::Param>& params) {
    std::string text(name);
    text += "_";
    for (const ir::Param& p : params) text += fmt::format("_{}", ir::info(p.type).name);
    return text;
}

std::vector<ir::Param> paramsOf(const std::vector<ParamDecl>& decls) {
    std::vector<ir::Param> params;
    for (const ParamDecl& p : decls) params.push_back({p.name, p.type});
    return params;
}

void Compiler::declare() {
    for (std::uint32_t u = 0; u < units.size(); u++)
        for (std::uint32_t f = 0; f < units[u].tree.functions.size(); f++) {
            const FunctionDecl& d = units[u].tree.functions[f];
            sources.push_back({u, f});
            signatures.push_back({{}, d.name, d.result, paramsOf(d.params), paramsOf(d.outputs)});
        }
}

// What one declaration can have wrong by itself.
void Compiler::check(std::uint32_t i) {
    const FunctionDecl& d = decl(i);
    if (d.result == Type::Void && d.outputs.empty())
        report(i).error(d.offset, "no-result",
                        fmt::format("{} has neither a result nor an output", quoted(text(d.name))));
    if (d.result == Type::Texture2D) report(i).error(d.offset, "unsupported", "a function cannot give a texture");
    for (const ParamDecl& p : d.outputs) {
        if (p.type == Type::Texture2D) report(i).error(p.offset, "unsupported", "a texture cannot be an output");
        if (d.result != Type::Void && text(p.name) == "out")
            report(i).error(p.offset, "duplicate-name",
                            "'out' is what the result is called; name the output differently");
    }
}

// Finds duplicates and chooses the names in the IR.
void Compiler::name() {
    std::unordered_map<Name, int> count;                     // functions of a plain name
    std::unordered_map<std::string, std::uint32_t> byInput;  // first function with these inputs
    std::unordered_map<std::string, std::uint32_t> byAll;
    std::unordered_set<std::string> knownTypes;
    std::unordered_set<Name> taken;
    auto whole = [&](const Signature& s) { return mangled(mangled(text(s.plainName), s.params), s.outputs); };
    for (const Signature& s : signatures) count[s.plainName]++;
    for (const Signature& s : known) {
        count[s.plainName]++;
        taken.insert(s.name);
        knownTypes.insert(whole(s));
    }
    for (std::uint32_t i = 0; i < signatures.size(); i++) {
        Signature& s = signatures[i];
        std::string inputs = mangled(text(s.plainName), s.params), all = whole(s);
        auto [same, isNew] = byAll.emplace(all, i);
        if (!isNew || knownTypes.count(all)) {
            Diagnostic& d =
                report(i).error(decl(i).offset, "duplicate-function",
                                fmt::format("{} with these types exists already", quoted(text(s.plainName))));
            if (!isNew)
                d.notes.push_back({report(same->second).at(decl(same->second).offset), "here"});
            else
                d.notes.push_back({{}, "in a library"});
        }
        // Outputs tell apart only where inputs do not.
        bool isFirst = byInput.emplace(inputs, i).second;
        std::string chosen = count[s.plainName] == 1 ? std::string(text(s.plainName)) : isFirst ? inputs : all;
        while (!taken.insert(module.names->intern(chosen)).second) chosen += '_';
        s.name = module.names->intern(chosen);
        byName.emplace(s.name, i);
    }
}

void Compiler::collectConstants(Program& program) {
    for (std::uint32_t u = 0; u < units.size(); u++)
        for (std::uint32_t k = 0; k < units[u].tree.constants.size(); k++) {
            const ConstDecl& d = units[u].tree.constants[k];
            Constant c;
            c.name = d.name;
            c.type = d.type;
            c.unit = u;
            c.declaration = k;
            std::vector<std::uint32_t>& named = program.constantsByName[d.name];
            if (!named.empty() && program.constants[named.back()].unit == u) {
                std::uint32_t first = units[u].tree.constants[program.constants[named.back()].declaration].offset;
                Diagnostic& e = units[u].report.error(d.offset, "duplicate-name",
                                                      fmt::format("{} exists already", quoted(text(d.name))));
                e.notes.push_back({units[u].report.at(first), "here"});
                continue;
            }
            named.push_back(static_cast<std::uint32_t>(program.constants.size()));
            program.constants.push_back(std::move(c));
        }
}

void Compiler::foldConstants(Program& program) {
    std::vector<std::vector<std::uint32_t>> needs(program.constants.size()), cycles;
    for (std::size_t i = 0; i < needs.size(); i++) {
        const Constant& c = program.constants[i];
        const Tree& tree = units[c.unit].tree;
        std::vector<Name> read;
        namesRead(tree, tree.constants[c.declaration].value, read);
        for (Name n : read)
            for (std::uint32_t other : program.constantsCalled(c.unit, n)) needs[i].push_back(other);
    }
    std::vector<std::uint32_t> order = neededFirst(needs, cycles);
    for (const auto& cycle : cycles) {
        const Constant& c = program.constants[cycle[0]];
        units[c.unit].report.error(units[c.unit].tree.constants[c.declaration].offset, "recursion",
                                   fmt::format("the value of {} needs itself", quoted(text(c.name))));
    }
    // What needs itself stays unknown, without further messages.
    for (std::uint32_t i : order) foldConstant(program, program.constants[i]);
}

void Compiler::lower(Program& program) {
    functions.resize(signatures.size());
    calls.resize(signatures.size());
    callees.resize(signatures.size());
    for (std::uint32_t i = 0; i < signatures.size(); i++) {
        ir::Function& f = functions[i];
        f.name = signatures[i].name;
        f.params = signatures[i].params;
        f.comment = decl(i).comment;
        f.isInline = decl(i).isInline;
        if (decl(i).isBroken) continue;
        lowerFunction(program, sources[i].unit, decl(i), f, calls[i]);
        for (const CallSite& c : calls[i]) callees[i].push_back(c.callee);
    }
}

void Compiler::checkRecursion(const std::vector<std::vector<std::uint32_t>>& cycles) {
    for (const auto& cycle : cycles) {
        std::string path;
        constexpr std::size_t kTold = 10;
        for (std::size_t k = 0; k < cycle.size() && k < kTold; k++)
            path += fmt::format("{} -> ", text(signatures[cycle[k]].plainName));
        if (cycle.size() > kTold) path += "... -> ";
        path += text(signatures[cycle[0]].plainName);
        for (const CallSite& c : calls[cycle.back()])
            if (c.callee == cycle[0]) {
                report(cycle.back())
                    .error(c.offset, "recursion", fmt::format("functions cannot call themselves: {}", path));
                break;
            }
    }
}

// One statement that returns an expression, or gives it to the only output.
bool Compiler::isExpression(const FunctionDecl& f, const Tree& tree) const {
    if (f.body.count != 1) return false;
    const Stmt& s = tree[tree.statementLists[f.body.first]];
    return s.kind == StmtKind::Return ||
           (s.kind == StmtKind::Assign && f.result == Type::Void && f.outputs.size() == 1);
}

bool Compiler::isSmall(const ir::Function& f) const {
    std::vector<bool> live = ir::reachable(f);
    std::size_t operations = 0;
    for (std::size_t i = 0; i < f.exprs.size(); i++) {
        const ir::Expr& e = f.exprs[i];
        if (!live[i] || e.op <= Op::Uniform || e.op == Op::Result) continue;
        if (e.op == Op::Loop) return false;
        if (e.op == Op::Call) {
            Name callee(e.payload);
            auto own = byName.find(callee);
            const ir::Function* g = own != byName.end() ? &functions[own->second] : module.find(callee);
            if (!g || !g->isInline) return false;
        }
        operations++;
    }
    return operations <= kInlineOperations;
}

bool Compiler::run(std::span<const SourceFile> files) {
    std::size_t before = diagnostics.errorCount();
    for (const SourceFile& f : files) {
        Reporter r(diagnostics, f.name, f.text);
        Tree tree = parseFunctions(f.text, *module.names, r);
        units.push_back({std::move(tree), r});
    }
    declare();
    name();
    for (std::uint32_t i = 0; i < signatures.size(); i++) check(i);
    FunctionTable table(signatures, known, true);
    Program program{module, table, units, {}, {}};
    for (const Unit& u : units) program.isIncomplete = program.isIncomplete || u.tree.isIncomplete;
    collectConstants(program);
    foldConstants(program);
    lower(program);
    std::vector<std::vector<std::uint32_t>> cycles;
    std::vector<std::uint32_t> order = neededFirst(callees, cycles);
    checkRecursion(cycles);
    if (diagnostics.errorCount() != before) return false;
    for (const Unit& u : units) ensure(u.report.errors() == 0, "an error that was not told");
    for (std::uint32_t i : order)
        if (!functions[i].isInline && isExpression(decl(i), units[sources[i].unit].tree))
            functions[i].isInline = isSmall(functions[i]);
    for (ir::Function& f : functions) {
        ir::compact(f);
        module.put(std::move(f));
    }
    return true;
}

}  // namespace

bool compile(ir::Module& module, std::span<const SourceFile> files, const std::vector<Signature>& known,
             std::vector<Signature>& made, Diagnostics& diagnostics) {
    Compiler c{module, known, diagnostics};
    if (!c.run(files)) return false;
    made.insert(made.end(), c.signatures.begin(), c.signatures.end());
    return true;
}

bool compileInline(ir::Module& module, Name name, std::span<const ir::Param> params, std::span<const ir::Param> results,
                   const SourceFile& text, const std::vector<Signature>& known, Diagnostics& diagnostics) {
    std::size_t before = diagnostics.errorCount();
    std::deque<Unit> units;
    Reporter report(diagnostics, text.name, text.text);
    Tree tree = parseInlineText(text.text, results.size(), *module.names, report);
    if (report.errors()) return false;
    units.push_back({std::move(tree), report});
    FunctionTable table({}, known, false);
    Program program{module, table, units, {}, {}};
    ir::Function f;
    f.name = name;
    f.params.assign(params.begin(), params.end());
    f.isInline = true;
    lowerInline(program, 0, results, f);
    if (diagnostics.errorCount() != before) return false;
    ir::compact(f);
    module.put(std::move(f));
    return true;
}

}  // namespace shaderx::sl
