// From one colour space to another, as text of the portable language.
#pragma once

#include <string>

#include "doc/color_spaces.h"

namespace shaderx {

// An expression in {{in}}, a color3, or a color4 whose alpha stays; empty where there is nothing to do.
std::string conversionText(const doc::ColorSpace& from, const doc::ColorSpace& to, bool hasAlpha);

}  // namespace shaderx
