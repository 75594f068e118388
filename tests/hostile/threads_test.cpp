// Compilers of their own on threads of their own share nothing but the built-in library, which is read in place. So do
// the program's own threads, and the interpreter's share what none writes. Built with ThreadSanitizer too (preset
// tsan).
#include <thread>

#include "hostile.h"

namespace shaderx::tests {
namespace {

struct Job {
    std::string file, text;
};

// Everything that comes of the jobs, one after the other, as one text.
std::string generateAll(const std::vector<Job>& jobs, Interface interface) {
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    std::string all;
    for (const Job& job : jobs) {
        auto document = compiler.read(job.file, job.text, none, diagnostics);
        if (!document) continue;
        compiler.validate(*document, diagnostics);
        GenerateOptions how;
        how.interface = interface;
        for (doc::ElementId element : compiler.renderableElements(*document))
            if (auto shader = compiler.generate(*document, element, how, diagnostics))
                all += shader->vertex + shader->pixel;
    }
    return all + diagnostics.text();
}

TEST(Threads, GenerateTheSameAsOne) {
    std::vector<Job> jobs;
    std::vector<fs::path> files = ownDocuments();
    fs::path foreign = fs::path(SHADERX_SOURCE_DIR) / "../shared/resources/Materials/Examples/StandardSurface";
    if (fs::is_directory(foreign))
        for (const fs::path& f : filesOf(foreign, ".mtlx")) files.push_back(f);
    for (const fs::path& f : files) jobs.push_back({f.filename().string(), fileText(f)});
    ASSERT_GT(jobs.size(), 20u);
    const std::string live = generateAll(jobs, Interface::Live), baked = generateAll(jobs, Interface::Baked);
    ASSERT_GT(live.size(), 100000u);

    constexpr int kThreads = 4;
    std::string found[kThreads];
    std::vector<std::thread> threads;
    for (int i = 0; i < kThreads; i++)
        threads.emplace_back([&, i] { found[i] = generateAll(jobs, i % 2 ? Interface::Baked : Interface::Live); });
    for (std::thread& t : threads) t.join();
    for (int i = 0; i < kThreads; i++) EXPECT_EQ(found[i], i % 2 ? baked : live) << "thread " << i;
}

// A race makes the program fail where ThreadSanitizer watches it; tests/cli/jobs_test compares what comes out.
TEST(Threads, OfTheProgram) {
    const std::string program = std::string("'") + SHADERX_PROGRAM + "'";
    std::string files;
    for (const fs::path& f : ownDocuments()) files += " '" + f.string() + "'";
    const std::string wood = " '" + (fs::path(SHADERX_SOURCE_DIR) / "examples/lacquered_wood.mtlx").string() + "'";
    for (const std::string& command : {"generate --jobs 4 -o -" + files, std::string("generate --jobs 3 -o one") + wood,
                                       "draw --with interpreter --jobs 4 --size 16 --samples 3 -o x.pfm" + wood}) {
        OwnFolder own;
        const Ran ran = runCommand(program + " " + command, own.path());
        EXPECT_EQ(ran.exitCode, 0) << command << "\n" << ran.errors;
    }
}

}  // namespace
}  // namespace shaderx::tests
