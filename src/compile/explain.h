// What the check of a document has to say of what an element is made of.
#pragma once

#include <optional>
#include <unordered_set>
#include <vector>

#include "doc/check.h"
#include "graph/graph.h"

namespace shaderx {

// The mistakes of one document, found when they are first asked for.
class Explainer {
  public:
    Explainer(const doc::Document& document, const doc::Definitions& definitions, const doc::CheckOptions& options)
        : d_(document), definitions_(definitions), options_(options) {}

    // Whether there may be something to say: a node is not as it ought to be, or the document defines it itself.
    bool isNeeded(const graph::Graph& graph) const;
    // Adds what concerns the nodes and ports upstream, and the document's own definitions of these. True without
    // errors.
    bool explain(const graph::Graph& graph, Diagnostics& diagnostics);

  private:
    void mark(const graph::Graph& graph);
    void mark(doc::NodeDef def);
    bool concerns(doc::ElementId element) const;

    const doc::Document& d_;
    const doc::Definitions& definitions_;
    doc::CheckOptions options_;
    std::optional<std::vector<doc::Finding>> found_;
    std::unordered_set<doc::ElementId> upstream_;  // of one explanation
    std::vector<doc::NodeDef> waiting_{};          // definitions of the document that are yet to be marked
};

}  // namespace shaderx
