// Pictures as textures: levels, address modes and filters as OpenGL has them, with the choices of Mesa's software
// driver where OpenGL leaves one.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "image/image.h"

namespace shaderx::oracle {

using Colour = std::array<float, 4>;

enum class Address : std::uint8_t { Periodic, Clamp, Mirror, Constant };
Address addressNamed(const std::string& name);

struct Sampling {
    Address u = Address::Periodic, v = Address::Periodic;
    bool closest = false;
    Colour border = {0, 0, 0, 0};
};

class Texture {
  public:
    // The first row of the picture is at v = 0. With levels, each is made of the one before by linear filtering.
    Texture(const image::Image& picture, bool levels, const Sampling& sampling);

    int width() const { return levels_[0].width; }
    int height() const { return levels_[0].height; }
    int levels() const { return static_cast<int>(levels_.size()); }

    // At a level of detail, 0 being the largest picture.
    Colour at(float u, float v, float level) const;
    // The level of detail for the change of (u, v) from pixel to pixel: base 2 logarithm of the largest change of a
    // coordinate in texels.
    float levelOf(const float (&ddx)[2], const float (&ddy)[2]) const;

  private:
    struct Level {
        int width = 0, height = 0;
        std::vector<float> texels;        // RGBA
        std::vector<std::uint8_t> bytes;  // RGBA, instead of those
    };
    Level halved(const Level& from) const;
    Colour texel(const Level& level, int x, int y) const;
    Colour linear(const Level& level, float u, float v, const Sampling& how) const;
    Colour closest(const Level& level, float u, float v) const;
    std::array<int, 4> linearBytes(const Level& level, float u, float v, const Sampling& how) const;

    std::vector<Level> levels_;
    Sampling sampling_;
    bool byteFilter_ = false;
};

}  // namespace shaderx::oracle
