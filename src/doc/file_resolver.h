// Finds included files on disk. Opt-in: reading itself opens no file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doc/read.h"

namespace shaderx::doc {

// Looks in the including file's directory, then in each search path. Takes plain files only, up to the size limit, and
// only such as stand, by their path, in the first file's directory, in a search path, or below.
class FileResolver final : public Resolver {
  public:
    explicit FileResolver(std::vector<std::string> searchPaths = {}, std::size_t maxBytes = ReadOptions().maxFileBytes)
        : searchPaths_(std::move(searchPaths)), maxBytes_(maxBytes) {}
    std::optional<ResolvedFile> resolve(std::string_view href, std::string_view fromDirectory) override;

  private:
    bool isWithin(std::string_view path) const;

    std::vector<std::string> searchPaths_;
    std::optional<std::string> root_;  // the directory that the first include came from
    std::size_t maxBytes_;
};

// The content of a plain file, none if there is no such file, it is larger, or it cannot be read.
std::optional<std::string> readFile(const std::string& path, std::size_t maxBytes = ReadOptions().maxFileBytes);

}  // namespace shaderx::doc
