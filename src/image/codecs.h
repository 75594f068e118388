// The room's inner interface: one decoder a format, over a file that is already in memory.
#pragma once

#include <span>

#include "image/image.h"

namespace shaderx::image {

using Bytes = std::span<const std::uint8_t>;

// A picture file that is being read.
struct Source {
    const std::string& path;
    Bytes bytes;
    const ReadLimits& limits;
    Diagnostics& diagnostics;

    // Reports; returned by a decoder that gives up.
    Failure fail(std::string_view code, std::string message) const;
    Failure damaged(std::string_view format, std::string_view reason) const;
    // Whether a picture of this size may be decoded; reports where it may not.
    bool allows(long long width, long long height) const;
};

Result<Image> decodePng(const Source& source);
Result<Image> decodeExr(const Source& source);
Result<Image> decodePfm(const Source& source);
// JPEG, Radiance HDR, BMP, GIF, TGA.
Result<Image> decodeStb(const Source& source);

// Whether stb_image takes the file for one of its formats.
bool stbKnows(Bytes bytes);

// Writes beside `path` first and then renames, so that nobody ever sees half a file.
bool writeFile(const std::string& path, Bytes bytes, Diagnostics& diagnostics);
// Reports that a picture could not be encoded; returns false.
bool cannotWrite(const std::string& path, std::string_view reason, Diagnostics& diagnostics);

}  // namespace shaderx::image
