#include "compile/library.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "doc/read.h"
#include "doc/upgrade.h"
#include "passes/specialise.h"

namespace shaderx {

namespace {

// The files of the library itself are what its includes may name.
struct OwnFiles final : doc::Resolver {
    std::map<std::string, std::string, std::less<>> texts;
    std::optional<doc::ResolvedFile> resolve(std::string_view href, std::string_view from) override {
        auto it = texts.find(doc::normalPath(href));
        if (it == texts.end() && !from.empty())
            it = texts.find(doc::normalPath(std::string(from).append("/").append(href)));
        if (it == texts.end()) return {};
        return doc::ResolvedFile{it->first, doc::directoryOf(it->first), it->second};
    }
};

bool endsWith(std::string_view text, std::string_view end) {
    return text.size() >= end.size() && text.substr(text.size() - end.size()) == end;
}

class TextLibrary final : public Library {
  public:
    explicit TextLibrary(NameTable& names) : document_(names), module_(names) {}

    bool load(std::vector<LibraryFile> files, std::span<Library* const> below, Diagnostics& diagnostics) {
        std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
        std::size_t errors = diagnostics.errorCount();
        OwnFiles own;
        std::string root =
            "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" xmlns:xi=\"http://www.w3.org/2001/XInclude\">\n";
        for (const LibraryFile& f : files)
            if (endsWith(f.name, ".mtlx")) {
                own.texts[doc::normalPath(f.name)] = f.text;
                std::string escaped;
                for (char c : f.name)
                    escaped += c == '&' || c == '<' || c == '"' || static_cast<unsigned char>(c) < 0x20
                                   ? "&#" + std::to_string(c) + ";"
                                   : std::string(1, c);
                root += "<xi:include href=\"" + escaped + "\"/>\n";
            }
        root += "</materialx>\n";
        auto read = doc::read(document_, "library", std::move(root), own, diagnostics);
        (void)read;  // every error is in the diagnostics
        doc::Definitions others;
        for (Library* l : below) others.add(l->document(), l->index());
        doc::upgrade(document_, diagnostics, {&others, nullptr});
        tables_ = doc::buildIndex(document_);
        std::vector<sl::SourceFile> sources;
        for (const LibraryFile& f : files)
            if (endsWith(f.name, ".sl")) sources.push_back({f.name, f.text});
        checkSources(sources, diagnostics);
        std::vector<sl::Signature> known;
        for (Library* l : below) {
            module_.sources.push_back(l);
            known.insert(known.end(), l->signatures().begin(), l->signatures().end());
        }
        sl::compile(module_, sources, known, signatures_, diagnostics);
        for (auto& f : module_.functions) passes::flatten(module_, *f);
        return diagnostics.errorCount() == errors;
    }

    const doc::Document& document() const override { return document_; }
    doc::DefinitionsIndex index() const override { return tables_.index(); }
    const std::vector<sl::Signature>& signatures() override { return signatures_; }
    const ir::Function* find(Name name) override { return module_.findOwn(name); }
    const ir::LeafInfo* findLeaf(Name) override { return nullptr; }
    std::vector<const ir::Function*> functions() const override {
        std::vector<const ir::Function*> all;
        for (const auto& f : module_.functions) all.push_back(f.get());
        return all;
    }

  private:
    // Functions are found whichever file they are in; but a file that is named has to be there.
    void checkSources(std::span<const sl::SourceFile> sources, Diagnostics& diagnostics) const {
        const doc::WellKnown& k = document_.known();
        std::vector<std::string> names;
        for (const sl::SourceFile& s : sources) names.push_back(doc::normalPath(s.name));
        const auto isThere = [&](const std::string& name) { return std::count(names.begin(), names.end(), name) > 0; };
        for (doc::ElementId e : doc::children(document_, document_.root())) {
            if (document_[e].category != k.implementation) continue;
            if (document_.attribute(e, k.target) || document_.attribute(e, k.language)) continue;
            const std::string_view file = document_.attributeText(e, k.file);
            const Location where = document_.locate(e, k.file);
            const std::string folder = doc::directoryOf(where.file).append("/");
            if (file.empty() || isThere(doc::normalPath(file)) || isThere(doc::normalPath(folder + std::string(file))))
                continue;
            Diagnostic& error =
                diagnostics.error("missing-source", fmt::format("the library has no file '{}' of functions", file));
            error.where = where;
            error.path = document_.path(e);
            std::vector<std::string_view> candidates(names.begin(), names.end());
            for (std::string_view& c : candidates)
                if (c.starts_with(folder)) c.remove_prefix(folder.size());
            const std::string_view near = nearest(file, candidates);
            if (!near.empty()) error.hint = fmt::format("did you mean '{}'?", near);
        }
    }

    doc::Document document_;
    doc::DefinitionsTables tables_;
    ir::Module module_;
    std::vector<sl::Signature> signatures_;
};

}  // namespace

std::unique_ptr<Library> makeLibrary(NameTable& names, std::vector<LibraryFile> files, std::span<Library* const> below,
                                     Diagnostics& diagnostics) {
    auto library = std::make_unique<TextLibrary>(names);
    if (!library->load(std::move(files), below, diagnostics)) return nullptr;
    return library;
}

}  // namespace shaderx
