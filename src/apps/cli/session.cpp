#include "apps/cli/session.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>
#include <unistd.h>

#include "apps/cli/files.h"
#include "doc/file_resolver.h"

namespace shaderx::cli {

void PrintDump::dump(StageName, const std::string& text) { session.print(visibleLines(text)); }

// A diagnostic, its kind in colour on a terminal. A warning is told once: elements share what they are made of.
void Session::tell(const Diagnostic& d) {
    std::string text = format(d);
    if (d.severity == Severity::Warning && d.where.line && !told.insert(text).second) return;
    if (d.code == "limit" && d.hint.empty()) text += "  hint: --limit sets another one\n";
    static const bool colour = isatty(2) && !std::getenv("NO_COLOR");
    if (colour) {
        struct Word {
            std::string_view text, colour;
        };
        static constexpr Word kWords[] = {
            {"note:", "\033[1;36m"}, {"warning:", "\033[1;35m"}, {"error:", "\033[1;31m"}, {"error:", "\033[1;31m"}};
        const Word& word = kWords[static_cast<std::size_t>(d.severity)];
        if (std::size_t at = text.find(word.text); at != std::string::npos) {
            text.insert(at + word.text.size(), "\033[0m");
            text.insert(at, word.colour);
        }
    }
    std::fputs(text.c_str(), stderr);
}

// With --strict, every warning is an error.
static Diagnostics strictly(const Diagnostics& diagnostics) {
    Diagnostics strict;
    for (Diagnostic d : diagnostics.all()) {
        if (d.severity == Severity::Warning) d.severity = Severity::Error;
        strict.add(std::move(d));
    }
    return strict;
}

bool Session::report(const Diagnostics& found, const std::string& replay) {
    Diagnostics strict;  // a copy only where one is asked for: each element comes by here
    const Diagnostics& diagnostics = options.strict ? (strict = strictly(found)) : found;
    if (later && !diagnostics.all().empty()) later->sayings.push_back({{}, diagnostics, replay});
    if (later) return !diagnostics.hasErrors();
    for (const Diagnostic& d : diagnostics.all()) tell(d);
    if (diagnostics.hasInternal()) {
        bug = true;
        if (!replay.empty()) std::fprintf(stderr, "  replay: shaderx %s\n", visible(replay).c_str());
    }
    failed = failed || diagnostics.hasErrors();
    return !diagnostics.hasErrors();
}

void Session::say(const Later& kept) {
    for (const Later::Saying& each : kept.sayings) {
        if (!each.output.empty()) print(each.output);
        report(each.diagnostics, each.replay);
    }
}

void Session::print(const std::string& text) {
    Diagnostics diagnostics;
    if (later)
        later->sayings.push_back({text, {}, {}});
    else if (!writeFile("-", text, diagnostics))
        report(diagnostics);
}

bool Session::start() {
    Diagnostics diagnostics;
    if (std::string problem = limits.set(options.limits); !problem.empty()) {
        std::fprintf(stderr, "shaderx: %s\n", visible(problem).c_str());
        badUsage = true;
        return false;
    }
    for (const std::string& folder : options.libraries) {
        std::vector<LibraryFile> files;
        if (readLibrary(folder, files, diagnostics)) compiler.addLibrary(std::move(files), diagnostics);
    }
    dumps.active = !options.dump.empty();
    if (dumps.active && !stageNamed(options.dump, dumps.stage)) {
        std::fprintf(stderr, "shaderx: there is no stage '%s'\n", visible(options.dump).c_str());
        badUsage = true;
        return false;
    }
    return report(diagnostics);
}

std::unique_ptr<doc::Document> Session::read(const std::string& file, KeptFiles* kept) {
    Diagnostics diagnostics;
    std::string text;
    std::unique_ptr<doc::Document> document;
    doc::FileResolver files(options.paths, limits.read.maxFileBytes, options.followsLinks);
    RememberingResolver remembering(files, kept);
    doc::Resolver& resolver = kept ? static_cast<doc::Resolver&>(remembering) : files;
    const bool isKnown = kept && kept->text;
    if (isKnown) text = *kept->text;
    if (isKnown || readInput(file, text, diagnostics, limits.read.maxFileBytes)) {
        if (kept) kept->text = text;
        document = compiler.read(file, std::move(text), resolver, diagnostics, limits.read);
    }
    return report(diagnostics, "validate " + file) ? std::move(document) : nullptr;
}

std::unique_ptr<doc::Document> Session::readAgain(const std::string& file, const KeptFiles& kept) {
    Diagnostics diagnostics;
    RecallingResolver resolver(kept);
    auto document = compiler.read(file, kept.text.value_or(""), resolver, diagnostics, limits.read);
    if (!document) report(diagnostics, "validate " + file);  // for want of memory, say; warnings were told before
    return document;
}

void Session::unknownElement(const doc::Document& document, Diagnostics& diagnostics) {
    Diagnostic& e = diagnostics.error("unknown-element", "there is no element '" + options.element + "'");
    e.where = document.locate(document.root());
    std::vector<std::string> paths;
    for (std::uint32_t i = 0; i < document.size(); i++) paths.push_back(document.path(doc::ElementId(i)));
    if (const std::string_view near = nearest(options.element, {paths.begin(), paths.end()}); !near.empty()) {
        e.hint = fmt::format("did you mean '{}'?", near);
        return;
    }
    constexpr std::size_t kNamed = 6;
    const std::vector<doc::ElementId> all = compiler.renderableElements(document);
    for (std::size_t i = 0; i < std::min(all.size(), kNamed); i++)
        e.hint += (i ? ", " : "what it renders: ") + document.path(all[i]);
    if (all.size() > kNamed) e.hint += ", …";
}

std::vector<doc::ElementId> Session::elements(const doc::Document& document) {
    Diagnostics diagnostics;
    std::vector<doc::ElementId> found;
    if (options.element.empty()) {
        found = compiler.renderableElements(document);
        if (found.empty())
            doc::reportUnrendered(document, true, diagnostics);
        else
            doc::reportUnrendered(document, false, diagnostics);
    } else if (doc::ElementId e = document.find(options.element)) {
        found.push_back(e);
    } else {
        unknownElement(document, diagnostics);
    }
    return report(diagnostics) ? found : std::vector<doc::ElementId>();
}

GenerateOptions Session::how() {
    GenerateOptions how;
    interfaceNamed(options.interface, how.interface);
    how.dumps = &dumps;
    how.strict = options.strict;
    how.unknownIsDefault = options.unknown == "default";
    how.maxDepth = limits.depth;
    how.maxExpressions = limits.expressions;
    if (options.light != "fis")
        how.environment = options.light == "none" ? EnvironmentLight::None : EnvironmentLight::Prefiltered;
    how.flipV = options.flipV;
    how.transparency = options.transparency;
    how.blocks = options.blocks;
    how.bindingBase = options.bindingBase;
    how.unit = options.unit;
    how.colorspace = options.colorspace;
    return how;
}

void Session::reportElement(const std::string& file, const doc::Document& document, doc::ElementId element,
                            const Diagnostics& diagnostics) {
    report(diagnostics,
           "generate " + file + " --interface " + options.interface + " --element " + document.path(element));
}

}  // namespace shaderx::cli
