// The parts of the printer. Dumb on purpose: what to compute where, `place` has decided.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "ir/module.h"
#include "passes/stages.h"
#include "targets/text/namer.h"
#include "targets/text/writer.h"

namespace shaderx::glsl {

// One stage's text.
struct Stage {
    const ir::Module& module;
    const passes::ShaderInterface& interface;
    bool isPixel;
    text::Namer namer;
    text::Writer out{};
    std::unordered_map<Name, std::string> globals{};           // uniforms and functions by their names in the module
    std::unordered_map<Name, std::string> inputs{};            // of the vertex stage, by the names in the interface
    std::unordered_map<Name, std::string> members{};           // of the block VertexData, by the names of the varyings
    std::string output{};                                      // of the pixel stage
    std::vector<std::pair<std::size_t, std::size_t>> apart{};  // see Sources
};

// The text of constants: 0.5, vec3(0.8), mat3(…).
void writeConstant(std::string& to, ir::Type type, const std::uint32_t* words);

// Prints one function of a stage.
class FunctionPrinter {
  public:
    FunctionPrinter(Stage& stage, const ir::Function& function, bool isEntry);
    void print();

  private:
    void entryResults();
    void functionResults();
    std::string signature();

    void block(ir::BlockId block);
    void let(const ir::Stmt& s);
    void letTuple(const ir::Stmt& s);
    std::string* outFor(ir::ExprId e);
    void branch(const ir::Stmt& s);
    void loop(const ir::Stmt& s);
    void nextValues(ir::ExprId loop, std::size_t carried, std::size_t firstNext, const std::vector<std::string>& names);
    void assign(const std::string& target, ir::ExprId value, ir::ExprId self);
    bool readsInline(ir::ExprId value, std::uint32_t payload) const;
    void nameLoopValues(ir::ExprId loop, std::size_t carried, std::vector<std::string>& names, std::string& index);

    // Appends an expression; parenthesised where it binds less tightly than `precedence`.
    void write(std::string& to, ir::ExprId e, int precedence = 0);
    std::string textOf(ir::ExprId e, int precedence = 0);
    void writeOperation(std::string& to, ir::ExprId e, int precedence);
    void writeCall(std::string& to, std::string_view function, std::span<const ir::ExprId> arguments);
    void writeLeaf(std::string& to, ir::ExprId e);
    void writeMake(std::string& to, ir::ExprId e);
    void writeSwizzle(std::string& to, ir::ExprId e);
    void writeTexture(std::string& to, ir::ExprId e);
    std::string variableFor(ir::ExprId e);  // a fresh local name after the value's hint or kind

    Stage& stage_;
    const ir::Function& f_;
    bool isEntry_, atEntryLevel_ = false;
    std::vector<std::string> names_;                                           // by expression, of those that have one
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> resultsOf_;  // by call or loop
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> argumentsOf_;  // by loop number
    std::vector<std::string> params_;
    std::vector<int> uses_;          // by expression, as an operand
    std::vector<Name> asked_;        // by expression: the parameter that it is given to
    std::vector<std::string> outs_;  // of results after the first
};

}  // namespace shaderx::glsl
