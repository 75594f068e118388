#include "apps/cli/commands.h"

#include <bit>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>

#include <unistd.h>

#include "apps/cli/files.h"
#include "apps/cli/limits.h"
#include "compile/compile.h"
#include "compile/inspect.h"
#include "doc/file_resolver.h"
#include "draw/loader.h"
#include "oracle/loader.h"

namespace shaderx::cli {

namespace {

// The dump that was asked for, on standard output.
struct PrintDump final : DumpSink {
    StageName stage{};
    bool active = false;
    bool wants(StageName s) override { return active && s == stage; }
    void dump(StageName, const std::string& text) override { std::fputs(text.c_str(), stdout); }
};

// A diagnostic, its kind in colour on a terminal.
void print(const Diagnostic& d) {
    std::string text = format(d);
    if (d.code == "limit" && d.hint.empty()) text += "  hint: --limit sets another one\n";
    static const bool colour = isatty(2) && !std::getenv("NO_COLOR");
    if (colour) {
        const char* word = d.severity == Severity::Warning ? "warning:" : "error:";
        if (std::size_t at = text.find(word); at != std::string::npos) {
            text.insert(at + std::string_view(word).size(), "\033[0m");
            text.insert(at, d.severity == Severity::Warning ? "\033[1;35m" : "\033[1;31m");
        }
    }
    std::fputs(text.c_str(), stderr);
}

// A run of the program: its compiler, and how it went so far.
struct Session {
    const Options& options;
    Compiler compiler{builtinLibrary()};
    PrintDump dumps{};
    Limits limits{};
    bool failed = false, bug = false, badUsage = false;

    // Prints what was found; what the step returned and errors decide the exit code.
    bool report(const Diagnostics& diagnostics, const std::string& replay = {}) {
        for (const Diagnostic& d : diagnostics.all()) print(d);
        if (diagnostics.hasInternal()) {
            bug = true;
            if (!replay.empty()) std::fprintf(stderr, "  replay: shaderx %s\n", replay.c_str());
        }
        failed = failed || diagnostics.hasErrors();
        return !diagnostics.hasErrors();
    }

    int exitCode() const { return bug ? kOurBug : badUsage ? kBadUsage : failed ? kInputErrors : kDone; }

    bool start() {
        Diagnostics diagnostics;
        if (std::string problem = limits.set(options.limits); !problem.empty()) {
            std::fprintf(stderr, "shaderx: %s\n", problem.c_str());
            badUsage = true;
            return false;
        }
        for (const std::string& folder : options.libraries) {
            std::vector<LibraryFile> files;
            if (readLibrary(folder, files, diagnostics)) compiler.addLibrary(std::move(files), diagnostics);
        }
        dumps.active = !options.dump.empty();
        if (dumps.active && !stageNamed(options.dump, dumps.stage)) {
            std::fprintf(stderr, "shaderx: there is no stage '%s'\n", options.dump.c_str());
            badUsage = true;
            return false;
        }
        return report(diagnostics);
    }

    std::unique_ptr<doc::Document> read(const std::string& file) {
        Diagnostics diagnostics;
        std::string text;
        std::unique_ptr<doc::Document> document;
        doc::FileResolver resolver(options.paths, limits.read.maxFileBytes);
        if (readInput(file, text, diagnostics, limits.read.maxFileBytes))
            document = compiler.read(file, std::move(text), resolver, diagnostics, limits.read);
        report(diagnostics, "validate " + file);
        return document;
    }

    // The elements that are asked for.
    std::vector<doc::ElementId> elements(const std::string& file, const doc::Document& document) {
        Diagnostics diagnostics;
        std::vector<doc::ElementId> found;
        if (options.element.empty()) {
            found = compiler.renderableElements(document);
            if (found.empty())
                diagnostics.error("nothing-to-render", "the document has no material and no output").where.file = file;
        } else if (doc::ElementId e = document.find(options.element)) {
            found.push_back(e);
        } else {
            diagnostics.error("unknown-element", "there is no element '" + options.element + "'").where.file = file;
        }
        report(diagnostics);
        return found;
    }

    GenerateOptions how() {
        GenerateOptions how;
        interfaceNamed(options.interface, how.interface);
        how.dumps = &dumps;
        how.maxDepth = limits.depth;
        how.maxExpressions = limits.expressions;
        if (options.light != "fis")
            how.environment = options.light == "none" ? EnvironmentLight::None : EnvironmentLight::Prefiltered;
        how.flipV = options.flipV;
        how.transparency = options.transparency;
        how.blocks = options.blocks;
        how.bindingBase = options.bindingBase;
        how.unit = options.unit;
        return how;
    }

    void reportElement(const std::string& file, const doc::Document& document, doc::ElementId element,
                       const Diagnostics& diagnostics) {
        report(diagnostics,
               "generate " + file + " --interface " + options.interface + " --element " + document.path(element));
    }

    Result<Shader> shaderOf(const std::string& file, const doc::Document& document, doc::ElementId element) {
        Diagnostics diagnostics;
        Result<Shader> shader = compiler.generate(document, element, how(), diagnostics);
        reportElement(file, document, element, diagnostics);
        return shader;
    }

    void write(const std::string& stem, const Shader& shader) {
        Diagnostics diagnostics;
        if (options.out == "-") {
            writeFile("-", shader.vertex + "\n" + shader.pixel, diagnostics);
        } else {
            std::string base = (std::filesystem::path(options.out) / stem).string();
            const std::string reflection = shader.reflection();
            const std::pair<const char*, std::string_view> files[] = {
                {".vert", shader.vertex}, {".frag", shader.pixel}, {".json", reflection}};
            std::size_t written = 0;
            while (written < std::size(files) &&
                   writeFile(base + files[written].first, files[written].second, diagnostics))
                written++;
            for (std::size_t i = 0; written < std::size(files) && i < written; i++)
                std::remove((base + files[i].first).c_str());
        }
        report(diagnostics);
    }
};

// What to compile of a document, and the names of its files.
struct Work {
    const std::string& file;
    std::unique_ptr<doc::Document> document;
    std::vector<doc::ElementId> elements = {};
    std::vector<std::string> stems = {};
};

}  // namespace

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
                                if (shader && writes) s.write(w.stems[next], *shader);
                                next++;
                            });
    }
    return s.exitCode();
}

int validate(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    for (const std::string& file : options.files) {
        std::unique_ptr<doc::Document> document = s.read(file);
        if (!document) continue;
        Diagnostics diagnostics;
        s.compiler.validate(*document, diagnostics);
        s.report(diagnostics, "validate " + file);
    }
    return s.exitCode();
}

int inspect(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    bool both = !options.lobes && !options.cost;
    std::vector<Inspection> found;
    for (const std::string& file : options.files) {
        std::unique_ptr<doc::Document> document = s.read(file);
        if (!document) continue;
        for (doc::ElementId element : s.elements(file, *document)) {
            Diagnostics diagnostics;
            Inspection one{document->path(element), {}, {}};
            if (both || options.lobes)
                if (auto lobes = s.compiler.lobes(*document, element, s.how(), diagnostics))
                    one.lobes = std::move(*lobes);
            if ((both || options.cost) && !diagnostics.hasErrors())
                if (auto costs = s.compiler.costs(*document, element, s.how(), diagnostics))
                    one.costs = std::move(*costs);
            if (s.report(diagnostics, "inspect " + file + " --element " + one.element)) found.push_back(std::move(one));
        }
    }
    std::string text = options.json ? inspectionJson(found) : inspectionText(found);
    std::fputs(text.c_str(), stdout);
    return s.exitCode();
}

// A file of a document: as it is, beside the document, or below a search path.
static std::string resolved(const Options& options, const std::string& document, const std::string& file) {
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (file.empty() || fs::path(file).is_absolute()) return file;
    fs::path beside = fs::path(document).parent_path() / file;
    if (fs::exists(beside, ignored)) return beside.string();
    for (const std::string& path : options.paths)
        if (fs::exists(fs::path(path) / file, ignored)) return (fs::path(path) / file).string();
    return beside.string();
}

// The default of a uniform, as numbers of any kind are set.
static std::vector<float> numbersOf(const UniformBinding& u) {
    std::vector<float> numbers;
    for (std::uint32_t w : u.value)
        numbers.push_back(ir::info(u.type).scalar == ir::Scalar::Float ? std::bit_cast<float>(w)
                                                                       : static_cast<float>(static_cast<int>(w)));
    return numbers;
}

int draw(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    const std::string& file = options.files[0];
    std::unique_ptr<doc::Document> document = s.read(file);
    if (!document) return s.exitCode();
    std::vector<doc::ElementId> elements = s.elements(file, *document);
    if (elements.empty()) return s.exitCode();
    Result<Shader> shader = s.shaderOf(file, *document, elements[0]);
    if (!shader || !options.dump.empty()) return s.exitCode();

    scene::Settings settings;
    settings.size = options.size;
    settings.samples = options.samples;
    settings.environment = options.environment;
    settings.exposure = options.exposure;
    settings.output = options.picture;
    for (const UniformBinding& u : shader->uniforms)
        if (u.block >= 0) settings.defaults.push_back({u.name, numbersOf(u)});
    for (const TextureBinding& t : shader->textures) {
        scene::Texture texture{
            t.uniform, resolved(options, file, t.file), t.uAddress, t.vAddress, t.filter, {0, 0, 0, 0}, t.path};
        std::size_t n = t.defaultColor.size();
        for (std::size_t i = 0; i < 4; i++)
            texture.defaultColor[i] = n == 1 ? t.defaultColor[0] : i < n ? t.defaultColor[i] : i == 3 ? 1.0f : 0.0f;
        settings.textures.push_back(std::move(texture));
    }
    Diagnostics diagnostics;
    if (options.with == "interpreter") {
        oracle::RenderJob job{std::move(settings), &shader->program->module, &shader->program->interface};
        oracle::drawWithModule(job, diagnostics);
    } else {
        draw::Job job{std::move(settings), shader->vertex, shader->pixel};
        draw::drawWithModule(job, diagnostics);
    }
    s.report(diagnostics);
    return s.exitCode();
}

}  // namespace shaderx::cli
