// Programs: functions as arenas of pure expressions, and what they share.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/handle.h"
#include "base/names.h"
#include "ir/ops.h"

namespace shaderx::ir {

using ExprId = Handle<struct ExprTag>;
using BlockId = Handle<struct BlockTag>;

// One operation. Operands are Function::operands[firstOperand … + operandCount).
struct Expr {
    Op op;
    std::uint8_t reserved = 0;
    std::uint16_t operandCount = 0;
    Type type = Type::Void;
    std::uint16_t reserved2 = 0;
    std::uint32_t firstOperand = 0;
    std::uint32_t payload = 0;
};
static_assert(sizeof(Expr) == 16);

struct Param {
    Name name;
    Type type;
};
struct ResultValue {
    Name name;
    Type type;
    ExprId value;
};

// What `place` makes: the order in which a program computes. Only expressions named by a `Let` are computed at a
// statement; all others are computed where they are used.
enum class StmtKind : std::uint8_t {
    Let,   // computes `expr` here and gives it a name
    If,    // decides the selects phis[firstPhi … + phiCount) by `expr`: then-block `body`, else-block `orElse`
    Loop,  // runs the loop `expr` (Loop or Lights), its turns being `body`
};
struct Stmt {
    StmtKind kind;
    ExprId expr;
    BlockId body, orElse;
    std::uint32_t firstPhi = 0, phiCount = 0;
};
struct Body {
    std::vector<std::vector<Stmt>> blocks;  // blocks[0] is the function's own
    std::vector<ExprId> phis;
};

struct Function {
    Name name;
    std::vector<Param> params;
    std::vector<ResultValue> results;
    std::vector<Expr> exprs;  // operands before users
    std::vector<ExprId> operands;
    std::vector<std::uint32_t> words;  // bits of constants
    std::vector<Name> hints;           // by expression: what to call the value, may be none
    Body body;                         // empty before `place`
    // Which node of the document expressions come from: a name for all from an expression on. Empty unless asked for.
    std::vector<std::pair<std::uint32_t, Name>> origins;
    std::uint32_t loops = 0;  // loop numbers in use
    bool isInline = false;    // expand wherever called
    bool isApart = false;     // of a library: never expanded, which was asked when the library was made
    std::string comment;      // one or more sentences about what it does, may be empty

    const Expr& operator[](ExprId e) const { return exprs[e.index]; }
    std::span<const ExprId> operandsOf(ExprId e) const { return operandsOf(exprs[e.index]); }
    std::span<const ExprId> operandsOf(const Expr& e) const {
        return {operands.data() + e.firstOperand, e.operandCount};
    }
    ExprId operand(ExprId e, std::size_t k) const { return operands[exprs[e.index].firstOperand + k]; }
    // What is made from now on comes from there.
    void beginOrigin(Name origin) {
        if (origins.empty() || origins.back().second != origin)
            origins.emplace_back(static_cast<std::uint32_t>(exprs.size()), origin);
    }
    Name originOf(ExprId e) const;
    bool isConstant(ExprId e) const { return exprs[e.index].op == Op::Constant; }
    // Bits of a constant that has components.
    std::span<const std::uint32_t> constantWords(ExprId e) const {
        return {words.data() + exprs[e.index].payload, static_cast<std::size_t>(componentCount(exprs[e.index].type))};
    }
};

// A value that the host may set. `values` are its bits, none for textures.
struct Uniform {
    Name name;
    Type type = Type::Float;
    std::vector<std::uint32_t> values;
    std::string path;  // of the input in the document: "SR_gold/specular_roughness"
    // Of textures: the file as the document says it, prefix included, and how it is read.
    std::string file, uAddress = "periodic", vAddress = "periodic", filter = "linear";
    std::vector<float> defaultColor;
    std::string colorspace;
};

// The inputs of a closure leaf's node, in the order of its operands.
struct LeafInfo {
    Name name;
    std::vector<Param> params;
};

// What a geometric attribute is on a mesh that lacks it.
struct AttributeDefault {
    Name attribute;
    Type type;
    std::vector<std::uint32_t> words;  // its bits
};

struct StructType {
    Name name;
    std::vector<Param> members;
};

// A body in a target's own language. Its identifiers are reserved in the namer.
struct ExternText {
    Name target, node;
    std::string text;
};

// Where a module finds a function that it does not have yet: a library's, decoded when first asked for.
class FunctionSource {
  public:
    virtual ~FunctionSource() = default;
    // Null where there is none. What it returns lives as long as the source.
    virtual const Function* find(Name name) = 0;
    virtual const LeafInfo* findLeaf(Name) { return nullptr; }
};

// A program under way. Functions refer to each other, to uniforms and leaves by Name.
class Module {
  public:
    explicit Module(NameTable& nameTable) : names(&nameTable) {}

    // A new function that this module owns; its name must be new here.
    Function& add(Name name);
    // Takes a function over, in place of one with its name.
    Function& put(Function function);
    // Own functions first, then the sources in order; null where there is none.
    const Function* find(Name name) const;
    Function* findOwn(Name name) const;
    // Drops all own functions but these, and puts these in this order.
    void keepOnly(std::span<const Name> kept);
    Uniform* uniform(Name name);
    const Uniform* uniform(Name name) const { return const_cast<Module*>(this)->uniform(name); }
    const LeafInfo* leaf(Name name) const;

    NameTable* names;
    std::vector<std::unique_ptr<Function>> functions;  // in the order in which they were added
    std::vector<Uniform> uniforms;
    std::vector<LeafInfo> leaves;
    std::vector<AttributeDefault> attributeDefaults;  // the first of an attribute counts
    std::vector<StructType> structs;
    std::vector<ExternText> externs;
    std::vector<FunctionSource*> sources;

  private:
    std::unordered_map<Name, Function*> byName_;
    std::unordered_map<Name, std::size_t> uniformByName_;  // of the first uniforms, as many as it knows
    std::size_t uniformsKnown_ = 0;
};

}  // namespace shaderx::ir
