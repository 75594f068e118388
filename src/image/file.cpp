#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "base/temporary_name.h"
#include "image/codecs.h"

namespace shaderx::image {

namespace fs = std::filesystem;

bool cannotWrite(const std::string& path, std::string_view reason, Diagnostics& diagnostics) {
    diagnostics.error("cannot-write-file", fmt::format("cannot write '{}': {}", path, reason)).where.file = path;
    return false;
}

// The reason why not, or an empty text.
static std::string writeWhole(const std::string& path, const char* mode, Bytes bytes) {
    errno = 0;
    std::FILE* file = std::fopen(path.c_str(), mode);
    if (!file) return std::strerror(errno);
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    const std::string reason = whole ? "" : std::strerror(errno);
    if (std::fclose(file) != 0 && whole) return std::strerror(errno);
    return reason;
}

bool writeFile(const std::string& path, Bytes bytes, Diagnostics& diagnostics) {
    std::error_code ignored;
    std::string target = path;
    // A link stays a link: what it names is replaced.
    if (fs::is_symlink(target, ignored)) {
        const fs::path named = fs::canonical(target, ignored);
        if (!ignored) target = named.string();
    }
    if (fs::is_directory(target, ignored)) return cannotWrite(path, "it is a directory", diagnostics);
    if (fs::exists(target, ignored) && !fs::is_regular_file(target, ignored)) {  // a pipe or device is not replaced
        const std::string reason = writeWhole(target, "wb", bytes);
        return reason.empty() || cannotWrite(path, reason, diagnostics);
    }
    const std::string partial = temporaryNameFor(target);
    std::string reason = writeWhole(partial, "wb", bytes);
    if (reason.empty() && std::rename(partial.c_str(), target.c_str()) != 0) reason = std::strerror(errno);
    if (reason.empty()) return true;
    fs::remove(partial, ignored);
    return cannotWrite(path, reason, diagnostics);
}

}  // namespace shaderx::image
