// Reads MaterialX XML into a document, with its includes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "doc/document.h"

namespace shaderx::doc {

struct ResolvedFile {
    std::string file;  // the file's one name: tells whether two includes mean the same file, and stands in messages
    std::string directory;  // what the file's own includes are relative to
    std::string text;
};

// Finds what an include means. This room opens no files of its own accord; see file_resolver.h for one that does.
struct Resolver {
    virtual ~Resolver() = default;
    // None where there is no such file.
    virtual std::optional<ResolvedFile> resolve(std::string_view href, std::string_view fromDirectory) = 0;
    // Why it found the last one not to be there, where there is more to say.
    virtual std::string hint() const { return {}; }
};

// A resolver for documents that stand alone: every include is missing.
struct NoIncludes final : Resolver {
    std::optional<ResolvedFile> resolve(std::string_view, std::string_view) override { return {}; }
};

struct ReadOptions {
    std::uint32_t maxIncludeDepth = 32;
    std::uint32_t maxElements = 8u << 20;  // and twice as many tags and attributes
    std::uint32_t maxNesting = 1024;
    std::uint32_t maxAttributes = 10000;        // of one element
    std::size_t maxAttributeBytes = 16u << 20;  // of each attribute and text
    std::size_t maxFileBytes = std::size_t(1) << 28;
};

// Reads a text into an empty document (as the constructor leaves it) and returns its root. Each xi:include stays as a
// mark, followed by the top-level elements of the file it means, on which the included root's fileprefix, colorspace
// and namespace are set where they have none; a namespace also goes before their names ("space:name"). A file that is
// included twice is merged once. All errors are reported; after an error the document is incomplete.
// Error codes: bad-xml, bad-encoding, not-materialx, bad-version, duplicate-attribute, missing-include, include-cycle,
// limit.
Result<ElementId> read(Document& document, std::string_view fileName, std::string text, Resolver& resolver,
                       Diagnostics& diagnostics, const ReadOptions& options = {});

// "a/../b/./c" as "b/c": without touching any file.
std::string normalPath(std::string_view path);
// What stands before the last slash; empty where there is none.
std::string directoryOf(std::string_view path);

}  // namespace shaderx::doc
