#include "doc/read.h"

#include <algorithm>
#include <memory>
#include <span>

#include <fmt/format.h>
#include <pugixml.hpp>

#include "base/numbers.h"
#include "doc/xml_errors.h"

namespace shaderx::doc {

// The editor of a document that knows its insides: elements with a source, and no look-ups on the way.
class DocumentFiller {
  public:
    explicit DocumentFiller(Document& d) : d_(d) {
        ensure(d.editable() && d.size() == 1 && d.sources_.empty(), "reading needs an empty document");
        d.ownAttributes_.clear();
        d.ownElements_[0].attributeCount = d.ownElements_[0].firstAttribute = 0;
        d.refresh();
    }
    void reserve(std::size_t elements, std::size_t attributes) {
        d_.ownElements_.reserve(elements);
        d_.lastChild_.reserve(elements);
        d_.ownAttributes_.reserve(attributes);
        d_.refresh();
    }
    // An attribute of the element that is added next.
    void attribute(Name name, Name value) {
        if (attributes_ == d_.ownAttributes_.size()) makeRoom();
        d_.ownAttributes_[attributes_++] = {name, value};
    }
    std::span<const Attribute> pending() const {
        return std::span<const Attribute>(d_.ownAttributes_).subspan(taken_, attributes_ - taken_);
    }
    ElementId add(Name category, ElementId parent, std::uint32_t source, std::size_t offset) {
        ElementId id = d_.addElement(category, parent);
        complete(id, source, offset);
        return id;
    }
    // Gives the newest element its attributes and its place.
    void complete(ElementId id, std::uint32_t source, std::size_t offset) {
        Element& e = d_.ownElements_[id.index];
        e.source = source;
        e.offset = static_cast<std::uint32_t>(offset);
        e.attributeCount = static_cast<std::uint32_t>(attributes_ - taken_);
        e.firstAttribute = static_cast<std::uint32_t>(taken_);
        for (const Attribute& a : pending()) {
            if (a.name == d_.known_.name) e.name = a.value;
            if (a.name == d_.known_.namespaceName) d_.hasNamespaces_ = true;
        }
        taken_ = attributes_;
    }
    void finish() {
        d_.ownAttributes_.resize(attributes_);
        d_.refresh();
    }
    // Comments before the root (`last` is none at first) and after it.
    void chain(ElementId& last, ElementId id) {
        (last ? d_.ownElements_[last.index].next : d_.prologue_) = id;
        last = id;
    }
    void setName(ElementId id, Name name) { d_.ownElements_[id.index].name = name; }

  private:
    // Apart, so that what is called for every attribute stays small.
    [[gnu::noinline]] void makeRoom() {
        std::vector<Attribute>& all = d_.ownAttributes_;
        all.resize(std::max<std::size_t>({64, all.capacity(), all.size() * 2}));
        d_.refresh();
    }

    Document& d_;
    // Of ownAttributes_, those that are filled, and of these, those of elements that are complete. The rest is room.
    std::size_t attributes_ = 0, taken_ = 0;
};

namespace {

constexpr std::size_t kLarge = 1u << 20;  // from here on, a count before is worth it

std::size_t countOf(std::string_view text, char c) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), c));
}

constexpr unsigned kParseFlags = pugi::parse_default | pugi::parse_comments | pugi::parse_pi | pugi::parse_doctype;

// What an included root passes on to the elements it brings in.
struct Inheritance {
    Name fileprefix, colorspace, space;
};

// A file being merged: what is left of it.
struct Frame {
    std::unique_ptr<pugi::xml_document> xml;
    pugi::xml_node top, at;      // the root element in it, and what comes next; none at the end
    const char* text = nullptr;  // what the offsets of its elements count from
    std::uint32_t source = 0;
    ElementId parent;  // of the elements to come
    std::uint32_t depth = 0;
    ElementId mark;  // the include that is being merged
    Inheritance passed;
};

struct Reader {
    Document& document;
    Resolver& resolver;
    Diagnostics& diagnostics;
    const ReadOptions& options;
    DocumentFiller fill;
    NameTable& names;
    const WellKnown& known;
    std::vector<Frame> frames{};
    std::vector<std::string> files{};  // by source
    std::size_t tokens = 0;            // tags and attributes of all large files

    Diagnostic& error(std::string_view code, std::string message, std::uint32_t source, std::size_t offset) {
        Diagnostic& d = diagnostics.error(code, std::move(message));
        d.where = document.locateOffset(source, offset);
        for (auto f = frames.rbegin(); f != frames.rend(); ++f)
            if (f->source != source && f->mark) d.notes.push_back({document.locate(f->mark), "included from here"});
        return d;
    }
    static std::size_t offsetOf(pugi::xml_node n) {
        std::ptrdiff_t at = n.offset_debug(), before = 0;
        switch (n.type()) {
            case pugi::node_element:
                before = 1;
                break;  // "<"
            case pugi::node_comment:
                before = 4;
                break;  // "<!--"
            case pugi::node_cdata:
                before = 9;
                break;  // "<![CDATA["
            case pugi::node_pi:
                before = 2;
                break;  // "<?"
            case pugi::node_null:
            case pugi::node_document:
            case pugi::node_pcdata:
            case pugi::node_declaration:
            case pugi::node_doctype:
                break;
        }
        return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, at - before));
    }

    // Whether an attribute that is left empty, as many programs write all that they know of, is as good as absent.
    bool saysNothing(Name name) const {
        const Name all[] = {known.nodename,     known.nodegraph,
                            known.output,       known.interfacename,
                            known.colorspace,   known.type,
                            known.nodedef,      known.node,
                            known.version,      known.target,
                            known.inherit,      known.channels,
                            known.fileprefix,   known.namespaceName,
                            known.language,     known.defaultgeomprop,
                            known.sourcecode,   known.function,
                            known.file,         known.isdefaultversion,
                            names.find("unit"), names.find("unittype")};
        return std::find(std::begin(all), std::end(all), name) != std::end(all);
    }

    // Includes within an include's fallback are not followed.
    bool isActiveInclude(ElementId id) const {
        if (!id || document[id].category != known.include) return false;
        for (ElementId p = document[id].parent; p; p = document[p].parent)
            if (document[p].category == known.include) return false;
        return true;
    }
    std::optional<std::uint32_t> checkedSource(std::string file, std::string text, std::string directory);
    bool parse(std::uint32_t source, pugi::xml_document& xml);
    bool checkRoot(std::uint32_t source, pugi::xml_node root);
    bool openFile(std::string file, std::string text, std::string directory, ElementId mark);
    void attributes(pugi::xml_node n, const Frame& f, bool topLevel);
    ElementId convert(pugi::xml_node n, ElementId parent, const Frame& f, bool topLevel);
    void include(ElementId mark);
    void merge();
    void outside(pugi::xml_node xmlDocument, std::uint32_t source);
};

// Takes the text in as a source if it is UTF-8 of a size we take.
std::optional<std::uint32_t> Reader::checkedSource(std::string file, std::string text, std::string directory) {
    std::string_view t = text;
    bool wide = t.starts_with("\xFE\xFF") || t.starts_with("\xFF\xFE") || t.starts_with(std::string_view("\0<", 2)) ||
                t.starts_with(std::string_view("<\0", 2));
    bool tooLarge = text.size() > std::min<std::size_t>(options.maxFileBytes, 0xfffffff0u);
    if (t.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    if (wide || tooLarge) text.clear();
    std::uint32_t source = document.addSource({std::move(file), std::move(text), std::move(directory), {}});
    const std::string& kept = document.sources()[source].text;
    // Counted before the parser takes memory for each.
    if (kept.size() > kLarge) tokens += countOf(kept, '<') + countOf(kept, '=');
    if (tooLarge) {
        error("limit", fmt::format("the file is larger than {} bytes", options.maxFileBytes), source, 0);
    } else if (wide) {
        error("bad-encoding", "the file is UTF-16 or UTF-32; only UTF-8 is read", source, 0).hint = "save it as UTF-8";
    } else if (tokens / 2 > options.maxElements) {
        error("limit", fmt::format("the document has more than {} elements", options.maxElements), source, 0);
    } else if (std::optional<std::size_t> bad = findBadByte(kept)) {
        error("bad-encoding",
              kept[*bad] == '\0'
                  ? "a zero byte is not text"
                  : fmt::format("byte {:#04x} is not UTF-8 here", static_cast<unsigned char>(kept[*bad])),
              source, *bad);
    } else if (std::optional<std::size_t> reference = findBadReference(kept)) {
        error("bad-encoding", "this reference means no character", source, *reference);
    } else {
        return source;
    }
    return {};
}

bool Reader::parse(std::uint32_t source, pugi::xml_document& xml) {
    const std::string& text = document.sources()[source].text;
    pugi::xml_parse_result parsed = xml.load_buffer(text.data(), text.size(), kParseFlags, pugi::encoding_utf8);
    if (parsed) return true;
    if (parsed.status == pugi::status_no_document_element) {
        error("bad-xml", "expected a root element <materialx>, found none", source, text.size());
        return false;
    }
    std::optional<XmlProblem> problem = findXmlProblem(text);
    if (!problem) problem = XmlProblem{static_cast<std::size_t>(parsed.offset), parsed.description(), {}, {}};
    Diagnostic& d = error("bad-xml", problem->message, source, problem->offset);
    if (problem->opened)
        d.notes.push_back(
            {document.locateOffset(source, *problem->opened), fmt::format("<{}> is opened here", problem->openedName)});
    return false;
}

bool Reader::checkRoot(std::uint32_t source, pugi::xml_node root) {
    if (std::string_view(root.name()) != "materialx") {
        error("not-materialx", fmt::format("expected <materialx> as the root element, found <{}>", root.name()), source,
              offsetOf(root));
        return false;
    }
    for (pugi::xml_node n = root.next_sibling(); n; n = n.next_sibling())
        if (n.type() == pugi::node_element) {
            error("bad-xml", fmt::format("expected the end of the file after </materialx>, found <{}>", n.name()),
                  source, offsetOf(n));
            return false;
        }
    std::string_view text = root.attribute("version").value();
    if (text.empty()) return true;  // the upgrade tells by what the file contains
    std::size_t dot = text.find('.');
    bool good = dot != std::string_view::npos && parseInt(text.substr(0, dot)) && parseInt(text.substr(dot + 1));
    if (good && text.starts_with("1.")) {
        document.setSourceVersion(source, names.intern(text));
        return true;
    }
    error("bad-version", fmt::format("expected a version of the form 1.39, found '{}'", text), source, offsetOf(root));
    return false;
}

// The attributes of the element that comes next.
void Reader::attributes(pugi::xml_node n, const Frame& f, bool topLevel) {
    bool passes = topLevel && f.source != 0;
    auto has = [&](Name name) {
        for (const Attribute& a : fill.pending())
            if (a.name == name) return true;
        return false;
    };
    std::size_t count = 0;
    for (pugi::xml_attribute a = n.first_attribute(); a; a = a.next_attribute(), count++) {
        std::string_view text = a.value();
        if (count == options.maxAttributes) {
            error("limit", fmt::format("<{}> has more than {} attributes", n.name(), count), f.source, offsetOf(n));
            break;
        }
        if (text.size() > options.maxAttributeBytes) {
            error("limit",
                  fmt::format("the attribute '{}' is longer than {} bytes", a.name(), options.maxAttributeBytes),
                  f.source, offsetOf(n));
            continue;
        }
        Name name = names.intern(a.name()), value = names.intern(text);
        if (text.empty() && saysNothing(name)) continue;
        if (has(name)) {
            error("duplicate-attribute", fmt::format("<{}> has the attribute '{}' twice", n.name(), a.name()), f.source,
                  offsetOf(n));
            continue;
        }
        if (passes && name == known.name) value = document.qualified(f.passed.space, value);
        fill.attribute(name, value);
    }
    if (!passes) return;
    auto pass = [&](Name attr, Name value) {
        if (value && !has(attr)) fill.attribute(attr, value);
    };
    pass(known.fileprefix, f.passed.fileprefix);
    pass(known.colorspace, f.passed.colorspace);
    pass(known.namespaceName, f.passed.space);
}

// One node of the tree, without what is below it.
ElementId Reader::convert(pugi::xml_node n, ElementId parent, const Frame& f, bool topLevel) {
    Name category;
    switch (n.type()) {
        case pugi::node_element: {
            const char* name = n.name();
            category = names.intern(name);
            attributes(n, f, topLevel);
            return fill.add(category, parent, f.source, static_cast<std::size_t>(name - f.text - 1));
        }
        case pugi::node_comment:
            category = known.comment;
            break;
        case pugi::node_pcdata:
            category = known.textNode;
            break;
        case pugi::node_cdata:
            category = known.cdata;
            break;
        case pugi::node_pi:
            category = known.pi;
            break;
        case pugi::node_doctype:
            category = known.doctype;
            break;
        case pugi::node_null:
        case pugi::node_document:
        case pugi::node_declaration:
            return {};
    }
    fill.attribute(known.text, names.intern(n.value()));
    ElementId id = fill.add(category, parent, f.source, offsetOf(n));
    if (n.type() == pugi::node_pi) fill.setName(id, names.intern(n.name()));
    return id;
}

// Comments and the like around the root of the first file.
void Reader::outside(pugi::xml_node xmlDocument, std::uint32_t source) {
    Frame f;
    f.source = source;
    ElementId last;
    for (pugi::xml_node n = xmlDocument.first_child(); n; n = n.next_sibling()) {
        if (n.type() == pugi::node_element)
            last = document.root();
        else if (ElementId id = convert(n, {}, f, false))
            fill.chain(last, id);
    }
}

bool Reader::openFile(std::string file, std::string text, std::string directory, ElementId mark) {
    files.push_back(file);
    std::optional<std::uint32_t> source = checkedSource(std::move(file), std::move(text), std::move(directory));
    if (!source) return false;
    Frame f;
    f.xml = std::make_unique<pugi::xml_document>();
    if (!parse(*source, *f.xml)) return false;
    f.top = f.xml->document_element();
    if (!checkRoot(*source, f.top)) return false;
    f.source = *source;
    f.at = f.top.first_child();
    f.text = f.top.name() - f.top.offset_debug();
    if (mark) {
        f.parent = document[mark].parent;
        const Inheritance& outer = frames.back().passed;
        auto own = [&](const char* attr, Name otherwise) {
            pugi::xml_attribute a = f.top.attribute(attr);
            return a ? names.intern(a.value()) : otherwise;
        };
        f.passed = {own("fileprefix", outer.fileprefix), own("colorspace", outer.colorspace),
                    own("namespace", outer.space)};
    } else {
        f.parent = document.root();
        attributes(f.top, f, false);
        fill.complete(f.parent, *source, offsetOf(f.top));
        outside(*f.xml, *source);
    }
    frames.push_back(std::move(f));
    return true;
}

void Reader::include(ElementId mark) {
    Name hrefName = names.intern("href");
    std::string_view href = document.attributeText(mark, hrefName);
    auto fail = [&](std::string_view code, std::string message) -> Diagnostic& {
        Diagnostic& d = diagnostics.error(code, std::move(message));
        d.where = document.locate(mark, document.attribute(mark, hrefName) ? hrefName : Name());
        return d;
    };
    frames.back().mark = mark;
    if (href.empty()) {
        fail("missing-include", "an include needs an attribute 'href' that names a file");
        return;
    }
    if (frames.size() > options.maxIncludeDepth) {
        fail("limit", fmt::format("includes are nested deeper than {}", options.maxIncludeDepth));
        return;
    }
    std::string from = document.sources()[frames.back().source].directory;
    std::optional<ResolvedFile> found = resolver.resolve(href, from);
    if (!found) {
        std::string message = fmt::format("cannot find the included file '{}'", href);
        Diagnostic& d = fail("missing-include", std::move(message));
        d.hint = resolver.hint();
        if (d.hint.empty() && (href.starts_with('/') || href.find("..") != std::string_view::npos))
            d.hint = "files are only taken from the document's own folder, from search paths, and from below these";
        return;
    }
    std::string file = normalPath(found->file);
    for (const Frame& f : frames)
        if (files[f.source] == file) {
            Diagnostic& d = fail("include-cycle", fmt::format("'{}' includes itself", href));
            for (std::size_t i = frames.size() - 1; i > 0 && frames[i].source != f.source; i--)
                d.notes.push_back({document.locate(frames[i - 1].mark), "included from here"});
            return;
        }
    if (std::find(files.begin(), files.end(), file) != files.end()) return;  // merged already
    openFile(std::move(file), std::move(found->text), std::move(found->directory), mark);
}

// Walks the files' trees as one, a file of its own for each include met.
void Reader::merge() {
    while (!frames.empty()) {
        Frame& f = frames.back();
        if (!f.at) {
            frames.pop_back();
            continue;
        }
        pugi::xml_node n = f.at;
        bool topLevel = f.depth == 0;
        if (document.size() >= options.maxElements) {
            error("limit", fmt::format("the document has more than {} elements", options.maxElements), f.source,
                  offsetOf(n));
            return;
        }
        ElementId id = convert(n, f.parent, f, topLevel);
        if (pugi::xml_node first = n.first_child(); id && first) {
            if (f.depth + 2 > options.maxNesting) {
                error("limit", fmt::format("elements are nested deeper than {}", options.maxNesting), f.source,
                      offsetOf(first));
                return;
            }
            f.parent = id;
            f.at = first;
            f.depth++;
            continue;
        }
        ElementId mark = isActiveInclude(id) ? id : ElementId();
        while (f.depth && !n.next_sibling()) {
            n = n.parent();
            if (isActiveInclude(f.parent)) mark = f.parent;
            f.parent = document[f.parent].parent;
            f.depth--;
        }
        f.at = n.next_sibling();
        if (mark) include(mark);  // may add a frame: f is gone
    }
}

}  // namespace

Result<ElementId> read(Document& document, std::string_view fileName, std::string text, Resolver& resolver,
                       Diagnostics& diagnostics, const ReadOptions& options) {
    std::size_t errors = diagnostics.errorCount();
    Reader reader{document,         resolver,        diagnostics, options, DocumentFiller(document),
                  document.names(), document.known()};
    if (text.size() > kLarge) {  // so that the arrays do not grow by doubling
        std::size_t most = options.maxElements;
        reader.fill.reserve(std::min(countOf(text, '<'), most) + 1, std::min(countOf(text, '='), 2 * most) + 1);
    }
    std::string file(fileName);
    if (reader.openFile(normalPath(file), std::move(text), directoryOf(file), {})) reader.merge();
    reader.fill.finish();
    if (diagnostics.errorCount() != errors) return Failure{};
    return document.root();
}

std::string normalPath(std::string_view path) {
    std::vector<std::string_view> parts;
    bool absolute = path.starts_with("/");
    while (!path.empty()) {
        std::size_t slash = path.find_first_of("/\\");
        std::string_view part = path.substr(0, slash);
        path.remove_prefix(slash == std::string_view::npos ? path.size() : slash + 1);
        if (part.empty() || part == ".") continue;
        if (part == ".." && !parts.empty() && parts.back() != "..")
            parts.pop_back();
        else if (part != ".." || !absolute)
            parts.push_back(part);
    }
    std::string out;
    for (std::string_view part : parts) {
        if (absolute || !out.empty()) out += '/';
        out += part;
    }
    return out;
}

std::string directoryOf(std::string_view path) {
    std::size_t slash = path.find_last_of("/\\");
    if (slash == std::string_view::npos) return {};
    return std::string(path.substr(0, std::max<std::size_t>(slash, 1)));
}

}  // namespace shaderx::doc
