// Every colour space to the working space and back, by the driver and by the interpreter, against what the standards'
// primaries, white points and curves give in double precision.
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "compile/compile.h"
#include "draw/draw.h"
#include "oracle/render.h"
#include "support.h"

namespace shaderx::tests {
namespace {

using Color = std::array<double, 3>;
using Columns = std::array<Color, 3>;

// ---- The reference: the same standards, computed another way ----

struct Chromaticity {
    double x, y;
};
struct Gamut {
    Chromaticity red, green, blue, white;
};
constexpr Gamut kRec709{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.3127, 0.3290}};
constexpr Gamut kP3{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, {0.3127, 0.3290}};
constexpr Gamut kAdobe{{0.64, 0.33}, {0.21, 0.71}, {0.15, 0.06}, {0.3127, 0.3290}};
constexpr Gamut kRec2020{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}};
constexpr Gamut kAp1{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, {0.32168, 0.33767}};
constexpr Gamut kAp0{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}};

struct Space {
    const char* name;
    std::optional<Gamut> gamut;  // none: XYZ
    double gamma;                // 1: linear, 0: sRGB's curve
};
const Space kSpaces[] = {
    {"lin_rec709", kRec709, 1},
    {"srgb_texture", kRec709, 0},
    {"g18_rec709", kRec709, 1.8},
    {"g22_rec709", kRec709, 2.2},
    {"rec709_display", kRec709, 2.4},
    {"acescg", kAp1, 1},
    {"g22_ap1", kAp1, 2.2},
    {"srgb_ap1", kAp1, 0},
    {"lin_ap0", kAp0, 1},
    {"lin_displayp3", kP3, 1},
    {"srgb_displayp3", kP3, 0},
    {"g26_p3d65", kP3, 2.6},
    {"lin_adobergb", kAdobe, 1},
    {"adobergb", kAdobe, 563.0 / 256.0},
    {"lin_rec2020", kRec2020, 1},
    {"lin_ciexyzd65", std::nullopt, 1},
};

Color xyz(const Chromaticity& c) { return {c.x / c.y, 1, (1 - c.x - c.y) / c.y}; }

Color times(const Columns& m, const Color& v) {
    Color out{};
    for (std::size_t i = 0; i < 3; i++)
        for (std::size_t k = 0; k < 3; k++) out[i] += m[k][i] * v[k];
    return out;
}

// Solves m x = v by Gauss's elimination with pivots.
Color solved(const Columns& m, const Color& v) {
    double a[3][4];
    for (std::size_t i = 0; i < 3; i++) {
        for (std::size_t k = 0; k < 3; k++) a[i][k] = m[k][i];
        a[i][3] = v[i];
    }
    for (int p = 0; p < 3; p++) {
        int best = p;
        for (int i = p; i < 3; i++)
            if (std::abs(a[i][p]) > std::abs(a[best][p])) best = i;
        std::swap(a[p], a[best]);
        for (int i = 0; i < 3; i++) {
            if (i == p) continue;
            const double f = a[i][p] / a[p][p];
            for (int k = p; k < 4; k++) a[i][k] -= f * a[p][k];
        }
    }
    return {a[0][3] / a[0][0], a[1][3] / a[1][1], a[2][3] / a[2][2]};
}

Columns toXyz(const Gamut& g) {
    auto column = [](const Chromaticity& c) { return Color{c.x, c.y, 1 - c.x - c.y}; };
    Columns m{column(g.red), column(g.green), column(g.blue)};
    const Color strength = solved(m, xyz(g.white));
    for (std::size_t k = 0; k < 3; k++)
        for (double& e : m[k]) e *= strength[k];
    return m;
}

// Bradford's cones, by columns.
constexpr Columns kBradford{{{0.8951, -0.7502, 0.0389}, {0.2664, 1.7135, -0.0685}, {-0.1614, 0.0367, 1.0296}}};

Color adapted(const Color& value, const Chromaticity& from, const Chromaticity& to) {
    const Color a = times(kBradford, xyz(from)), b = times(kBradford, xyz(to));
    Color cones = times(kBradford, value);
    for (std::size_t i = 0; i < 3; i++) cones[i] *= b[i] / a[i];
    return solved(kBradford, cones);
}

double decoded(const Space& s, double v) {
    if (s.gamma == 0) return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    return s.gamma == 1 ? v : std::pow(std::max(v, 0.0), s.gamma);
}

double encoded(const Space& s, double v) {
    if (s.gamma == 0) return v <= 0.0031308 ? v * 12.92 : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return s.gamma == 1 ? v : std::pow(std::max(v, 0.0), 1 / s.gamma);
}

Color expected(const Space& from, const Space& to, Color v) {
    for (double& c : v) c = decoded(from, c);
    if (from.gamut) v = adapted(times(toXyz(*from.gamut), v), from.gamut->white, kRec709.white);
    if (to.gamut) v = solved(toXyz(*to.gamut), adapted(v, kRec709.white, to.gamut->white));
    for (double& c : v) c = encoded(to, c);
    return v;
}

// ---- What the shaders give ----

class ColorSpacesDrawn : public testing::Test {
  protected:
    void SetUp() override {
        Diagnostics loading;
        context_ = draw::Context::create(loading);
        if (!context_) GTEST_SKIP() << "no graphics driver here: " << loading.text();
        settings_.size = 3;
        settings_.samples = 1;
        settings_.supersample = 1;
    }

    void expectConversion(const Space& from, const Space& to, const Color& v) {
        Diagnostics diagnostics;
        doc::NoIncludes none;
        GenerateOptions how;
        how.colorspace = to.name;
        auto document = compiler_.read(
            "test.mtlx",
            fmt::format(
                "<materialx version='1.39' colorspace='{}'><constant name='c' type='color3'><input name='value' "
                "type='color3' value='{:.9g}, {:.9g}, {:.9g}'/></constant><output name='out' type='color3' "
                "nodename='c'/></materialx>",
                from.name, v[0], v[1], v[2]),
            none, diagnostics);
        Result<Shader> shader = compiler_.generate(*document, document->find("out"), how, diagnostics);
        ASSERT_TRUE(shader) << diagnostics.text();
        auto drawn = context_->render(draw::Job{settings_, shader->vertex, shader->pixel}, diagnostics);
        auto interpreted =
            studio_.render({settings_, &shader->program->module, &shader->program->interface}, diagnostics);
        ASSERT_TRUE(drawn && interpreted) << diagnostics.text();
        EXPECT_EQ(diagnostics.text(), "");
        const Color wanted = expected(from, to, v);
        for (int c = 0; c < 3; c++) {
            const double want = wanted[static_cast<std::size_t>(c)], size = std::max(1.0, std::abs(want));
            const auto where =
                fmt::format("{} to {} of ({}, {}, {}), component {}", from.name, to.name, v[0], v[1], v[2], c);
            EXPECT_NEAR(interpreted->at(1, 1, c), want, 1e-6 * size) << where;
            EXPECT_NEAR(drawn->at(1, 1, c), want, 1e-5 * size) << where;
        }
    }

    Compiler compiler_{builtinLibrary()};
    std::unique_ptr<draw::Context> context_;
    oracle::Studio studio_;
    scene::Settings settings_;
};

constexpr Color kValues[] = {{0.5, 0.25, 0.75}, {0.02, 0.9, 0.0}, {1, 1, 1}, {0.04, 0.003, 0.6}};

TEST_F(ColorSpacesDrawn, EachLeadsToRec709AndBack) {
    for (const Space& s : kSpaces)
        for (const Color& v : kValues) {
            expectConversion(s, kSpaces[0], v);
            expectConversion(kSpaces[0], s, v);
        }
}

TEST_F(ColorSpacesDrawn, EachLeadsToEach) {
    for (const Space& from : kSpaces)
        for (const Space& to : kSpaces) expectConversion(from, to, kValues[0]);
}

// Below 0 the straight piece of sRGB goes on, a power is 0, and what is linear keeps its sign.
TEST_F(ColorSpacesDrawn, Negatives) {
    for (const Space& s : {kSpaces[1], kSpaces[3], kSpaces[14]}) {
        expectConversion(s, kSpaces[0], {-0.25, 0.5, -0.01});
        expectConversion(kSpaces[0], s, {-0.25, 0.5, -0.001});
    }
}

}  // namespace
}  // namespace shaderx::tests
