// The environment: radiance and irradiance as latitude-longitude maps, zenith first.
#pragma once

#include "base/diagnostics.h"
#include "base/result.h"
#include "image/image.h"
#include "scene/settings.h"

namespace shaderx::scene {

struct Environment {
    image::Image radiance;    // float RGBA, width twice the height
    image::Image irradiance;  // 64 × 32, float RGBA: radiance convolved with the cosine, divided by π
};

// The built-in sky, 512 × 256: a gradient from the ground to the zenith and two soft lamps.
Environment builtInSky();

// A picture as environment. Values that are no radiance (negative, infinite, NaN) count as 0; one of bytes is taken as
// sRGB. Neither side may exceed `maxSide`: larger pictures are halved until they fit.
Result<Environment> loadEnvironment(const std::string& file, int maxSide, Diagnostics& diagnostics);

// The same light in the working space of a shader.
Environment inWorkingSpace(Environment environment, const Settings& settings);

}  // namespace shaderx::scene
