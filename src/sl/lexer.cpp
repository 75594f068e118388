#include "sl/lexer.h"

#include <bit>
#include <string>

#include <fmt/format.h>

#include "base/numbers.h"

namespace shaderx::sl {

namespace {

constexpr std::size_t kMaxText = 16u << 20;
constexpr std::size_t kMaxName = 255;

struct Symbol {
    std::string_view text;
    TokenKind kind;
    Operator op = Operator::None;
};

// Longer ones first where one begins another.
constexpr Symbol kSymbols[] = {
    {">>>=", TokenKind::Assign, Operator::ShiftRightLogical},
    {">>>", TokenKind::Operator, Operator::ShiftRightLogical},
    {"<<=", TokenKind::Assign, Operator::ShiftLeft},
    {">>=", TokenKind::Assign, Operator::ShiftRight},
    {"<<", TokenKind::Operator, Operator::ShiftLeft},
    {">>", TokenKind::Operator, Operator::ShiftRight},
    {"<=", TokenKind::Operator, Operator::LessEqual},
    {">=", TokenKind::Operator, Operator::GreaterEqual},
    {"==", TokenKind::Operator, Operator::Equal},
    {"!=", TokenKind::Operator, Operator::NotEqual},
    {"&&", TokenKind::Operator, Operator::And},
    {"||", TokenKind::Operator, Operator::Or},
    {"++", TokenKind::Increment, Operator::Add},
    {"--", TokenKind::Increment, Operator::Sub},
    {"+=", TokenKind::Assign, Operator::Add},
    {"-=", TokenKind::Assign, Operator::Sub},
    {"*=", TokenKind::Assign, Operator::Mul},
    {"/=", TokenKind::Assign, Operator::Div},
    {"%=", TokenKind::Assign, Operator::Rem},
    {"&=", TokenKind::Assign, Operator::BitAnd},
    {"|=", TokenKind::Assign, Operator::BitOr},
    {"^=", TokenKind::Assign, Operator::BitXor},
    {"=", TokenKind::Assign},
    {"+", TokenKind::Operator, Operator::Add},
    {"-", TokenKind::Operator, Operator::Sub},
    {"*", TokenKind::Operator, Operator::Mul},
    {"/", TokenKind::Operator, Operator::Div},
    {"%", TokenKind::Operator, Operator::Rem},
    {"&", TokenKind::Operator, Operator::BitAnd},
    {"|", TokenKind::Operator, Operator::BitOr},
    {"^", TokenKind::Operator, Operator::BitXor},
    {"~", TokenKind::Operator, Operator::BitNot},
    {"!", TokenKind::Operator, Operator::Not},
    {"<", TokenKind::Operator, Operator::Less},
    {">", TokenKind::Operator, Operator::Greater},
    {"(", TokenKind::LeftParen},
    {")", TokenKind::RightParen},
    {"{", TokenKind::LeftBrace},
    {"}", TokenKind::RightBrace},
    {"[", TokenKind::LeftBracket},
    {"]", TokenKind::RightBracket},
    {",", TokenKind::Comma},
    {";", TokenKind::Semicolon},
    {".", TokenKind::Dot},
    {"?", TokenKind::Question},
    {":", TokenKind::Colon},
};

constexpr Symbol kWords[] = {
    {"if", TokenKind::If},
    {"else", TokenKind::Else},
    {"for", TokenKind::For},
    {"return", TokenKind::Return},
    {"const", TokenKind::Const},
    {"inline", TokenKind::Inline},
    {"true", TokenKind::True},
    {"false", TokenKind::False},
    {"while", TokenKind::Unsupported},
    {"do", TokenKind::Unsupported},
    {"break", TokenKind::Unsupported},
    {"continue", TokenKind::Unsupported},
    {"struct", TokenKind::Unsupported},
};

bool isDigit(char c) { return c >= '0' && c <= '9'; }
bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }

struct State {
    std::string_view text;
    bool withPlaceholders;
    NameTable& names;
    Reporter& report;
    Tokens out;
    std::uint32_t at = 0;

    char peek(std::size_t ahead = 0) const { return at + ahead < text.size() ? text[at + ahead] : '\0'; }
    bool starts(std::string_view what) const { return text.substr(at, what.size()) == what; }

    Token& push(TokenKind kind, std::uint32_t begin) {
        Token t;
        t.kind = kind;
        t.offset = begin;
        t.length = at - begin;
        out.tokens.push_back(t);
        return out.tokens.back();
    }

    Diagnostic& error(std::uint32_t offset, std::string_view code, std::string message) {
        out.errors.push_back(offset);
        return report.error(offset, code, std::move(message));
    }

    void run();
    void comment();
    void placeholder();
    void word();
    void number();
    void decimal(std::uint32_t begin, bool isFloat);
    void hexadecimal(std::uint32_t begin);
    void string();
    void symbol();
};

void State::comment() {
    std::uint32_t begin = at;
    std::size_t end;
    if (peek(1) == '/') {
        end = std::min(text.find('\n', at), text.size());
    } else if (end = text.find("*/", at + 2); end == std::string_view::npos) {
        error(begin, "unterminated-comment", "this comment has no end");
        end = text.size();
    } else {
        end += 2;
    }
    at = static_cast<std::uint32_t>(end);
    out.comments.push_back({begin, at});
}

void State::placeholder() {
    std::uint32_t begin = at;
    std::size_t end = text.find("}}", at);
    if (end == std::string_view::npos) {
        error(begin, "syntax", "'{{' without '}}'");
        at = static_cast<std::uint32_t>(text.size());
        return;
    }
    std::string_view name = trim(text.substr(at + 2, end - at - 2));
    at = static_cast<std::uint32_t>(end + 2);
    push(TokenKind::Placeholder, begin).name = names.intern(name.substr(0, kMaxName));
}

void State::word() {
    std::uint32_t begin = at;
    while (isLetter(peek()) || isDigit(peek())) at++;
    std::string_view name = text.substr(begin, at - begin);
    if (name.size() > kMaxName) {
        error(begin, "name-too-long", fmt::format("the name {} is too long", quoted(name)));
        name = name.substr(0, kMaxName);
    }
    for (const Symbol& w : kWords)
        if (w.text == name) {
            push(w.kind, begin);
            return;
        }
    push(TokenKind::Name, begin).name = names.intern(name);
}

void State::hexadecimal(std::uint32_t begin) {
    at += 2;
    std::uint64_t value = 0;
    std::uint32_t digits = 0;
    bool isBad = false;
    while (isLetter(peek()) || isDigit(peek())) {
        char c = peek();
        int digit = isDigit(c) ? c - '0' : (c | 32) - 'a' + 10;
        isBad = isBad || digit > 15 || value >> 28;
        value = value << 4 | static_cast<std::uint32_t>(digit & 15);
        value &= 0xffffffffffull;
        digits++;
        at++;
    }
    Token& t = push(TokenKind::Integer, begin);
    t.bits = static_cast<std::uint32_t>(value);
    if (isBad || digits == 0)
        error(begin, "bad-number",
              fmt::format("{} is not a hexadecimal number of 32 bits", quoted(text.substr(begin, at - begin))));
}

void State::decimal(std::uint32_t begin, bool isFloat) {
    std::string_view digits = text.substr(begin, at - begin);
    Token& t = push(isFloat ? TokenKind::Float : TokenKind::Integer, begin);
    if (isFloat) {
        if (auto value = parseFloat(digits))
            t.bits = std::bit_cast<std::uint32_t>(*value);
        else
            error(begin, "bad-number", fmt::format("{} does not fit a float", quoted(digits)));
    } else if (auto value = parseInt(digits)) {
        t.bits = static_cast<std::uint32_t>(*value);
    } else {
        error(begin, "bad-number", fmt::format("{} does not fit an integer", quoted(digits))).hint =
            "write 32 bits as a hexadecimal number, or a float with a point";
    }
}

void State::number() {
    std::uint32_t begin = at;
    if (peek() == '0' && (peek(1) | 32) == 'x') return hexadecimal(begin);
    bool isFloat = false;
    while (isDigit(peek())) at++;
    if (peek() == '.') {
        isFloat = true;
        at++;
        while (isDigit(peek())) at++;
    }
    if ((peek() | 32) == 'e') {
        std::size_t sign = peek(1) == '+' || peek(1) == '-';
        if (isDigit(peek(1 + sign))) {
            isFloat = true;
            at += static_cast<std::uint32_t>(1 + sign);
            while (isDigit(peek())) at++;
        }
    }
    if (!isLetter(peek())) return decimal(begin, isFloat);
    bool isSuffix = (peek() | 32) == 'f' && !isLetter(peek(1)) && !isDigit(peek(1));
    while (isLetter(peek()) || isDigit(peek())) at++;
    push(TokenKind::Float, begin);
    Diagnostic& d =
        error(begin, "bad-number", fmt::format("{} is not a number", quoted(text.substr(begin, at - begin))));
    if (isSuffix) d.hint = "numbers have no suffix here";
}

void State::string() {
    std::uint32_t begin = at++;
    std::string value;
    for (;;) {
        char c = peek();
        if (at >= text.size() || c == '\n') {
            error(begin, "unterminated-string", "this string has no end on its line");
            break;
        }
        at++;
        if (c == '"') break;
        if (c != '\\') {
            value += c;
            continue;
        }
        if (at >= text.size() || peek() == '\n') continue;
        char escaped = peek();
        at++;
        constexpr std::string_view kEscapes = "ntr\\\"'", kMeanings = "\n\t\r\\\"'";
        if (std::size_t k = kEscapes.find(escaped); k != std::string_view::npos)
            value += kMeanings[k];
        else
            error(at - 2, "bad-escape",
                  fmt::format("'\\{}' is no escape", escaped > ' ' && escaped < 127 ? escaped : '?'));
    }
    push(TokenKind::String, begin).name = names.intern(value);
}

void State::symbol() {
    std::uint32_t begin = at;
    for (const Symbol& s : kSymbols)
        if (s.text[0] == peek() && starts(s.text)) {
            at += static_cast<std::uint32_t>(s.text.size());
            push(s.kind, begin).op = s.op;
            return;
        }
    if (peek() == '#') {
        at = static_cast<std::uint32_t>(std::min(text.find('\n', at), text.size()));
        error(begin, "unsupported", "there is no preprocessor").hint = "write a constant as 'const float X = 1.0;'";
        return;
    }
    // One message for a run of them.
    auto isStrange = [&] {
        char c = peek();
        return at < text.size() && (static_cast<unsigned char>(c) >= 127 || (c < ' ' && !isBlank(c)) || c == '@' ||
                                    c == '$' || c == '`' || c == '\\' || c == '\'');
    };
    while (isStrange()) at++;
    if (at == begin) at++;
    error(begin, "bad-character", fmt::format("{} has no meaning here", quoted(text.substr(begin, at - begin))));
}

void State::run() {
    if (text.size() > kMaxText) {
        error(0, "too-large", "the text is larger than 16 MiB");
        text = {};
    }
    if (starts("\xef\xbb\xbf")) at = 3;  // a byte order mark
    while (at < text.size()) {
        char c = peek();
        if (isBlank(c))
            at++;
        else if (c == '/' && (peek(1) == '/' || peek(1) == '*'))
            comment();
        else if (withPlaceholders && c == '{' && peek(1) == '{')
            placeholder();
        else if (isLetter(c))
            word();
        else if (isDigit(c) || (c == '.' && isDigit(peek(1))))
            number();
        else if (c == '"')
            string();
        else
            symbol();
    }
    push(TokenKind::End, at);
}

}  // namespace

Tokens lex(std::string_view text, bool withPlaceholders, NameTable& names, Reporter& report) {
    State s{text, withPlaceholders, names, report, {}};
    s.run();
    return std::move(s.out);
}

}  // namespace shaderx::sl
