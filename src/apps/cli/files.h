// The program's dealings with files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "compile/library.h"
#include "doc/read.h"

namespace shaderx::cli {

// A whole plain file, or standard input for "-". Reports where it can't.
bool readInput(const std::string& file, std::string& text, Diagnostics& diagnostics,
               std::size_t maxBytes = doc::ReadOptions().maxFileBytes);

// Writes beside the file and renames, so that there is never half a file. "-" is standard output.
bool writeFile(const std::string& file, std::string_view text, Diagnostics& diagnostics);

// Makes a folder and those above it.
bool makeFolder(const std::string& folder, Diagnostics& diagnostics);

// The .mtlx and .sl files of a folder.
bool readLibrary(const std::string& folder, std::vector<LibraryFile>& files, Diagnostics& diagnostics);

// "dir/gold.mtlx" as "gold"; standard input as "stdin".
std::string stemOf(const std::string& file);

// What an element's files are called: its path with every sign but letters, digits and _ as _.
std::string fileNameOf(std::string_view path);

}  // namespace shaderx::cli
