// What an application needs to know of a generated shader to bind and to edit it.
#pragma once

#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "compile/compile.h"

namespace shaderx {

// Where the description of a shader comes from.
struct ReflectionSource {
    const ir::Module& module;
    const passes::ShaderInterface& interface;
    const doc::Document& document;
    const doc::Definitions& definitions;
    std::span<const graph::Authored> authored;             // as `lower` gives it
    const std::unordered_set<Name>& baked;                 // uniforms that decide topology
    const std::unordered_map<Name, std::string>& spelled;  // names as the texts have them, by those in the module
};

// Fills in everything of the shader but its element, texts, hash and program.
void reflect(const ReflectionSource& from, Shader& shader);

// Whether what a port says is for whoever binds textures and meshes: it has an effect without being in a text.
bool isForHost(std::string_view port);

// A hash of texts, the same in every run and on every machine.
std::uint64_t stableHash(std::string_view text, std::uint64_t seed = 0);

}  // namespace shaderx
