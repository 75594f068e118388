// Portable float map: "PF" (RGB) or "Pf" (grey), width, height, a scale whose sign tells the byte order (negative:
// little endian), then rows of floats, the bottom row first.
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/numbers.h"
#include "image/codecs.h"

namespace shaderx::image {

// The next word of the header; `at` moves behind the one blank that ends it.
static std::string_view word(std::string_view text, std::size_t& at) {
    const auto blank = [&](std::size_t i) {
        return text[i] == ' ' || text[i] == '\n' || text[i] == '\t' || text[i] == '\r';
    };
    while (at < text.size() && blank(at)) at++;
    const std::size_t start = at;
    while (at < text.size() && !blank(at)) at++;
    const std::string_view out = text.substr(start, at - start);
    if (at < text.size()) at++;
    return out;
}

static float readFloat(const std::uint8_t* bytes, bool little) {
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < 4; i++) bits |= static_cast<std::uint32_t>(bytes[i]) << 8 * (little ? i : 3 - i);
    return std::bit_cast<float>(bits);
}

Result<Image> decodePfm(const Source& source) {
    const std::string_view text(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size());
    std::size_t at = 0;
    const std::string_view kind = word(text, at);
    const std::optional<int> width = parseInt(word(text, at)), height = parseInt(word(text, at));
    const std::optional<float> scale = parseFloat(word(text, at));
    if ((kind != "PF" && kind != "Pf") || !width || !height || !scale)
        return source.damaged("PFM", "its header is bad");
    if (!source.allows(*width, *height)) return Failure{};
    const int channels = kind == "PF" ? 3 : 1;
    const std::size_t row = static_cast<std::size_t>(*width) * static_cast<std::size_t>(channels);
    if (text.size() - at < row * static_cast<std::size_t>(*height) * 4)
        return source.damaged("PFM", "it ends too early");
    Image out = Image::ofFloats(*width, *height, channels);
    const std::uint8_t* in = source.bytes.data() + at;
    for (int y = *height - 1; y >= 0; y--)
        for (std::size_t i = 0; i < row; i++, in += 4) out.floats[out.index(0, y, 0) + i] = readFloat(in, *scale < 0);
    return out;
}

bool writePfm(const std::string& path, const Image& image, Diagnostics& diagnostics) {
    const int channels = image.channels < 3 ? 1 : 3;
    std::string file = fmt::format("{}\n{} {}\n-1.0\n", channels == 1 ? "Pf" : "PF", image.width, image.height);
    for (int y = image.height - 1; y >= 0; y--)
        for (int x = 0; x < image.width; x++)
            for (int c = 0; c < channels; c++) {
                const std::uint32_t bits = std::bit_cast<std::uint32_t>(image.at(x, y, c));
                for (unsigned i = 0; i < 4; i++) file += static_cast<char>(bits >> 8 * i & 0xff);
            }
    return writeFile(path, {reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, diagnostics);
}

}  // namespace shaderx::image
