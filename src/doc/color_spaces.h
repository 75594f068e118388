// Colour spaces as libraries and documents declare them, and the way from each to each.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "doc/definitions.h"
#include "doc/document.h"

namespace shaderx::doc {

using Matrix3 = std::array<double, 9>;  // row by row

// What a <colorspacedef> says (nodes/color_transform.mtlx).
struct ColorSpace {
    enum class Curve : std::uint8_t { Linear, Srgb, Gamma };

    std::string_view name;  // the declared one, not an alias
    bool isData = false;    // no colour: never converted
    Curve curve = Curve::Linear;
    double gamma = 1;
    Matrix3 toXyz{};  // of linear values, to CIE XYZ with the white point of D65
};

// Finds spaces by name or alias; case does not matter. Earlier documents go before later ones.
class ColorSpaces {
  public:
    explicit ColorSpaces(const Definitions& definitions) : definitions_(definitions) {}

    // Null where there is no such space, or its declaration says no primaries that span a space.
    const ColorSpace* find(std::string_view name);
    // All names that are declared, for hints.
    std::vector<std::string_view> names() const;
    // The declared name that a wrong one may mean, empty where none is near.
    std::string_view nearest(std::string_view name) const;

  private:
    ElementRef declaration(std::string_view name) const;
    std::optional<ColorSpace> read(std::string_view name, int depth) const;

    const Definitions& definitions_;
    std::unordered_map<std::string, std::optional<ColorSpace>> found_;  // by name as asked for
};

// Warns (unknown-colorspace) of a space that an element says; `near` is the name that it may mean, or none.
void warnUnknownColorSpace(const Document& document, ElementId element, std::string_view workingSpace,
                           std::string_view near, Diagnostics& diagnostics);
// Warns of all unknown spaces that elements of a document say. `definitions` may have nodes X_to_lin_rec709 for a space
// X.
void reportUnknownColorSpaces(const Document& document, const Definitions& definitions, Diagnostics& diagnostics);

// Takes linear values of one space to linear values of another; the identity where their primaries are one's.
Matrix3 matrixBetween(const ColorSpace& from, const ColorSpace& to);
bool isIdentity(const Matrix3& matrix);
inline bool isSameCurve(const ColorSpace& a, const ColorSpace& b) { return a.curve == b.curve && a.gamma == b.gamma; }

}  // namespace shaderx::doc
