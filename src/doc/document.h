// A MaterialX document: elements in one flat vector, linked by indices, all text interned.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/handle.h"
#include "base/names.h"

namespace shaderx::doc {

using ElementId = Handle<struct ElementTag>;

// Elements and attributes are plain data, so that a precompiled library is these arrays, read in place.
struct Attribute {
    Name name, value;
};

// Comments, texts and the like are elements too, of a category that starts with '#' ("#comment", "#text", "#cdata",
// "#pi", "#doctype"), with their content in the attribute "text".
struct Element {
    static constexpr std::uint32_t kNoSource = 0xffffffffu;

    Name category, name;  // of <add name="a">: "add" and "a"; no name where the attribute is absent
    ElementId parent, firstChild, next;
    std::uint32_t firstAttribute = 0, attributeCount = 0;  // in document order, the name included
    std::uint32_t source = kNoSource, offset = 0;          // index of the source and byte offset of the '<' in it
};

// A file that elements came from. Its text is kept to find lines and columns again.
struct Source {
    std::string file;       // as messages name it
    std::string text;       // UTF-8, without byte order mark
    std::string directory;  // what its includes are relative to
    Name version;           // of its root element, may be none
};

// The names that this room compares with, interned once so that hot paths compare handles.
struct WellKnown {
    explicit WellKnown(NameTable& names);

    // Categories that the format itself uses, which no node can have.
    bool isFormat(Name category) const {
        return (formatBits >> (category.index & 63) & 1) != 0 &&
               std::find(format.begin(), format.end(), category) != format.end();
    }

    Name name, type, value, nodename, nodegraph, output, interfacename, nodedef, node, input, parameter, token;
    Name implementation, version, isdefaultversion, target, inherit, colorspace, fileprefix, namespaceName, file;
    Name function, sourcecode, channels, text, material, look, lookgroup, materialassign, collection, multioutput;
    Name materialx, include, comment, textNode, cdata, pi, doctype, trueValue, out, defaultgeomprop, surfaceshader;
    Name empty, enumName, language, filename, string, typedefName;
    Name geomprop, varname, defaultName, fallback, texcoord, geomcolor;

  private:
    std::array<Name, 37> format;
    std::uint64_t formatBits = 0;  // which handles modulo 64 occur in it: most others are told apart by these alone
};

// Owns its elements while it is edited, or views a library's arrays read only. Lookups fill an index on the way, so a
// document belongs to one thread. Ids stay valid for the document's life; those of removed elements have no category.
class Document {
  public:
    // An empty document: a root <materialx version="1.39">.
    explicit Document(NameTable& names) : Document(names, WellKnown(names)) {}
    // The same for a table whose well-known names are at hand.
    Document(NameTable& names, const WellKnown& known);
    // A read-only view of arrays that outlive it; element 0 is the root. Names refer to `names`.
    Document(NameTable& names, std::span<const Element> elements, std::span<const Attribute> attributes);
    Document(const Document&) = delete;
    Document& operator=(const Document&) = delete;

    NameTable& names() const { return names_; }
    const WellKnown& known() const { return known_; }
    std::string_view text(Name name) const { return names_.text(name); }

    ElementId root() const { return ElementId(0); }
    // The first of the comments and the like that stand before the root, linked by `next`; those after the root follow
    // it by its own `next`.
    ElementId prologue() const { return prologue_; }
    const Element& operator[](ElementId id) const { return elements_[id.index]; }
    std::size_t size() const { return elements_.size(); }
    // True for the elements of this document. All that takes an element wants one of these; only editing asks.
    bool has(ElementId id) const { return id.index < elements_.size() && elements_[id.index].category; }
    std::span<const Element> elements() const { return elements_; }
    std::span<const Attribute> allAttributes() const { return attributes_; }
    std::span<const Attribute> attributes(ElementId id) const {
        return attributes_.subspan(elements_[id.index].firstAttribute, elements_[id.index].attributeCount);
    }

    // The value of an attribute, none where absent.
    Name attribute(ElementId id, Name attr) const {
        for (const Attribute& a : attributes(id))
            if (a.name == attr) return a.value;
        return {};
    }
    std::string_view attributeText(ElementId id, Name attr) const { return names_.text(attribute(id, attr)); }
    // The attribute of the element or of its nearest ancestor that has it: fileprefix, colorspace, namespace.
    Name inherited(ElementId id, Name attr) const;
    // The namespace that the element stands in, none outside of any.
    Name namespaceOf(ElementId id) const { return hasNamespaces_ ? inherited(id, known_.namespaceName) : Name(); }
    // "space:name", or the name itself where there is no space or the name has it already.
    Name qualified(Name space, Name name) const;

    // The first child of that name, in constant time on average however many children there are.
    ElementId child(ElementId parent, Name name) const;
    ElementId child(ElementId parent, std::string_view name) const;
    // The first child of that name and category.
    ElementId child(ElementId parent, Name category, Name name) const;
    // A child of `scope` by a name as written in `from`, whose namespace is tried first.
    ElementId childFrom(ElementId from, ElementId scope, Name name) const;
    // Whether no other child of its parent has the element's name.
    bool isUnique(ElementId id) const;
    // The element at "graph/node" or "node", none where there is none. An empty path is none.
    ElementId find(std::string_view path) const;

    // Editing; an internal error on a view. New children go last; set() on "name" renames. Editing an element that the
    // document does not have changes nothing, but is counted: such a document is not what its maker meant.
    ElementId append(ElementId parent, std::string_view category, std::string_view name = {});
    // The same right after a sibling, which is not the root.
    ElementId insertAfter(ElementId sibling, std::string_view category, std::string_view name = {});
    void set(ElementId id, std::string_view attr, std::string_view value);
    void set(ElementId id, Name attr, Name value);
    void unset(ElementId id, Name attr);
    void setCategory(ElementId id, std::string_view category);
    void rename(ElementId id, std::string_view name) { set(id, known_.name, names_.intern(name)); }
    // Messages about an element that was made in place of another one point at that one.
    void setOrigin(ElementId id, ElementId from);
    // Takes the element with all below it out of the document. Not the root.
    void remove(ElementId id);
    std::size_t badEdits() const { return badEdits_; }

    // The names from below the root to the element: "NG_wood/mix1". The root's path is empty.
    std::string path(ElementId id) const;
    // Where the element, or one of its attributes, was written. Unknown (line 0) for elements that were not read.
    Location locate(ElementId id, Name attr = {}) const;
    // The place of a byte of an attribute's value; that of the attribute where the source writes the value with
    // references such as &lt;.
    Location locateInValue(ElementId id, Name attr, std::size_t offset) const;
    // The location of a byte of a source.
    Location locateOffset(std::uint32_t source, std::size_t offset) const;

    const std::vector<Source>& sources() const { return sources_; }
    std::uint32_t addSource(Source source);
    void setSourceVersion(std::uint32_t source, Name version) { sources_[source].version = version; }

  private:
    friend class DocumentFiller;

    bool editable() const { return elements_.data() == ownElements_.data(); }
    bool mayEdit(ElementId id);
    ElementId addElement(Name category, ElementId parent);
    void addAttribute(ElementId id, Name attr, Name value);
    void refresh();
    void indexChildren(ElementId parent) const;
    void indexName(ElementId id) const;
    void growIndex(std::size_t more) const;

    NameTable& names_;
    WellKnown known_;
    std::span<const Element> elements_;
    std::span<const Attribute> attributes_;
    std::vector<Element> ownElements_;
    std::vector<Attribute> ownAttributes_;
    std::vector<ElementId> lastChild_;
    std::vector<Source> sources_;
    ElementId prologue_;
    std::size_t badEdits_ = 0;
    bool hasNamespaces_ = false;

    void forgetTwins();

    // Children by (parent, name), for parents with many children, filled when first asked for.
    mutable std::vector<std::uint32_t> slots_;  // element + 1, or 0; entries may be stale, so a hit is checked
    mutable std::size_t slotsUsed_ = 0;
    mutable std::vector<bool> indexed_;  // per element: its children are in slots_
    mutable bool hasTwins_ = false;      // children of one parent in slots_ have one name
    mutable std::vector<std::vector<std::uint32_t>> lineStarts_;
};

// An element of one of several documents.
struct ElementRef {
    const Document* document = nullptr;
    ElementId id;

    explicit operator bool() const { return document != nullptr && static_cast<bool>(id); }
    const Element& operator*() const { return (*document)[id]; }
    const Element* operator->() const { return &(*document)[id]; }
    Name attribute(Name attr) const { return document->attribute(id, attr); }
    std::string_view attributeText(Name attr) const { return document->attributeText(id, attr); }
    friend bool operator==(const ElementRef&, const ElementRef&) = default;
};

// Children one after the other: for (ElementId c : children(document, parent)) …
class Children {
  public:
    struct End {};
    struct Iterator {
        const Document* document;
        ElementId at;
        ElementId operator*() const { return at; }
        void operator++() { at = (*document)[at].next; }
        bool operator!=(End) const { return static_cast<bool>(at); }
    };
    Children(const Document& d, ElementId parent) : first_{&d, d[parent].firstChild} {}
    Iterator begin() const { return first_; }
    End end() const { return {}; }

  private:
    Iterator first_;
};
inline Children children(const Document& d, ElementId parent) { return Children(d, parent); }

}  // namespace shaderx::doc
