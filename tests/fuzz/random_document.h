// Random valid documents over all nodes of a library.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "passes/dice.h"

namespace shaderx::fuzz {

// An input or output of a node's declaration, and where its random values come from.
struct Port {
    std::string name, type, value;
    std::vector<std::string> choices;    // of an enumeration
    std::vector<float> lowest, highest;  // of its range, by component; empty where none is declared
    std::string unittype;
    bool isUniform = false;  // takes no connection to a node
};

// A node as its declaration has it.
struct Signature {
    std::string category, nodedef, version;  // the version only where a node must ask for it
    std::vector<Port> inputs, outputs;
    bool isShading = false;  // its parameters are shares and colours
};

// The nodes of a library that something implements, found by walking its declarations.
class NodeTable {
  public:
    explicit NodeTable(std::span<const std::uint8_t> libraryImage);

    // Those that have an output of the type, by category.
    using Categories = std::map<std::string, std::vector<const Signature*>>;
    const std::map<std::string, Categories>& byType() const { return byType_; }
    const std::vector<std::string>& colorspaces() const { return colorspaces_; }
    std::size_t size() const { return signatures_.size(); }

  private:
    std::vector<Signature> signatures_;
    std::map<std::string, Categories> byType_;
    std::vector<std::string> colorspaces_;
};

// A document as MaterialX text: every choice is one of the dice's. Pictures are named as in `pictures`.
std::string randomDocument(const NodeTable& nodes, passes::Dice dice, std::span<const std::string> pictures);

}  // namespace shaderx::fuzz
