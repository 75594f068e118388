// What is to be drawn.
#pragma once

#include <string>

#include "scene/settings.h"

namespace shaderx::draw {

using scene::Texture;
using scene::UniformValue;

struct Job : scene::Settings {
    std::string vertex, pixel;  // shader text
};

}  // namespace shaderx::draw
