// The command that writes shaders.
#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>

#include "apps/cli/files.h"
#include "apps/cli/session.h"

namespace shaderx::cli {

namespace {

// What to compile of a document, and the names of its files.
struct Work {
    const std::string& file;
    std::unique_ptr<doc::Document> document;
    std::vector<doc::ElementId> elements = {};
    std::vector<std::string> stems = {};
};

}  // namespace

static void write(Session& s, const std::string& stem, const Shader& shader) {
    Diagnostics diagnostics;
    if (s.options.out == "-") {
        writeFile("-", shader.vertex + "\n" + shader.pixel, diagnostics);
    } else {
        std::string base = (std::filesystem::path(s.options.out) / stem).string();
        const std::string reflection = shader.reflection();
        const std::pair<const char*, std::string_view> files[] = {
            {".vert", shader.vertex}, {".frag", shader.pixel}, {".json", reflection}};
        std::size_t written = 0;
        while (written < std::size(files) && writeFile(base + files[written].first, files[written].second, diagnostics))
            written++;
        for (std::size_t i = 0; written < std::size(files) && i < written; i++)
            std::remove((base + files[i].first).c_str());
    }
    s.report(diagnostics);
}

int generate(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    bool writes = options.dump.empty();
    if (writes && options.out != "-") {
        Diagnostics diagnostics;
        if (!makeFolder(options.out, diagnostics) && !s.report(diagnostics)) return kInputErrors;
    }
    // Two elements of one file name are an error for both, so all names are known before anything is written.
    std::vector<Work> work;
    std::map<std::string, int> names;
    for (const std::string& file : options.files) {
        Work w{file, s.read(file)};
        if (!w.document) continue;
        w.elements = s.elements(file, *w.document);
        for (doc::ElementId e : w.elements) {
            w.stems.push_back(stemOf(file) + "." + fileNameOf(w.document->path(e)));
            names[w.stems.back()]++;
        }
        work.push_back(std::move(w));
    }
    for (Work& w : work) {
        std::size_t left = 0;
        for (std::size_t i = 0; i < w.elements.size(); i++) {
            if (writes && options.out != "-" && names[w.stems[i]] > 1) {
                Diagnostics diagnostics;
                Diagnostic& e = diagnostics.error("file-name-clash",
                                                  "another element would be written to '" + w.stems[i] + "' too");
                e.where = w.document->locate(w.elements[i]);
                e.path = w.document->path(w.elements[i]);
                s.report(diagnostics);
                continue;
            }
            w.elements[left] = w.elements[i];
            std::swap(w.stems[left++], w.stems[i]);
        }
        w.elements.resize(left);
        std::size_t next = 0;
        s.compiler.generate(*w.document, w.elements, s.how(),
                            [&](doc::ElementId e, Result<Shader> shader, const Diagnostics& diagnostics) {
                                s.reportElement(w.file, *w.document, e, diagnostics);
                                if (shader && writes) write(s, w.stems[next], *shader);
                                next++;
                            });
    }
    return s.exitCode();
}

}  // namespace shaderx::cli
