#include "compile/color_conversion.h"

#include <fmt/format.h>

namespace shaderx {

namespace {

using doc::ColorSpace;

std::string decoded(const ColorSpace& space, std::string value) {
    switch (space.curve) {
        case ColorSpace::Curve::Linear:
            return value;
        case ColorSpace::Curve::Srgb:
            return fmt::format("srgb_to_linear({})", value);
        case ColorSpace::Curve::Gamma:
            return fmt::format("gamma_to_linear({}, {})", value, space.gamma);
    }
    return value;
}

std::string encoded(const ColorSpace& space, std::string value) {
    switch (space.curve) {
        case ColorSpace::Curve::Linear:
            return value;
        case ColorSpace::Curve::Srgb:
            return fmt::format("linear_to_srgb({})", value);
        case ColorSpace::Curve::Gamma:
            return fmt::format("linear_to_gamma({}, {})", value, space.gamma);
    }
    return value;
}

std::string timesMatrix(const doc::Matrix3& m, const std::string& value) {
    return fmt::format(
        "color(matrix33(vector({:.9g}, {:.9g}, {:.9g}), vector({:.9g}, {:.9g}, {:.9g}), "
        "vector({:.9g}, {:.9g}, {:.9g})) * vector({}))",
        m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8], value);
}

}  // namespace

std::string conversionText(const ColorSpace& from, const ColorSpace& to, bool hasAlpha) {
    const doc::Matrix3 matrix = doc::matrixBetween(from, to);
    const bool isLinear = doc::isIdentity(matrix);
    if (from.isData || to.isData || (isLinear && doc::isSameCurve(from, to))) return {};
    std::string value = decoded(from, hasAlpha ? "{{in}}.rgb" : "{{in}}");
    if (!isLinear) value = timesMatrix(matrix, value);
    value = encoded(to, value);
    return hasAlpha ? fmt::format("color4({}, {{{{in}}}}.a)", value) : value;
}

}  // namespace shaderx
