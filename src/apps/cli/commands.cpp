// The commands that say what is in a document.
#include <cstdio>
#include <utility>

#include "apps/cli/session.h"
#include "compile/inspect.h"

namespace shaderx::cli {

int validate(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    for (const std::string& file : options.files) {
        std::unique_ptr<doc::Document> document = s.read(file);
        if (!document) continue;
        Diagnostics diagnostics;
        s.compiler.validate(*document, diagnostics, s.how());
        s.report(diagnostics, "validate " + file);
    }
    return s.exitCode();
}

static Inspection inspected(Session& s, const doc::Document& document, doc::ElementId element,
                            Diagnostics& diagnostics) {
    const Options& o = s.options;
    const bool all = !o.lobes && !o.cost && !o.idle;
    Inspection one{document.path(element), {}, {}, {}};
    if (all || o.lobes)
        if (auto lobes = s.compiler.lobes(document, element, s.how(), diagnostics)) one.lobes = std::move(*lobes);
    if ((all || o.cost) && !diagnostics.hasErrors())
        if (auto costs = s.compiler.costs(document, element, s.how(), diagnostics)) one.costs = std::move(*costs);
    if ((all || o.idle) && !diagnostics.hasErrors()) {
        GenerateOptions how = s.how();
        how.dumps = nullptr;
        if (how.interface == Interface::Baked) how.interface = Interface::Live;  // which still knows its values
        Diagnostics own;
        Result<Shader> shader = s.compiler.generate(document, element, how, own);
        if (shader) one.withoutEffect = std::move(shader->withoutEffect);
        if (diagnostics.all().empty()) diagnostics = std::move(own);  // what the others tell, too
    }
    return one;
}

// What nothing reads has no effect either.
static void tellUnused(Session& s, const doc::Document& document) {
    Diagnostics all, unused;
    GenerateOptions how = s.how();
    how.dumps = nullptr;
    s.compiler.validate(document, all, how);
    for (const Diagnostic& d : all.all())
        if (d.code.starts_with("unused-")) unused.add(d);
    s.report(unused);
}

int inspect(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    std::vector<Inspection> found;
    for (const std::string& file : options.files) {
        std::unique_ptr<doc::Document> document = s.read(file);
        if (!document) continue;
        if (options.idle || (!options.lobes && !options.cost)) tellUnused(s, *document);
        for (doc::ElementId element : s.elements(*document)) {
            Diagnostics diagnostics;
            Inspection one = inspected(s, *document, element, diagnostics);
            if (s.report(diagnostics, "inspect " + file + " --element " + one.element)) found.push_back(std::move(one));
        }
    }
    std::string text = options.json ? inspectionJson(found) : visibleLines(inspectionText(found));
    std::fputs(text.c_str(), stdout);
    return s.exitCode();
}

}  // namespace shaderx::cli
