// Functions that implement nodes, found in libraries or made on demand.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "compile/library.h"
#include "doc/color_spaces.h"
#include "graph/lower.h"

namespace shaderx {

struct BodyOptions {
    graph::SceneConventions scene;  // whose texts must outlive what is made
    std::uint32_t maxDepth = 128;   // graphs that implement nodes in graphs that implement nodes
    bool unknownIsDefault = false;  // what reads a node that nothing defines takes its default
};

// Makes the function of a nodedef, named as the nodedef, by the cheapest of its implementations: an inline expression,
// a graph of nodes, a portable function, a closure leaf, or a builder of ours. Functions of precompiled libraries are
// there already. What is made is kept for the next asking.
class NodeBodies final : public graph::Bodies, public ir::FunctionSource {
  public:
    NodeBodies(NameTable& names, const doc::Definitions& definitions, std::vector<Library*> libraries,
               const BodyOptions& options = {});

    Name functionOf(doc::NodeDef def, Diagnostics& diagnostics) override;
    bool takeName(Name name) override { return uniformNames_.insert(name).second; }
    // Before another program.
    void forgetNames() { uniformNames_.clear(); }
    Name instanceOf(doc::NodeDef def, const graph::Instance& instance, bool& decodes,
                    Diagnostics& diagnostics) override;
    Name setOf(doc::NodeDef def, int index, Diagnostics& diagnostics) override;
    graph::ColorConversion toWorkingSpace(Name from, ir::Type type, Diagnostics& diagnostics) override;
    std::string_view nearestColorSpace(std::string_view name) override { return spaces_.nearest(name); }
    doc::ColorSpaces& colorSpaces() { return spaces_; }
    float unitScale(std::string_view type, std::string_view unit) override;
    doc::ElementRef geometricProperty(Name name) override;
    doc::NodeDef nodeFor(std::string_view category, ir::Type type) override;

    const ir::Function* find(Name name) override { return made_.findOwn(name); }
    const ir::LeafInfo* findLeaf(Name name) override;
    const ir::Module& made() const { return made_; }
    // Keeps a function that was made of these, under its name.
    void keep(ir::Function function) { made_.put(std::move(function)); }
    // Whether the function of a node came with a library that was precompiled.
    bool isPrecompiled(Name function) const { return !made_.findOwn(function); }

  private:
    bool fromSource(doc::NodeDef def, const doc::Implementation& implementation, Diagnostics& diagnostics);
    bool fromGraph(doc::NodeDef def, const doc::Implementation& implementation, Name name,
                   const graph::Instance& instance, Diagnostics& diagnostics);
    bool guarded(doc::NodeDef def, Diagnostics& diagnostics, const std::function<bool()>& make);
    bool colorTransform(doc::NodeDef def, doc::ElementRef element, Diagnostics& diagnostics);
    Name conversion(const doc::ColorSpace& from, const doc::ColorSpace& to, ir::Type type, Diagnostics& diagnostics);
    bool inlineText(doc::NodeDef def, doc::ElementRef element, std::string_view text, Diagnostics& diagnostics);
    bool wrap(doc::NodeDef def, doc::ElementRef element, std::string_view function, Diagnostics& diagnostics);
    bool leaf(doc::NodeDef def, std::string_view name);
    bool attribute(doc::NodeDef def);
    bool attributeSet(doc::NodeDef def, Name name, int first, int end);
    ir::Function start(doc::NodeDef def) const;
    Name nameOf(doc::NodeDef def) const;
    const std::vector<sl::Signature>& known();

    NameTable& names_;
    const doc::Definitions& definitions_;
    std::vector<Library*> libraries_;
    BodyOptions options_;
    doc::ColorSpaces spaces_{definitions_};
    std::unordered_map<std::uint64_t, graph::ColorConversion> conversions_;  // by name of the space and type
    ir::Module made_;
    std::vector<sl::Signature> known_;  // of all libraries, once asked for
    std::unordered_set<Name> uniformNames_;
    std::unordered_set<Name> underWay_;  // graphs that use themselves must not go on for ever
};

}  // namespace shaderx
