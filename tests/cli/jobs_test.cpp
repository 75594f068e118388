// Threads change nothing but the time: files, messages with their order, standard output and exit code are those of
// one.
#include <map>

#include <fcntl.h>

#include "support.h"

namespace shaderx::tests {
namespace {

const std::string kProgram = std::string("'") + SHADERX_PROGRAM + "'";

// All that a run leaves, as text: file by file, then what it said.
struct Left {
    std::map<std::string, std::string> files;
    std::string output, errors;
    int exitCode = -1;
};

Left leftBy(const std::string& arguments, const std::string& rest = {}) {
    OwnFolder own;
    Ran ran = runCommand(kProgram + " " + arguments + rest, own.path());
    Left left{{}, ran.output, ran.errors, ran.exitCode};
    for (const auto& entry : fs::recursive_directory_iterator(own.path()))
        if (entry.is_regular_file()) left.files[entry.path().filename().string()] = fileText(entry.path());
    return left;
}

// What one thread leaves, after finding that 2 and 7 leave the same.
Left expectSame(const std::string& arguments, const std::string& rest = {}) {
    const Left one = leftBy(arguments + " --jobs 1", rest);
    for (const char* jobs : {"2", "7"}) {
        const Left several = leftBy(arguments + " --jobs " + jobs, rest);
        EXPECT_EQ(several.exitCode, one.exitCode) << arguments << " --jobs " << jobs;
        EXPECT_EQ(several.output, one.output) << arguments << " --jobs " << jobs;
        EXPECT_EQ(several.errors, one.errors) << arguments << " --jobs " << jobs;
        EXPECT_EQ(several.files.size(), one.files.size()) << arguments << " --jobs " << jobs;
        for (const auto& [name, text] : one.files) {
            auto found = several.files.find(name);
            EXPECT_EQ(found == several.files.end() ? "(no such file)" : found->second, text) << name << ", " << jobs;
        }
    }
    return one;
}

std::string inQuotes(const fs::path& path) { return " '" + path.string() + "'"; }

// Our examples and test documents, the broken ones too, and MaterialX's examples where they are.
std::string allDocuments() {
    std::string files;
    for (const char* folder : {"golden", "errors/cli", "errors/doc"})
        for (const fs::path& f : filesOf(testFolder(folder), ".mtlx")) files += inQuotes(f);
    for (const fs::path& f : filesOf(fs::path(SHADERX_SOURCE_DIR) / "examples", ".mtlx")) files += inQuotes(f);
    const fs::path foreign = fs::path(SHADERX_SOURCE_DIR) / "../shared/resources/Materials/Examples";
    if (fs::is_directory(foreign))
        for (const auto& entry : fs::directory_iterator(foreign))
            for (const fs::path& f : filesOf(entry.path(), ".mtlx")) files += inQuotes(f);
    return files + inQuotes("nowhere.mtlx");
}

TEST(GenerateJobs, AllDocumentsInAllInterfaces) {
    for (const char* interface : {"live", "complete", "baked"}) {
        const Left left = expectSame(std::string("generate -o out --interface ") + interface + allDocuments());
        EXPECT_EQ(left.exitCode, 1);
        EXPECT_GT(left.files.size(), 100u);
        EXPECT_NE(left.errors.find("nowhere.mtlx: error: "), std::string::npos) << left.errors;
    }
}

TEST(GenerateJobs, OnStandardOutput) {
    for (const char* options : {"-o -", "--dump read", "--dump lower"}) {
        const Left left = expectSame(std::string("generate ") + options + allDocuments());
        EXPECT_GT(left.output.size(), 10000u);
    }
}

// 60 outputs in a row, of nodes that share nodedefs; every third fails for a body, another for a node, in one document
// whose nodedefs come from an include.
void writeMany(const fs::path& folder) {
    writeText(folder / "defs.mtlx", R"(<?xml version="1.0"?>
<materialx version="1.39">
  <nodedef name="ND_bad" node="bad"><input name="in" type="float" value="0"/><output name="out" type="float"/></nodedef>
  <implementation name="IM_bad" nodedef="ND_bad" sourcecode="{{in}} + + nope("/>
  <nodedef name="ND_good" node="good"><input name="in" type="float" value="0"/><output name="out" type="float"/></nodedef>
  <implementation name="IM_good" nodedef="ND_good" sourcecode="{{in}} * 2.0"/>
  <nodedef name="ND_deep" node="deep"><input name="in" type="float" value="0"/><output name="out" type="float"/></nodedef>
  <nodegraph name="NG_deep" nodedef="ND_deep">
    <good name="b" type="float"><input name="in" type="float" interfacename="in"/></good>
    <noise2d name="n" type="float"><input name="amplitude" type="float" nodename="b"/></noise2d>
    <output name="out" type="float" nodename="n"/>
  </nodegraph>
</materialx>
)");
    std::string text =
        "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" xmlns:xi=\"http://www.w3.org/2001/XInclude\">\n"
        "<xi:include href=\"defs.mtlx\"/>\n";
    const char* const kinds[] = {"bad", "good", "deep", "unheard_of"};
    for (int i = 0; i < 60; i++) {
        const std::string n = std::to_string(i), kind = kinds[i % 4];
        text += "<" + kind + " name=\"n" + n + "\" type=\"float\"><input name=\"in\" type=\"float\" value=\"" + n +
                "\"/></" + kind + ">\n<output name=\"o" + n + "\" type=\"float\" nodename=\"n" + n + "\"/>\n";
    }
    writeText(folder / "many.mtlx", text + "</materialx>\n");
}

TEST(GenerateJobs, OneDocumentOfManyElements) {
    OwnFolder own;
    writeMany(own.path());
    const Left left = expectSame("generate -o out" + inQuotes(own / "many.mtlx"));
    EXPECT_EQ(left.exitCode, 1);
    EXPECT_EQ(left.files.size(), 90u);
    EXPECT_NE(left.errors.find("IM_bad"), std::string::npos) << left.errors;
}

TEST(GenerateJobs, StandardInputIsReadOnce) {
    OwnFolder own;
    writeMany(own.path());
    const std::string gold = inQuotes(testFolder("golden") / "gold.mtlx"), many = inQuotes(own / "many.mtlx");
    const Left left = expectSame("generate -o - -" + gold + " -" + many, " <" + gold);
    EXPECT_NE(left.output.find("gl_Position"), std::string::npos);
    expectSame("generate -o out - --path" + inQuotes(own.path()), " <" + many);
}

TEST(GenerateJobs, NamesThatClashAndFoldersThatAreNone) {
    OwnFolder own;
    writeMany(own.path());
    const std::string many = inQuotes(own / "many.mtlx");
    const Left left = expectSame("generate -o out" + many + many);
    EXPECT_TRUE(left.files.empty());
    EXPECT_NE(left.errors.find("[file-name-clash]"), std::string::npos);
    EXPECT_EQ(expectSame("generate -o" + many + many).exitCode, 1);
    EXPECT_EQ(expectSame("generate -o out --library nowhere" + many).exitCode, 1);
    EXPECT_EQ(expectSame("generate -o out --limit depth=many" + many).exitCode, 2);
}

TEST(GenerateJobs, NoneIsOneACore) {
    const std::string gold = inQuotes(testFolder("golden") / "gold.mtlx");
    const Left one = leftBy("generate -o out" + gold), all = leftBy("generate -o out --jobs 0" + gold);
    EXPECT_EQ(one.files.size(), 3u);
    EXPECT_EQ(all.files, one.files);
    for (const char* jobs : {"-1", "many", "2000"})
        EXPECT_EQ(leftBy(std::string("generate -o out --jobs ") + jobs + gold).exitCode, 2) << jobs;
}

// A material of three pictures that are not there.
std::string drawing() {
    return "draw --with interpreter --size 40 --samples 9 -o x.pfm" + inQuotes(testFolder("golden") / "textured.mtlx");
}

TEST(DrawJobs, TheInterpreterDrawsTheSamePicture) {
    const fs::path examples = fs::path(SHADERX_SOURCE_DIR) / "examples";
    for (const fs::path& f : {examples / "lacquered_wood.mtlx", examples / "peach.mtlx"}) {
        const Left left = expectSame("draw --with interpreter --size 24 --samples 5 -o x.pfm" + inQuotes(f));
        EXPECT_EQ(left.exitCode, 0) << left.errors;
        EXPECT_EQ(left.files.size(), 1u);
    }
    EXPECT_NE(expectSame(drawing()).errors.find("[missing-texture]"), std::string::npos);
    EXPECT_EQ(expectSame("draw --with interpreter -o x.pfm nowhere.mtlx").exitCode, 1);
}

TEST(DrawJobs, ProgressIsToldInLines) {
    const Left silent = leftBy(drawing()), told = leftBy(drawing() + " --progress");
    EXPECT_EQ(silent.errors.find("drawing:"), std::string::npos) << silent.errors;
    EXPECT_NE(told.errors.find("drawing: 100 %\n"), std::string::npos) << told.errors;
    EXPECT_EQ(told.files, silent.files);
}

// A terminal shows one line, which is gone in the end.
TEST(DrawJobs, ProgressIsALineOnATerminal) {
    const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
    if (terminal < 0 || ::grantpt(terminal) || ::unlockpt(terminal)) GTEST_SKIP() << "there are no terminals here";
    const std::string other = ::ptsname(terminal);
    const int kept = ::open(other.c_str(), O_RDWR | O_NOCTTY);  // so that what was written stays to be read
    ASSERT_GE(kept, 0);
    ASSERT_EQ(::fcntl(terminal, F_SETFL, O_NONBLOCK), 0);
    const std::string gold = inQuotes(testFolder("golden") / "gold.mtlx");
    const auto shownBy = [&](const std::string& options) {
        OwnFolder own;
        const std::string command = kProgram + " draw --with interpreter --jobs 1 -o x.pfm " + options + gold;
        EXPECT_EQ(runCommand("sh -c \"" + command + " 2>" + other + "\"", own.path()).exitCode, 0);
        std::string shown;
        char buffer[4096];
        for (ssize_t n; (n = ::read(terminal, buffer, sizeof buffer)) > 0;)
            shown.append(buffer, static_cast<std::size_t>(n));
        return shown;
    };
    const std::string shown = shownBy("--size 128 --samples 2048"), erased = "\r\033[K";
    EXPECT_NE(shown.find("\rdrawing: "), std::string::npos) << shown;
    EXPECT_NE(shown.find(" s left"), std::string::npos) << shown;
    EXPECT_EQ(shown.find('\n'), std::string::npos) << shown;
    ASSERT_GE(shown.size(), erased.size());
    EXPECT_EQ(shown.substr(shown.size() - erased.size()), erased);
    ::close(kept);
    ::close(terminal);
}

}  // namespace
}  // namespace shaderx::tests
