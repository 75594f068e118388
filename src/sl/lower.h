// Syntax trees to IR: names, types and the data flow of variables, statement by statement.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "ir/builder.h"
#include "sl/ast.h"
#include "sl/functions.h"
#include "sl/report.h"

namespace shaderx::sl {

using ir::ExprId;
using ir::Op;

// One source text.
struct Unit {
    Tree tree;
    Reporter report;
};

// A constant outside of functions and its value as bits, or as a name for strings.
struct Constant {
    Name name;
    Type type = Type::Void;
    std::uint32_t unit = 0;
    std::uint32_t declaration = 0;  // in Tree::constants
    bool isKnown = false;           // false before it is folded, and where that failed
    std::vector<std::uint32_t> words;
    Name text;
};

// What all functions under compilation share.
struct Program {
    ir::Module& module;
    const FunctionTable& functions;
    std::deque<Unit>& units;
    std::vector<Constant> constants;
    std::unordered_map<Name, std::vector<std::uint32_t>> constantsByName;
    bool isIncomplete = false;  // some declaration could not be read: that a name is unknown proves nothing

    // The unit's own constant of a name, else another's; several others of one name are all returned.
    std::vector<std::uint32_t> constantsCalled(std::uint32_t unit, Name name) const;
};

// A call of a function under compilation.
struct CallSite {
    std::uint32_t callee = 0;  // in the list of functions
    std::uint32_t offset = 0;
};

// Lowers a function's body into `out`, whose name and parameters are set. Errors go to the unit's reporter.
void lowerFunction(Program& program, std::uint32_t unit, const FunctionDecl& decl, ir::Function& out,
                   std::vector<CallSite>& calls);

// Lowers the expressions of an inline text as the results, whose types and names are given.
void lowerInline(Program& program, std::uint32_t unit, std::span<const ir::Param> results, ir::Function& out);

// Folds a constant into its words; those that it needs have been folded before.
void foldConstant(Program& program, Constant& constant);

// Names that an expression reads, calls excluded.
void namesRead(const Tree& tree, NodeId root, std::vector<Name>& names);

}  // namespace shaderx::sl
