#include "compile/explain.h"

#include <algorithm>

namespace shaderx {

using doc::ElementId;

bool Explainer::isNeeded(const graph::Graph& graph) const {
    auto isOwn = [&](const graph::NodeKind& kind) { return definitions_.element(kind.def).document == &d_; };
    return !graph.isExact || std::any_of(graph.kinds.begin(), graph.kinds.end(), isOwn);
}

void Explainer::mark(const graph::Graph& graph) {
    for (ElementId e : graph.visited)
        for (; e && e != d_.root(); e = d_[e].parent) upstream_.insert(e);
    for (const graph::NodeKind& kind : graph.kinds)
        if (definitions_.element(kind.def).document == &d_) waiting_.push_back(kind.def);
}

// A definition of the document's own: what declares it, what that inherits, and what implements it.
void Explainer::mark(doc::NodeDef def) {
    doc::NodeDef at = def;
    while (at && definitions_.element(at).document == &d_) {
        const ElementId element = definitions_.element(at).id;
        if (!upstream_.insert(element).second) return;
        at = definitions_.byName(definitions_.row(at).inherit, d_.namespaceOf(element));
    }
    const doc::Implementation how = definitions_.implementation(def);
    if (how && how.element.document == &d_) upstream_.insert(how.element.id);
    if (!how.graph || how.graph.document != &d_) return;
    graph::Graph inside;
    Diagnostics ignored;
    graph::build(d_, how.graph.id, definitions_, inside, ignored);
    upstream_.insert(how.graph.id);
    mark(inside);
}

// An element is upstream, or it is a part of a node or nodedef that is. What else stands in a nodegraph is not.
bool Explainer::concerns(ElementId element) const {
    const doc::WellKnown& k = d_.known();
    for (ElementId e = element; e && e != d_.root(); e = d_[e].parent) {
        if (e != element && d_[e].category == k.nodegraph) return false;
        if (upstream_.count(e)) return true;
    }
    return false;
}

bool Explainer::explain(const graph::Graph& graph, Diagnostics& diagnostics) {
    if (!found_) found_ = doc::findMistakes(d_, definitions_, options_);
    upstream_.clear();
    mark(graph);
    while (!waiting_.empty()) {  // definitions use definitions as deep as a document likes
        const doc::NodeDef def = waiting_.back();
        waiting_.pop_back();
        mark(def);
    }
    const std::size_t errors = diagnostics.errorCount();
    for (const doc::Finding& f : *found_)
        if (!f.diagnostic.code.starts_with("unused-") && (concerns(f.element) || concerns(f.other)))
            diagnostics.add(f.diagnostic);
    return diagnostics.errorCount() == errors;
}

}  // namespace shaderx
