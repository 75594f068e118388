// Libraries of nodes: declarations and bodies, from their files or from a precompiled image.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/diagnostics.h"
#include "doc/definitions.h"
#include "doc/document.h"
#include "ir/module.h"
#include "sl/compile.h"

namespace shaderx {

// A file of a library: `.mtlx` files declare, `.sl` files hold functions.
struct LibraryFile {
    std::string name, text;
};

// What every library offers: its document, with an index of its definitions, and functions by name.
class Library : public ir::FunctionSource {
  public:
    virtual const doc::Document& document() const = 0;
    virtual doc::DefinitionsIndex index() const = 0;
    // What portable code may call.
    virtual const std::vector<sl::Signature>& signatures() = 0;
    // All functions that are there without asking for them.
    virtual std::vector<const ir::Function*> functions() const = 0;
};

// A library from the texts of its files, in any order. All `.sl` files are compiled together and may call the functions
// of `below`. Errors are located in the files. Bodies of nodes are not made yet: see NodeBodies.
std::unique_ptr<Library> makeLibrary(NameTable& names, std::vector<LibraryFile> files, std::span<Library* const> below,
                                     Diagnostics& diagnostics);

// A precompiled library: read in place, functions decoded when first asked for. Null if the bytes are no such image.
// The name table must have been started from the same image.
std::unique_ptr<Library> openLibrary(NameTable& names, std::span<const std::uint8_t> image);

// The names of an image, to start a name table from; empty if the bytes are no image.
NameImage namesOf(std::span<const std::uint8_t> image);

// The image of a library: its document, the index of its definitions, and functions. `made` holds the bodies of its
// nodes.
std::vector<std::uint8_t> writeImage(const Library& library, std::span<const sl::Signature> signatures,
                                     std::span<const ir::Function* const> functions,
                                     std::span<const ir::LeafInfo> leaves, const NameTable& names);

}  // namespace shaderx
