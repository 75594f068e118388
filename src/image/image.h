// Pictures in memory, and to and from files. The only room that knows the picture libraries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"

namespace shaderx::image {

// A picture, top row first, pixels from left to right, channels together: grey, grey and alpha, RGB, or RGBA for 1 to 4
// channels. Values are as the file has them: no colour space is decoded.
struct Image {
    int width = 0, height = 0, channels = 0;
    bool isFloat = false;
    std::vector<float> floats;        // where isFloat is set, else empty
    std::vector<std::uint8_t> bytes;  // where isFloat is not set, else empty

    // An all-zero picture.
    static Image ofFloats(int width, int height, int channels);
    static Image ofBytes(int width, int height, int channels);

    std::size_t index(int x, int y, int c) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(channels) +
               static_cast<std::size_t>(c);
    }
    // A channel's value; a byte reads as 0 … 1.
    float at(int x, int y, int c) const {
        return isFloat ? floats[index(x, y, c)] : static_cast<float>(bytes[index(x, y, c)]) / 255.0f;
    }
};

// What a file may ask for at most.
struct ReadLimits {
    std::size_t maxFileBytes = std::size_t{1} << 31;
    int maxSide = 1 << 17;                         // pixels
    std::size_t maxPixels = std::size_t{1} << 28;  // width times height
};

// Reads PNG, OpenEXR (scanlines or tiles, flat), JPEG, Radiance HDR, PFM, BMP, GIF (its first picture) and TGA, told
// apart by content. PNG of 16 bits a channel, EXR, HDR and PFM become floats, everything else bytes. An EXR is read
// over its display window, with R G B A, or Y, or Y RY BY, or the first layer's channels. Errors: cannot-read-image,
// unknown-image-format, damaged-image, image-too-large.
Result<Image> readImage(const std::string& path, Diagnostics& diagnostics, const ReadLimits& limits = {});

struct PngOptions {
    float exposure = 0;         // in stops, applied to floats
    bool encodeSrgb = true;     // floats are linear and written through the sRGB curve, alpha excepted
    bool premultiplied = true;  // a float picture's colours hold alpha as a factor, which PNG wants divided out
};

// Each writer leaves either the whole file or what was there before, and returns false after it has reported why
// (cannot-write-file).

// Writes 8 bits a channel; a picture of bytes is written as it is.
bool writePng(const std::string& path, const Image& image, Diagnostics& diagnostics, const PngOptions& options = {});
// Writes 32-bit float channels Y, Y A, R G B or R G B A, ZIP-compressed.
bool writeExr(const std::string& path, const Image& image, Diagnostics& diagnostics);
// Writes one or three float channels; alpha is left out.
bool writePfm(const std::string& path, const Image& image, Diagnostics& diagnostics);

// The same picture with four channels: grey becomes R = G = B, missing alpha 1.
Image toRgba(const Image& image);
// A picture of half the size, rounded up, each pixel the mean of up to 2×2.
Image halved(const Image& image);
// Top row becomes bottom row.
Image flipped(const Image& image);

// The sRGB transfer curve (IEC 61966-2-1) for one value of 0 … 1 and beyond, either way.
float linearToSrgb(float value);
float srgbToLinear(float value);

}  // namespace shaderx::image
