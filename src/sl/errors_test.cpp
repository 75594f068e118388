// Messages are snapshots: tests/errors/sl/NAME.sl gives the diagnostics of NAME.expected. SHADERX_BLESS=1 rewrites
// them.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "sl/compile.h"

namespace shaderx::sl {

namespace fs = std::filesystem;

static std::string readAll(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

TEST(Errors, AsExpected) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(fs::path(SHADERX_SOURCE_DIR) / "tests/errors/sl"))
        if (entry.path().extension() == ".sl") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    ASSERT_FALSE(files.empty());
    for (const fs::path& file : files) {
        std::string text = readAll(file);
        SourceFile source{file.filename().string(), text};
        NameTable names;
        ir::Module module(names);
        std::vector<Signature> made;
        Diagnostics diagnostics;
        bool good = compile(module, std::span(&source, 1), {}, made, diagnostics);
        EXPECT_EQ(good, !diagnostics.hasErrors());
        EXPECT_EQ(good, !module.functions.empty());
        fs::path expected = fs::path(file).replace_extension(".expected");
        if (std::getenv("SHADERX_BLESS")) std::ofstream(expected, std::ios::binary) << diagnostics.text();
        EXPECT_EQ(diagnostics.text(), readAll(expected)) << file.filename();
    }
}

}  // namespace shaderx::sl
