#include <algorithm>
#include <cmath>
#include <memory>

#include <spng.h>

#include "image/codecs.h"

namespace shaderx::image {

namespace {

struct FreeContext {
    void operator()(spng_ctx* context) const { spng_ctx_free(context); }
};
using Context = std::unique_ptr<spng_ctx, FreeContext>;

int channelsOf(const spng_ihdr& header, bool transparentColour) {
    switch (header.color_type) {
        case SPNG_COLOR_TYPE_GRAYSCALE:
            return transparentColour ? 2 : 1;
        case SPNG_COLOR_TYPE_GRAYSCALE_ALPHA:
            return 2;
        case SPNG_COLOR_TYPE_TRUECOLOR_ALPHA:
            return 4;
        default:
            return transparentColour ? 4 : 3;  // true colour or a palette
    }
}

// Keeps of RGBA pixels the channels that the file had.
template <class T, class Out>
void keepChannels(const std::vector<T>& rgba, int channels, std::vector<Out>& out, Out scale) {
    const int take[4][4] = {{0}, {0, 3}, {0, 1, 2}, {0, 1, 2, 3}};
    std::size_t o = 0;
    for (std::size_t p = 0; p < rgba.size(); p += 4)
        for (int c = 0; c < channels; c++)
            out[o++] =
                static_cast<Out>(static_cast<Out>(rgba[p + static_cast<std::size_t>(take[channels - 1][c])]) / scale);
}

template <class T>
int decodeRgba(spng_ctx* context, int format, std::vector<T>& rgba) {
    std::size_t size = 0;
    if (const int error = spng_decoded_image_size(context, format, &size)) return error;
    rgba.resize(size / sizeof(T));
    return spng_decode_image(context, rgba.data(), size, format, SPNG_DECODE_TRNS);
}

}  // namespace

Result<Image> decodePng(const Source& source) {
    const auto damaged = [&](int error) { return source.damaged("PNG", spng_strerror(error)); };
    const Context context(spng_ctx_new(0));
    if (!context) return damaged(SPNG_EMEM);
    // Text and other chunks are of no use here; a bound keeps a hostile one from taking memory.
    spng_set_chunk_limits(context.get(), std::size_t{1} << 26, std::size_t{1} << 27);
    if (const int error = spng_set_png_buffer(context.get(), source.bytes.data(), source.bytes.size()))
        return damaged(error);
    spng_ihdr header{};
    if (const int error = spng_get_ihdr(context.get(), &header)) return damaged(error);
    if (!source.allows(header.width, header.height)) return Failure{};
    spng_trns transparency{};
    const int channels = channelsOf(header, spng_get_trns(context.get(), &transparency) == 0);
    const int width = static_cast<int>(header.width), height = static_cast<int>(header.height);
    if (header.bit_depth == 16) {
        std::vector<std::uint16_t> rgba;
        if (const int error = decodeRgba(context.get(), SPNG_FMT_RGBA16, rgba)) return damaged(error);
        Image out = Image::ofFloats(width, height, channels);
        keepChannels(rgba, channels, out.floats, 65535.0f);
        return out;
    }
    std::vector<std::uint8_t> rgba;
    if (const int error = decodeRgba(context.get(), SPNG_FMT_RGBA8, rgba)) return damaged(error);
    Image out = Image::ofBytes(width, height, channels);
    keepChannels(rgba, channels, out.bytes, std::uint8_t{1});
    return out;
}

static std::uint8_t quantise(float value) {
    return static_cast<std::uint8_t>(value > 0 ? std::min(value, 1.0f) * 255.0f + 0.5f : 0.0f);  // NaN becomes 0
}

static std::vector<std::uint8_t> quantise(const Image& image, const PngOptions& options) {
    std::vector<std::uint8_t> out(image.floats.size());
    const std::size_t channels = static_cast<std::size_t>(image.channels);
    const bool hasAlpha = channels % 2 == 0;
    const float scale = std::exp2(options.exposure);
    for (std::size_t p = 0; p < out.size(); p += channels) {
        const std::size_t colours = hasAlpha ? channels - 1 : channels;
        const float alpha = hasAlpha ? image.floats[p + colours] : 1.0f;
        const float factor = options.premultiplied && alpha > 0 && alpha < 1 ? scale / alpha : scale;
        for (std::size_t c = 0; c < colours; c++) {
            const float value = image.floats[p + c] * factor;
            out[p + c] = quantise(options.encodeSrgb ? linearToSrgb(value) : value);
        }
        if (hasAlpha) out[p + colours] = quantise(alpha);
    }
    return out;
}

bool writePng(const std::string& path, const Image& image, Diagnostics& diagnostics, const PngOptions& options) {
    static constexpr int kColourTypes[] = {SPNG_COLOR_TYPE_GRAYSCALE, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA,
                                           SPNG_COLOR_TYPE_TRUECOLOR, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA};
    const std::vector<std::uint8_t> pixels = image.isFloat ? quantise(image, options) : image.bytes;
    const Context context(spng_ctx_new(SPNG_CTX_ENCODER));
    if (!context) return cannotWrite(path, "out of memory", diagnostics);
    spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
    spng_ihdr header{};
    header.width = static_cast<std::uint32_t>(image.width);
    header.height = static_cast<std::uint32_t>(image.height);
    header.bit_depth = 8;
    header.color_type = static_cast<std::uint8_t>(kColourTypes[image.channels - 1]);
    int error = spng_set_ihdr(context.get(), &header);
    if (!error && image.isFloat && options.encodeSrgb) spng_set_srgb(context.get(), 0);
    if (!error)
        error = spng_encode_image(context.get(), pixels.data(), pixels.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE);
    std::size_t size = 0;
    std::unique_ptr<void, void (*)(void*)> file(error ? nullptr : spng_get_png_buffer(context.get(), &size, &error),
                                                std::free);
    if (error || !file) return cannotWrite(path, spng_strerror(error), diagnostics);
    return writeFile(path, {static_cast<const std::uint8_t*>(file.get()), size}, diagnostics);
}

}  // namespace shaderx::image
