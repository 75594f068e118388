// Which pixels a mesh covers.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace shaderx::oracle {

using Position = std::array<float, 4>;  // in clip space

// A quad of pixels as one triangle sees it: (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) with even x and y. Bit i of
// `covered` is set where the picture shows the triangle in pixel i.
struct Quad {
    std::uint32_t triangle = 0;
    int x = 0, y = 0;
    std::uint8_t covered = 0;
};

// Rasterises the triangles that turn counter-clockwise, with a depth test, bottom row first. A pixel is covered where
// its centre is inside; vertices are rounded to 1/256 of a pixel, as OpenGL's rasterisers do; shared edges belong to
// one triangle. Triangles that reach behind the eye are left out. The order of the quads is that of the triangles.
std::vector<Quad> rasterise(std::span<const Position> vertices, std::span<const unsigned> triangles, int side);

// The weights of a triangle's vertices at a pixel's centre, corrected for perspective. They add up to 1.
class Weights {
  public:
    Weights(const Position& a, const Position& b, const Position& c, int side);
    std::array<float, 3> at(int x, int y) const;

  private:
    double x_[3], y_[3], reciprocal_[3];  // of w
    double area_;
};

}  // namespace shaderx::oracle
