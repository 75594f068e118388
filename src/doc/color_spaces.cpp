#include "doc/color_spaces.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/numbers.h"

namespace shaderx::doc {

namespace {

using Vector3 = std::array<double, 3>;
using Point = std::array<double, 2>;  // CIE xy

constexpr Point kD65{0.3127, 0.3290};
constexpr Matrix3 kIdentity{1, 0, 0, 0, 1, 0, 0, 0, 1};

Matrix3 product(const Matrix3& a, const Matrix3& b) {
    Matrix3 c{};
    for (std::size_t i = 0; i < 3; i++)
        for (std::size_t j = 0; j < 3; j++)
            for (std::size_t k = 0; k < 3; k++) c[3 * i + j] += a[3 * i + k] * b[3 * k + j];
    return c;
}

Vector3 product(const Matrix3& a, const Vector3& v) {
    return {a[0] * v[0] + a[1] * v[1] + a[2] * v[2], a[3] * v[0] + a[4] * v[1] + a[5] * v[2],
            a[6] * v[0] + a[7] * v[1] + a[8] * v[2]};
}

double determinant(const Matrix3& m) {
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

// By Cramer's rule; the determinant is not 0.
Matrix3 inverse(const Matrix3& m) {
    const double d = 1 / determinant(m);
    return {d * (m[4] * m[8] - m[5] * m[7]), d * (m[2] * m[7] - m[1] * m[8]), d * (m[1] * m[5] - m[2] * m[4]),
            d * (m[5] * m[6] - m[3] * m[8]), d * (m[0] * m[8] - m[2] * m[6]), d * (m[2] * m[3] - m[0] * m[5]),
            d * (m[3] * m[7] - m[4] * m[6]), d * (m[1] * m[6] - m[0] * m[7]), d * (m[0] * m[4] - m[1] * m[3])};
}

Vector3 xyzOf(const Point& p) { return {p[0] / p[1], 1, (1 - p[0] - p[1]) / p[1]}; }

// White to white by Bradford's cone responses (Lam 1985; Lindbloom, "Chromatic Adaptation").
Matrix3 adaptation(const Point& from, const Point& to) {
    if (from == to) return kIdentity;
    constexpr Matrix3 kCones{0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
    const Vector3 a = product(kCones, xyzOf(from)), b = product(kCones, xyzOf(to));
    return product(inverse(kCones), product({b[0] / a[0], 0, 0, 0, b[1] / a[1], 0, 0, 0, b[2] / a[2]}, kCones));
}

// RGB to XYZ: the primaries' XYZ, each as strong as it must be for their sum to be the white (SMPTE RP 177).
std::optional<Matrix3> normalisedPrimaries(const Point& red, const Point& green, const Point& blue,
                                           const Point& white) {
    if (!(std::abs(white[1]) > 1e-6)) return {};
    const Matrix3 primaries{red[0],
                            green[0],
                            blue[0],
                            red[1],
                            green[1],
                            blue[1],
                            1 - red[0] - red[1],
                            1 - green[0] - green[1],
                            1 - blue[0] - blue[1]};
    if (!(std::abs(determinant(primaries)) > 1e-9)) return {};
    const Vector3 strength = product(inverse(primaries), xyzOf(white));
    return product(primaries, {strength[0], 0, 0, 0, strength[1], 0, 0, 0, strength[2]});
}

std::string lowered(std::string_view text) {
    std::string out(trim(text));
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return out;
}

// Whether one of the names in a list with commas is this one.
bool lists(std::string_view list, std::string_view name) {
    for (std::size_t at = 0; at <= list.size();) {
        const std::size_t end = std::min(list.find(',', at), list.size());
        if (lowered(list.substr(at, end - at)) == name) return true;
        at = end + 1;
    }
    return false;
}

std::optional<Point> pointOf(std::string_view text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) return {};
    const std::optional<double> x = parseDouble(text.substr(0, comma)), y = parseDouble(text.substr(comma + 1));
    if (!x || !y) return {};
    return Point{*x, *y};
}

}  // namespace

ElementRef ColorSpaces::declaration(std::string_view name) const {
    for (const ElementRef& e : definitions_.declared("colorspacedef")) {
        const Document& d = *e.document;
        if (lowered(d.text(e->name)) == name || lists(d.attributeText(e.id, d.names().find("alias")), name)) return e;
    }
    return {};
}

std::optional<ColorSpace> ColorSpaces::read(std::string_view name, int depth) const {
    constexpr int kDeepest = 8;  // aliases of aliases, primaries of another's
    const ElementRef element = declaration(lowered(name));
    if (!element || depth > kDeepest) return {};
    const NameTable& names = element.document->names();
    auto text = [&](std::string_view attribute) {
        const Name known = names.find(attribute);
        return known ? element.attributeText(known) : std::string_view();
    };
    if (std::string_view other = text("space"); !other.empty()) return read(other, depth + 1);
    ColorSpace space;
    space.name = element.document->text(element->name);
    space.isData = text("isdata") == "true";
    if (text("curve") == "srgb") space.curve = ColorSpace::Curve::Srgb;
    if (std::optional<double> gamma = parseDouble(text("gamma")); gamma && *gamma > 0) {
        space.curve = ColorSpace::Curve::Gamma;
        space.gamma = *gamma;
    }
    space.toXyz = kIdentity;
    if (std::string_view other = text("primaries"); !other.empty()) {
        const std::optional<ColorSpace> found = read(other, depth + 1);
        if (!found) return {};
        space.toXyz = found->toXyz;
    } else if (!text("red").empty()) {
        const std::optional<Point> red = pointOf(text("red")), green = pointOf(text("green")),
                                   blue = pointOf(text("blue")), white = pointOf(text("white"));
        if (!red || !green || !blue || !white) return {};
        const std::optional<Matrix3> matrix = normalisedPrimaries(*red, *green, *blue, *white);
        if (!matrix) return {};
        space.toXyz = product(adaptation(*white, kD65), *matrix);
    }
    return space;
}

const ColorSpace* ColorSpaces::find(std::string_view name) {
    auto [at, isNew] = found_.try_emplace(std::string(name));
    if (isNew) at->second = read(name, 0);
    return at->second ? &*at->second : nullptr;
}

std::vector<std::string_view> ColorSpaces::names() const {
    std::vector<std::string_view> all;
    for (const ElementRef& e : definitions_.declared("colorspacedef")) all.push_back(e.document->text(e->name));
    return all;
}

std::string_view ColorSpaces::nearest(std::string_view name) const {
    const std::string word = lowered(name);
    const std::vector<std::string_view> all = names();
    if (std::string_view found = shaderx::nearest(word, all); !found.empty()) return found;
    for (std::string_view candidate : all)
        if (!word.empty() && candidate.starts_with(word)) return candidate;
    return {};
}

void warnUnknownColorSpace(const Document& d, ElementId element, std::string_view workingSpace, std::string_view near,
                           Diagnostics& diagnostics) {
    Diagnostic& w = diagnostics.warning(
        "unknown-colorspace", fmt::format("there is no colour space '{}'; its colours are taken to be in '{}'",
                                          d.attributeText(element, d.known().colorspace), workingSpace));
    if (!near.empty()) w.hint = fmt::format("did you mean '{}'?", near);
    w.where = d.locate(element, d.known().colorspace);
    w.path = d.path(element);
}

void reportUnknownColorSpaces(const Document& d, const Definitions& definitions, Diagnostics& diagnostics) {
    constexpr std::string_view kWorking = "lin_rec709";
    const Name word = d.known().colorspace, usual = d.names().find(kWorking);
    ColorSpaces spaces(definitions);
    for (std::uint32_t i = 0; i < d.size(); i++) {
        const ElementId e(i);
        const Name said = d[e].category ? d.attribute(e, word) : Name();
        if (!said || said == usual || d.text(said).empty() || spaces.find(d.text(said))) continue;
        const Name node = d.names().find(fmt::format("{}_to_{}", d.text(said), kWorking));
        if (node && definitions.hasCategory(node)) continue;
        warnUnknownColorSpace(d, e, kWorking, spaces.nearest(d.text(said)), diagnostics);
    }
}

Matrix3 matrixBetween(const ColorSpace& from, const ColorSpace& to) {
    return from.toXyz == to.toXyz ? kIdentity : product(inverse(to.toXyz), from.toXyz);
}

bool isIdentity(const Matrix3& matrix) { return matrix == kIdentity; }

}  // namespace shaderx::doc
