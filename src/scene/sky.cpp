#include "scene/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "scene/picture.h"

namespace shaderx::scene {

using image::Image;
using std::numbers::pi;
using Vector = std::array<float, 3>;

namespace {

constexpr int kIrradianceWidth = 64, kIrradianceHeight = 32;

// The direction of a map's point; u and v in 0 … 1, v = 0 the zenith.
struct Direction {
    Vector d;
    float sinTheta;
    Direction(float u, float v) {
        const float theta = static_cast<float>(v * pi), phi = static_cast<float>(u * 2 * pi);
        sinTheta = std::sin(theta);
        d = {sinTheta * std::cos(phi), std::cos(theta), sinTheta * std::sin(phi)};
    }
};

float dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Direction pixelDirection(const Image& map, int x, int y) {
    return {(static_cast<float>(x) + 0.5f) / static_cast<float>(map.width),
            (static_cast<float>(y) + 0.5f) / static_cast<float>(map.height)};
}

void addLamp(Vector& radiance, const Vector& d, const Vector& toLamp, float sharpness, const Vector& colour) {
    const float falloff = std::exp((dot(d, toLamp) / std::sqrt(dot(toLamp, toLamp)) - 1) * sharpness);
    for (std::size_t c = 0; c < 3; c++) radiance[c] += colour[c] * falloff;
}

Vector skyRadiance(const Vector& d) {
    const float height = 0.5f + 0.5f * d[1];
    Vector out{0.25f + 0.35f * height, 0.28f + 0.5f * height, 0.3f + 0.8f * height};
    addLamp(out, d, {0.6f, 0.7f, 0.4f}, 40, {6, 5, 4});
    addLamp(out, d, {-0.7f, 0.3f, 0.6f}, 15, {0.6f, 0.9f, 1.6f});
    return out;
}

Image skyMap(int width, int height) {
    Image out = Image::ofFloats(width, height, 4);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const Vector radiance = skyRadiance(pixelDirection(out, x, y).d);
            float* pixel = &out.floats[out.index(x, y, 0)];
            std::copy(radiance.begin(), radiance.end(), pixel);
            pixel[3] = 1;
        }
    return out;
}

// Cosine-weighted mean of a small radiance map about each direction. Dividing by the sum of the very weights used keeps
// a white world at exactly 1.
Image convolve(const Image& radiance) {
    Image out = Image::ofFloats(kIrradianceWidth, kIrradianceHeight, 4);
    std::vector<Direction> from;
    for (int y = 0; y < radiance.height; y++)
        for (int x = 0; x < radiance.width; x++) from.push_back(pixelDirection(radiance, x, y));
    for (int y = 0; y < out.height; y++)
        for (int x = 0; x < out.width; x++) {
            const Vector normal = pixelDirection(out, x, y).d;
            double sum[3] = {}, weights = 0;
            for (std::size_t i = 0; i < from.size(); i++) {
                const float cosine = dot(from[i].d, normal);
                if (cosine <= 0) continue;
                const double weight = cosine * from[i].sinTheta;
                for (std::size_t c = 0; c < 3; c++) sum[c] += radiance.floats[i * 4 + c] * weight;
                weights += weight;
            }
            float* pixel = &out.floats[out.index(x, y, 0)];
            for (std::size_t c = 0; c < 3; c++) pixel[c] = static_cast<float>(sum[c] / weights);
            pixel[3] = 1;
        }
    return out;
}

// The mean radiance of each cell of a 64 × 32 map, rows weighted by their solid angle.
Image reduced(const Image& map) {
    Image out = Image::ofFloats(kIrradianceWidth, kIrradianceHeight, 4);
    const auto range = [](int cell, int cells, int pixels) {
        const int begin = static_cast<int>(static_cast<long long>(cell) * pixels / cells);
        const int end = static_cast<int>(static_cast<long long>(cell + 1) * pixels / cells);
        return std::array<int, 2>{begin, std::max(end, begin + 1)};
    };
    for (int y = 0; y < out.height; y++)
        for (int x = 0; x < out.width; x++) {
            const auto [y0, y1] = range(y, out.height, map.height);
            const auto [x0, x1] = range(x, out.width, map.width);
            double sum[3] = {}, weights = 0;
            for (int sy = y0; sy < y1; sy++) {
                const double weight = std::sin((sy + 0.5) / map.height * pi);
                for (int sx = x0; sx < x1; sx++) {
                    const float* pixel = &map.floats[map.index(sx, sy, 0)];
                    for (std::size_t c = 0; c < 3; c++) sum[c] += pixel[c] * weight;
                    weights += weight;
                }
            }
            float* pixel = &out.floats[out.index(x, y, 0)];
            for (std::size_t c = 0; c < 3; c++) pixel[c] = static_cast<float>(sum[c] / weights);
            pixel[3] = 1;
        }
    return out;
}

// A picture as radiance: floats, four channels, only values that light can have.
Image asRadiance(const Image& picture) {
    const Image rgba = toRgba(picture);
    Image out = Image::ofFloats(rgba.width, rgba.height, 4);
    for (std::size_t i = 0; i < out.floats.size(); i++) {
        float value = rgba.isFloat ? rgba.floats[i] : image::srgbToLinear(static_cast<float>(rgba.bytes[i]) / 255.0f);
        if (!(value >= 0 && value <= std::numeric_limits<float>::max())) value = 0;
        out.floats[i] = i % 4 == 3 ? 1.0f : value;
    }
    return out;
}

}  // namespace

Environment builtInSky() { return {skyMap(512, 256), convolve(skyMap(kIrradianceWidth, kIrradianceHeight))}; }

Result<Environment> loadEnvironment(const std::string& file, int maxSide, Diagnostics& diagnostics) {
    const Result<Image> picture = image::readImage(file, diagnostics);
    if (!picture) return Failure{};
    Image radiance = asRadiance(*picture);
    while (radiance.width > maxSide || radiance.height > maxSide) radiance = halved(radiance);
    Image irradiance = convolve(reduced(radiance));
    return Environment{std::move(radiance), std::move(irradiance)};
}

Environment inWorkingSpace(Environment environment, const Settings& settings) {
    if (!settings.working) return environment;
    for (image::Image* map : {&environment.radiance, &environment.irradiance})
        for (std::size_t i = 0; i + 3 < map->floats.size(); i += 4)
            multiply(settings.working->fromRec709, map->floats.data() + i);
    return environment;
}

}  // namespace shaderx::scene
