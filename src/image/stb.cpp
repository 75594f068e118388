// JPEG, Radiance HDR, BMP, GIF and TGA by stb_image.
#include <algorithm>
#include <cstdlib>
#include <memory>

#include "image/codecs.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_ONLY_HDR
#define STBI_ONLY_BMP
#define STBI_ONLY_GIF
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS (1 << 20)
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#include <stb_image.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace shaderx::image {

namespace {

// stb_image 2.27 writes out of bounds for a JPEG whose Huffman table has more than 256 codes (ITU T.81, B.2.4.2, allows
// no more), so such a file is turned away before the library sees it.
class JpegTables {
  public:
    explicit JpegTables(Bytes bytes) : bytes_(bytes) {}

    // Walks from segment to segment up to the end of the picture, and sets `length` to what belongs to it: the library
    // shall not read on behind that.
    bool areSound(std::size_t& length) const {
        std::size_t at = 2, scan = 0;
        while (at + 1 < bytes_.size()) {
            const std::uint8_t marker = bytes_[at + 1];
            if (bytes_[at] != 0xff || marker == 0xff || marker == 0 || (marker >= 0xd0 && marker <= 0xd8)) {
                at++;
                continue;
            }
            at += 2;
            if (marker == 0xd9) break;  // end of the picture
            if (marker == 0xc4 && !tableIsSound(at)) return false;
            if (marker == 0xda && scan == 0) scan = at;
            at += std::max<std::size_t>(word(at), 2);
        }
        length = std::min(at, bytes_.size());
        // Within and after the coded data, a damaged file may be read by the library out of step with this walk.
        for (std::size_t i = scan; scan != 0 && i + 1 < length; i++)
            if (bytes_[i] == 0xff && bytes_[i + 1] == 0xc4 && !tableIsSound(i + 2)) return false;
        return true;
    }

  private:
    std::uint8_t byte(std::size_t at) const { return at < bytes_.size() ? bytes_[at] : 0; }
    std::size_t word(std::size_t at) const { return static_cast<std::size_t>(byte(at)) << 8 | byte(at + 1); }

    bool tableIsSound(std::size_t at) const {
        const std::size_t end = at + word(at);
        for (at += 2; at < end;) {
            std::size_t codes = 0;
            for (std::size_t i = 1; i <= 16; i++) codes += byte(at + i);
            if (codes > 256) return false;
            at += 17 + codes;
        }
        return true;
    }

    Bytes bytes_;
};

}  // namespace

static bool isJpeg(Bytes bytes) { return bytes.size() > 2 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff; }

bool stbKnows(Bytes bytes) {
    if (isJpeg(bytes)) return true;
    // The library takes more beginnings for a JPEG than isJpeg, and would read those unchecked.
    if (!bytes.empty() && bytes[0] == 0xff) return false;
    int width = 0, height = 0, channels = 0;
    const int head = static_cast<int>(std::min<std::size_t>(bytes.size(), 0x7fffffffu));
    return stbi_info_from_memory(bytes.data(), head, &width, &height, &channels) != 0;
}

Result<Image> decodeStb(const Source& source) {
    const stbi_uc* data = source.bytes.data();
    std::size_t length = source.bytes.size();
    if (length > 0x7fffffffu) return source.fail("image-too-large", "the file has more than 2147483647 bytes");
    if (isJpeg(source.bytes) && !JpegTables(source.bytes).areSound(length))
        return source.damaged("JPEG", "bad Huffman table");
    const int size = static_cast<int>(length);
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, size, &width, &height, &channels))
        return source.damaged("", stbi_failure_reason());
    if (!source.allows(width, height)) return Failure{};
    if (stbi_is_hdr_from_memory(data, size)) {
        const std::unique_ptr<float, void (*)(void*)> pixels(
            stbi_loadf_from_memory(data, size, &width, &height, &channels, 3), std::free);
        if (!pixels) return source.damaged("HDR", stbi_failure_reason());
        Image out = Image::ofFloats(width, height, 3);
        std::copy(pixels.get(), pixels.get() + out.floats.size(), out.floats.begin());
        return out;
    }
    // What the header promises is what is asked for: the decoder's own count may differ for a damaged file.
    const int wanted = channels >= 1 && channels <= 4 ? channels : 4;
    const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, wanted), std::free);
    if (!pixels) return source.damaged("", stbi_failure_reason());
    if (!source.allows(width, height)) return Failure{};
    Image out = Image::ofBytes(width, height, wanted);
    std::copy(pixels.get(), pixels.get() + out.bytes.size(), out.bytes.begin());
    return out;
}

}  // namespace shaderx::image
