#include "oracle/texture.h"

#include <algorithm>
#include <cmath>

namespace shaderx::oracle {

using image::Image;

Address addressNamed(const std::string& name) {
    if (name == "constant" || name == "black") return Address::Constant;
    if (name == "clamp") return Address::Clamp;
    if (name == "mirror") return Address::Mirror;
    return Address::Periodic;
}

namespace {

constexpr int kOutside = -1;

// Which two texels of a row a coordinate lies between, and how far from the first.
struct Between {
    int first, second;
    float weight;
};

// Keeps what no picture has from becoming an index: NaN and infinities count as 0.
float finite(float v) { return std::fabs(v) < 1e9f ? v : 0; }

// std::floor of what finite() leaves, without a call.
float floorOf(float v) {
    const float whole = static_cast<float>(static_cast<std::int32_t>(v));
    return whole > v ? whole - 1 : whole;
}

// 0 … 1 … 0 as the coordinate grows.
float mirrored(float v) {
    const float part = v - 2 * floorOf(v * 0.5f);
    return part > 1 ? 2 - part : part;
}

Between between(Address address, float coordinate, int size) {
    const float n = static_cast<float>(size);
    coordinate = finite(coordinate);
    if (address == Address::Periodic) {
        const float at = (coordinate - floorOf(coordinate)) * n - 0.5f, low = floorOf(at);
        const int first = static_cast<int>(low), second = first + 1;
        return {first < 0 ? size - 1 : first, second >= size ? 0 : second, at - low};
    }
    if (address == Address::Mirror) coordinate = mirrored(coordinate);
    const float at = std::clamp(coordinate * n - 0.5f, -1.0f, n), low = floorOf(at);
    Between out{static_cast<int>(low), static_cast<int>(low) + 1, at - low};
    for (int* i : {&out.first, &out.second}) {
        if (address == Address::Constant)
            *i = *i < 0 || *i >= size ? kOutside : *i;
        else
            *i = std::clamp(*i, 0, size - 1);
    }
    return out;
}

int nearest(Address address, float coordinate, int size) {
    coordinate = finite(coordinate);
    if (address == Address::Periodic) coordinate -= floorOf(coordinate);
    if (address == Address::Mirror) coordinate = mirrored(coordinate);
    const float n = static_cast<float>(size);
    const int i = static_cast<int>(std::floor(std::clamp(coordinate * n, -1.0f, n)));
    if (address == Address::Constant) return i < 0 || i >= size ? kOutside : i;
    return std::clamp(i, 0, size - 1);
}

Colour mixed(const Colour& a, const Colour& b, float t) {
    Colour out;
    for (std::size_t c = 0; c < 4; c++) out[c] = a[c] + t * (b[c] - a[c]);
    return out;
}

// The driver's mix of bytes, with a weight in 256ths.
int mixedBytes(int a, int b, int weight) { return a + ((weight * (b - a) + 128) >> 8); }

bool isSimple(Address a) { return a == Address::Periodic || a == Address::Clamp; }

}  // namespace

Texture::Texture(const Image& picture, bool levels, const Sampling& sampling) : sampling_(sampling) {
    const Image rgba = toRgba(picture);
    levels_.push_back({rgba.width, rgba.height, rgba.floats, rgba.bytes});
    byteFilter_ = !rgba.isFloat && isSimple(sampling.u) && isSimple(sampling.v);
    // OpenGL clamps the border's colour to what the texels can hold.
    if (!rgba.isFloat)
        for (float& c : sampling_.border) c = std::clamp(c, 0.0f, 1.0f);
    while (levels && (levels_.back().width > 1 || levels_.back().height > 1)) levels_.push_back(halved(levels_.back()));
}

Texture::Level Texture::halved(const Level& from) const {
    Level out{std::max(from.width / 2, 1), std::max(from.height / 2, 1), {}, {}};
    const Sampling kClamped{Address::Clamp, Address::Clamp, false, {}};
    for (int y = 0; y < out.height; y++)
        for (int x = 0; x < out.width; x++) {
            const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(out.width);
            const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(out.height);
            if (from.bytes.empty()) {
                const Colour c = linear(from, u, v, kClamped);
                out.texels.insert(out.texels.end(), c.begin(), c.end());
            } else {
                for (int c : linearBytes(from, u, v, kClamped)) out.bytes.push_back(static_cast<std::uint8_t>(c));
            }
        }
    return out;
}

Colour Texture::texel(const Level& level, int x, int y) const {
    if (x == kOutside || y == kOutside) return sampling_.border;
    const std::size_t at =
        (static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x)) * 4;
    Colour out;
    for (std::size_t c = 0; c < 4; c++)
        out[c] = level.bytes.empty() ? level.texels[at + c] : static_cast<float>(level.bytes[at + c]) / 255.0f;
    return out;
}

Colour Texture::linear(const Level& level, float u, float v, const Sampling& how) const {
    const Between x = between(how.u, u, level.width), y = between(how.v, v, level.height);
    if (level.bytes.empty() && how.u != Address::Constant && how.v != Address::Constant) {
        const auto at = [&](int column, int row) {
            return &level.texels[(static_cast<std::size_t>(row) * static_cast<std::size_t>(level.width) +
                                  static_cast<std::size_t>(column)) *
                                 4];
        };
        const float *a = at(x.first, y.first), *b = at(x.second, y.first), *c = at(x.first, y.second),
                    *d = at(x.second, y.second);
        Colour out;
        for (std::size_t k = 0; k < 4; k++) {
            const float low = a[k] + x.weight * (b[k] - a[k]), high = c[k] + x.weight * (d[k] - c[k]);
            out[k] = low + y.weight * (high - low);
        }
        return out;
    }
    return mixed(mixed(texel(level, x.first, y.first), texel(level, x.second, y.first), x.weight),
                 mixed(texel(level, x.first, y.second), texel(level, x.second, y.second), x.weight), y.weight);
}

std::array<int, 4> Texture::linearBytes(const Level& level, float u, float v, const Sampling& how) const {
    const Between x = between(how.u, u, level.width), y = between(how.v, v, level.height);
    const int wx = static_cast<int>(std::lrint(x.weight * 256)), wy = static_cast<int>(std::lrint(y.weight * 256));
    const auto at = [&](int column, int row) {
        return &level.bytes[(static_cast<std::size_t>(row) * static_cast<std::size_t>(level.width) +
                             static_cast<std::size_t>(column)) *
                            4];
    };
    const std::uint8_t *a = at(x.first, y.first), *b = at(x.second, y.first), *c = at(x.first, y.second),
                       *d = at(x.second, y.second);
    std::array<int, 4> out;
    for (std::size_t k = 0; k < 4; k++) out[k] = mixedBytes(mixedBytes(a[k], b[k], wx), mixedBytes(c[k], d[k], wx), wy);
    return out;
}

Colour Texture::closest(const Level& level, float u, float v) const {
    return texel(level, nearest(sampling_.u, u, level.width), nearest(sampling_.v, v, level.height));
}

// The logarithm is linear between powers of two.
float Texture::levelOf(const float (&ddx)[2], const float (&ddy)[2]) const {
    const float w = static_cast<float>(width()), h = static_cast<float>(height());
    const auto squared = [&](const float(&d)[2]) { return d[0] * w * d[0] * w + d[1] * h * d[1] * h; };
    const float x = squared(ddx), y = squared(ddy), largest = std::max(x, y);
    if (!std::isfinite(x + y)) return 1000.0f;  // the coarsest, whatever is not a number
    int exponent = 0;
    const float mantissa = std::frexp(largest, &exponent);  // 0.5 … 1
    if (!(largest > 0)) return -1000.0f;
    return 0.5f * (static_cast<float>(exponent) + 2 * mantissa - 2);
}

Colour Texture::at(float u, float v, float level) const {
    const int last = levels() - 1;
    level = level == level ? std::clamp(level, 0.0f, static_cast<float>(last)) : static_cast<float>(last);
    const auto number = [](int i) { return static_cast<std::size_t>(i); };
    if (sampling_.closest) return closest(levels_[number(static_cast<int>(std::floor(level + 0.5f)))], u, v);
    const int first = static_cast<int>(level), second = std::min(first + 1, last);
    const float weight = level - static_cast<float>(first);
    if (!byteFilter_) {
        const Colour near = linear(levels_[number(first)], u, v, sampling_);
        return weight <= 0 ? near : mixed(near, linear(levels_[number(second)], u, v, sampling_), weight);
    }
    std::array<int, 4> bytes = linearBytes(levels_[number(first)], u, v, sampling_);
    if (weight > 0) {
        const std::array<int, 4> far = linearBytes(levels_[number(second)], u, v, sampling_);
        for (std::size_t c = 0; c < 4; c++) bytes[c] = mixedBytes(bytes[c], far[c], static_cast<int>(weight * 256));
    }
    Colour out;
    for (std::size_t c = 0; c < 4; c++) out[c] = static_cast<float>(bytes[c]) / 255.0f;
    return out;
}

}  // namespace shaderx::oracle
