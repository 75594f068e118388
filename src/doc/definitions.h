// Node definitions and implementations of a list of documents.
#pragma once

#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

#include "doc/document.h"

namespace shaderx::doc {

// An input or output of a nodedef.
struct Port {
    static constexpr std::uint32_t kOwnLayer = 0xffffffffu;

    Name name, type;
    ElementId element;
    std::uint32_t layer = kOwnLayer;  // whose document `element` is of, if it is not that of the nodedef
};

struct NodeDefRow {
    enum : std::uint32_t {
        DefaultVersion = 1,
        OpenInherit = 2,     // what it inherits is in another document
        InheritsItself = 4,  // at once, or by way of others: what it inherits is left out
        TooManyPorts = 8,    // more than kMostPorts, or too many in all: they are left out
        HasTokens = 16,      // parts of file names that its nodes may replace
    };
    static constexpr std::size_t kMostPorts = 4096;

    Name category;  // of its nodes, with the namespace: "mix", "studio:rust"
    Name name;      // with the namespace
    Name output;    // type of its one output, or multioutput
    Name version, target, inherit;
    ElementId element;
    std::uint32_t firstPort = 0, inputCount = 0, outputCount = 0;  // inherited ones included; the inputs come first
    std::uint32_t flags = 0;
};

struct ImplementationRow {
    enum Kind : std::uint32_t {
        Graph,         // <nodegraph nodedef="…">
        LinkedGraph,   // <implementation nodedef="…" nodegraph="…">
        Source,        // <implementation nodedef="…" file="…" | sourcecode="…">
        CategoryWide,  // <implementation node="add" …>: for every nodedef of that category
    };

    Name key;     // the nodedef's name, or the category
    Name target;  // or the language that its text is in, where it names no target
    ElementId element;
    std::uint32_t kind = Graph;
};

struct NameRow {
    Name name;
    std::uint32_t row;
};

// What a document defines, as sorted arrays of plain data: built once, it can be stored beside the document's own
// arrays and be read in place. Sorting is by name handle, then by document order.
struct DefinitionsIndex {
    std::span<const NodeDefRow> nodedefs;                // by category
    std::span<const NameRow> names;                      // of the nodedefs, by name
    std::span<const Port> ports;                         // of NodeDefRow::firstPort
    std::span<const ImplementationRow> implementations;  // by key
    std::span<const ElementId> declarations;  // geometric properties, units, types, colour spaces, by category
};

struct DefinitionsTables {
    std::vector<NodeDefRow> nodedefs;
    std::vector<NameRow> names;
    std::vector<Port> ports;
    std::vector<ImplementationRow> implementations;
    std::vector<ElementId> declarations;
    DefinitionsIndex index() const { return {nodedefs, names, ports, implementations, declarations}; }
};
DefinitionsTables buildIndex(const Document& document);

// A <typedef> with members: a value made of others.
struct StructDef {
    struct Member {
        Name name, type;
        Name value;  // its default, may be none
    };
    Name name;
    std::vector<Member> members;
};

// A nodedef of a Definitions. A default-made one is none.
struct NodeDef {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t layer = kNone, row = kNone;
    explicit operator bool() const { return row != kNone; }
    friend bool operator==(NodeDef, NodeDef) = default;
};

struct GivenInput {
    Name name, type;
    friend bool operator==(const GivenInput&, const GivenInput&) = default;
};

// What is asked for: a node as written.
struct Query {
    Name category;
    Name type;                           // of the output, multioutput, or none for any
    std::span<const GivenInput> inputs;  // those that the node gives; a none type fits any
    Name version;                        // none asks for the default version
    Name target;                         // none for any
    Name nodedef;                        // asks for that one by name
    Name space;                          // the namespace of the node, tried first for category and nodedef
};

struct Match {
    NodeDef def;
    bool exact = false;  // every given input is one of the nodedef's, with its type
    explicit operator bool() const { return static_cast<bool>(def); }
};

struct Implementation {
    enum class Kind : std::uint8_t { None, Graph, Source };
    Kind kind = Kind::None;
    ElementRef element;  // the <implementation>, or the <nodegraph nodedef=…> itself
    ElementRef graph;    // of Kind::Graph: the nodegraph
    Name target;         // the target or language it serves, none if it is portable
    explicit operator bool() const { return kind != Kind::None; }
};

// Definitions of several documents, searched in the order in which they were added: first the user's document, then the
// user's libraries, then the built-in one. It is a snapshot: after edits of nodedefs, make a new one. The documents
// must outlive it and share one name table.
class Definitions {
  public:
    void add(const Document& document);                          // builds the index
    void add(const Document& document, DefinitionsIndex index);  // uses a stored one, which must outlive this

    // The nodedef that fits: the first whose signature fits exactly, else the first of that category, output type,
    // version and target, not exact; else none.
    Match match(const Query& query) const;
    // The same for a node element as it is written, its attribute `nodedef` included.
    Match match(const Document& document, ElementId node, Name target = {}) const;
    // A nodedef by name; `space` is tried first.
    NodeDef byName(Name name, Name space = {}) const;
    bool hasCategory(Name category, Name space = {}) const;
    // All of a category, in order.
    std::vector<NodeDef> ofCategory(Name category, Name space = {}) const;
    // Whether a document declares the type by a <typedef>, and all that are declared.
    bool hasType(Name name) const;
    std::vector<std::string_view> types() const;
    // All categories, each once.
    std::vector<Name> categories() const;

    // A name of their table. There must be a document.
    std::string_view text(Name name) const { return layers_[0].document->text(name); }
    const NodeDefRow& row(NodeDef def) const { return layers_[def.layer].index.nodedefs[def.row]; }
    ElementRef element(NodeDef def) const { return {layers_[def.layer].document, row(def).element}; }
    // The whole interface: inherited ports in the order of the base, each replaced by the def's own of that name, then
    // the def's further ones.
    std::span<const Port> inputs(NodeDef def) const;
    std::span<const Port> outputs(NodeDef def) const;
    ElementRef element(NodeDef def, const Port& port) const;
    const Port* input(NodeDef def, Name name) const;
    const Port* output(NodeDef def, Name name) const;

    // All structures of all documents, each name once, those before it that a member is of; one that holds itself, or
    // something that is no value, is none. Nothing is searched where no document has any.
    const std::vector<StructDef>& structs() const;
    // What the documents declare beside nodes: their geompropdef, unitdef, typedef or colorspacedef elements, document
    // by document in the order of the layers.
    std::vector<ElementRef> declared(std::string_view category) const;
    // What implements a nodedef: in each document in turn, one for the first of the targets that has one, else a
    // portable one; those of the nodedef go before category-wide ones; then what the inherited nodedef has.
    Implementation implementation(NodeDef def, std::span<const Name> targets = {}) const;
    // All that implement it, or its base, whatever they are for.
    std::vector<ElementRef> implementations(NodeDef def) const;
    // The nodedef that a nodegraph implements (by its own attribute or by an <implementation>), none if it is none's.
    NodeDef implementedBy(const Document& document, ElementId graph) const;

  private:
    struct Layer {
        const Document* document;
        DefinitionsIndex index;
        std::unique_ptr<DefinitionsTables> own;
    };
    struct Flat {
        std::vector<Port> ports;
        std::uint32_t inputCount = 0;
    };
    std::span<const NodeDefRow> range(const Layer& layer, Name category) const;
    const Flat* flatten(NodeDef def) const;
    NodeDef base(NodeDef def) const;
    Implementation inLayer(const Layer& layer, Name key, bool categoryWide, std::span<const Name> targets) const;

    void collectStructs() const;

    std::vector<Layer> layers_;
    mutable std::vector<StructDef> structs_;
    mutable bool hasStructs_ = false;                       // collected
    mutable std::unordered_map<std::uint64_t, Flat> flat_;  // of nodedefs that inherit across documents
};

}  // namespace shaderx::doc
