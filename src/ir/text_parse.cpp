#include <algorithm>
#include <bit>
#include <charconv>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include "base/numbers.h"
#include "ir/text.h"
#include "ir/text_form.h"

namespace shaderx::ir {
namespace {

constexpr std::size_t kMaxErrors = 100;

enum class TokenKind : std::uint8_t { End, Word, String, Number, Ref, Punct, Bad };

struct Token {
    TokenKind kind = TokenKind::End;
    std::string_view text = {};  // of strings what stands between the quotes, of refs what follows the %
    std::size_t offset = 0;
    bool firstOnLine = true;

    bool is(std::string_view punct) const { return kind == TokenKind::Punct && text == punct; }
    bool isWord(std::string_view word) const { return kind == TokenKind::Word && text == word; }
};

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isWordChar(char c) { return isLetter(c) || isDigit(c); }

struct Lexer {
    std::string_view text;
    std::size_t at = 0;
    // The lines of comment right before the last token.
    std::string comment = {};
    bool hasComment = false;

    char peek(std::size_t ahead = 0) const { return at + ahead < text.size() ? text[at + ahead] : '\0'; }

    template <class Test>
    void skipWhile(Test test) {
        while (at < text.size() && test(text[at])) at++;
    }

    // Skips blanks and comments; says whether the next token is the first on its line.
    bool skipBlanks() {
        bool first = at == 0, blankLine = first;
        comment.clear();
        hasComment = false;
        while (at < text.size()) {
            const char c = text[at];
            if (c == '\n') {
                if (first && blankLine) {
                    comment.clear();
                    hasComment = false;
                }
                first = blankLine = true;
                at++;
            } else if (c == '#') {
                const std::size_t start = at + 1;
                skipWhile([](char d) { return d != '\n'; });
                std::string_view line = text.substr(start, at - start);
                if (!line.empty() && line[0] == ' ') line.remove_prefix(1);
                if (first) {
                    if (hasComment) comment += '\n';
                    comment += line;
                    hasComment = true;
                }
                blankLine = false;
            } else if (c == ' ' || c == '\t' || c == '\r') {
                at++;
            } else {
                break;
            }
        }
        return first;
    }

    Token next() {
        Token t;
        t.firstOnLine = skipBlanks();
        t.offset = at;
        if (at == text.size()) return t;
        const char c = peek();
        const std::size_t start = at;
        if (c == '"') return string(t);
        if (c == '%') {
            at++;
            if (peek() == '?')
                at++;
            else
                skipWhile(isWordChar);
            t.kind = TokenKind::Ref;
            t.text = text.substr(start + 1, at - start - 1);
            return t;
        }
        if (isLetter(c)) {
            skipWhile(isWordChar);
            t.kind = TokenKind::Word;
        } else if (isDigit(c) || ((c == '-' || c == '+' || c == '.') && (isWordChar(peek(1)) || peek(1) == '.'))) {
            at++;
            while (at < text.size()) {
                const bool exponent = (peek() == '-' || peek() == '+') && (text[at - 1] == 'e' || text[at - 1] == 'E');
                if (!isWordChar(peek()) && peek() != '.' && !exponent) break;
                at++;
            }
            t.kind = TokenKind::Number;
        } else {
            at += c == '-' && peek(1) == '>' ? 2 : 1;
            t.kind =
                std::string_view("(){},:=|-").find(c) != std::string_view::npos ? TokenKind::Punct : TokenKind::Bad;
        }
        t.text = text.substr(start, at - start);
        return t;
    }

    Token string(Token t) {
        at++;
        const std::size_t start = at;
        while (at < text.size() && text[at] != '"' && text[at] != '\n')
            at += text[at] == '\\' && at + 1 < text.size() ? 2 : 1;
        at = std::min(at, text.size());
        t.text = text.substr(start, at - start);
        if (peek() == '"') {
            at++;
            t.kind = TokenKind::String;
        } else {
            t.kind = TokenKind::Bad;
        }
        return t;
    }
};

int hexDigit(char c) {
    if (isDigit(c)) return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// The text between quotes without its escapes.
std::string unescaped(std::string_view s) {
    std::string out;
    for (std::size_t i = 0; i < s.size(); i++) {
        if (s[i] != '\\' || i + 1 == s.size()) {
            out += s[i];
            continue;
        }
        const char c = s[++i];
        const int high = i + 2 < s.size() ? hexDigit(s[i + 1]) : -1, low = i + 2 < s.size() ? hexDigit(s[i + 2]) : -1;
        if (c == 'n') {
            out += '\n';
        } else if (c == 'x' && high >= 0 && low >= 0) {
            out += static_cast<char>(high * 16 + low);
            i += 2;
        } else {
            out += c;
        }
    }
    return out;
}

std::optional<std::uint32_t> parseUnsigned(std::string_view s) {
    const bool hex = s.substr(0, 2) == "0x";
    if (hex) s.remove_prefix(2);
    std::uint32_t v = 0;
    const auto r = std::from_chars(s.data(), s.data() + s.size(), v, hex ? 16 : 10);
    if (r.ec != std::errc() || r.ptr != s.data() + s.size()) return {};
    return v;
}

// The bits of a number of a kind.
std::optional<std::uint32_t> parseWord(Scalar scalar, std::string_view s) {
    if (s.substr(0, 2) == "0x") return parseUnsigned(s);
    switch (scalar) {
        case Scalar::Float:
            if (s == "inf") return 0x7f800000u;
            if (s == "-inf") return 0xff800000u;
            if (s == "nan") return 0x7fc00000u;
            if (const auto v = parseFloat(s)) return std::bit_cast<std::uint32_t>(*v);
            return {};
        case Scalar::Integer:
            if (const auto v = parseInt(s)) return static_cast<std::uint32_t>(*v);
            return {};
        case Scalar::Boolean:
            if (s == "true") return 1u;
            if (s == "false") return 0u;
            return {};
        case Scalar::None:
            return {};
    }
    return {};
}

struct Parser {
    Module& module;
    std::string_view file, text;
    Diagnostics& diagnostics;
    Lexer lexer{text};
    Token token = {};
    std::string comment = {};  // before `token`
    std::size_t errors = 0;
    std::vector<Function*> made = {};
    // Of the function under way.
    Function f = {};
    std::unordered_map<std::string_view, ExprId> exprs = {};

    // ---- Tokens ----

    void next() {
        token = lexer.next();
        comment = lexer.comment;
    }

    // Reports; false, so that callers can return it.
    bool fail(const Token& where, std::string_view code, std::string message, std::string_view near = {}) {
        if (errors++ >= kMaxErrors) return false;
        Diagnostic& d = diagnostics.error(code, std::move(message));
        d.where = locate(file, text, where.offset);
        if (!near.empty()) d.hint = fmt::format("did you mean '{}'?", near);
        return false;
    }

    bool expected(std::string_view what) {
        if (token.kind == TokenKind::End) return fail(token, "syntax", fmt::format("expected {}, found the end", what));
        return fail(token, "syntax", fmt::format("expected {}, found '{}'", what, token.text.substr(0, 60)));
    }

    bool expect(std::string_view punct) {
        if (!token.is(punct)) return expected(fmt::format("'{}'", punct));
        next();
        return true;
    }

    bool accept(std::string_view punct) {
        if (!token.is(punct)) return false;
        next();
        return true;
    }

    bool acceptWord(std::string_view word) {
        if (!token.isWord(word)) return false;
        next();
        return true;
    }

    // A name: a word or a string.
    bool name(Name& out) {
        if (token.kind == TokenKind::Word)
            out = module.names->intern(token.text);
        else if (token.kind == TokenKind::String)
            out = module.names->intern(unescaped(token.text));
        else
            return expected("a name");
        next();
        return true;
    }

    bool string(std::string& out) {
        if (token.kind != TokenKind::String) return expected("a quoted text");
        out = unescaped(token.text);
        next();
        return true;
    }

    bool number(std::uint32_t& out, std::uint32_t most = 0xffffffffu) {
        const auto v = token.kind == TokenKind::Number ? parseUnsigned(token.text) : std::nullopt;
        if (!v) return expected("a whole number");
        if (*v > most) return fail(token, "number-range", fmt::format("{} is more than {}", *v, most));
        out = *v;
        next();
        return true;
    }

    bool word(Scalar scalar, std::uint32_t& out) {
        const bool fits = token.kind == TokenKind::Number || token.kind == TokenKind::Word;
        const auto v = fits ? parseWord(scalar, token.text) : std::nullopt;
        if (!v) return expected("a number of the type");
        out = *v;
        next();
        return true;
    }

    bool type(Type& out) {
        if (token.kind != TokenKind::Word && token.kind != TokenKind::String) return expected("a type");
        const bool isWord = token.kind == TokenKind::Word;
        const std::string spelled = isWord ? std::string(token.text) : unescaped(token.text);
        out = isWord ? typeNamed(spelled) : Type::Void;
        if (out == Type::Void && !(isWord && spelled == "void")) {
            std::size_t i = 0;
            while (i < module.structs.size() && module.names->text(module.structs[i].name) != spelled) i++;
            if (i == module.structs.size()) {
                std::vector<std::string_view> known;
                for (int t = 0; t < kBuiltinTypes; t++) known.push_back(info(static_cast<Type>(t)).name);
                return fail(token, "unknown-type", fmt::format("unknown type '{}'", spelled), nearest(spelled, known));
            }
            out = static_cast<Type>(static_cast<std::size_t>(Type::FirstStruct) + i);
        }
        next();
        return true;
    }

    // ---- Declarations ----

    // `name: type, …` up to a closing mark.
    template <class Member>
    bool members(std::vector<Member>& out, std::string_view close) {
        while (!token.is(close)) {
            Member m = {};
            if (!out.empty() && !expect(",")) return false;
            if (!name(m.name) || !expect(":") || !type(m.type)) return false;
            out.push_back(m);
        }
        next();
        return true;
    }

    bool structure() {
        StructType s;
        const Token where = token;
        if (!name(s.name) || !expect("{") || !members(s.members, "}")) return false;
        for (const StructType& other : module.structs)
            if (other.name == s.name) return redefined(where, "structure");
        if (module.structs.size() >= 0xffff - kBuiltinTypes) return fail(where, "limit", "too many structures");
        module.structs.push_back(std::move(s));
        return true;
    }

    bool leaf() {
        LeafInfo l;
        const Token where = token;
        if (!name(l.name) || !expect("(") || !members(l.params, ")")) return false;
        if (module.leaf(l.name)) return redefined(where, "leaf");
        module.leaves.push_back(std::move(l));
        return true;
    }

    bool externText() {
        ExternText e;
        if (!name(e.target) || !name(e.node) || !string(e.text)) return false;
        module.externs.push_back(std::move(e));
        return true;
    }

    bool redefined(const Token& where, std::string_view what) {
        return fail(where, "redefinition", fmt::format("a {} '{}' is there already", what, where.text));
    }

    bool uniform() {
        Uniform u;
        const Token where = token;
        if (!name(u.name) || !expect(":") || !type(u.type)) return false;
        if (accept("=")) {
            do {
                std::uint32_t v = 0;
                if (!word(info(u.type).scalar, v)) return false;
                u.values.push_back(v);
            } while (accept(","));
        }
        if (token.kind == TokenKind::String && !token.firstOnLine && !string(u.path)) return false;
        while (token.kind == TokenKind::Word && !token.firstOnLine)
            if (!uniformDetail(u)) return false;
        if (module.uniform(u.name)) return redefined(where, "uniform");
        module.uniforms.push_back(std::move(u));
        return true;
    }

    bool uniformDetail(Uniform& u) {
        if (acceptWord("file")) return string(u.file);
        if (acceptWord("uaddress")) return string(u.uAddress);
        if (acceptWord("vaddress")) return string(u.vAddress);
        if (acceptWord("filter")) return string(u.filter);
        if (acceptWord("colorspace")) return string(u.colorspace);
        if (!acceptWord("default")) return expected("file, uaddress, vaddress, filter, default or colorspace");
        do {
            std::uint32_t v = 0;
            if (!word(Scalar::Float, v)) return false;
            u.defaultColor.push_back(std::bit_cast<float>(v));
        } while (accept(","));
        return true;
    }

    // ---- Expressions ----

    bool ref(ExprId& out) {
        if (token.kind != TokenKind::Ref) return expected("an expression");
        if (token.text == "?") {
            out = {};
        } else if (const auto it = exprs.find(token.text); it != exprs.end()) {
            out = it->second;
        } else {
            return fail(token, "undefined-expression", fmt::format("%{} is not defined before this line", token.text));
        }
        next();
        return true;
    }

    bool here() const { return !token.firstOnLine && token.kind != TokenKind::End; }

    // Operands on this line. Stops behind a comma where what follows it is no operand, and says so.
    bool operands(std::vector<ExprId>& out, bool& stoppedAtComma) {
        stoppedAtComma = false;
        if (!here() || token.kind != TokenKind::Ref) return true;
        while (true) {
            ExprId e;
            if (!ref(e)) return false;
            out.push_back(e);
            if (!accept(",")) return true;
            if (token.kind != TokenKind::Ref) {
                stoppedAtComma = true;
                return true;
            }
        }
    }

    bool loopNumber(std::uint32_t& out) {
        if (!acceptWord("loop")) return expected("'loop'");
        if (!number(out, 0xfffffeu)) return false;
        f.loops = std::max(f.loops, out + 1);
        return true;
    }

    bool swizzle(Expr& e, std::vector<ExprId>& list) {
        bool comma = false;
        if (!operands(list, comma)) return false;
        if (!comma) return payload(e);
        if (acceptWord("column")) return number(e.payload);
        const std::string_view mask = token.text;
        if (token.kind != TokenKind::Word || mask.size() > 4 || mask.find_first_not_of("xyzw") != mask.npos)
            return expected("one to four of x, y, z and w");
        int at[4] = {};
        for (std::size_t i = 0; i < mask.size(); i++) at[i] = mask[i] == 'w' ? 3 : mask[i] - 'x';
        e.payload = swizzleMask(static_cast<int>(mask.size()), at[0], at[1], at[2], at[3]);
        next();
        return true;
    }

    bool constant(Expr& e) {
        const int n = componentCount(e.type);
        if (e.type == Type::String && here() && token.kind == TokenKind::String) {
            Name said;
            if (!name(said)) return false;
            e.payload = said.index;
            return true;
        }
        if (n == 0) return payload(e);
        e.payload = static_cast<std::uint32_t>(f.words.size());
        for (int i = 0; i < n; i++) {
            std::uint32_t v = 0;
            if (i && !expect(",")) return false;
            if (!here()) return expected("a number on this line");
            if (!word(info(e.type).scalar, v)) return false;
            f.words.push_back(v);
        }
        return true;
    }

    bool param(Expr& e) {
        if (token.kind == TokenKind::Number) return number(e.payload);
        const Token where = token;
        Name n;
        if (!name(n)) return false;
        std::vector<std::string_view> known;
        for (std::size_t i = 0; i < f.params.size(); i++) {
            if (f.params[i].name == n) {
                e.payload = static_cast<std::uint32_t>(i);
                return true;
            }
            known.push_back(module.names->text(f.params[i].name));
        }
        return fail(where, "unknown-parameter", fmt::format("the function has no parameter '{}'", where.text),
                    nearest(where.text, known));
    }

    bool context(Expr& e) {
        if (token.isWord("payload")) return payload(e);
        Context c = {};
        if (token.kind != TokenKind::Word) return expected("a name of the context");
        if (!contextNamed(token.text, c)) {
            std::vector<std::string_view> known;
            for (int i = 0; i < kContexts; i++) known.push_back(info(static_cast<Context>(i)).name);
            return fail(token, "unknown-context", fmt::format("unknown context '{}'", token.text),
                        nearest(token.text, known));
        }
        e.payload = static_cast<std::uint32_t>(c);
        next();
        return true;
    }

    bool payload(Expr& e) {
        if (!here() || !acceptWord("payload")) return true;
        return number(e.payload);
    }

    // What follows the type, by the operation.
    bool rest(Expr& e, std::vector<ExprId>& list) {
        bool comma = false;
        switch (textForm(e.op)) {
            case TextForm::Constant:
                return constant(e);
            case TextForm::Param:
                return param(e);
            case TextForm::Context:
                return context(e);
            case TextForm::Named: {
                Name n;
                if (!here()) return expected("a name on this line");
                if (!name(n)) return false;
                e.payload = n.index;
                break;
            }
            case TextForm::Swizzle:
                return swizzle(e, list);
            case TextForm::Numbered:
                if (!operands(list, comma)) return false;
                if (!comma && !list.empty()) return expected("',' and a number");
                return number(e.payload);
            case TextForm::LoopArg: {
                std::uint32_t loop = 0, k = 0;
                if (!loopNumber(loop) || !expect(",") || !number(k, 255)) return false;
                e.payload = loop << 8 | k;
                return true;
            }
            case TextForm::Loop:
                if (!loopNumber(e.payload)) return false;
                while (here() && (token.is(",") || token.is("|"))) {
                    next();
                    ExprId o;
                    if (!ref(o)) return false;
                    list.push_back(o);
                }
                return true;
            case TextForm::Extern:
                if (!number(e.payload)) return false;
                break;
            case TextForm::Plain:
                if (!operands(list, comma)) return false;
                return comma ? expected("an expression") : payload(e);
        }
        if (!operands(list, comma)) return false;
        return comma ? expected("an expression") : true;
    }

    bool opName(Op& op) {
        if (token.kind != TokenKind::Word) return expected("an operation");
        if (!opNamed(token.text, op)) {
            std::vector<std::string_view> known;
            for (int i = 0; i < kOps; i++) known.push_back(info(static_cast<Op>(i)).name);
            return fail(token, "unknown-operation", fmt::format("unknown operation '{}'", token.text),
                        nearest(token.text, known));
        }
        next();
        return true;
    }

    bool exprLine() {
        const Token label = token;
        next();
        Name hint;
        if (token.kind == TokenKind::String && !name(hint)) return false;
        Expr e{Op::Constant};
        std::vector<ExprId> list;
        const bool read = expect("=") && opName(e.op) && type(e.type) && rest(e, list);
        if (read && list.size() > 0xffff) return fail(label, "limit", "too many operands");
        // A line with an error defines its name too, so that the lines after it are not errors for that.
        e.operandCount = static_cast<std::uint16_t>(list.size());
        e.firstOperand = static_cast<std::uint32_t>(f.operands.size());
        f.operands.insert(f.operands.end(), list.begin(), list.end());
        const ExprId id(static_cast<std::uint32_t>(f.exprs.size()));
        f.exprs.push_back(e);
        f.hints.push_back(hint);
        if (label.text.empty() || label.text == "?" || !exprs.emplace(label.text, id).second)
            return fail(label, "redefinition", fmt::format("%{} is defined already", label.text));
        return read;
    }

    // ---- Functions ----

    bool returns() {
        std::size_t i = 0;
        const Token where = token;
        while (here() && (i == 0 ? token.kind == TokenKind::Ref : accept(","))) {
            ExprId e;
            if (!ref(e)) return false;
            if (i < f.results.size()) f.results[i].value = e;
            i++;
        }
        if (i == f.results.size()) return true;
        return fail(where, "result-count", fmt::format("{} results for {} declared", i, f.results.size()));
    }

    struct Frame {
        BlockId block;
        Stmt open = {};  // the statement whose blocks lie above this frame
        bool inElse = false;
    };

    BlockId newBlock() {
        f.body.blocks.emplace_back();
        return BlockId(static_cast<std::uint32_t>(f.body.blocks.size() - 1));
    }

    // The `}` of a block inside another is read: else or phis may follow.
    bool closeStatement(std::vector<Frame>& stack) {
        Frame& outer = stack.back();
        if (outer.open.kind == StmtKind::If && !outer.inElse && acceptWord("else")) {
            if (!expect("{")) return false;
            outer.inElse = true;
            outer.open.orElse = newBlock();
            stack.push_back({outer.open.orElse});
            return true;
        }
        outer.open.firstPhi = static_cast<std::uint32_t>(f.body.phis.size());
        if (outer.open.kind == StmtKind::If && accept("->")) {
            do {
                ExprId e;
                if (!ref(e)) return false;
                f.body.phis.push_back(e);
                outer.open.phiCount++;
            } while (accept(","));
        }
        if (outer.open.phiCount == 0) outer.open.firstPhi = 0;
        f.body.blocks[outer.block.index].push_back(outer.open);
        return true;
    }

    bool body() {
        if (!f.body.blocks.empty()) return fail(token, "redefinition", "the function has a body already");
        if (!expect("{")) return false;
        std::vector<Frame> stack{{newBlock()}};
        while (true) {
            if (accept("}")) {
                stack.pop_back();
                if (stack.empty()) return true;
                if (!closeStatement(stack)) return false;
                continue;
            }
            Stmt s = {};
            if (acceptWord("let"))
                s.kind = StmtKind::Let;
            else if (acceptWord("if"))
                s.kind = StmtKind::If;
            else if (acceptWord("loop"))
                s.kind = StmtKind::Loop;
            else
                return expected("let, if, loop or '}'");
            if (!ref(s.expr)) return false;
            if (s.kind == StmtKind::Let) {
                f.body.blocks[stack.back().block.index].push_back(s);
                continue;
            }
            if (!expect("{")) return false;
            s.body = newBlock();
            stack.back().open = s;
            stack.back().inElse = false;
            stack.push_back({s.body});
        }
    }

    // To the next line that can follow in a function after an error.
    void skipLine() {
        do {
            next();
        } while (token.kind != TokenKind::End &&
                 !(token.firstOnLine && (token.kind == TokenKind::Ref || token.is("}") || token.isWord("return") ||
                                         token.isWord("body") || startsDeclaration())));
    }

    bool header(const std::string& said) {
        f = Function();
        exprs.clear();
        f.comment = said;
        f.isInline = acceptWord("inline");
        if (!acceptWord("function")) return expected("'function'");
        const Token where = token;
        std::vector<Param> results;
        if (!name(f.name) || !expect("(") || !members(f.params, ")")) return false;
        if (!expect("->") || !expect("(") || !members(f.results, ")")) return false;
        if (acceptWord("loops") && !number(f.loops, 0xffffffu)) return false;
        if (!expect("{")) return false;
        if (module.findOwn(f.name)) return redefined(where, "function");
        return true;
    }

    bool function() {
        const std::string said = comment;
        const std::size_t before = errors;
        if (!header(said)) return false;
        bool returned = false;
        while (!token.is("}")) {
            const Token start = token;
            bool fine = true;
            if (token.kind == TokenKind::Ref) {
                fine = exprLine();
            } else if (acceptWord("return")) {
                fine = returns();
                returned = true;
            } else if (acceptWord("body")) {
                fine = body();
            } else if (token.kind == TokenKind::End || (token.firstOnLine && startsDeclaration())) {
                return expected("'}' at the end of the function");
            } else {
                fine = expected("an expression, return, body or '}'");
            }
            if (fine && !token.firstOnLine && !token.is("}")) fine = expected("the end of the line");
            if (!fine && !(token.firstOnLine && token.offset != start.offset &&
                           (token.kind == TokenKind::Ref || token.is("}") || token.isWord("return"))))
                skipLine();
            if (errors > kMaxErrors) return false;
        }
        if (!returned && !f.results.empty()) fail(token, "result-count", "the function returns nothing");
        next();
        if (errors == before) made.push_back(&module.put(std::move(f)));
        return errors == before;
    }

    // ---- The whole ----

    bool startsDeclaration() const {
        for (std::string_view word : {"uniform", "leaf", "struct", "extern", "inline", "function"})
            if (token.isWord(word)) return true;
        return false;
    }

    bool declaration() {
        if (acceptWord("uniform")) return uniform();
        if (acceptWord("leaf")) return leaf();
        if (acceptWord("struct")) return structure();
        if (acceptWord("extern")) return externText();
        if (token.isWord("inline") || token.isWord("function")) return function();
        return expected("uniform, leaf, struct, extern, inline or function");
    }

    void run() {
        next();
        while (token.kind != TokenKind::End && errors <= kMaxErrors) {
            const Token start = token;
            if (declaration()) continue;
            // The lines of a broken function are no declarations.
            const bool isFunction = start.isWord("function") || start.isWord("inline");
            while (token.kind != TokenKind::End &&
                   (token.offset == start.offset || !token.firstOnLine || (isFunction && !startsDeclaration())))
                next();
        }
    }
};

}  // namespace

Result<std::vector<Function*>> parse(Module& module, std::string_view file, std::string_view text,
                                     Diagnostics& diagnostics) {
    Parser p{module, file, text, diagnostics};
    p.run();
    if (p.errors) return Failure();
    return std::move(p.made);
}

}  // namespace shaderx::ir
