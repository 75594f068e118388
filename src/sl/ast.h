// The syntax tree of one source text, shared by the dialects of the shading language.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/handle.h"
#include "base/names.h"
#include "ir/types.h"

namespace shaderx::sl {

using ir::Type;
using NodeId = Handle<struct NodeTag>;
using StmtId = Handle<struct StmtTag>;

enum class Operator : std::uint8_t {
    None,
    Add,
    Sub,
    Mul,
    Div,
    Rem,
    BitAnd,
    BitOr,
    BitXor,
    ShiftLeft,
    ShiftRight,
    ShiftRightLogical,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
    Equal,
    NotEqual,
    And,
    Or,
    Neg,
    Plus,
    Not,
    BitNot,
};

enum class NodeKind : std::uint8_t {
    Integer,      // bits
    Float,        // bits
    Boolean,      // bits
    String,       // name
    Name,         // name: a variable, constant or context value
    Placeholder,  // name: a parameter, whatever its name
    Unary,        // op; one child
    Binary,       // op; two children
    Conditional,  // condition, then, else
    Call,         // name; type where it names a type and makes a value; the arguments
    Member,       // name: components; one child
    Index,        // value, index
};

// A run of Tree::children or Tree::statementLists.
struct List {
    std::uint32_t first = 0, count = 0;
};

struct Node {
    NodeKind kind;
    Operator op = Operator::None;
    std::uint16_t height = 1;  // levels that a walk recurses, the left spine of binary operators being one
    Type type = Type::Void;
    std::uint32_t offset = 0;  // in the text: of the operator where there is one
    Name name = {};
    std::uint32_t bits = 0;
    List children = {};
};

enum class StmtKind : std::uint8_t {
    Declare,  // type name = value, or no value
    Assign,   // target op= value; op None for plain assignment
    Call,     // value, for its outputs
    If,       // arms
    For,      // init (Declare), value: the condition, step (Assign), body
    Return,   // value, none in void functions
    Block,    // body
};

// `if (condition) body`, or the last `else body` where the condition is none.
struct Arm {
    NodeId condition;
    List body;
};

struct Stmt {
    StmtKind kind;
    Operator op = Operator::None;
    bool isConst = false;
    Type type = Type::Void;
    std::uint32_t offset = 0;
    Name name = {};
    NodeId target = {}, value = {};
    StmtId init = {}, step = {};
    List body = {};  // of For, Block; for If: a run of Tree::arms
};

struct ParamDecl {
    Type type = Type::Void;
    Name name;
    std::uint32_t offset = 0;
};

struct FunctionDecl {
    Name name;
    Type result = Type::Void;
    std::vector<ParamDecl> params, outputs;
    List body;
    std::uint32_t offset = 0;  // of the name
    bool isInline = false;
    bool isBroken = false;  // the body had syntax errors: its signature serves others, but it cannot be lowered
    std::string comment;
};

struct ConstDecl {
    Name name;
    Type type = Type::Void;
    NodeId value;
    std::uint32_t offset = 0;
};

struct Tree {
    std::vector<Node> nodes;
    std::vector<NodeId> children;
    std::vector<Stmt> statements;
    std::vector<StmtId> statementLists;
    std::vector<Arm> arms;
    std::vector<FunctionDecl> functions;
    std::vector<ConstDecl> constants;
    std::vector<NodeId> expressions;  // of an inline text
    bool isIncomplete = false;        // a declaration could not be read: names may be missing

    const Node& operator[](NodeId n) const { return nodes[n.index]; }
    const Stmt& operator[](StmtId s) const { return statements[s.index]; }
    NodeId child(const Node& n, std::uint32_t k) const { return children[n.children.first + k]; }
};

}  // namespace shaderx::sl
