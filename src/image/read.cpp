#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>

#include <fmt/format.h>

#include "image/codecs.h"

namespace shaderx::image {

namespace fs = std::filesystem;

Failure Source::fail(std::string_view code, std::string message) const {
    diagnostics.error(code, std::move(message)).where.file = path;
    return {};
}

Failure Source::damaged(std::string_view format, std::string_view reason) const {
    return fail("damaged-image", fmt::format("cannot decode the {} picture: {}", format, reason));
}

bool Source::allows(long long width, long long height) const {
    if (width <= 0 || height <= 0) {
        damaged("", "it has no pixels");
        return false;
    }
    const long long side = limits.maxSide;
    if (width <= side && height <= side && static_cast<std::size_t>(width * height) <= limits.maxPixels) return true;
    fail("image-too-large", fmt::format("the picture has {}×{} pixels, more than the limits of {} a side and {} in all",
                                        width, height, limits.maxSide, limits.maxPixels));
    return false;
}

static bool startsWith(Bytes bytes, std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

static Result<Image> decode(const Source& source) {
    if (startsWith(source.bytes, "\x89PNG\r\n\x1a\n")) return decodePng(source);
    if (startsWith(source.bytes, "\x76\x2f\x31\x01")) return decodeExr(source);
    if (startsWith(source.bytes, "PF") || startsWith(source.bytes, "Pf")) return decodePfm(source);
    if (stbKnows(source.bytes)) return decodeStb(source);
    return source.fail("unknown-image-format", "the file is no PNG, EXR, JPEG, HDR, PFM, BMP, GIF or TGA picture");
}

// Reports and returns false where the file cannot be read.
static bool load(const Source& source, std::vector<std::uint8_t>& bytes) {
    const auto fail = [&](std::string_view reason) {
        source.fail("cannot-read-image", fmt::format("cannot read '{}': {}", source.path, reason));
        return false;
    };
    std::error_code error;
    const fs::file_status status = fs::status(source.path, error);
    if (!fs::exists(status)) return fail("there is no such file");
    if (!fs::is_regular_file(status)) return fail("it is not a regular file");
    const std::uintmax_t size = fs::file_size(source.path, error);
    if (error) return fail(error.message());
    if (size > source.limits.maxFileBytes) {
        source.fail("image-too-large",
                    fmt::format("the file has {} bytes, more than the limit of {}", size, source.limits.maxFileBytes));
        return false;
    }
    std::FILE* file = std::fopen(source.path.c_str(), "rb");
    if (!file) return fail(std::strerror(errno));
    bytes.resize(static_cast<std::size_t>(size));
    bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file));
    std::fclose(file);
    return true;
}

Result<Image> readImage(const std::string& path, Diagnostics& diagnostics, const ReadLimits& limits) {
    Source source{path, {}, limits, diagnostics};
    try {
        std::vector<std::uint8_t> bytes;
        if (!load(source, bytes)) return Failure{};
        source.bytes = bytes;
        return decode(source);
    } catch (const std::bad_alloc&) {
        return source.fail("image-too-large", "the picture does not fit into memory");
    } catch (const std::length_error&) {
        return source.fail("image-too-large", "the picture does not fit into memory");
    }
}

}  // namespace shaderx::image
