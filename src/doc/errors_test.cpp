// The messages of wrong documents: each tests/errors/doc/NAME.mtlx with what is said about it in NAME.expected.
// SHADERX_BLESS=1 rewrites the expected files.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "doc/check.h"
#include "doc/file_resolver.h"
#include "doc/test_documents.h"
#include "doc/upgrade.h"

namespace shaderx::doc {
namespace {

std::filesystem::path folder() { return std::filesystem::path(SHADERX_SOURCE_DIR) / "tests/errors/doc"; }

// Includes by their bare names, so that no folder stands in a message.
struct FolderFiles final : Resolver {
    std::optional<ResolvedFile> resolve(std::string_view href, std::string_view) override {
        std::optional<std::string> text = readFile((folder() / href).string());
        if (!text) return {};
        return ResolvedFile{std::string(href), "", std::move(*text)};
    }
};

std::string messages(const std::filesystem::path& file) {
    NameTable names;
    Document library(names), d(names);
    readInto(library, kTestLibrary, "library.mtlx");
    Diagnostics diagnostics;
    FolderFiles files;
    if (read(d, file.filename().string(), readFile(file.string()).value_or(""), files, diagnostics)) {
        upgrade(d, diagnostics);
        Definitions definitions;
        definitions.add(d);
        definitions.add(library);
        validate(d, definitions, diagnostics);
    }
    return diagnostics.text();
}

TEST(ErrorMessages, AreAsExpected) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder()))
        if (entry.path().extension() == ".mtlx") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    EXPECT_GT(files.size(), 10u);
    for (const auto& file : files) {
        std::string found = messages(file);
        std::filesystem::path expected = file;
        expected.replace_extension(".expected");
        if (std::getenv("SHADERX_BLESS")) {
            std::FILE* out = std::fopen(expected.string().c_str(), "wb");
            ASSERT_TRUE(out);
            std::fwrite(found.data(), 1, found.size(), out);
            std::fclose(out);
        }
        EXPECT_EQ(found, readFile(expected.string()).value_or("(no such file)")) << file.filename();
    }
}

}  // namespace
}  // namespace shaderx::doc
