#include "doc/document.h"

#include <algorithm>

namespace shaderx::doc {

WellKnown::WellKnown(NameTable& names)
    : name(names.intern("name")),
      type(names.intern("type")),
      value(names.intern("value")),
      nodename(names.intern("nodename")),
      nodegraph(names.intern("nodegraph")),
      output(names.intern("output")),
      interfacename(names.intern("interfacename")),
      nodedef(names.intern("nodedef")),
      node(names.intern("node")),
      input(names.intern("input")),
      parameter(names.intern("parameter")),
      token(names.intern("token")),
      implementation(names.intern("implementation")),
      version(names.intern("version")),
      isdefaultversion(names.intern("isdefaultversion")),
      target(names.intern("target")),
      inherit(names.intern("inherit")),
      colorspace(names.intern("colorspace")),
      fileprefix(names.intern("fileprefix")),
      namespaceName(names.intern("namespace")),
      file(names.intern("file")),
      function(names.intern("function")),
      sourcecode(names.intern("sourcecode")),
      channels(names.intern("channels")),
      text(names.intern("text")),
      material(names.intern("material")),
      look(names.intern("look")),
      lookgroup(names.intern("lookgroup")),
      materialassign(names.intern("materialassign")),
      collection(names.intern("collection")),
      multioutput(names.intern("multioutput")),
      materialx(names.intern("materialx")),
      include(names.intern("xi:include")),
      comment(names.intern("#comment")),
      textNode(names.intern("#text")),
      cdata(names.intern("#cdata")),
      pi(names.intern("#pi")),
      doctype(names.intern("#doctype")),
      trueValue(names.intern("true")),
      out(names.intern("out")),
      defaultgeomprop(names.intern("defaultgeomprop")),
      surfaceshader(names.intern("surfaceshader")),
      empty(names.intern("")),
      enumName(names.intern("enum")),
      language(names.intern("language")),
      filename(names.intern("filename")),
      string(names.intern("string")),
      typedefName(names.intern("typedef")),
      geomprop(names.intern("geomprop")),
      varname(names.intern("varname")),
      defaultName(names.intern("default")),
      fallback(names.intern("fallback")),
      texcoord(names.intern("texcoord")),
      geomcolor(names.intern("geomcolor")) {
    constexpr std::string_view kFormat[] = {
        "input",         "output",      "nodegraph",      "nodedef",        "parameter",      "token",
        "look",          "lookgroup",   "implementation", "collection",     "materialassign", "geominfo",
        "geomprop",      "geompropdef", "typedef",        "unitdef",        "unittypedef",    "targetdef",
        "attributedef",  "propertyset", "property",       "propertyassign", "variantset",     "variant",
        "variantassign", "visibility",  "backdrop",       "xi:include",     "materialx",      "member",
        "unit",          "geomattr",    "opgraph",        "shader",         "material",       "shaderref",
        "colorspacedef",
    };
    static_assert(std::size(kFormat) == std::tuple_size_v<decltype(format)>);
    std::transform(std::begin(kFormat), std::end(kFormat), format.begin(),
                   [&](std::string_view word) { return names.intern(word); });
    for (Name word : format) formatBits |= std::uint64_t(1) << (word.index & 63);
}

Document::Document(NameTable& names, const WellKnown& known) : names_(names), known_(known) {
    addElement(known_.materialx, {});
    addAttribute(root(), known_.version, names.intern("1.39"));
}

Document::Document(NameTable& names, std::span<const Element> elements, std::span<const Attribute> attributes)
    : names_(names), known_(names), elements_(elements), attributes_(attributes) {
    ensure(!elements.empty(), "a document has a root");
    hasNamespaces_ = true;  // not worth a search
}

void Document::refresh() {
    elements_ = ownElements_;
    attributes_ = ownAttributes_;
}

ElementId Document::addElement(Name category, ElementId parent) {
    ElementId id(static_cast<std::uint32_t>(ownElements_.size()));
    Element& e = ownElements_.emplace_back();
    e.category = category;
    e.parent = parent;
    e.firstAttribute = static_cast<std::uint32_t>(ownAttributes_.size());
    lastChild_.emplace_back();
    if (parent) {
        ElementId& last = lastChild_[parent.index];
        (last ? ownElements_[last.index].next : ownElements_[parent.index].firstChild) = id;
        last = id;
    }
    refresh();
    return id;
}

void Document::addAttribute(ElementId id, Name attr, Name value) {
    Element& e = ownElements_[id.index];
    std::uint32_t end = static_cast<std::uint32_t>(ownAttributes_.size());
    if (e.firstAttribute + e.attributeCount != end) {  // others follow: move this element's to the end
        ownAttributes_.reserve(std::max(ownAttributes_.capacity(), ownAttributes_.size() + e.attributeCount + 1));
        for (std::uint32_t i = 0; i < e.attributeCount; i++)
            ownAttributes_.push_back(Attribute(ownAttributes_[e.firstAttribute + i]));
        e.firstAttribute = end;
    }
    ownAttributes_.push_back({attr, value});
    e.attributeCount++;
    if (attr == known_.name) e.name = value;
    if (attr == known_.namespaceName) hasNamespaces_ = true;
    refresh();
}

Name Document::inherited(ElementId id, Name attr) const {
    for (; id; id = elements_[id.index].parent)
        if (Name value = attribute(id, attr)) return value;
    return {};
}

Name Document::qualified(Name space, Name name) const {
    if (!space || !name) return name;
    std::string_view prefix = text(space), rest = text(name);
    if (prefix.empty()) return name;
    if (rest.size() > prefix.size() && rest.starts_with(prefix) && rest[prefix.size()] == ':') return name;
    std::string full(prefix);
    full += ':';
    full += rest;
    return names_.intern(full);
}

// A mix of parent and name; 0x9e3779b1 is the golden ratio, which spreads consecutive handles.
static std::uint32_t hashChild(ElementId parent, Name name) {
    std::uint32_t h = parent.index * 0x9e3779b1u ^ name.index * 0x85ebca6bu;
    return h ^ (h >> 15);
}

// Makes room, and drops what renaming and removing have left behind.
void Document::growIndex(std::size_t more) const {
    std::vector<std::uint32_t> entries;
    for (std::uint32_t s : slots_)
        if (s && elements_[s - 1].parent && elements_[s - 1].name) entries.push_back(s - 1);
    // The first of equal names must be met first, so they go in by age.
    std::sort(entries.begin(), entries.end());
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
    std::size_t size = 256;
    while (size < (entries.size() + more) * 2) size *= 2;
    slots_.assign(size, 0);
    slotsUsed_ = 0;
    for (std::uint32_t i : entries) indexName(ElementId(i));
}

void Document::indexName(ElementId id) const {
    if (slotsUsed_ * 2 >= slots_.size()) growIndex(slotsUsed_ + 1);
    const Element& e = elements_[id.index];
    std::size_t mask = slots_.size() - 1, at = hashChild(e.parent, e.name) & mask;
    int alike = 0;
    for (; slots_[at]; at = (at + 1) & mask) {
        const Element& other = elements_[slots_[at] - 1];
        if (slots_[at] == id.index + 1 || other.name != e.name || other.parent != e.parent) continue;
        hasTwins_ = true;
        if (++alike == 2) return;  // the first is found, and that it is not alone
    }
    slots_[at] = id.index + 1;
    slotsUsed_++;
}

// Of more than two children of one name the others are not in the index: where one of the two goes, it is made anew.
void Document::forgetTwins() {
    if (!hasTwins_) return;
    slots_.clear();
    slotsUsed_ = 0;
    indexed_.clear();
    hasTwins_ = false;
}

void Document::indexChildren(ElementId parent) const {
    if (indexed_.size() < elements_.size()) indexed_.resize(elements_.size());
    indexed_[parent.index] = true;
    std::size_t count = 0;
    for (ElementId c : children(*this, parent)) count += static_cast<bool>(elements_[c.index].name);
    if ((slotsUsed_ + count) * 2 > slots_.size()) growIndex(count);
    for (ElementId c : children(*this, parent))
        if (elements_[c.index].name) indexName(c);
}

ElementId Document::child(ElementId parent, Name name) const {
    if (!name) return {};
    bool indexed = parent.index < indexed_.size() && indexed_[parent.index];
    if (!indexed) {
        int left = 16;  // up to here, walking is cheaper than an index
        ElementId c = elements_[parent.index].firstChild;
        for (; c && left; c = elements_[c.index].next, left--)
            if (elements_[c.index].name == name) return c;
        if (!c) return {};
        indexChildren(parent);
    }
    if (slots_.empty()) return {};
    std::size_t mask = slots_.size() - 1;
    for (std::size_t at = hashChild(parent, name) & mask; slots_[at]; at = (at + 1) & mask) {
        const Element& e = elements_[slots_[at] - 1];
        if (e.parent == parent && e.name == name) return ElementId(slots_[at] - 1);
    }
    return {};
}

bool Document::isUnique(ElementId id) const {
    const Name name = elements_[id.index].name;
    const ElementId parent = elements_[id.index].parent;
    if (!name || !parent) return true;
    bool indexed = parent.index < indexed_.size() && indexed_[parent.index];
    if (!indexed) {
        int left = 16;  // as in child()
        ElementId c = elements_[parent.index].firstChild;
        for (; c && left; c = elements_[c.index].next, left--)
            if (elements_[c.index].name == name && c != id) return false;
        if (!c) return true;
        indexChildren(parent);
    }
    if (!hasTwins_) return true;
    std::size_t mask = slots_.size() - 1;
    for (std::size_t at = hashChild(parent, name) & mask; slots_[at]; at = (at + 1) & mask) {
        const Element& e = elements_[slots_[at] - 1];
        if (e.parent == parent && e.name == name && slots_[at] != id.index + 1) return false;
    }
    return true;
}

ElementId Document::child(ElementId parent, std::string_view name) const { return child(parent, names_.find(name)); }

ElementId Document::child(ElementId parent, Name category, Name name) const {
    ElementId first = child(parent, name);
    for (ElementId c = first; c; c = elements_[c.index].next)
        if (elements_[c.index].name == name && elements_[c.index].category == category) return c;
    return {};
}

ElementId Document::childFrom(ElementId from, ElementId scope, Name name) const {
    if (Name space = namespaceOf(from))
        if (ElementId c = child(scope, qualified(space, name))) return c;
    return child(scope, name);
}

ElementId Document::find(std::string_view path) const {
    if (path.empty()) return {};
    ElementId at = root();
    while (at) {
        std::size_t slash = path.find('/');
        at = child(at, path.substr(0, slash));
        if (slash == std::string_view::npos) return at;
        path.remove_prefix(slash + 1);
    }
    return {};
}

bool Document::mayEdit(ElementId id) {
    ensure(editable(), "a library's document is read only");
    bool known = has(id);
    if (!known) badEdits_++;
    return known;
}

ElementId Document::append(ElementId parent, std::string_view category, std::string_view name) {
    if (!mayEdit(parent)) return {};
    ElementId id = addElement(names_.intern(category), parent);
    if (!name.empty()) set(id, known_.name, names_.intern(name));
    return id;
}

ElementId Document::insertAfter(ElementId sibling, std::string_view category, std::string_view name) {
    if (!mayEdit(sibling)) return {};
    ElementId parent = ownElements_[sibling.index].parent;
    if (!parent) {  // the root, or a comment beside it
        badEdits_++;
        return {};
    }
    ElementId last = lastChild_[parent.index], id = append(parent, category, name);
    if (last == sibling) return id;
    ownElements_[last.index].next = {};
    ownElements_[id.index].next = ownElements_[sibling.index].next;
    ownElements_[sibling.index].next = id;
    lastChild_[parent.index] = last;
    return id;
}

void Document::set(ElementId id, std::string_view attr, std::string_view value) {
    set(id, names_.intern(attr), names_.intern(value));
}

void Document::set(ElementId id, Name attr, Name value) {
    if (!mayEdit(id)) return;
    Element& e = ownElements_[id.index];
    bool found = false;
    for (std::uint32_t i = 0; i < e.attributeCount && !found; i++)
        if (Attribute& a = ownAttributes_[e.firstAttribute + i]; a.name == attr) {
            a.value = value;
            found = true;
        }
    if (!found) addAttribute(id, attr, value);
    if (attr != known_.name) return;
    forgetTwins();
    ownElements_[id.index].name = value;
    ElementId parent = ownElements_[id.index].parent;
    if (parent && parent.index < indexed_.size() && indexed_[parent.index]) indexName(id);
}

void Document::unset(ElementId id, Name attr) {
    if (!mayEdit(id)) return;
    Element& e = ownElements_[id.index];
    auto begin = ownAttributes_.begin() + e.firstAttribute, end = begin + e.attributeCount;
    auto at = std::find_if(begin, end, [&](const Attribute& a) { return a.name == attr; });
    if (at == end) return;
    std::move(at + 1, end, at);
    e.attributeCount--;
    if (attr != known_.name) return;
    forgetTwins();
    e.name = {};
}

void Document::setCategory(ElementId id, std::string_view category) {
    if (!mayEdit(id)) return;
    ownElements_[id.index].category = names_.intern(category);
}

void Document::setOrigin(ElementId id, ElementId from) {
    if (!mayEdit(id) || !mayEdit(from)) return;
    ownElements_[id.index].source = ownElements_[from.index].source;
    ownElements_[id.index].offset = ownElements_[from.index].offset;
}

void Document::remove(ElementId id) {
    if (!mayEdit(id)) return;
    forgetTwins();
    Element& e = ownElements_[id.index];
    ElementId parent = e.parent, before;
    if (!parent) {  // the root, or a comment beside it
        badEdits_++;
        return;
    }
    for (ElementId c = ownElements_[parent.index].firstChild; c != id; c = ownElements_[c.index].next) before = c;
    (before ? ownElements_[before.index].next : ownElements_[parent.index].firstChild) = e.next;
    if (lastChild_[parent.index] == id) lastChild_[parent.index] = before;
    e.next = {};
    // Everything below goes with it, so that walks over all elements do not find it.
    std::vector<ElementId> left{id};
    while (!left.empty()) {
        Element& gone = ownElements_[left.back().index];
        left.pop_back();
        for (ElementId c = gone.firstChild; c; c = ownElements_[c.index].next) left.push_back(c);
        gone.category = gone.name = {};
        gone.parent = gone.firstChild = {};
    }
}

std::string Document::path(ElementId id) const {
    if (!has(id)) return {};
    // From the end to the start, which is how elements know each other.
    auto each = [&](auto&& visit) {
        for (ElementId e = id; e && elements_[e.index].parent; e = elements_[e.index].parent)
            if (elements_[e.index].name) visit(text(elements_[e.index].name));
    };
    std::size_t size = 0;
    each([&](std::string_view part) { size += part.size() + 1; });
    if (!size) return {};
    std::string out(size - 1, '/');
    each([&](std::string_view part) {
        size -= part.size() + 1;
        part.copy(out.data() + size, part.size());
    });
    return out;
}

std::uint32_t Document::addSource(Source source) {
    sources_.push_back(std::move(source));
    return static_cast<std::uint32_t>(sources_.size() - 1);
}

Location Document::locateOffset(std::uint32_t source, std::size_t offset) const {
    if (source >= sources_.size()) return {};
    if (lineStarts_.size() < sources_.size()) lineStarts_.resize(sources_.size());
    std::vector<std::uint32_t>& starts = lineStarts_[source];
    const std::string& text = sources_[source].text;
    if (starts.empty()) {
        starts.push_back(0);
        for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i + 1))
            starts.push_back(static_cast<std::uint32_t>(i + 1));
    }
    offset = std::min(offset, text.size());
    auto line = std::upper_bound(starts.begin(), starts.end(), static_cast<std::uint32_t>(offset)) - 1;
    return {sources_[source].file, static_cast<std::uint32_t>(line - starts.begin() + 1),
            static_cast<std::uint32_t>(offset - *line + 1)};
}

// The offset of an attribute's name in the tag that starts at `offset`; that of the tag if it is not found there.
static std::size_t findAttribute(std::string_view text, std::size_t offset, std::string_view attr) {
    constexpr std::string_view kBlank = " \t\r\n";
    std::size_t at = text.find_first_of(" \t\r\n/>", offset);
    while (at != std::string_view::npos) {
        at = text.find_first_not_of(kBlank, at);
        if (at == std::string_view::npos || text[at] == '>' || text[at] == '/') break;
        std::size_t end = text.find_first_of("= \t\r\n", at);
        if (end == std::string_view::npos) break;
        if (text.substr(at, end - at) == attr) return at;
        std::size_t open = text.find_first_of("\"'", end);
        if (open == std::string_view::npos) break;
        at = text.find(text[open], open + 1);
        if (at != std::string_view::npos) at++;
    }
    return offset;
}

Location Document::locate(ElementId id, Name attr) const {
    if (!has(id)) return {};
    const Element& e = elements_[id.index];
    if (e.source >= sources_.size()) return {};
    std::size_t offset = e.offset;
    if (attr) offset = findAttribute(sources_[e.source].text, offset, text(attr));
    return locateOffset(e.source, offset);
}

Location Document::locateInValue(ElementId id, Name attr, std::size_t offset) const {
    if (!has(id)) return {};
    const Element& e = elements_[id.index];
    if (e.source >= sources_.size()) return {};
    const std::string_view source = sources_[e.source].text, value = attributeText(id, attr);
    const std::size_t name = findAttribute(source, e.offset, text(attr));
    const std::size_t open = source.find_first_of("\"'", name);
    const bool isPlain = name != e.offset && open != std::string_view::npos &&
                         source.substr(open + 1, value.size()) == value && value.find('\n') == std::string_view::npos;
    return locateOffset(e.source, isPlain ? open + 1 + std::min(offset, value.size()) : name);
}

}  // namespace shaderx::doc
