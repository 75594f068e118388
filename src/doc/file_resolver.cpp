#include "doc/file_resolver.h"

#include <algorithm>
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

// A path as the directory itself, "" where it is the current one.
static bool isBelow(std::string_view path, std::string_view directory) {
    std::string top = normalPath(directory);
    if (top.empty() && !directory.starts_with('/')) return !path.starts_with('/') && !path.starts_with("../");
    if (top == "/" || top.empty()) return path.starts_with('/');
    if (top.ends_with("..") && path.starts_with(top + "/..")) return false;
    return path.starts_with(top) && path.size() > top.size() && path[top.size()] == '/';
}

bool FileResolver::isWithin(std::string_view path) const {
    if (isBelow(path, *root_)) return true;
    for (const std::string& directory : searchPaths_)
        if (isBelow(path, directory)) return true;
    return false;
}

// The same for the file that is opened in the end, whatever links are on the way. The directories may be links too.
bool FileResolver::leadsWithin(const std::string& path) const {
    namespace fs = std::filesystem;
    auto real = [](std::string_view file) {
        std::error_code failed;
        fs::path found = fs::canonical(file.empty() ? fs::path(".") : fs::path(file), failed);
        return failed ? std::string() : found.string();
    };
    const std::string file = real(path);
    auto holds = [&](std::string_view directory) {
        const std::string top = real(directory);
        return !top.empty() && isBelow(file, top);
    };
    if (file.empty()) return false;
    return holds(*root_) || std::any_of(searchPaths_.begin(), searchPaths_.end(), holds);
}

std::optional<ResolvedFile> FileResolver::resolve(std::string_view href, std::string_view fromDirectory) {
    if (!root_) root_ = std::string(fromDirectory);
    leftByLink_ = false;
    auto tryIn = [&](std::string_view directory) -> std::optional<ResolvedFile> {
        std::string path;
        bool absolute = href.starts_with('/') || (href.size() > 1 && href[1] == ':');
        if (!absolute && !directory.empty()) path.append(directory).append("/");
        path = normalPath(path.append(href));
        if (!isWithin(path)) return {};
        if (!followsLinks_ && !leadsWithin(path)) {
            std::error_code ignored;
            leftByLink_ = leftByLink_ || std::filesystem::is_regular_file(path, ignored);
            return {};
        }
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

std::string FileResolver::hint() const {
    return leftByLink_
               ? "a symbolic link leads out of the document's folder and the search paths; --follow-links takes it"
               : "";
}

}  // namespace shaderx::doc
