// What the commands that compile share: the compiler, what was asked for, and how it went so far.
#pragma once

#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "apps/cli/commands.h"
#include "apps/cli/files.h"
#include "apps/cli/limits.h"
#include "compile/compile.h"

namespace shaderx::cli {

// What a command has to say, kept until its turn comes: threads work in any order, but speak in that of one.
struct Later {
    struct Saying {
        std::string output;       // on standard output
        Diagnostics diagnostics;  // on standard error
        std::string replay;
    };
    std::vector<Saying> sayings;
};

struct Session;

// The dump that was asked for, on standard output.
struct PrintDump final : DumpSink {
    Session& session;
    StageName stage{};
    bool active = false;
    explicit PrintDump(Session& s) : session(s) {}
    bool wants(StageName s) override { return active && s == stage; }
    void dump(StageName, const std::string& text) override;
};

// A run of the program, or one thread's share of it.
struct Session {
    const Options& options;
    Compiler compiler{builtinLibrary()};
    PrintDump dumps{*this};
    Limits limits{};
    bool failed = false, bug = false, badUsage = false;
    Later* later = nullptr;                  // where what it has to say is kept, if it is
    std::unordered_set<std::string> told{};  // warnings

    // Keeps what it has to say from here on; say() says that of another session, and takes it into the exit code.
    void keepIn(Later& kept) { later = &kept; }
    void say(const Later& kept);
    // Writes to standard output; reports cannot-write.
    void print(const std::string& text);

    void tell(const Diagnostic& diagnostic);
    // Prints what was found; what the step returned and errors decide the exit code.
    bool report(const Diagnostics& diagnostics, const std::string& replay = {});
    void reportElement(const std::string& file, const doc::Document& document, doc::ElementId element,
                       const Diagnostics& diagnostics);
    int exitCode() const { return bug ? kOurBug : badUsage ? kBadUsage : failed ? kInputErrors : kDone; }

    void unknownElement(const doc::Document& document, Diagnostics& diagnostics);

    // Reads the libraries and checks the options that the command line left to check. False after errors.
    bool start();
    // A document, reported on; null after errors. With `kept`, a text that is there already is taken, and its files are
    // remembered.
    std::unique_ptr<doc::Document> read(const std::string& file, KeptFiles* kept = nullptr);
    // The same document once more, from what was remembered of it. Any number of threads may do so.
    std::unique_ptr<doc::Document> readAgain(const std::string& file, const KeptFiles& kept);
    // The elements that are asked for.
    std::vector<doc::ElementId> elements(const doc::Document& document);
    GenerateOptions how();
};

}  // namespace shaderx::cli
