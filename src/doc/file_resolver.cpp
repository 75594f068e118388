#include "doc/file_resolver.h"

#include <cstdio>
#include <filesystem>
#include <system_error>

namespace shaderx::doc {

std::optional<std::string> readFile(const std::string& path, std::size_t maxBytes) {
    std::error_code failed;
    if (path.find('\0') != std::string::npos || !std::filesystem::is_regular_file(path, failed)) return {};
    std::uintmax_t size = std::filesystem::file_size(path, failed);
    if (failed || size > maxBytes) return {};
    std::FILE* file = std::fopen(path.c_str(), "rb");
    if (!file) return {};
    std::string text(static_cast<std::size_t>(size), '\0');
    std::size_t got = text.empty() ? 0 : std::fread(text.data(), 1, text.size(), file);
    bool good = !std::ferror(file);
    std::fclose(file);
    if (!good) return {};
    text.resize(got);
    return text;
}

std::optional<ResolvedFile> FileResolver::resolve(std::string_view href, std::string_view fromDirectory) {
    auto tryIn = [&](std::string_view directory) -> std::optional<ResolvedFile> {
        std::string path;
        bool absolute = href.starts_with('/') || (href.size() > 1 && href[1] == ':');
        if (!absolute && !directory.empty()) path.append(directory).append("/");
        path = normalPath(path.append(href));
        std::optional<std::string> text = readFile(path, maxBytes_);
        if (!text) return {};
        std::string directoryOfFile = directoryOf(path);
        return ResolvedFile{std::move(path), std::move(directoryOfFile), std::move(*text)};
    };
    if (auto found = tryIn(fromDirectory)) return found;
    for (const std::string& directory : searchPaths_)
        if (auto found = tryIn(directory)) return found;
    return {};
}

}  // namespace shaderx::doc
