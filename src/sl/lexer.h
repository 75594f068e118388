// Source text to tokens.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "base/names.h"
#include "sl/ast.h"
#include "sl/report.h"

namespace shaderx::sl {

enum class TokenKind : std::uint8_t {
    End,
    Name,         // also the names of types, which are not reserved: `color color` is a parameter
    Placeholder,  // {{name}} in inline text
    Integer,
    Float,
    String,
    LeftParen,
    RightParen,
    LeftBrace,
    RightBrace,
    LeftBracket,
    RightBracket,
    Comma,
    Semicolon,
    Dot,
    Question,
    Colon,
    Assign,     // = += -= …; op says which
    Increment,  // ++ --; op Add or Sub
    Operator,   // binary or unary; op says which, `-` being Sub
    If,
    Else,
    For,
    Return,
    Const,
    Inline,
    True,
    False,
    Unsupported,  // a word or sign of related languages that has no meaning here
};

struct Token {
    TokenKind kind = TokenKind::End;
    Operator op = Operator::None;
    std::uint32_t offset = 0, length = 0;
    Name name;               // of Name and Placeholder; text of String without quotes, escapes replaced
    std::uint32_t bits = 0;  // value of Integer and Float
};

struct Comment {
    std::uint32_t begin = 0, end = 0;  // from its first slash to its end
};

struct Tokens {
    std::vector<Token> tokens;  // the last one is End
    std::vector<Comment> comments;
    std::vector<std::uint32_t> errors;  // where
};

// Splits a text of at most 16 MiB. What is no token is reported and left out. Names are at most 255 bytes long.
// Number literals: 1, 1.0, .5, 1e-3, 0x1f (a hexadecimal integer may use all 32 bits), without suffix.
Tokens lex(std::string_view text, bool withPlaceholders, NameTable& names, Reporter& report);

}  // namespace shaderx::sl
