// From what was drawn to the file.
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "image/image.h"
#include "scene/settings.h"

namespace shaderx::scene {

// How many pixels a side are drawn for one of the picture.
int supersampling(const Settings& settings);

// Means of n × n pixels.
image::Image reduced(const image::Image& image, int n);

// A color times a matrix given row by row, in place.
void multiply(const std::array<float, 9>& matrix, float* color);

// A picture as a display has to be told: linear Rec. 709.
image::Image forDisplay(const Settings& settings, image::Image picture);

// Warns that a texture's file could not be read, for the reasons that `reading` has: missing-texture, where the
// document names the file.
void warnOfMissing(const Texture& texture, const Diagnostics& reading, Diagnostics& diagnostics);

// Whether the output's name says what kind of picture it is to be; reports unknown-output-format.
bool checkOutput(const Settings& settings, Diagnostics& diagnostics);

// Writes the picture to the output. Reports cannot-write-file.
bool writePicture(const Settings& settings, const image::Image& picture, Diagnostics& diagnostics);

}  // namespace shaderx::scene
