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

}  // namespace shaderx::cli
