#include "graph/texture_hints.h"

namespace shaderx::graph {

namespace {

// The node of a graph that is given one of the graph's files, and as which of its inputs; none where none is.
struct Reader {
    doc::ElementId node;
    Name input;
};

Reader readerOf(const doc::Document& d, doc::ElementId graph, Name file) {
    const doc::WellKnown& k = d.known();
    for (doc::ElementId node : doc::children(d, graph))
        for (doc::ElementId port : doc::children(d, node))
            if (d[port].category == k.input && d.attribute(port, k.interfacename) == file) return {node, d[port].name};
    return {};
}

}  // namespace

std::string_view addressMode(std::string_view word) {
    if (word == "repeat") return "periodic";
    return word == "useMetadata" ? "black" : word;
}

TextureReader::TextureReader(const doc::Definitions& definitions, doc::NodeDef def, Name file) {
    constexpr int kDeepest = 16;  // graphs that use themselves are reported elsewhere
    for (int depth = 0; def && depth < kDeepest; depth++) {
        const doc::Implementation how = definitions.implementation(def);
        if (how.kind != doc::Implementation::Kind::Graph) break;
        const Reader reader = readerOf(*how.graph.document, how.graph.id, file);
        if (!reader.node) break;
        within_.push_back({how.graph.document, reader.node});
        file = reader.input;
        def = definitions.match(*how.graph.document, reader.node).def;
    }
}

HintSource TextureReader::source(Name wanted) const {
    // Outwards again, as long as each graph hands on an input of its own.
    Name input = wanted;
    for (std::size_t i = within_.size(); i-- > 0;) {
        const doc::Document& d = *within_[i].document;
        const doc::ElementId port = d.child(within_[i].id, d.known().input, input);
        if (!port) return {};
        const Name outer = d.attribute(port, d.known().interfacename);
        if (!outer) return {{}, {&d, port}};
        input = outer;
    }
    return {input, {}};
}

}  // namespace shaderx::graph
