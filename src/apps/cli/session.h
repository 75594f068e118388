// What the commands that compile share: the compiler, what was asked for, and how it went so far.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/cli/commands.h"
#include "apps/cli/limits.h"
#include "compile/compile.h"

namespace shaderx::cli {

// The dump that was asked for, on standard output.
struct PrintDump final : DumpSink {
    StageName stage{};
    bool active = false;
    bool wants(StageName s) override { return active && s == stage; }
    void dump(StageName, const std::string& text) override;
};

// A run of the program.
struct Session {
    const Options& options;
    Compiler compiler{builtinLibrary()};
    PrintDump dumps{};
    Limits limits{};
    bool failed = false, bug = false, badUsage = false;

    // Prints what was found; what the step returned and errors decide the exit code.
    bool report(const Diagnostics& diagnostics, const std::string& replay = {});
    void reportElement(const std::string& file, const doc::Document& document, doc::ElementId element,
                       const Diagnostics& diagnostics);
    int exitCode() const { return bug ? kOurBug : badUsage ? kBadUsage : failed ? kInputErrors : kDone; }

    // Reads the libraries and checks the options that the command line left to check. False after errors.
    bool start();
    // A document, reported on; null after errors.
    std::unique_ptr<doc::Document> read(const std::string& file);
    // The elements that are asked for.
    std::vector<doc::ElementId> elements(const std::string& file, const doc::Document& document);
    GenerateOptions how();
};

}  // namespace shaderx::cli
