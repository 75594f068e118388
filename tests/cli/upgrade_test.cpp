// `shaderx upgrade`: each tests/upgrade/NAME.mtlx becomes what NAME.expected shows, its edits included (SHADERX_BLESS=1
// rewrites that); documents are drawn the same before and after, and upgrading again changes nothing.
#include "support.h"

namespace shaderx::tests {
namespace {

const std::string kProgram = std::string("'") + SHADERX_PROGRAM + "'";

std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

class Upgraded : public testing::TestWithParam<fs::path> {};

TEST_P(Upgraded, IsAsExpected) {
    Ran ran = runCommand(kProgram + " upgrade --explain " + GetParam().filename().string(), GetParam().parent_path());
    EXPECT_EQ(ran.exitCode, 0);
    fs::path expected = GetParam();
    expectFile(expected.replace_extension(".expected"), ran.output + ran.errors);
}

INSTANTIATE_TEST_SUITE_P(All, Upgraded, testing::ValuesIn(filesOf(testFolder("upgrade"), ".mtlx")), testName);

// The shaders of a document, by file.
std::map<std::string, std::string> shadersOf(const fs::path& file, const fs::path& home, const fs::path& out) {
    runCommand(kProgram + " generate --interface baked --path " + quoted(home) + " -o " + quoted(out) + " " +
               quoted(file));
    std::map<std::string, std::string> all;
    if (fs::exists(out))
        for (const auto& entry : fs::directory_iterator(out))
            if (entry.path().extension() != ".json") all[entry.path().filename().string()] = fileText(entry.path());
    return all;
}

// Counts the documents that have shaders at all.
void expectSame(const fs::path& file, int& drawn) {
    OwnFolder own;
    const fs::path home = file.parent_path(), once = own.path() / file.filename();
    std::string path = " --path " + quoted(home);
    Ran first = runCommand(kProgram + " upgrade" + path + " -o " + quoted(once) + " " + quoted(file));
    if (first.exitCode != 0) {
        EXPECT_FALSE(fs::exists(once)) << file;
        EXPECT_NE(first.errors.find(": error: "), std::string::npos) << file << first.errors;
        return;
    }
    Ran second = runCommand(kProgram + " upgrade" + path + " " + quoted(once));
    EXPECT_EQ(second.output, fileText(once)) << file;
    std::map<std::string, std::string> before = shadersOf(file, home, own.path() / "before"),
                                       after = shadersOf(once, home, own.path() / "after");
    EXPECT_TRUE(before == after) << file;
    drawn += before.empty() ? 0 : 1;
}

TEST(Upgrade, OurDocumentsAreDrawnTheSame) {
    int drawn = 0;
    for (fs::path folder : {testFolder("upgrade"), testFolder("golden"), fs::path(SHADERX_SOURCE_DIR) / "examples"})
        for (const fs::path& file : filesOf(folder, ".mtlx")) expectSame(file, drawn);
    EXPECT_GE(drawn, 30);
}

TEST(Upgrade, SharedDocumentsAreDrawnTheSame) {
    fs::path shared = fs::path(SHADERX_SOURCE_DIR) / "../shared";
    std::vector<fs::path> files;
    for (const char* folder : {"resources/Materials", "cases"})
        if (fs::exists(shared / folder))
            for (const auto& entry : fs::recursive_directory_iterator(shared / folder))
                if (entry.path().extension() == ".mtlx") files.push_back(entry.path());
    if (files.empty()) GTEST_SKIP() << "../shared is not there";
    std::sort(files.begin(), files.end());
    const std::size_t step = std::getenv("SHADERX_ALL") ? 1 : 9;
    int drawn = 0;
    for (std::size_t i = 0; i < files.size(); i += step) expectSame(files[i], drawn);
    EXPECT_GT(drawn, 0);
}

TEST(Upgrade, LibrariesAreUpgradedToo) {
    OwnFolder own;
    writeText(own / "user.mtlx",
              "<materialx version='1.38'><turned name='t' type='color3'/><halved name='h' type='color3'>"
              "<input name='in' type='color3' nodename='t'/></halved><output name='o' type='color3' nodename='h'/>"
              "</materialx>");
    Ran ran = runCommand(kProgram + " generate --interface baked -o - --library " +
                             quoted(testFolder("upgrade") / "library") + " user.mtlx",
                         own.path());
    EXPECT_EQ(ran.exitCode, 0);
    EXPECT_EQ(ran.errors, "");
    EXPECT_NE(ran.output.find("0.125, 0.25, 0.5"), std::string::npos) << ran.output;
}

TEST(Upgrade, WhatCannotBeIsToldWithItsPlace) {
    OwnFolder own;
    writeText(own / "old.mtlx",
              "<materialx version='1.36'>\n<material name='M'><shaderref name='S'/></material>\n"
              "</materialx>");
    Ran ran = runCommand(kProgram + " generate -o out old.mtlx", own.path());
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_NE(ran.errors.find("old.mtlx:2:20: warning: nothing says which node the shader 'S' is [cannot-upgrade]"),
              std::string::npos)
        << ran.errors;
    EXPECT_NE(ran.errors.find("old.mtlx:2:1: error: "), std::string::npos) << ran.errors;
}

TEST(Upgrade, WritesWhereItIsTold) {
    OwnFolder own;
    writeText(own / "a.mtlx", "<materialx version='1.36'><rotate name='r' type='vector2'/></materialx>");
    writeText(own / "b.mtlx", "<materialx version='1.39'>  <!-- as it is -->\n</materialx>");
    fs::create_directories(own / "sub");
    fs::copy(own / "b.mtlx", own / "sub/b.mtlx");
    Ran both = runCommand(kProgram + " upgrade -o out a.mtlx b.mtlx", own.path());
    EXPECT_EQ(both.exitCode, 0) << both.errors;
    EXPECT_NE(fileText(own / "out/a.mtlx").find("<rotate2d name=\"r\""), std::string::npos);
    EXPECT_EQ(fileText(own / "out/b.mtlx"), fileText(own / "b.mtlx"));
    EXPECT_EQ(runCommand(kProgram + " upgrade a.mtlx b.mtlx", own.path()).exitCode, 2);
    Ran clash = runCommand(kProgram + " upgrade -o out b.mtlx sub/b.mtlx", own.path());
    EXPECT_EQ(clash.exitCode, 1);
    EXPECT_NE(clash.errors.find("[file-name-clash]"), std::string::npos) << clash.errors;
}

}  // namespace
}  // namespace shaderx::tests
