#include "sl/parser.h"

#include <algorithm>

#include <fmt/format.h>

#include "sl/lexer.h"

namespace shaderx::sl {

namespace {

constexpr int kMaxDepth = 256;
constexpr int kMaxHeight = 512;

// How tightly a binary operator binds; 0 for others.
int precedence(Operator op) {
    switch (op) {
        case Operator::Or:
            return 1;
        case Operator::And:
            return 2;
        case Operator::BitOr:
            return 3;
        case Operator::BitXor:
            return 4;
        case Operator::BitAnd:
            return 5;
        case Operator::Equal:
        case Operator::NotEqual:
            return 6;
        case Operator::Less:
        case Operator::LessEqual:
        case Operator::Greater:
        case Operator::GreaterEqual:
            return 7;
        case Operator::ShiftLeft:
        case Operator::ShiftRight:
        case Operator::ShiftRightLogical:
            return 8;
        case Operator::Add:
        case Operator::Sub:
            return 9;
        case Operator::Mul:
        case Operator::Div:
        case Operator::Rem:
            return 10;
        case Operator::None:
        case Operator::Neg:
        case Operator::Plus:
        case Operator::Not:
        case Operator::BitNot:
            return 0;
    }
    return 0;
}

struct State {
    std::string_view text;
    NameTable& names;
    Reporter& report;
    Tokens tokens;
    Tree tree;
    std::size_t at = 0;
    int depth = 0;
    bool failed = false;  // an error waits for synchronisation
    bool endTold = false;
    std::size_t strayErrors = 0;  // of the lexer, outside of functions

    // Counts a level of nesting; too many end the parse.
    struct Level {
        State& s;
        explicit Level(State& state) : s(state) {
            if (++s.depth > kMaxDepth) s.tooDeep();
        }
        ~Level() { s.depth--; }
    };

    const Token& peek(std::size_t ahead = 0) const {
        return tokens.tokens[std::min(at + ahead, tokens.tokens.size() - 1)];
    }
    TokenKind kind(std::size_t ahead = 0) const { return peek(ahead).kind; }
    Token next() {
        Token t = peek();
        if (at + 1 < tokens.tokens.size()) at++;
        return t;
    }
    bool accept(TokenKind k) {
        if (kind() != k) return false;
        next();
        return true;
    }
    bool isOperator(Operator op) const { return kind() == TokenKind::Operator && peek().op == op; }
    std::string_view word(const Token& t) const { return text.substr(t.offset, t.length); }

    void fail(const Token& t, std::string_view code, std::string message, std::string hint = {});
    void expected(std::string_view what);
    bool expect(TokenKind k, std::string_view what);
    void tooDeep();
    void unsupported();
    void skipStatement(std::size_t begin);
    void skipDeclaration();

    NodeId add(Node n, std::initializer_list<NodeId> children);
    NodeId add(Node n, const std::vector<NodeId>& children);
    NodeId expression();
    NodeId binary(int least);
    NodeId unary();
    NodeId postfix(NodeId value);
    NodeId primary();
    NodeId call(const Token& name);

    StmtId addStatement(const Stmt& s);
    List addList(const std::vector<StmtId>& list);
    bool block(List& body);
    List bodyOf();
    void statement(std::vector<StmtId>& list);
    bool isDeclaration() const;
    void declaration(std::vector<StmtId>& list, bool endsHere);
    StmtId simple();
    StmtId assignment(NodeId target, const Token& op, NodeId value);
    StmtId ifStatement();
    StmtId forStatement();

    Type type(const Token& t);
    void topLevel();
    void constant();
    void function(bool isInline, std::uint32_t begin);
    bool parameters(FunctionDecl& f);
    // Errors of the lexer before an offset.
    std::size_t unreadBefore(std::uint32_t offset) const {
        const auto& all = tokens.errors;
        return static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), offset) - all.begin());
    }
    std::string commentAbove(std::uint32_t offset) const;
};

// ---- errors ----

void State::fail(const Token& t, std::string_view code, std::string message, std::string hint) {
    bool isTold = failed || (t.kind == TokenKind::End && endTold);
    if (!isTold) report.error(t.offset, code, std::move(message)).hint = std::move(hint);
    failed = true;
    endTold = endTold || t.kind == TokenKind::End;
}

void State::expected(std::string_view what) {
    if (kind() == TokenKind::Unsupported) return unsupported();
    if (kind() == TokenKind::End)
        fail(peek(), "syntax", fmt::format("expected {} before the end of the text", what));
    else
        fail(peek(), "syntax", fmt::format("expected {} before {}", what, quoted(word(peek()))));
}

bool State::expect(TokenKind k, std::string_view what) {
    if (accept(k)) return true;
    expected(what);
    return false;
}

void State::tooDeep() {
    fail(peek(), "too-deep", fmt::format("nested more than {} levels deep", kMaxDepth));
    tree.isIncomplete = true;
    endTold = true;
    at = tokens.tokens.size() - 1;
}

void State::unsupported() {
    std::string_view w = word(peek());
    std::string hint = w == "while" || w == "do"         ? "write a 'for' whose count is known before it starts"
                       : w == "break" || w == "continue" ? "choose values with 'if' inside the loop"
                                                         : "";
    fail(peek(), "unsupported", fmt::format("'{}' is not supported", w), hint);
}

// Goes on after the next semicolon, or before the brace that closes the block, stepping over whole blocks.
void State::skipStatement(std::size_t begin) {
    failed = false;
    // The semicolons in the head of a loop do not end it.
    bool isLoop = tokens.tokens[begin].kind == TokenKind::For;
    int parens = 0;
    for (std::size_t i = begin; i < at; i++)
        parens += (tokens.tokens[i].kind == TokenKind::LeftParen) - (tokens.tokens[i].kind == TokenKind::RightParen);
    for (int braces = 0; kind() != TokenKind::End; next()) {
        TokenKind k = kind();
        if (k == TokenKind::LeftParen) parens++;
        if (k == TokenKind::RightParen) parens--;
        if (k == TokenKind::LeftBrace) braces++;
        if (k == TokenKind::RightBrace) {
            if (braces == 0) return;
            if (--braces == 0) {
                next();
                return;
            }
        }
        if (k == TokenKind::Semicolon && braces == 0 && !(isLoop && parens > 0)) {
            next();
            return;
        }
    }
}

void State::skipDeclaration() {
    tree.isIncomplete = true;
    failed = false;
    for (int braces = 0; kind() != TokenKind::End;) {
        TokenKind k = next().kind;
        if (k == TokenKind::LeftBrace) braces++;
        if (k == TokenKind::RightBrace && --braces <= 0) return;
        if (k == TokenKind::Semicolon && braces <= 0) return;
    }
}

// ---- expressions ----

NodeId State::add(Node n, const std::vector<NodeId>& children) {
    int height = 1;
    for (std::size_t k = 0; k < children.size(); k++) {
        if (!children[k]) return {};  // its error is told
        const Node& c = tree[children[k]];
        bool isSpine = k == 0 && n.kind == NodeKind::Binary && c.kind == NodeKind::Binary;
        height = std::max(height, c.height + (isSpine ? 0 : 1));
    }
    if (height > kMaxHeight) {
        tooDeep();
        return {};
    }
    n.height = static_cast<std::uint16_t>(height);
    n.children = {static_cast<std::uint32_t>(tree.children.size()), static_cast<std::uint32_t>(children.size())};
    tree.children.insert(tree.children.end(), children.begin(), children.end());
    tree.nodes.push_back(n);
    return NodeId(static_cast<std::uint32_t>(tree.nodes.size() - 1));
}

NodeId State::add(Node n, std::initializer_list<NodeId> children) { return add(n, std::vector<NodeId>(children)); }

NodeId State::expression() {
    Level level(*this);
    if (failed) return {};
    NodeId condition = binary(1);
    if (kind() != TokenKind::Question) return condition;
    Node n{NodeKind::Conditional};
    n.offset = next().offset;
    NodeId then = expression();
    if (!expect(TokenKind::Colon, "':'")) return {};
    NodeId otherwise = expression();
    return add(n, {condition, then, otherwise});
}

// Operators that bind at least as tightly as `least`.
NodeId State::binary(int least) {
    NodeId left = unary();
    while (left && kind() == TokenKind::Operator && precedence(peek().op) >= least) {
        Token op = next();
        Node n{NodeKind::Binary, op.op};
        n.offset = op.offset;
        NodeId right = binary(precedence(op.op) + 1);
        left = add(n, {left, right});
    }
    return left;
}

NodeId State::unary() {
    bool isSign = isOperator(Operator::Sub) || isOperator(Operator::Add);
    if (!isSign && !isOperator(Operator::Not) && !isOperator(Operator::BitNot)) return postfix(primary());
    Level level(*this);
    if (failed) return {};
    Token op = next();
    Node n{NodeKind::Unary, op.op};
    if (isSign) n.op = op.op == Operator::Sub ? Operator::Neg : Operator::Plus;
    n.offset = op.offset;
    return add(n, {unary()});
}

NodeId State::postfix(NodeId value) {
    while (value) {
        if (kind() == TokenKind::Dot) {
            next();
            Node n{NodeKind::Member};
            n.offset = peek().offset;
            n.name = peek().name;
            if (!expect(TokenKind::Name, "components such as 'xyz'")) return {};
            value = add(n, {value});
        } else if (kind() == TokenKind::LeftBracket) {
            Node n{NodeKind::Index};
            n.offset = next().offset;
            NodeId index = expression();
            if (!index || !expect(TokenKind::RightBracket, "']'")) return {};
            value = add(n, {value, index});
        } else {
            break;
        }
    }
    return value;
}

NodeId State::call(const Token& name) {
    Node n{NodeKind::Call};
    n.offset = name.offset;
    n.name = name.name;
    n.type = typeCalled(word(name));
    next();
    std::vector<NodeId> arguments;
    if (!accept(TokenKind::RightParen)) {
        do {
            arguments.push_back(expression());
            if (!arguments.back()) return {};
        } while (accept(TokenKind::Comma));
        if (!expect(TokenKind::RightParen, "',' or ')'")) return {};
    }
    if (arguments.size() > 256) {
        fail(name, "too-large", "more than 256 arguments");
        return {};
    }
    return add(n, arguments);
}

NodeId State::primary() {
    if (failed) return {};
    Token t = peek();
    Node n{NodeKind::Integer};
    n.offset = t.offset;
    n.name = t.name;
    n.bits = t.bits;
    switch (t.kind) {
        case TokenKind::Integer:
            break;
        case TokenKind::Float:
            n.kind = NodeKind::Float;
            break;
        case TokenKind::String:
            n.kind = NodeKind::String;
            break;
        case TokenKind::Placeholder:
            n.kind = NodeKind::Placeholder;
            break;
        case TokenKind::True:
        case TokenKind::False:
            n.kind = NodeKind::Boolean;
            n.bits = t.kind == TokenKind::True;
            break;
        case TokenKind::Name:
            next();
            if (kind() == TokenKind::LeftParen) return call(t);
            n.kind = NodeKind::Name;
            return add(n, {});
        case TokenKind::LeftParen: {
            next();
            NodeId inner = expression();
            if (!inner || !expect(TokenKind::RightParen, "')'")) return {};
            return inner;
        }
        case TokenKind::End:
        case TokenKind::RightParen:
        case TokenKind::LeftBrace:
        case TokenKind::RightBrace:
        case TokenKind::LeftBracket:
        case TokenKind::RightBracket:
        case TokenKind::Comma:
        case TokenKind::Semicolon:
        case TokenKind::Dot:
        case TokenKind::Question:
        case TokenKind::Colon:
        case TokenKind::Assign:
        case TokenKind::Increment:
        case TokenKind::Operator:
        case TokenKind::If:
        case TokenKind::Else:
        case TokenKind::For:
        case TokenKind::Return:
        case TokenKind::Const:
        case TokenKind::Inline:
        case TokenKind::Unsupported:
            expected("an expression");
            return {};
    }
    next();
    return add(n, {});
}

// ---- statements ----

StmtId State::addStatement(const Stmt& s) {
    tree.statements.push_back(s);
    return StmtId(static_cast<std::uint32_t>(tree.statements.size() - 1));
}

List State::addList(const std::vector<StmtId>& list) {
    List made{static_cast<std::uint32_t>(tree.statementLists.size()), static_cast<std::uint32_t>(list.size())};
    tree.statementLists.insert(tree.statementLists.end(), list.begin(), list.end());
    return made;
}

// From its opening brace; false where that is missing.
bool State::block(List& body) {
    if (!expect(TokenKind::LeftBrace, "'{'")) return false;
    std::vector<StmtId> list;
    while (kind() != TokenKind::RightBrace && kind() != TokenKind::End) statement(list);
    expect(TokenKind::RightBrace, "'}'");
    body = addList(list);
    return true;
}

// A block, or one statement in its place.
List State::bodyOf() {
    List body;
    if (failed) return body;
    if (kind() == TokenKind::LeftBrace) {
        block(body);
        return body;
    }
    std::vector<StmtId> list;
    statement(list);
    return addList(list);
}

void State::statement(std::vector<StmtId>& list) {
    Level level(*this);
    std::size_t begin = at;
    bool isLoop = kind() == TokenKind::For;
    Stmt s{StmtKind::Block};
    s.offset = peek().offset;
    StmtId made;
    if (failed || accept(TokenKind::Semicolon)) {
    } else if (kind() == TokenKind::LeftBrace) {
        block(s.body);
        made = addStatement(s);
    } else if (kind() == TokenKind::If) {
        made = ifStatement();
    } else if (isLoop) {
        made = forStatement();
    } else if (accept(TokenKind::Return)) {
        s.kind = StmtKind::Return;
        if (kind() != TokenKind::Semicolon) s.value = expression();
        if (!failed) expect(TokenKind::Semicolon, "';'");
        made = addStatement(s);
    } else if (kind() == TokenKind::Const || isDeclaration()) {
        declaration(list, true);
    } else {
        made = simple();
        if (!failed) expect(TokenKind::Semicolon, "';'");
    }
    if (failed) {
        if (at == begin && kind() != TokenKind::RightBrace) next();
        skipStatement(begin);
    } else if (made) {
        list.push_back(made);
    }
}

bool State::isDeclaration() const { return kind() == TokenKind::Name && kind(1) == TokenKind::Name; }

Type State::type(const Token& t) {
    Type found = t.kind == TokenKind::Name ? typeCalled(word(t)) : Type::Void;
    if (found != Type::Void || (t.kind == TokenKind::Name && word(t) == "void")) return found;
    std::vector<std::string_view> known;
    for (int i = 0; i < ir::kBuiltinTypes; i++) {
        std::string_view name = ir::info(static_cast<Type>(i)).name;
        if (typeCalled(name) != Type::Void) known.push_back(name);
    }
    known.insert(known.end(), {"int", "bool", "color", "vector", "void"});
    std::string_view near = t.length <= 64 ? nearest(word(t), known) : std::string_view();
    fail(t, "unknown-type", fmt::format("unknown type {}", quoted(word(t))),
         near.empty() ? "" : fmt::format("did you mean '{}'?", near));
    return Type::Void;
}

// `type name = value, name = value;`, each name a statement of its own.
void State::declaration(std::vector<StmtId>& list, bool endsHere) {
    Stmt s{StmtKind::Declare};
    s.isConst = accept(TokenKind::Const);
    Token typeToken = next();
    s.type = type(typeToken);
    if (!failed && s.type == Type::Void) fail(typeToken, "type-mismatch", "a variable cannot be void");
    do {
        s.offset = peek().offset;
        s.name = peek().name;
        s.value = {};
        if (failed || !expect(TokenKind::Name, "a name")) return;
        if (kind() == TokenKind::LeftBracket) return fail(peek(), "unsupported", "arrays are not supported");
        if (kind() == TokenKind::LeftParen)
            return fail(peek(), "syntax", "a function cannot stand inside another", "is a '}' missing above?");
        if (kind() == TokenKind::Assign && peek().op == Operator::None) {
            next();
            s.value = expression();
        }
        if (failed) return;
        list.push_back(addStatement(s));
    } while (endsHere && accept(TokenKind::Comma));
    if (endsHere) expect(TokenKind::Semicolon, "';'");
}

StmtId State::assignment(NodeId target, const Token& op, NodeId value) {
    Stmt s{StmtKind::Assign, op.op};
    s.offset = op.offset;
    s.target = target;
    s.value = value;
    return addStatement(s);
}

// An assignment or a call, without its semicolon.
StmtId State::simple() {
    auto one = [&](std::uint32_t offset) {
        Node n{NodeKind::Integer};
        n.offset = offset;
        n.bits = 1;
        return add(n, {});
    };
    Token first = peek();
    if (first.kind == TokenKind::Increment) {
        next();
        NodeId target = postfix(primary());
        return target ? assignment(target, first, one(first.offset)) : StmtId();
    }
    NodeId target = expression();
    if (!target) return {};
    Token op = peek();
    if (op.kind == TokenKind::Increment) {
        next();
        return assignment(target, op, one(op.offset));
    }
    if (op.kind == TokenKind::Assign) {
        next();
        NodeId value = expression();
        return value ? assignment(target, op, value) : StmtId();
    }
    if (tree[target].kind != NodeKind::Call || tree[target].type != Type::Void) {
        if (op.kind == TokenKind::Semicolon)
            fail(first, "no-effect", "this statement does nothing");
        else
            expected("'=' or ';'");
        return {};
    }
    Stmt s{StmtKind::Call};
    s.offset = first.offset;
    s.value = target;
    return addStatement(s);
}

// All arms of `if … else if … else …`, so that a long chain is not a deep tree.
StmtId State::ifStatement() {
    Stmt s{StmtKind::If};
    s.offset = peek().offset;
    std::vector<Arm> arms;
    bool goesOn = true;
    while (goesOn && accept(TokenKind::If)) {
        if (!expect(TokenKind::LeftParen, "'('")) return {};
        NodeId condition = expression();
        if (!condition || !expect(TokenKind::RightParen, "')'")) return {};
        arms.push_back({condition, bodyOf()});
        goesOn = !failed && accept(TokenKind::Else);
        if (goesOn && kind() != TokenKind::If) {
            arms.push_back({{}, bodyOf()});
            goesOn = false;
        }
    }
    s.body = {static_cast<std::uint32_t>(tree.arms.size()), static_cast<std::uint32_t>(arms.size())};
    tree.arms.insert(tree.arms.end(), arms.begin(), arms.end());
    return addStatement(s);
}

StmtId State::forStatement() {
    Stmt s{StmtKind::For};
    s.offset = next().offset;
    constexpr std::string_view kForm = "write 'for (int i = 0; i < count; i++)'";
    if (!expect(TokenKind::LeftParen, "'('")) return {};
    if (!isDeclaration()) {
        fail(peek(), "loop-form", "a loop declares its index", std::string(kForm));
        return {};
    }
    std::vector<StmtId> init;
    declaration(init, false);
    if (failed || !expect(TokenKind::Semicolon, "';'")) return {};
    s.init = init[0];
    if (kind() == TokenKind::Semicolon) {
        fail(peek(), "loop-form", "a loop without a condition", std::string(kForm));
        return {};
    }
    s.value = expression();
    if (failed || !expect(TokenKind::Semicolon, "';'")) return {};
    if (kind() == TokenKind::RightParen) {
        fail(peek(), "loop-form", "a loop without a step", std::string(kForm));
        return {};
    }
    s.step = simple();
    if (failed || !expect(TokenKind::RightParen, "')'")) return {};
    s.body = bodyOf();
    return addStatement(s);
}

// ---- declarations ----

void State::topLevel() {
    strayErrors = tokens.errors.size();
    while (kind() != TokenKind::End) {
        std::uint32_t begin = peek().offset;
        if (accept(TokenKind::Semicolon)) continue;
        if (accept(TokenKind::Const))
            constant();
        else
            function(accept(TokenKind::Inline), begin);
        if (failed) skipDeclaration();
    }
    tree.isIncomplete = tree.isIncomplete || strayErrors != 0;
}

void State::constant() {
    ConstDecl c;
    Token typeToken = next();
    c.type = type(typeToken);
    if (!failed && c.type == Type::Void) fail(typeToken, "type-mismatch", "a constant cannot be void");
    c.offset = peek().offset;
    c.name = peek().name;
    if (failed || !expect(TokenKind::Name, "a name")) return;
    if (kind() == TokenKind::LeftBracket) return fail(peek(), "unsupported", "arrays are not supported");
    if (kind() != TokenKind::Assign || peek().op != Operator::None) return expected("'='");
    next();
    c.value = expression();
    if (failed || !expect(TokenKind::Semicolon, "';'")) return;
    tree.constants.push_back(c);
}

void State::function(bool isInline, std::uint32_t begin) {
    FunctionDecl f;
    f.isInline = isInline;
    if (kind() != TokenKind::Name) return expected("a function or a constant");
    f.result = type(next());
    f.offset = peek().offset;
    f.name = peek().name;
    if (failed || !expect(TokenKind::Name, "a name")) return;
    if (kind() == TokenKind::Assign || kind() == TokenKind::Semicolon)
        return fail(peek(), "unsupported", "a variable outside of functions must be constant",
                    "write 'const' before its type");
    if (!expect(TokenKind::LeftParen, "'('") || !parameters(f)) return;
    if (kind() == TokenKind::Semicolon)
        return fail(peek(), "syntax", "a function needs no declaration before its definition", "leave it out");
    f.comment = commentAbove(begin);
    std::size_t before = report.errors();
    if (kind() != TokenKind::LeftBrace) return expected("'{'");
    block(f.body);
    // A token left out inside leaves the others' functions as they are.
    std::size_t inside = unreadBefore(peek().offset) - unreadBefore(begin);
    strayErrors -= inside;
    f.isBroken = inside != 0 || report.errors() != before;
    tree.functions.push_back(std::move(f));
}

// From after the opening parenthesis.
bool State::parameters(FunctionDecl& f) {
    if (accept(TokenKind::RightParen)) return true;
    if (kind() == TokenKind::Name && word(peek()) == "void" && kind(1) == TokenKind::RightParen) {
        next();
        next();
        return true;
    }
    do {
        // `output` is a word like any other unless a type and a name follow.
        bool isOutput = kind() == TokenKind::Name && word(peek()) == "output" && kind(1) == TokenKind::Name &&
                        kind(2) == TokenKind::Name;
        if (isOutput) next();
        ParamDecl p;
        Token typeToken = next();
        p.type = type(typeToken);
        if (!failed && p.type == Type::Void) fail(typeToken, "type-mismatch", "a parameter cannot be void");
        p.offset = peek().offset;
        p.name = peek().name;
        if (failed || !expect(TokenKind::Name, "a name")) return false;
        if (kind() == TokenKind::LeftBracket) fail(peek(), "unsupported", "arrays are not supported");
        if (kind() == TokenKind::Assign) fail(peek(), "unsupported", "a parameter of a function has no default");
        if (!isOutput && !f.outputs.empty()) fail(typeToken, "syntax", "outputs stand after all other parameters");
        (isOutput ? f.outputs : f.params).push_back(p);
    } while (!failed && accept(TokenKind::Comma));
    if (!failed && f.params.size() + f.outputs.size() > 256) fail(peek(), "too-large", "more than 256 parameters");
    return !failed && expect(TokenKind::RightParen, "',' or ')'");
}

// The text of a comment without its slashes, stars and the blank after them.
void appendComment(std::string_view c, std::string& text) {
    bool isBlock = c.substr(0, 2) == "/*";
    c.remove_prefix(2);
    if (isBlock && c.size() >= 2 && c.substr(c.size() - 2) == "*/") c.remove_suffix(2);
    while (!c.empty()) {
        std::size_t end = c.find('\n');
        std::string_view line = c.substr(0, end);
        c = end == std::string_view::npos ? std::string_view() : c.substr(end + 1);
        while (!line.empty() &&
               (line.back() == ' ' || line.back() == '\t' || line.back() == '\r' || (isBlock && line.back() == '*')))
            line.remove_suffix(1);
        std::size_t first = line.find_first_not_of(isBlock ? " \t*" : "/ \t");
        line = first == std::string_view::npos ? std::string_view() : line.substr(first);
        if (line.empty()) continue;
        if (!text.empty()) text += '\n';
        text += line;
    }
}

// The comments that stand directly above an offset, each the first on its line.
std::string State::commentAbove(std::uint32_t offset) const {
    auto isGap = [&](std::uint32_t a, std::uint32_t b) {
        int lines = 0;
        for (char c : text.substr(a, b - a)) {
            if (c == '\n') lines++;
            if (c != '\n' && c != ' ' && c != '\t' && c != '\r') return false;
        }
        return lines <= 1;
    };
    auto startsLine = [&](std::uint32_t a) {
        while (a > 0 && (text[a - 1] == ' ' || text[a - 1] == '\t')) a--;
        return a == 0 || text[a - 1] == '\n';
    };
    auto end = std::upper_bound(tokens.comments.begin(), tokens.comments.end(), offset,
                                [](std::uint32_t o, const Comment& c) { return o < c.begin; });
    auto begin = end;
    while (begin != tokens.comments.begin() && isGap((begin - 1)->end, offset) && startsLine((begin - 1)->begin)) {
        begin--;
        offset = begin->begin;
    }
    std::string found;
    for (; begin != end; begin++) appendComment(text.substr(begin->begin, begin->end - begin->begin), found);
    return found;
}

}  // namespace

Type typeCalled(std::string_view name) {
    Type t = name == "matrix" ? Type::Matrix44 : ir::typeNamed(name);
    return t == Type::Tuple || t == Type::Material ? Type::Void : t;
}

Tree parseFunctions(std::string_view text, NameTable& names, Reporter& report) {
    State s{text, names, report, lex(text, false, names, report), {}};
    s.topLevel();
    return std::move(s.tree);
}

Tree parseInlineText(std::string_view text, std::size_t count, NameTable& names, Reporter& report) {
    State s{text, names, report, lex(text, true, names, report), {}};
    for (std::size_t k = 0; k < count && !s.failed; k++) {
        if (k > 0) s.expect(TokenKind::Comma, "',' and the next result");
        NodeId e = s.expression();
        s.tree.expressions.push_back(e);
    }
    if (!s.failed && s.kind() != TokenKind::End) s.expected("the end");
    return std::move(s.tree);
}

}  // namespace shaderx::sl
