#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "base/numbers.h"
#include "ir/text.h"
#include "ir/text_form.h"

namespace shaderx::ir {
namespace {

bool isIdentifier(std::string_view s) {
    const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    if (s.empty() || !letter(s[0])) return false;
    return std::all_of(s.begin(), s.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

std::string quoted(std::string_view s) {
    std::string out = "\"";
    while (!s.empty()) {
        std::size_t size = 1;
        const char32_t c = characterAt(s, size);
        const bool isShown = !isControl(c) && (c < 0x80 || size > 1);
        if (c == '"' || c == '\\')
            out += fmt::format("\\{}", s[0]);
        else if (c == '\n')
            out += "\\n";
        else if (isShown)
            out += s.substr(0, size);
        else
            for (char byte : s.substr(0, size)) out += fmt::format("\\x{:02x}", static_cast<unsigned char>(byte));
        s.remove_prefix(size);
    }
    return out + '"';
}

std::string formatWord(Scalar scalar, std::uint32_t word) {
    switch (scalar) {
        case Scalar::Float: {
            const float v = std::bit_cast<float>(word);
            // Text says neither the sign nor the payload of a NaN.
            if (std::isnan(v) && word != 0x7fc00000u) return fmt::format("0x{:08x}", word);
            return formatFloat(v);
        }
        case Scalar::Integer:
            return fmt::format("{}", static_cast<std::int32_t>(word));
        case Scalar::Boolean:
            if (word < 2) return word ? "true" : "false";
            break;
        case Scalar::None:
            break;
    }
    return fmt::format("0x{:08x}", word);
}

struct Printer {
    const Module& module;
    const Function* function = nullptr;
    std::vector<std::size_t>* columns = nullptr;
    std::string out = {};
    std::size_t lineStart = 0;

    template <class... Args>
    void put(fmt::format_string<Args...> text, Args&&... args) {
        fmt::format_to(std::back_inserter(out), text, std::forward<Args>(args)...);
    }

    std::string name(std::string_view text) const { return isIdentifier(text) ? std::string(text) : quoted(text); }
    std::string name(Name n) const { return name(text(n)); }
    // The name table's text; empty for numbers that are no names.
    std::string_view text(Name n) const { return n.index < module.names->size() ? module.names->text(n) : ""; }

    std::string type(Type t) const {
        if (t < Type::FirstStruct) return std::string(info(t).name);
        const std::size_t i = static_cast<std::size_t>(t) - static_cast<std::size_t>(Type::FirstStruct);
        if (i >= module.structs.size()) return fmt::format("no_such_struct_{}", i);
        const std::string_view structName = text(module.structs[i].name);
        const bool isBuiltin = typeNamed(structName) != Type::Void || structName == "void";
        return isBuiltin ? quoted(structName) : name(structName);
    }

    static std::string handle(ExprId e) { return e ? fmt::format("%{}", e.index) : "%?"; }

    template <class Members>
    void members(const Members& list) {
        const char* separator = "";
        for (const auto& m : list) {
            put("{}{}: {}", separator, name(m.name), type(m.type));
            separator = ", ";
        }
    }

    void words(Scalar scalar, std::span<const std::uint32_t> list) {
        for (std::size_t i = 0; i < list.size(); i++) put("{}{}", i ? ", " : "", formatWord(scalar, list[i]));
    }

    // ---- Declarations ----

    void uniform(const Uniform& u) {
        put("uniform {}: {}", name(u.name), type(u.type));
        if (!u.values.empty()) {
            out += " = ";
            words(info(u.type).scalar, u.values);
        }
        if (!u.path.empty()) put(" {}", quoted(u.path));
        const Uniform usual;
        if (u.file != usual.file) put(" file {}", quoted(u.file));
        if (u.uAddress != usual.uAddress) put(" uaddress {}", quoted(u.uAddress));
        if (u.vAddress != usual.vAddress) put(" vaddress {}", quoted(u.vAddress));
        if (u.filter != usual.filter) put(" filter {}", quoted(u.filter));
        for (std::size_t i = 0; i < u.defaultColor.size(); i++)
            put("{}{}", i ? ", " : " default ",
                formatWord(Scalar::Float, std::bit_cast<std::uint32_t>(u.defaultColor[i])));
        if (u.colorspace != usual.colorspace) put(" colorspace {}", quoted(u.colorspace));
        out += '\n';
    }

    void declarations() {
        for (const StructType& s : module.structs) {
            put("struct {} {{ ", name(s.name));
            members(s.members);
            out += " }\n";
        }
        for (const Uniform& u : module.uniforms) uniform(u);
        for (const LeafInfo& l : module.leaves) {
            put("leaf {}(", name(l.name));
            members(l.params);
            out += ")\n";
        }
        for (const ExternText& e : module.externs)
            put("extern {} {} {}\n", name(e.target), name(e.node), quoted(e.text));
    }

    // ---- Expressions ----

    void operand(ExprId e) {
        if (columns) columns->push_back(out.size() - lineStart);
        out += handle(e);
    }

    void operands(std::span<const ExprId> list, std::string_view before = " ") {
        for (std::size_t i = 0; i < list.size(); i++) {
            out += i ? ", " : before;
            operand(list[i]);
        }
    }

    // The operands of an expression; none where they lie outside the arena.
    std::span<const ExprId> operandsOf(const Expr& e) const {
        const std::size_t end = static_cast<std::size_t>(e.firstOperand) + e.operandCount;
        return end <= function->operands.size() ? function->operandsOf(e) : std::span<const ExprId>();
    }

    void payload(const Expr& e) {
        if (e.payload) put(" payload {}", e.payload);
    }

    void constant(const Expr& e) {
        const std::size_t n = static_cast<std::size_t>(componentCount(e.type));
        if (e.type == Type::String && e.payload < module.names->size()) {
            put(" {}", quoted(text(Name(e.payload))));
        } else if (n > 0 && e.payload + n <= function->words.size()) {
            out += ' ';
            words(info(e.type).scalar, std::span(function->words).subspan(e.payload, n));
        } else {
            payload(e);
        }
    }

    void param(const Expr& e) {
        const auto& params = function->params;
        const auto same = [&](const Param& p) { return p.name == params[e.payload].name; };
        if (e.payload < params.size() && std::count_if(params.begin(), params.end(), same) == 1)
            put(" {}", name(params[e.payload].name));
        else
            put(" {}", e.payload);
    }

    void named(const Expr& e) {
        if (e.payload < module.names->size())
            put(" {}", name(Name(e.payload)));
        else
            payload(e);
        operands(operandsOf(e));
    }

    void swizzle(const Expr& e) {
        operands(operandsOf(e));
        const auto list = operandsOf(e);
        const bool known = list.size() == 1 && list[0].index < function->exprs.size();
        if (known && isMatrix((*function)[list[0]].type)) {
            put(", column {}", e.payload);
            return;
        }
        const int n = swizzleCount(e.payload);
        const std::uint32_t used = (1u << 2 * n) - 1;
        if (n < 1 || n > 4 || (e.payload & ~used) != static_cast<std::uint32_t>(n) << 8) {
            payload(e);
            return;
        }
        out += ", ";
        for (int i = 0; i < n; i++) out += "xyzw"[swizzleAt(e.payload, i)];
    }

    void loop(const Expr& e) {
        const auto list = operandsOf(e);
        const std::size_t before = e.op == Op::Loop ? 1 : 0;
        put(" loop {}", e.payload);
        if (list.size() <= before || (list.size() - before) % 2) {
            operands(list, ", ");
            return;
        }
        const std::size_t carried = (list.size() - before) / 2;
        operands(list.first(before), ", ");
        operands(list.subspan(before, carried), " | ");
        operands(list.subspan(before + carried), " | ");
    }

    // What follows the type.
    void rest(const Expr& e) {
        const auto list = operandsOf(e);
        switch (textForm(e.op)) {
            case TextForm::Constant:
                return constant(e);
            case TextForm::Param:
                return param(e);
            case TextForm::Context:
                if (e.payload < static_cast<std::uint32_t>(kContexts))
                    put(" {}", info(static_cast<Context>(e.payload)).name);
                else
                    payload(e);
                return;
            case TextForm::Named:
                return named(e);
            case TextForm::Swizzle:
                return swizzle(e);
            case TextForm::Numbered:
                operands(list);
                put("{}{}", list.empty() ? " " : ", ", e.payload);
                return;
            case TextForm::LoopArg:
                return put(" loop {}, {}", e.payload >> 8, e.payload & 255);
            case TextForm::Loop:
                return loop(e);
            case TextForm::Extern:
                put(" {}", e.payload);
                return operands(list);
            case TextForm::Plain:
                operands(list);
                return payload(e);
        }
    }

    void expr(ExprId id) {
        lineStart = out.size();
        const Expr& e = (*function)[id];
        put("%{}", id.index);
        if (id.index < function->hints.size() && function->hints[id.index])
            put(" {}", quoted(text(function->hints[id.index])));
        if (static_cast<int>(e.op) >= kOps)
            put(" = no_such_op_{}", static_cast<int>(e.op));
        else {
            put(" = {} {}", info(e.op).name, type(e.type));
            rest(e);
        }
    }

    // ---- Functions ----

    void phis(const Stmt& s) {
        const auto& all = function->body.phis;
        if (s.phiCount == 0 || static_cast<std::size_t>(s.firstPhi) + s.phiCount > all.size()) return;
        out += " ->";
        for (std::uint32_t i = 0; i < s.phiCount; i++) put("{}{}", i ? ", " : " ", handle(all[s.firstPhi + i]));
    }

    // Of a statement in so many blocks; deep nests stop moving right, so that the text stays as long as the program.
    static std::string indentOf(std::size_t depth) {
        return std::string(4 * (std::min<std::size_t>(depth, 40) + 1), ' ');
    }

    void body() {
        struct Frame {
            const std::vector<Stmt>* block;
            std::size_t next = 0;
            bool inElse = false;
        };
        const auto& blocks = function->body.blocks;
        std::vector<bool> seen(blocks.size());  // a block that stands in several places is broken; once is enough
        const auto enter = [&](BlockId b) -> const std::vector<Stmt>* {
            if (b.index >= blocks.size() || seen[b.index]) return nullptr;
            seen[b.index] = true;
            return &blocks[b.index];
        };
        std::vector<Frame> stack{{enter(BlockId(0))}};
        out += "    body {\n";
        while (true) {
            Frame& frame = stack.back();
            const std::string indent = indentOf(stack.size());
            if (frame.next < frame.block->size()) {
                const Stmt& s = (*frame.block)[frame.next];
                if (s.kind == StmtKind::Let) {
                    put("{}let {}\n", indent, handle(s.expr));
                    frame.next++;
                    continue;
                }
                put("{}{} {} {{\n", indent, s.kind == StmtKind::If ? "if" : "loop", handle(s.expr));
                frame.inElse = false;
                static const std::vector<Stmt> kNothing;
                const std::vector<Stmt>* block = enter(s.body);
                stack.push_back({block ? block : &kNothing});
                continue;
            }
            stack.pop_back();
            if (stack.empty()) break;
            Frame& outer = stack.back();
            const Stmt& s = (*outer.block)[outer.next];
            put("{}}}", indentOf(stack.size()));
            const std::vector<Stmt>* orElse = s.kind == StmtKind::If && !outer.inElse ? enter(s.orElse) : nullptr;
            if (orElse) {
                out += " else {\n";
                outer.inElse = true;
                stack.push_back({orElse});
                continue;
            }
            phis(s);
            out += '\n';
            outer.next++;
        }
        out += "    }\n";
    }

    // Loop numbers that the expressions show.
    std::uint32_t loopsSeen() const {
        std::uint32_t n = 0;
        for (const Expr& e : function->exprs) {
            if (e.op == Op::LoopArg) n = std::max(n, (e.payload >> 8) + 1);
            if ((e.op == Op::Loop || e.op == Op::Lights) && e.payload != 0xffffffffu) n = std::max(n, e.payload + 1);
        }
        return n;
    }

    void comment(std::string_view text) {
        if (text.empty()) return;
        std::size_t start = 0;
        while (true) {
            const std::size_t end = std::min(text.find('\n', start), text.size());
            put("#{}{}\n", end > start ? " " : "", text.substr(start, end - start));
            if (end == text.size()) return;
            start = end + 1;
        }
    }

    void define(const Function& f) {
        function = &f;
        comment(f.comment);
        put("{}function {}(", f.isInline ? "inline " : "", name(f.name));
        members(f.params);
        out += ") -> (";
        members(f.results);
        out += ')';
        if (f.loops != loopsSeen()) put(" loops {}", f.loops);
        out += " {\n";
        for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
            out += "    ";
            expr(ExprId(i));
            out += '\n';
        }
        out += "    return";
        for (std::size_t i = 0; i < f.results.size(); i++) put("{}{}", i ? ", " : " ", handle(f.results[i].value));
        out += '\n';
        if (!f.body.blocks.empty()) body();
        out += "}\n";
    }
};

}  // namespace

std::string print(const Module& module, const Function& function) {
    Printer p{module};
    p.define(function);
    return std::move(p.out);
}

std::string print(const Module& module) {
    Printer p{module};
    p.declarations();
    for (const auto& f : module.functions) {
        if (!p.out.empty()) p.out += '\n';
        p.define(*f);
    }
    return std::move(p.out);
}

std::string printExpr(const Module& module, const Function& function, ExprId e,
                      std::vector<std::size_t>* operandColumns) {
    Printer p{module, &function, operandColumns};
    p.expr(e);
    return std::move(p.out);
}

}  // namespace shaderx::ir
