// Names of files that take their own names once they are whole.
#pragma once

#include <string>

namespace shaderx {

// Where a file is written to before it takes its name: in the same folder, in no other call's way, and no longer than
// the name of a file may be (255 bytes on usual file systems).
std::string temporaryNameFor(const std::string& file);

}  // namespace shaderx
