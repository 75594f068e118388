// One material at every stage, from document to text: tests/walk/wood/. It is the guided tour, and proves what holds of
// every stage: programs read back from their text, and print the same again. SHADERX_BLESS=1 rewrites what is expected.
#include <set>
#include <thread>

#include "compile/compile.h"
#include "ir/text.h"
#include "support.h"

namespace shaderx::tests {
namespace {

struct AllStages final : DumpSink {
    std::vector<std::pair<StageName, std::string>> dumps;
    bool wants(StageName) override { return true; }
    void dump(StageName stage, const std::string& text) override { dumps.emplace_back(stage, text); }
};

bool isProgram(StageName stage) { return stage >= StageName::Lower && stage <= StageName::Legalise; }

Result<Shader> generated(Compiler& compiler, const std::string& file, Interface interface, DumpSink* sink) {
    Diagnostics diagnostics;
    doc::NoIncludes none;
    auto document = compiler.read("wood.mtlx", fileText(file), none, diagnostics);
    if (!document) return Failure{};
    GenerateOptions how;
    how.interface = interface;
    how.dumps = sink;
    Result<Shader> shader =
        compiler.generate(*document, compiler.renderableElements(*document).at(0), how, diagnostics);
    EXPECT_EQ(diagnostics.text(), "");
    return shader;
}

TEST(Walk, EveryStageIsAsExpected) {
    fs::path folder = testFolder("walk") / "wood";
    AllStages stages;
    Compiler compiler(builtinLibrary());
    Result<Shader> shader = generated(compiler, (folder / "wood.mtlx").string(), Interface::Live, &stages);
    ASSERT_TRUE(shader);
    int number = 1;
    for (auto& [stage, text] : stages.dumps) {
        std::string name = (number < 10 ? "0" : "") + std::to_string(number) + "_" + std::string(nameOf(stage));
        number++;
        if (stage == StageName::Print) continue;  // the two texts stand in files of their own
        expectFile(folder / (name + (stage == StageName::Read ? ".xml" : isProgram(stage) ? ".ir" : ".txt")), text);
    }
    expectFile(folder / "10_print.vert", shader->vertex);
    expectFile(folder / "10_print.frag", shader->pixel);
    expectFile(folder / "10_print.json", shader->reflection());
}

TEST(Walk, EveryProgramReadsBack) {
    fs::path folder = testFolder("walk") / "wood";
    for (Interface interface : {Interface::Live, Interface::Baked}) {
        AllStages stages;
        Compiler compiler(builtinLibrary());
        ASSERT_TRUE(generated(compiler, (folder / "wood.mtlx").string(), interface, &stages));
        std::set<StageName> seen;
        for (auto& [stage, text] : stages.dumps) {
            if (!isProgram(stage)) continue;
            seen.insert(stage);
            NameTable names;
            ir::Module module(names);
            Diagnostics diagnostics;
            EXPECT_TRUE(ir::parse(module, nameOf(stage), text, diagnostics)) << diagnostics.text();
            EXPECT_EQ(ir::print(module), text) << nameOf(stage);
        }
        EXPECT_EQ(seen.size(), 6u);
    }
}

// The same bytes from any number of threads, each with a compiler of its own.
TEST(Walk, ThreadsAgree) {
    std::string file = (testFolder("walk") / "wood" / "wood.mtlx").string();
    std::vector<std::string> texts(4);
    std::vector<std::thread> threads;
    for (std::string& text : texts)
        threads.emplace_back([&text, &file] {
            Compiler compiler(builtinLibrary());
            for (int i = 0; i < 3; i++)
                if (Result<Shader> shader = generated(compiler, file, Interface::Live, nullptr)) text = shader->pixel;
        });
    for (std::thread& t : threads) t.join();
    for (const std::string& text : texts) EXPECT_EQ(text, texts[0]);
    EXPECT_FALSE(texts[0].empty());
}

}  // namespace
}  // namespace shaderx::tests
