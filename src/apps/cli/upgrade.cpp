// The command that writes documents anew in the current version.
#include <cstdio>
#include <filesystem>
#include <map>

#include "apps/cli/session.h"
#include "doc/file_resolver.h"
#include "doc/write.h"

namespace shaderx::cli {

namespace fs = std::filesystem;

// Where each document is written to: a file, or files of the same names in a folder.
static std::string targetOf(const Options& options, const std::string& file, bool toFolder) {
    if (!toFolder) return options.out;
    return (fs::path(options.out) / (file == "-" ? fs::path("stdin.mtlx") : fs::path(file).filename())).string();
}

// "old.mtlx:5:3: <rotate name="r"> -> <rotate3d name="r">"
static std::string lineOf(const doc::Edit& e) {
    std::string line = e.where.file + ":" + std::to_string(e.where.line) + ":" + std::to_string(e.where.column) + ": ";
    line += e.was.empty() ? "added " + e.now : e.was + " -> " + e.now;
    if (!e.path.empty()) line += " [" + e.path + "]";
    return visible(line) + '\n';
}

static void upgradeOne(Session& s, const std::string& file, const std::string& target) {
    Diagnostics diagnostics;
    std::string text;
    doc::FileResolver resolver(s.options.paths, s.limits.read.maxFileBytes);
    std::unique_ptr<doc::Document> document;
    std::vector<doc::Edit> edits;
    if (readInput(file, text, diagnostics, s.limits.read.maxFileBytes))
        document = s.compiler.read(file, std::move(text), resolver, diagnostics, s.limits.read, &edits);
    if (!s.report(diagnostics, "upgrade " + file) || !document) return;
    // What an include brought in stays in its own file, which is as old as before.
    const doc::Source& own = document->sources()[0];
    std::erase_if(edits, [&](const doc::Edit& e) { return e.where.file != own.file; });
    Diagnostics written;
    writeFile(target, edits.empty() ? own.text : doc::write(*document), written);
    s.report(written);
    if (s.options.explain)
        for (const doc::Edit& e : edits) std::fputs(lineOf(e).c_str(), stderr);
}

int upgrade(const Options& options) {
    Session s{options};
    if (!s.start()) return s.exitCode();
    std::error_code unknown;
    bool console = options.out == "-";
    bool toFolder =
        !console && (options.files.size() > 1 || options.out.ends_with('/') || fs::is_directory(options.out, unknown));
    if (console && options.files.size() > 1) {
        std::fputs("shaderx: several documents need a folder to be written to: -o FOLDER\n", stderr);
        return kBadUsage;
    }
    Diagnostics diagnostics;
    if (toFolder && !makeFolder(options.out, diagnostics)) s.report(diagnostics);
    if (s.failed) return s.exitCode();
    std::map<std::string, int> targets;
    for (const std::string& file : options.files) targets[targetOf(options, file, toFolder)]++;
    for (const std::string& file : options.files) {
        std::string target = targetOf(options, file, toFolder);
        if (targets[target] > 1) {
            Diagnostics clash;
            clash.error("file-name-clash", "another document would be written to '" + target + "' too").where.file =
                file;
            s.report(clash);
            continue;
        }
        upgradeOne(s, file, target);
    }
    return s.exitCode();
}

}  // namespace shaderx::cli
