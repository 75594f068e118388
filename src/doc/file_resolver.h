// Finds included files on disk. Opt-in: reading itself opens no file.
#pragma once

#include <string>
#include <vector>

#include "doc/read.h"

namespace shaderx::doc {

// Looks in the including file's directory, then in each search path. Takes plain files only, up to the size limit.
class FileResolver final : public Resolver {
  public:
    explicit FileResolver(std::vector<std::string> searchPaths = {}, std::size_t maxBytes = std::size_t(1) << 30)
        : searchPaths_(std::move(searchPaths)), maxBytes_(maxBytes) {}
    std::optional<ResolvedFile> resolve(std::string_view href, std::string_view fromDirectory) override;

  private:
    std::vector<std::string> searchPaths_;
    std::size_t maxBytes_;
};

// The content of a plain file, none if there is no such file, it is larger, or it cannot be read.
std::optional<std::string> readFile(const std::string& path, std::size_t maxBytes = std::size_t(1) << 30);

}  // namespace shaderx::doc
