// What a pixel's program costs, by the nodes of the document that ask for it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ir/module.h"

namespace shaderx::passes {

struct Work {
    std::uint32_t instructions = 0;      // operations of the IR, those of called functions at each call
    std::uint32_t environmentReads = 0;  // look-ups in the environment's maps
    std::uint32_t textureReads = 0;      // of textures of the document
    Work& operator+=(const Work& other);
};

// A loop over the samples of the environment is counted once in `perSample`; any other loop as often as it turns, where
// that is known, else once.
struct NodeCost {
    std::string node;  // by its path, and the closure in it; empty for what belongs to none
    Work fixed, perSample;
};

// The costs of the module's function `entry`, whose origins must be told, in the order in which nodes first occur.
std::vector<NodeCost> costsByNode(const ir::Module& module, Name entry);

}  // namespace shaderx::passes
