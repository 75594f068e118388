#include "apps/cli/files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/temporary_name.h"
#include "doc/file_resolver.h"

namespace shaderx::cli {

namespace fs = std::filesystem;

bool readInput(const std::string& file, std::string& text, Diagnostics& diagnostics, std::size_t maxBytes) {
    if (file == "-") {  // one that goes on for ever is cut; the reader says that it is too long
        char buffer[65536];
        for (std::size_t n; text.size() <= maxBytes && (n = std::fread(buffer, 1, sizeof buffer, stdin)) > 0;)
            text.append(buffer, n);
        return true;
    }
    std::optional<std::string> read = doc::readFile(file, maxBytes);
    if (!read) {
        std::error_code unknown;
        std::uintmax_t size = fs::is_regular_file(file, unknown) ? fs::file_size(file, unknown) : 0;
        bool tooLarge = !unknown && size > maxBytes;
        Diagnostic& e =
            tooLarge ? diagnostics.error("limit", "the file is larger than " + std::to_string(maxBytes) + " bytes")
                     : diagnostics.error("cannot-read", "cannot read this file");
        e.where.file = file;
        return false;
    }
    text = std::move(*read);
    return true;
}

std::optional<doc::ResolvedFile> RememberingResolver::resolve(std::string_view href, std::string_view fromDirectory) {
    std::optional<doc::ResolvedFile> found = source_.resolve(href, fromDirectory);
    if (kept_) kept_->includes[{std::string(href), std::string(fromDirectory)}] = found;
    return found;
}

std::optional<doc::ResolvedFile> RecallingResolver::resolve(std::string_view href, std::string_view fromDirectory) {
    const auto found = kept_.includes.find({std::string(href), std::string(fromDirectory)});
    return found == kept_.includes.end() ? std::nullopt : found->second;
}

bool writeFile(const std::string& file, std::string_view text, Diagnostics& diagnostics) {
    bool console = file == "-";
    std::string beside = temporaryNameFor(file);
    std::FILE* out = console ? stdout : std::fopen(beside.c_str(), "wb");
    bool ok = out && std::fwrite(text.data(), 1, text.size(), out) == text.size();
    if (out) ok = (console ? std::fflush(out) : std::fclose(out)) == 0 && ok;
    if (ok && !console) ok = std::rename(beside.c_str(), file.c_str()) == 0;
    if (ok) return true;
    diagnostics.error("cannot-write", std::string("cannot write this file: ") + std::strerror(errno)).where.file = file;
    if (out && !console) std::remove(beside.c_str());
    return false;
}

bool makeFolder(const std::string& folder, Diagnostics& diagnostics) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (!failed && fs::is_directory(folder, failed)) return true;
    diagnostics.error("cannot-write", "cannot make this folder").where.file = folder;
    return false;
}

bool readLibrary(const std::string& folder, std::vector<LibraryFile>& files, Diagnostics& diagnostics) {
    std::error_code failed;
    fs::recursive_directory_iterator it(folder, failed);
    std::vector<std::string> found;
    for (; !failed && it != fs::recursive_directory_iterator(); it.increment(failed)) {
        const std::string extension = it->path().extension().string();
        if (extension == ".mtlx" || extension == ".sl") found.push_back(it->path().string());
    }
    if (failed) {
        diagnostics.error("cannot-read", "cannot read this folder").where.file = folder;
        return false;
    }
    if (found.empty()) {
        Diagnostic& w = diagnostics.warning("empty-library", "the folder has no .mtlx and no .sl file");
        w.where.file = folder;
    }
    std::sort(found.begin(), found.end());
    bool ok = true;
    for (std::string& name : found) {
        LibraryFile file{std::move(name), {}};
        ok = readInput(file.name, file.text, diagnostics) && ok;
        files.push_back(std::move(file));
    }
    return ok;
}

std::string stemOf(const std::string& file) { return file == "-" ? "stdin" : fs::path(file).stem().string(); }

std::string fileNameOf(std::string_view path) {
    std::string out;
    for (char c : path) {
        bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        out += plain ? c : '_';
    }
    return out;
}

}  // namespace shaderx::cli
