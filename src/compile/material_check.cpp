#include "compile/material_check.h"

#include <string_view>

#include <fmt/format.h>

namespace shaderx {

static void warn(const doc::Document& document, doc::ElementId at, std::string_view code, std::string message,
                 Diagnostics& diagnostics) {
    Diagnostic& w = diagnostics.warning(code, std::move(message));
    w.where = document.locate(at);
    w.path = document.path(at);
}

static bool hasNoShader(const graph::Graph& graph, const graph::Node& material) {
    bool hasPorts = false;
    for (const graph::Input& input : graph.inputsOf(material)) {
        if (!ir::isShader(input.type)) continue;
        hasPorts = true;
        if (input.source.kind == graph::Source::Kind::Node) return false;
    }
    return hasPorts;  // else it makes its own, of closures or values
}

// Whether a shader is to come through a port of the graph that the material is in.
static bool isOpen(const doc::Document& document, const graph::Node& material, Diagnostics& diagnostics) {
    for (doc::ElementId port : doc::children(document, material.element)) {
        if (!document.attribute(port, document.known().interfacename)) continue;
        warn(document, port, "no-shader",
             "nothing is connected to the port that the shader comes through: the material is black", diagnostics);
        return true;
    }
    return false;
}

// What a material reads and a raster's pixel does not show.
static void warnOfLost(const doc::Document& document, const graph::Graph& graph, const graph::Node& material,
                       Diagnostics& diagnostics) {
    const Name back = document.names().find("backsurfaceshader");
    for (const graph::Input& input : graph.inputsOf(material)) {
        if (input.source.kind != graph::Source::Kind::Node) continue;
        std::string_view what;
        if (input.type == ir::Type::DisplacementShader) what = "the displacement";
        if (input.type == ir::Type::VolumeShader) what = "the volume";
        if (input.port->name == back) what = "the surface of the back";
        if (what.empty()) continue;
        const doc::ElementId port = document.child(material.element, input.port->name);
        warn(document, port ? port : material.element, "ignored-shader", fmt::format("{} is not drawn yet", what),
             diagnostics);
    }
}

bool checkMaterial(const doc::Document& document, const graph::Graph& graph, Diagnostics& diagnostics) {
    const graph::Output& output = graph.outputs[0];
    if (output.type != ir::Type::Material || output.source.kind != graph::Source::Kind::Node) return true;
    const graph::Node& material = graph.nodes[output.source.node.index];
    if (hasNoShader(graph, material) && !isOpen(document, material, diagnostics)) return false;
    warnOfLost(document, graph, material, diagnostics);
    return true;
}

}  // namespace shaderx
