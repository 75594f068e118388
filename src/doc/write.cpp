#include "doc/write.h"

#include <algorithm>

namespace shaderx::doc {

namespace {

struct Writer {
    const Document& document;
    const WriteOptions& options;
    std::string out{};

    const WellKnown& known() const { return document.known(); }
    std::string_view content(ElementId id) const { return document.attributeText(id, known().text); }

    void escape(std::string_view text, bool inAttribute) {
        for (char c : text) switch (c) {
                case '&':
                    out += "&amp;";
                    break;
                case '<':
                    out += "&lt;";
                    break;
                case '>':
                    out += "&gt;";
                    break;
                case '"':
                    out += inAttribute ? "&quot;" : "\"";
                    break;
                case '\r':
                    out += "&#13;";
                    break;
                case '\n':
                    out += inAttribute ? "&#10;" : "\n";
                    break;
                case '\t':
                    out += inAttribute ? "&#9;" : "\t";
                    break;
                default:
                    out += c;
            }
    }

    // A text of blanks alone comes back only if it is not written as blanks.
    void writeText(std::string_view text) {
        if (text.find_first_not_of(" \t\r\n") != std::string_view::npos) return escape(text, false);
        for (char c : text) out.append(c == ' ' ? "&#32;" : c == '\t' ? "&#9;" : c == '\n' ? "&#10;" : "&#13;");
    }

    bool isText(ElementId id) const {
        Name c = document[id].category;
        return c == known().textNode || c == known().cdata;
    }
    // Content with text in it is written without blanks of ours, which would become part of the text.
    bool hasText(ElementId id) const {
        for (ElementId c : children(document, id))
            if (isText(c)) return true;
        return false;
    }
    // What an include brought in, directly below the parent of its mark.
    bool isIncluded(ElementId id) const {
        const Element& e = document[id];
        return options.keepIncludes && e.parent && e.source != Element::kNoSource && e.source != 0 &&
               document[e.parent].source == 0;
    }
    bool isSkipped(ElementId id) const {
        return isIncluded(id) || (!options.keepIncludes && document[id].category == known().include);
    }

    void startTag(ElementId id) {
        const Element& e = document[id];
        out += '<';
        out += document.text(e.category);
        for (const Attribute& a : document.attributes(id)) {
            out += ' ';
            out += document.text(a.name);
            out += "=\"";
            escape(document.text(a.value), true);
            out += '"';
        }
        out += e.firstChild ? ">" : " />";
    }

    // A comment or the like; false for a real element.
    bool special(ElementId id) {
        Name c = document[id].category;
        if (c == known().comment)
            out.append("<!--").append(content(id)).append("-->");
        else if (c == known().textNode)
            writeText(content(id));
        else if (c == known().cdata)
            out.append("<![CDATA[").append(content(id)).append("]]>");
        else if (c == known().doctype)
            out.append("<!DOCTYPE ").append(content(id)).append(">");
        else if (c == known().pi)
            out.append("<?").append(document.text(document[id].name)).append(" ").append(content(id)).append("?>");
        else
            return false;
        return true;
    }

    // One element with all below it, on explicit ground: down by firstChild, along by next, up by parent.
    void tree(ElementId top) {
        std::size_t depth = 0, inlineFrom = ~std::size_t(0);  // at depths beyond `inlineFrom` no blanks are added
        ElementId at = top;
        for (;;) {
            bool skip = isSkipped(at);
            if (!skip) {
                if (depth <= inlineFrom) out.append(2 * depth, ' ');
                if (!special(at)) startTag(at);
                if (document[at].firstChild) {
                    if (inlineFrom == ~std::size_t(0) && hasText(at)) inlineFrom = depth;
                    if (depth < inlineFrom) out += '\n';
                    at = document[at].firstChild;
                    depth++;
                    continue;
                }
                if (depth <= inlineFrom) out += '\n';
            }
            while (at != top && !document[at].next) {
                at = document[at].parent;
                depth--;
                if (depth < inlineFrom) out.append(2 * depth, ' ');
                out.append("</").append(document.text(document[at].category)).append(">");
                if (depth <= inlineFrom) {
                    out += '\n';
                    inlineFrom = ~std::size_t(0);
                }
            }
            if (at == top) return;
            at = document[at].next;
        }
    }
};

}  // namespace

std::string write(const Document& document, const WriteOptions& options) {
    Writer w{document, options};
    w.out = "<?xml version=\"1.0\"?>\n";
    for (ElementId e = document.prologue(); e; e = document[e].next) w.tree(e);
    for (ElementId e = document.root(); e; e = document[e].next) w.tree(e);
    return std::move(w.out);
}

bool isXmlName(std::string_view text) {
    const auto isFirst = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
               static_cast<signed char>(c) < 0;
    };
    const auto isLater = [&](char c) { return isFirst(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; };
    return !text.empty() && isFirst(text[0]) && std::all_of(text.begin(), text.end(), isLater);
}

}  // namespace shaderx::doc
