#include "image/image.h"

#include <algorithm>
#include <cmath>

namespace shaderx::image {

static std::size_t valueCount(int width, int height, int channels) {
    ensure(width > 0 && height > 0 && channels >= 1 && channels <= 4, "a picture has pixels and one to four channels");
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
}

Image Image::ofFloats(int width, int height, int channels) {
    Image out{width, height, channels, true, {}, {}};
    out.floats.resize(valueCount(width, height, channels));
    return out;
}

Image Image::ofBytes(int width, int height, int channels) {
    Image out{width, height, channels, false, {}, {}};
    out.bytes.resize(valueCount(width, height, channels));
    return out;
}

template <class T>
static void spread(const std::vector<T>& from, int channels, T one, std::vector<T>& to) {
    const bool grey = channels < 3;
    const std::size_t step = static_cast<std::size_t>(channels);
    for (std::size_t p = 0, o = 0; o < to.size(); p += step, o += 4) {
        to[o] = from[p];
        to[o + 1] = from[grey ? p : p + 1];
        to[o + 2] = from[grey ? p : p + 2];
        to[o + 3] = channels % 2 ? one : from[p + step - 1];
    }
}

Image toRgba(const Image& image) {
    if (image.channels == 4) return image;
    Image out =
        image.isFloat ? Image::ofFloats(image.width, image.height, 4) : Image::ofBytes(image.width, image.height, 4);
    if (image.isFloat)
        spread(image.floats, image.channels, 1.0f, out.floats);
    else
        spread(image.bytes, image.channels, std::uint8_t{255}, out.bytes);
    return out;
}

Image halved(const Image& image) {
    const int w = (image.width + 1) / 2, h = (image.height + 1) / 2;
    Image out = image.isFloat ? Image::ofFloats(w, h, image.channels) : Image::ofBytes(w, h, image.channels);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const int x1 = std::min(2 * x + 1, image.width - 1), y1 = std::min(2 * y + 1, image.height - 1);
            for (int c = 0; c < image.channels; c++) {
                const float mean = (image.at(2 * x, 2 * y, c) + image.at(x1, 2 * y, c) + image.at(2 * x, y1, c) +
                                    image.at(x1, y1, c)) *
                                   0.25f;
                if (image.isFloat)
                    out.floats[out.index(x, y, c)] = mean;
                else
                    out.bytes[out.index(x, y, c)] = static_cast<std::uint8_t>(mean * 255.0f + 0.5f);
            }
        }
    return out;
}

template <class T>
static void flipRows(std::vector<T>& values, std::size_t rowLength) {
    for (std::size_t top = 0, bottom = values.size() - rowLength; top < bottom; top += rowLength, bottom -= rowLength)
        for (std::size_t i = 0; i < rowLength; i++) std::swap(values[top + i], values[bottom + i]);
}

Image flipped(const Image& image) {
    Image out = image;
    const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
    if (image.isFloat)
        flipRows(out.floats, row);
    else
        flipRows(out.bytes, row);
    return out;
}

float linearToSrgb(float value) {
    return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
}

float srgbToLinear(float value) {
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

}  // namespace shaderx::image
