// Finds included files on disk. Opt-in: reading itself opens no file.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "doc/read.h"

namespace shaderx::doc {

// Looks in the including file's directory, then in each search path. Takes plain files only, up to the size limit, and
// only such as stand in the first file's directory, in a search path, or below: by their path and, unless links are
// followed, where symbolic links lead as well.
class FileResolver final : public Resolver {
  public:
    explicit FileResolver(std::vector<std::string> searchPaths = {}, std::size_t maxBytes = ReadOptions().maxFileBytes,
                          bool followsLinks = false)
        : searchPaths_(std::move(searchPaths)), maxBytes_(maxBytes), followsLinks_(followsLinks) {}
    std::optional<ResolvedFile> resolve(std::string_view href, std::string_view fromDirectory) override;
    std::string hint() const override;

  private:
    bool isWithin(std::string_view path) const;
    bool leadsWithin(const std::string& path) const;

    std::vector<std::string> searchPaths_;
    std::optional<std::string> root_;  // the directory that the first include came from
    std::size_t maxBytes_;
    bool followsLinks_, leftByLink_ = false;
};

// The content of a plain file, none if there is no such file, it is larger, or it cannot be read.
std::optional<std::string> readFile(const std::string& path, std::size_t maxBytes = ReadOptions().maxFileBytes);

}  // namespace shaderx::doc
