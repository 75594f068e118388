// The sources of the node library compile together, to valid programs.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "ir/validate.h"
#include "sl/compile.h"

namespace shaderx::sl {

namespace fs = std::filesystem;

TEST(Nodes, Compile) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(fs::path(SHADERX_SOURCE_DIR) / "nodes"))
        if (entry.path().extension() == ".sl") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    std::vector<std::string> texts;
    for (const fs::path& p : paths) {
        std::stringstream text;
        text << std::ifstream(p).rdbuf();
        texts.push_back(text.str());
    }
    std::vector<SourceFile> files;
    for (std::size_t i = 0; i < paths.size(); i++) files.push_back({paths[i].filename().string(), texts[i]});
    NameTable names;
    ir::Module module(names);
    std::vector<Signature> made;
    Diagnostics diagnostics;
    EXPECT_TRUE(compile(module, files, {}, made, diagnostics));
    EXPECT_TRUE(ir::validate(module, diagnostics));
    EXPECT_EQ(diagnostics.text(), "");
    EXPECT_EQ(made.size(), module.functions.size());
}

}  // namespace shaderx::sl
