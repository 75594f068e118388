// What the tests of the whole program share: files, folders of their own, and running programs.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace shaderx::tests {

namespace fs = std::filesystem;

inline fs::path testFolder(const char* name) { return fs::path(SHADERX_SOURCE_DIR) / "tests" / name; }

// The content of a plain file; a message in its place where there is none.
inline std::string fileText(const fs::path& path) {
    std::FILE* in = fs::is_regular_file(path) ? std::fopen(path.c_str(), "rb") : nullptr;
    if (!in) return "(no such file: " + path.filename().string() + ")\n";
    std::string text;
    char buffer[65536];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, in)) > 0;) text.append(buffer, n);
    std::fclose(in);
    return text;
}

inline void writeText(const fs::path& path, std::string_view text) {
    std::FILE* out = std::fopen(path.c_str(), "wb");
    ASSERT_TRUE(out) << path;
    EXPECT_EQ(std::fwrite(text.data(), 1, text.size(), out), text.size());
    EXPECT_EQ(std::fclose(out), 0);
}

// SHADERX_BLESS=1 rewrites what is expected.
inline bool blessing() { return std::getenv("SHADERX_BLESS") != nullptr; }

inline void expectFile(const fs::path& path, const std::string& found) {
    if (blessing()) {
        writeText(path, found);
        return;
    }
    EXPECT_EQ(fileText(path), found) << path.filename().string() << " (SHADERX_BLESS=1 accepts what is found)";
}

// The files of a folder with that extension, in the order of their names.
inline std::vector<fs::path> filesOf(const fs::path& folder, std::string_view extension) {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == extension) all.push_back(entry.path());
    std::sort(all.begin(), all.end());
    return all;
}

// A file's name as the name of a test.
inline std::string testName(const testing::TestParamInfo<fs::path>& info) {
    std::string name = info.param.stem().string();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return name;
}

// An empty folder that goes away again.
class OwnFolder {
  public:
    OwnFolder() {
        std::string pattern = (fs::temp_directory_path() / "shaderx_test_XXXXXX").string();
        if (::mkdtemp(pattern.data())) path_ = pattern;
    }
    ~OwnFolder() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;
    const fs::path& path() const { return path_; }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  private:
    fs::path path_;
};

// What a program did. A program killed by a signal has an exit code of 128 and more.
struct Ran {
    int exitCode = -1;
    std::string output, errors;
};

// Runs a shell command; one that takes 200 seconds is stopped and has the exit code 124.
inline Ran runCommand(const std::string& command, const fs::path& folder = {}) {
    OwnFolder own;
    std::string line = folder.empty() ? "" : "cd '" + folder.string() + "' && ";
    line += "NO_COLOR=1 timeout 200 " + command + " 2>'" + own / "errors" + "'";
    Ran ran;
    std::FILE* pipe = ::popen(line.c_str(), "r");
    if (!pipe) return ran;
    char buffer[65536];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) ran.output.append(buffer, n);
    int status = ::pclose(pipe);
    ran.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ran.errors = fileText(own / "errors");
    return ran;
}

}  // namespace shaderx::tests
