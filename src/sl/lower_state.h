// The state of lowering one function, shared by the files lower_*.cpp alone.
//
// The IR has no variables. Lowering walks the statements in order and keeps the current value of each variable; an `if`
// walks its branches from the same values and selects between what they leave; a loop carries what its body assigns.
// A value that could not be made because of an error is none: whatever depends on it is none too, without a message.
#pragma once

#include <fmt/format.h>

#include "sl/lower.h"

namespace shaderx::sl {

struct Builtin;

// Lowers one function.
struct Lowering {
    struct Variable {
        Name name;
        Type type = Type::Void;
        std::uint32_t offset = 0;
        std::string_view fixedAs;  // what it is if it cannot be assigned: "a constant"; else empty
        int level = 0;             // of the block that declares it
        // Its value now, and a bit for each component that has one. A variable with all bits but no value has an error.
        ExprId value;
        std::uint32_t assigned = 0;
    };
    // Something that can be assigned: a variable, or some of its components.
    struct Place {
        std::uint32_t variable = 0;
        bool isWhole = true;
        int count = 0;   // of components
        int at[4] = {};  // which; columns of a matrix
    };
    // What a variable was before a change.
    struct Change {
        std::uint32_t variable;
        ExprId value;
        std::uint32_t assigned;
    };
    // How far a list of statements has returned: never, always, or where `condition` holds.
    struct Flow {
        enum class Ends : std::uint8_t { Never, Sometimes, Always } ends = Ends::Never;
        ExprId condition;
        std::vector<ExprId> results;
    };
    // A branch that was walked: what it left in the variables it changed, and where it returned.
    struct Branch {
        ExprId condition;  // none for the last
        Flow flow;
        std::vector<Change> left;
    };
    struct Argument {
        NodeId node;
        std::optional<Place> place;
        Variable before;  // of a place: the variable as it was when the argument's turn came
        ExprId value;     // of others
        Type type = Type::Void;
    };

    Lowering(Program& p, std::uint32_t u, ir::Function& f)
        : program(p), unitIndex(u), unit(p.units[u]), tree(unit.tree), report(unit.report), b(p.module, f) {}

    Program& program;
    std::uint32_t unitIndex;
    Unit& unit;
    const Tree& tree;
    Reporter& report;
    ir::Builder b;
    std::vector<Variable> variables;
    std::vector<std::uint32_t> scope;                           // variables that can be seen, innermost last
    std::unordered_map<Name, std::vector<std::uint32_t>> seen;  // the same by name
    std::vector<Change> changes;                                // since the outermost branch began
    int level = 0, branches = 0, loops = 0;
    const FunctionDecl* function = nullptr;  // none for inline texts and constants
    std::vector<std::uint32_t> outputs;      // variables
    std::vector<CallSite>* calls = nullptr;

    // Where a branch began.
    struct Mark {
        std::size_t changes, variables;
    };
    // What a loop's body assigns of what lies outside.
    struct Scan {
        std::vector<Name> inner;  // declared inside, innermost last
        std::unordered_map<Name, int> hidden;
        std::vector<std::uint32_t> found;
    };

    // Names and variables (lower_variables.cpp)
    std::string_view text(Name n) const { return program.module.names->text(n); }
    std::uint32_t declare(Name name, Type type, std::uint32_t offset, std::string_view fixedAs = {});
    std::optional<std::uint32_t> visible(Name name) const;
    void set(std::uint32_t variable, ExprId value, std::uint32_t assigned);
    static std::uint32_t allBits(Type t);
    void assign(const Place& place, ExprId value);
    Type placeType(const Place& place) const;

    // Branches and returns (lower_variables.cpp)
    void enterBlock() { level++; }
    void leaveBlock(std::size_t scopeSize);
    Mark beginBranch();
    std::vector<Change> endBranch(Mark mark);
    Flow merge(std::vector<Branch>& list);
    Flow mergeFlow(ExprId condition, const Flow& then, const Flow& otherwise);
    std::vector<Change> mergeLeft(ExprId condition, const std::vector<Change>& then,
                                  const std::vector<Change>& otherwise);
    Flow join(const std::vector<Flow>& parts);
    std::vector<ExprId> selectAll(ExprId condition, const std::vector<ExprId>& then,
                                  const std::vector<ExprId>& otherwise);
    ExprId select(ExprId condition, ExprId then, ExprId otherwise);
    void hint(ExprId value, Name name);

    // Statements (lower_statements.cpp)
    Flow list(List l);
    Flow statement(const Stmt& s);
    void declaration(const Stmt& s);
    void assignment(const Stmt& s);
    Flow returns(const Stmt& s);
    void addOutputs(std::vector<ExprId>& results, std::uint32_t offset);
    Flow ifStatement(const Stmt& s);
    void loop(const Stmt& s);
    struct LoopHead {
        Name index;
        ExprId start, step, count;  // none where the head is wrong
    };
    LoopHead loopHead(const Stmt& s, const std::vector<std::uint32_t>& carried);
    ExprId loopBound(const Stmt& s, Name index, const std::vector<std::uint32_t>& carried);
    ExprId loopStep(const Stmt& s, Name index);
    std::vector<std::uint32_t> assignedIn(const Stmt& loop);
    void scan(List l, Scan& into);
    void scanExpression(NodeId root, Scan& into);
    void scanTarget(NodeId target, Scan& into);
    void body(const FunctionDecl& decl);

    // Expressions (lower_expressions.cpp)
    ExprId expression(NodeId n);
    ExprId converted(ExprId value, Type to, std::uint32_t offset, std::string_view what);
    ExprId condition(NodeId n) { return asCondition(expression(n), tree[n].offset); }
    ExprId asCondition(ExprId value, std::uint32_t offset);
    ExprId name(const Node& n);
    ExprId placeholder(const Node& n);
    ExprId constant(const Constant& c);
    void unknownName(const Node& n);
    ExprId read(const Place& place, const Variable& v, std::uint32_t offset);
    ExprId component(ExprId value, int i);
    ExprId unary(const Node& n);
    ExprId binary(NodeId n);
    ExprId conditional(const Node& n);
    ExprId member(NodeId n);
    ExprId structMember(const Node& n, ExprId value);
    const ir::StructType* structNamed(Name name) const;
    ExprId makeStruct(const Node& n);
    ExprId index(NodeId n);
    bool componentsOf(const Node& n, Type type, bool tell, Place& place);
    std::optional<Place> placeOf(NodeId n, bool tell);
    bool notAssignable(const Node& n, std::string_view why, bool tell);
    bool writes(NodeId n) const;

    // Operators (lower_operators.cpp)
    ExprId binaryValue(Operator op, ExprId x, ExprId y, std::uint32_t offset);
    ExprId arithmetic(Operator op, ExprId x, ExprId y);
    ExprId componentwise(Op op, Type type, std::span<const ExprId> operands);
    ExprId closureArithmetic(Operator op, ExprId x, ExprId y);
    ExprId matrixProduct(ExprId x, ExprId y);
    ExprId bits(Operator op, ExprId x, ExprId y);
    ExprId comparison(Operator op, ExprId x, ExprId y);
    void doesNotFit(Operator op, Type x, Type y, std::uint32_t offset);

    // Calls (lower_calls.cpp)
    ExprId call(const Node& n, bool isStatement);
    std::vector<Argument> arguments(const Node& n, bool mayWrite);
    ExprId argumentValue(const Argument& a);
    ExprId userCall(const Node& n, const Choice& choice, const std::vector<Argument>& args, bool isStatement);
    void noFunction(const Node& n, const Choice& choice, const std::vector<Argument>& args);
    void forgive(const std::vector<Argument>& args);
    ExprId construct(const Node& n);
    ExprId constructVector(Type type, const std::vector<ExprId>& args);
    ExprId constructMatrix(Type type, const std::vector<ExprId>& args);
    ExprId geometricAttribute(const Node& n);

    // Builtins (builtins.cpp)
    ExprId builtin(const Builtin& f, const std::vector<ExprId>& args);
    ExprId builtinComponentwise(const Builtin& f, const std::vector<ExprId>& args);
    ExprId builtinGeometry(const Builtin& f, const std::vector<ExprId>& args);
    ExprId builtinTexture(const Builtin& f, const std::vector<ExprId>& args);
    ExprId builtinClosure(const Builtin& f, const std::vector<ExprId>& args);
    bool convertAll(std::span<ExprId> values, std::initializer_list<Type> types);
};

enum class Shape : std::uint8_t {
    Numbers,  // componentwise, of integers too
    Floats,   // componentwise
    Mix,
    Dot,
    Cross,
    Length,
    Distance,
    Normalize,
    Directions,  // of vectors of one type; the last of refract is a number
    Matrix,
    Determinant,
    TextureLevel,
    TextureGrad,
    Texture,
    TextureSize,
    Derivative,
    Known,
    Layer,
    Surface,
    SurfaceUnlit,
    Volume,
    Displacement,
};

// A function of the language itself.
struct Builtin {
    std::string_view name;
    int arguments;
    Shape shape;
    ir::Op op;
    std::string_view use;  // how it is called, for messages
};

// Those of a name, up to two with different numbers of arguments.
std::span<const Builtin> builtinsCalled(std::string_view name);
std::vector<std::string_view> builtinNames();

}  // namespace shaderx::sl
