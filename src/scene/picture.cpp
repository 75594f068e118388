#include "scene/picture.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace shaderx::scene {

using image::Image;

static std::string extensionOf(const std::string& path) {
    const std::size_t dot = path.rfind('.');
    std::string out = dot == std::string::npos ? "" : path.substr(dot + 1);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

int supersampling(const Settings& settings) {
    if (settings.supersample > 0) return settings.supersample;
    // About what a software driver draws in a few seconds: 512 × 512 pixels of 2 × 2 at 256 samples.
    constexpr double kCheap = 1 << 28;
    const double cost = 4.0 * settings.size * settings.size * std::max(settings.samples, 1);
    return extensionOf(settings.output) == "png" && cost <= kCheap ? 2 : 1;
}

Image reduced(const Image& image, int n) {
    Image out = Image::ofFloats(image.width / n, image.height / n, 4);
    const float weight = 1.0f / static_cast<float>(n * n);
    for (int y = 0; y < out.height * n; y++)
        for (int x = 0; x < out.width * n; x++)
            for (int c = 0; c < 4; c++) out.floats[out.index(x / n, y / n, c)] += image.at(x, y, c) * weight;
    return out;
}

void multiply(const std::array<float, 9>& m, float* color) {
    const float r = color[0], g = color[1], b = color[2];
    for (std::size_t i = 0; i < 3; i++) color[i] = m[3 * i] * r + m[3 * i + 1] * g + m[3 * i + 2] * b;
}

static float decoded(const WorkingSpace& space, float v) {
    switch (space.curve) {
        case WorkingSpace::Curve::Linear:
            break;
        case WorkingSpace::Curve::Srgb:
            return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
        case WorkingSpace::Curve::Gamma:
            return std::pow(std::max(v, 0.0f), space.gamma);
    }
    return v;
}

Image forDisplay(const Settings& settings, Image picture) {
    if (!settings.working) return picture;
    for (std::size_t i = 0; i + 3 < picture.floats.size(); i += 4) {
        float* color = picture.floats.data() + i;
        for (int c = 0; c < 3; c++) color[c] = decoded(*settings.working, color[c]);
        multiply(settings.working->toRec709, color);
    }
    return picture;
}

void warnOfMissing(const Texture& texture, const Diagnostics& reading, Diagnostics& diagnostics) {
    for (const Diagnostic& d : reading.all()) {
        Diagnostic& warning =
            diagnostics.warning("missing-texture", d.message + "; the node's default colour is drawn");
        warning.where = d.where;
        warning.path = texture.documentPath;
        if (!texture.where.line) continue;
        if (d.message.find(texture.file) == std::string::npos)
            warning.message = fmt::format("'{}': {}", texture.file, warning.message);
        warning.where = texture.where;
    }
}

bool checkOutput(const Settings& settings, Diagnostics& diagnostics) {
    const std::string extension = extensionOf(settings.output);
    if (extension == "png" || extension == "exr" || extension == "pfm") return true;
    diagnostics
        .error("unknown-output-format", fmt::format("cannot tell what kind of picture '{}' is to be", settings.output))
        .hint = "end its name in .png, .exr or .pfm";
    return false;
}

bool writePicture(const Settings& settings, const Image& picture, Diagnostics& diagnostics) {
    const std::string extension = extensionOf(settings.output);
    if (extension == "png")
        return image::writePng(settings.output, forDisplay(settings, picture), diagnostics,
                               {.exposure = settings.exposure});
    if (extension == "exr") return image::writeExr(settings.output, picture, diagnostics);
    return image::writePfm(settings.output, picture, diagnostics);
}

}  // namespace shaderx::scene
