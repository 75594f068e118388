#include "oracle/raster.h"

#include <algorithm>
#include <cmath>

namespace shaderx::oracle {
namespace {

constexpr int kSubpixels = 256;

// In pixels from the lower left corner of the picture.
struct Window {
    float x, y, depth;
};

Window windowOf(const Position& p, int side) {
    const float reciprocal = 1.0f / p[3], half = static_cast<float>(side) * 0.5f;
    return {p[0] * reciprocal * half + half, p[1] * reciprocal * half + half, p[2] * reciprocal};
}

// An edge as a function that grows to the left of it, in subpixels; 0 counts as inside on top and left edges.
struct Edge {
    std::int64_t x0, y0, dx, dy;
    bool isInside(std::int64_t x, std::int64_t y) const {
        const std::int64_t value = dx * (y - y0) - dy * (x - x0);
        const bool takesBorder = dy < 0 || (dy == 0 && dx < 0);
        return value > 0 || (value == 0 && takesBorder);
    }
};

struct Triangle {
    Window corners[3];
    std::int64_t x[3], y[3];

    Triangle(const Window& a, const Window& b, const Window& c) : corners{a, b, c} {
        for (int i = 0; i < 3; i++) {
            x[i] = std::llrint((corners[i].x - 0.5f) * kSubpixels);
            y[i] = std::llrint((corners[i].y - 0.5f) * kSubpixels);
        }
    }
    std::int64_t area() const { return (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]); }
    // Calls f for each pixel whose centre is inside.
    template <class F>
    void cover(int side, F f) const {
        const auto first = [](std::int64_t v) { return (v + kSubpixels - 1) >> 8; };
        const auto [lowX, highX] = std::minmax({x[0], x[1], x[2]});
        const auto [lowY, highY] = std::minmax({y[0], y[1], y[2]});
        const std::int64_t end = side;
        const Edge edges[3] = {{x[0], y[0], x[1] - x[0], y[1] - y[0]},
                               {x[1], y[1], x[2] - x[1], y[2] - y[1]},
                               {x[2], y[2], x[0] - x[2], y[0] - y[2]}};
        for (std::int64_t j = std::max<std::int64_t>(first(lowY), 0); j <= highY >> 8 && j < end; j++)
            for (std::int64_t i = std::max<std::int64_t>(first(lowX), 0); i <= highX >> 8 && i < end; i++) {
                const bool inside = std::all_of(std::begin(edges), std::end(edges), [&](const Edge& e) {
                    return e.isInside(i * kSubpixels, j * kSubpixels);
                });
                if (inside) f(static_cast<int>(i), static_cast<int>(j));
            }
    }
    double depth(int px, int py) const {
        const Window &a = corners[0], &b = corners[1], &c = corners[2];
        const double dx = px + 0.5 - a.x, dy = py + 0.5 - a.y;
        const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y, whole = bx * cy - cx * by;
        if (whole == 0) return a.depth;
        const double s = (dx * cy - cx * dy) / whole, t = (bx * dy - dx * by) / whole;
        return a.depth + s * (b.depth - a.depth) + t * (c.depth - a.depth);
    }
};

}  // namespace

std::vector<Quad> rasterise(std::span<const Position> vertices, std::span<const unsigned> triangles, int side) {
    const std::uint32_t none = 0xffffffffu;
    const std::size_t pixels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    std::vector<std::uint32_t> owner(pixels, none);
    std::vector<double> depth(pixels, 1);
    const auto triangleAt = [&](std::size_t t) {
        const Position &a = vertices[triangles[3 * t]], &b = vertices[triangles[3 * t + 1]],
                       &c = vertices[triangles[3 * t + 2]];
        return Triangle(windowOf(a, side), windowOf(b, side), windowOf(c, side));
    };
    const auto isDrawn = [&](std::size_t t) {
        for (std::size_t i = 0; i < 3; i++) {
            const Position& p = vertices[triangles[3 * t + i]];
            // Far outside, window coordinates would not fit.
            if (!(p[3] > 0) || !(std::fabs(p[0]) < 1000 * p[3]) || !(std::fabs(p[1]) < 1000 * p[3])) return false;
        }
        return true;
    };
    const auto pixel = [side](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x);
    };
    std::vector<std::uint32_t> drawn;
    for (std::size_t t = 0; t < triangles.size() / 3; t++) {
        if (!isDrawn(t)) continue;
        const Triangle triangle = triangleAt(t);
        if (triangle.area() <= 0) continue;
        drawn.push_back(static_cast<std::uint32_t>(t));
        triangle.cover(side, [&](int x, int y) {
            const double z = triangle.depth(x, y);
            if (!(z < depth[pixel(x, y)]) || z < -1) return;
            depth[pixel(x, y)] = z;
            owner[pixel(x, y)] = static_cast<std::uint32_t>(t);
        });
    }
    std::vector<Quad> quads;
    for (std::uint32_t t : drawn) {
        std::size_t first = quads.size();  // of these two rows
        int row = -1;
        triangleAt(t).cover(side, [&](int x, int y) {
            if (owner[pixel(x, y)] != t) return;
            if ((y & ~1) != row) first = quads.size();
            row = y & ~1;
            const auto known = std::find_if(quads.begin() + static_cast<std::ptrdiff_t>(first), quads.end(),
                                            [&](const Quad& q) { return q.x == (x & ~1) && q.y == (y & ~1); });
            Quad& quad = known != quads.end() ? *known : quads.emplace_back(Quad{t, x & ~1, y & ~1, 0});
            quad.covered = static_cast<std::uint8_t>(quad.covered | 1 << ((x & 1) + 2 * (y & 1)));
        });
    }
    return quads;
}

Weights::Weights(const Position& a, const Position& b, const Position& c, int side) {
    const Position* corners[3] = {&a, &b, &c};
    for (int i = 0; i < 3; i++) {
        const Window w = windowOf(*corners[i], side);
        x_[i] = w.x;
        y_[i] = w.y;
        reciprocal_[i] = 1.0 / (*corners[i])[3];
    }
    area_ = (x_[1] - x_[0]) * (y_[2] - y_[0]) - (x_[2] - x_[0]) * (y_[1] - y_[0]);
}

std::array<float, 3> Weights::at(int x, int y) const {
    if (area_ == 0) return {1, 0, 0};
    const double dx = x + 0.5 - x_[0], dy = y + 0.5 - y_[0];
    const double b = (dx * (y_[2] - y_[0]) - (x_[2] - x_[0]) * dy) / area_;
    const double c = ((x_[1] - x_[0]) * dy - dx * (y_[1] - y_[0])) / area_;
    const double weights[3] = {(1 - b - c) * reciprocal_[0], b * reciprocal_[1], c * reciprocal_[2]};
    const double sum = weights[0] + weights[1] + weights[2];
    return {static_cast<float>(weights[0] / sum), static_cast<float>(weights[1] / sum),
            static_cast<float>(weights[2] / sum)};
}

}  // namespace shaderx::oracle
