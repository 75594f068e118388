// The program's dealings with files.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics.h"
#include "compile/library.h"
#include "doc/read.h"

namespace shaderx::cli {

// A whole plain file, or standard input for "-". Reports where it can't.
bool readInput(const std::string& file, std::string& text, Diagnostics& diagnostics,
               std::size_t maxBytes = doc::ReadOptions().maxFileBytes);

// The text of a document and what its includes meant, each by its name and the directory that it is relative to.
struct KeptFiles {
    std::optional<std::string> text;
    std::map<std::pair<std::string, std::string>, std::optional<doc::ResolvedFile>> includes;
};

// Asks another resolver, and remembers what it says.
class RememberingResolver final : public doc::Resolver {
  public:
    RememberingResolver(doc::Resolver& source, KeptFiles* kept) : source_(source), kept_(kept) {}
    std::optional<doc::ResolvedFile> resolve(std::string_view href, std::string_view fromDirectory) override;
    std::string hint() const override { return source_.hint(); }

  private:
    doc::Resolver& source_;
    KeptFiles* kept_;
};

// Says what was remembered, and opens no file.
class RecallingResolver final : public doc::Resolver {
  public:
    explicit RecallingResolver(const KeptFiles& kept) : kept_(kept) {}
    std::optional<doc::ResolvedFile> resolve(std::string_view href, std::string_view fromDirectory) override;

  private:
    const KeptFiles& kept_;
};

// Writes beside the file and renames, so that there is never half a file. "-" is standard output.
bool writeFile(const std::string& file, std::string_view text, Diagnostics& diagnostics);

// Makes a folder and those above it.
bool makeFolder(const std::string& folder, Diagnostics& diagnostics);

// The .mtlx and .sl files of a folder and of those below it, in the order of their paths. Says where there is none.
bool readLibrary(const std::string& folder, std::vector<LibraryFile>& files, Diagnostics& diagnostics);

// "dir/gold.mtlx" as "gold"; standard input as "stdin".
std::string stemOf(const std::string& file);

// What an element's files are called: its path with every sign but letters, digits and _ as _.
std::string fileNameOf(std::string_view path);

}  // namespace shaderx::cli
