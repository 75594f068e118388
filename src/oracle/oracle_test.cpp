#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "ir/text.h"
#include "ir/validate.h"
#include "oracle/raster.h"
#include "oracle/render.h"
#include "oracle/texture.h"
#include "scene/sphere.h"

namespace shaderx::oracle {
namespace {

namespace fs = std::filesystem;
using image::Image;

// ---- Rasterising ----

int bits(unsigned v) { return __builtin_popcount(v); }

TEST(Raster, ADiscHasItsArea) {
    std::vector<Position> fan{{0, 0, 0, 1}};
    std::vector<unsigned> triangles;
    for (unsigned i = 0; i < 100; i++) {
        const double angle = i * 2 * std::numbers::pi / 100;
        fan.push_back({static_cast<float>(0.8 * std::cos(angle)), static_cast<float>(0.8 * std::sin(angle)), 0, 1});
        triangles.insert(triangles.end(), {0, i + 1, (i + 1) % 100 + 1});
    }
    int covered = 0;
    std::set<std::pair<int, int>> seen;
    for (const Quad& q : rasterise(fan, triangles, 100)) {
        EXPECT_TRUE(q.x % 2 == 0 && q.y % 2 == 0 && q.covered != 0);
        covered += bits(q.covered);
        for (int i = 0; i < 4; i++)
            if (q.covered >> i & 1) {
                EXPECT_TRUE(seen.insert({q.x + i % 2, q.y + i / 2}).second) << "drawn twice";
            }
    }
    EXPECT_NEAR(covered, std::numbers::pi * 40 * 40, 30);
}

TEST(Raster, NearerTrianglesHideOthersAndBacksAreLeftOut) {
    const std::vector<Position> corners{{-1, -1, 0.5, 1}, {1, -1, 0.5, 1}, {-1, 1, 0.5, 1},
                                        {-1, -1, 0.2, 1}, {1, -1, 0.2, 1}, {-1, 1, 0.2, 1}};
    const std::vector<unsigned> both{0, 1, 2, 3, 4, 5}, turned{0, 2, 1};
    int covered = 0;
    for (const Quad& q : rasterise(corners, both, 8)) {
        EXPECT_EQ(q.triangle, 1u);
        covered += bits(q.covered);
    }
    // The diagonal goes through pixel centres, which are the other half's: it is no left edge.
    EXPECT_EQ(covered, 28);
    EXPECT_TRUE(rasterise(corners, turned, 8).empty());
}

TEST(Raster, WeightsFollowPerspective) {
    // From (-1, 0) at w = 1 to (1, 0) at w = 3: the middle of the picture is a quarter of the way.
    const Position a{-1, -1, 0, 1}, b{3, -3, 0, 3}, c{-1, 1, 0, 1};
    const auto w = Weights(a, b, c, 2).at(0, 0);  // window (0.5, 0.5)
    EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-6);
    EXPECT_NEAR(w[1] / w[2], 1.0 / 3, 1e-5);
}

// ---- Textures ----

Image bytes(int width, int height, std::initializer_list<int> grey) {
    Image out = Image::ofBytes(width, height, 1);
    std::copy(grey.begin(), grey.end(), out.bytes.begin());
    return out;
}

Image numbers(int width, int height, std::initializer_list<float> grey) {
    Image out = Image::ofFloats(width, height, 1);
    std::copy(grey.begin(), grey.end(), out.floats.begin());
    return out;
}

TEST(Textures, Addresses) {
    const Image row = numbers(4, 1, {0, 1, 2, 3});
    const auto red = [&](Address address, float u) {
        return Texture(row, false, {address, Address::Clamp, false, {9, 9, 9, 9}}).at(u, 0.5f, 0)[0];
    };
    for (Address a : {Address::Periodic, Address::Clamp, Address::Mirror, Address::Constant}) {
        EXPECT_EQ(red(a, 0.125f), 0);
        EXPECT_EQ(red(a, 0.5f), 1.5f);
    }
    EXPECT_EQ(red(Address::Periodic, 0), 1.5f);  // between the last and the first
    EXPECT_EQ(red(Address::Periodic, -0.125f), 3);
    EXPECT_EQ(red(Address::Clamp, 5), 3);
    EXPECT_EQ(red(Address::Clamp, -5), 0);
    EXPECT_EQ(red(Address::Mirror, 1.125f), 3);
    EXPECT_EQ(red(Address::Mirror, -0.375f), 1);
    EXPECT_EQ(red(Address::Constant, 0), 4.5f);
    EXPECT_EQ(red(Address::Constant, 2), 9);
    for (Address a : {Address::Periodic, Address::Clamp, Address::Mirror, Address::Constant})
        for (float wild : {NAN, INFINITY, -INFINITY, 3e38f}) red(a, wild);  // only has to return
}

TEST(Textures, LevelsAreMeansAndMixLinearly) {
    const Texture t(numbers(4, 2, {0, 4, 8, 12, 4, 8, 12, 16}), true, {Address::Clamp, Address::Clamp, false, {}});
    EXPECT_EQ(t.levels(), 3);
    EXPECT_EQ(t.at(0.25f, 0.5f, 1)[0], 4);
    EXPECT_EQ(t.at(0.75f, 0.5f, 1)[0], 12);
    EXPECT_EQ(t.at(0.3f, 0.9f, 2)[0], 8);
    EXPECT_EQ(t.at(0.25f, 0.5f, 1.5f)[0], 6);
    EXPECT_EQ(t.at(0.25f, 0.5f, 100)[0], 8);
    EXPECT_EQ(t.at(0.25f, 0.5f, NAN)[0], t.at(0.25f, 0.5f, 100)[0]);
}

TEST(Textures, LevelOfAChange) {
    const Texture t(numbers(4, 4, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), true, {});
    const auto level = [&](float a, float b, float c, float d) { return t.levelOf({a, b}, {c, d}); };
    EXPECT_EQ(level(0.25f, 0, 0, 0), 0);
    EXPECT_EQ(level(0, 0.25f, 0, 1), 2);
    EXPECT_NEAR(level(0.25f, 0.25f, 0, 0), 0.5f, 1e-6);
    EXPECT_LT(level(0, 0, 0, 0), -100);
}

TEST(Textures, BytesAreMixedInWholeNumbers) {
    const Texture t(bytes(2, 1, {10, 15}), true, {Address::Clamp, Address::Clamp, false, {}});
    EXPECT_EQ(t.at(0.5f, 0.5f, 0)[0] * 255, 13);  // 12.5 rounded up
    EXPECT_EQ(t.at(0.5f, 0.5f, 1)[0] * 255, 13);
}

TEST(Textures, ClosestTakesOneTexel) {
    const Texture t(numbers(2, 1, {1, 5}), false, {Address::Periodic, Address::Periodic, true, {}});
    EXPECT_EQ(t.at(0.49f, 0.5f, 0)[0], 1);
    EXPECT_EQ(t.at(0.51f, 0.5f, 0)[0], 5);
    EXPECT_EQ(t.at(-0.1f, 0.5f, 0)[0], 5);
}

// ---- Pictures ----

struct Drawing {
    NameTable names;
    ir::Module module{names};
    passes::ShaderInterface interface;
    RenderJob job;
    Diagnostics diagnostics;

    explicit Drawing(const std::string& text) {
        Diagnostics d;
        EXPECT_TRUE(ir::parse(module, "test", text, d)) << d.text();
        interface = passes::makeStages(module, names.intern("pixel"), names.intern("vertex"));
        EXPECT_TRUE(ir::validate(module, d)) << d.text();
        job.module = &module;
        job.interface = &interface;
        job.size = 33;
    }
    Image render() {
        const Result<Image> out = oracle::render(job, diagnostics);
        EXPECT_TRUE(out) << diagnostics.text();
        return out ? *out : Image();
    }
    std::string codes() const {
        std::string out;
        for (const Diagnostic& d : diagnostics.all()) out += d.code + " ";
        return out;
    }
};

constexpr const char* kNormal = R"(function pixel() -> (out: vector4) {
    %n = context vector3 normal_world
    %one = constant float 1
    %r = make vector4 %n, %one
    return %r
})";

TEST(Render, TheSphereStandsUpright) {
    Drawing d(kNormal);
    const Image out = d.render();
    EXPECT_EQ(d.codes(), "");
    EXPECT_NEAR(out.at(16, 16, 2), 1, 1e-3);  // towards the eye
    EXPECT_GT(out.at(16, 6, 1), 0.5f);        // up
    EXPECT_GT(out.at(26, 16, 0), 0.5f);       // right
    EXPECT_EQ(out.at(0, 0, 3), 0);
    EXPECT_EQ(out.at(16, 16, 3), 1);
}

TEST(Render, ThreadsDoNotMatter) {
    Drawing d(kNormal);
    d.job.threads = 1;
    const Image one = d.render();
    d.job.threads = 5;
    EXPECT_EQ(d.render().floats, one.floats);
}

TEST(Render, DerivativesAreThoseOfTheTriangle) {
    Drawing d(R"(function pixel() -> (out: vector4) {
        %p = context point position_world
        %dx = ddx point %p
        %dy = ddy point %p
        %x = swizzle float %dx, x
        %y = swizzle float %dy, y
        %z = swizzle float %dx, y
        %one = constant float 1
        %r = make vector4 %x, %y, %z, %one
        return %r
    })");
    const Image out = d.render();
    const float pixel = 2 * 3 * std::tan(static_cast<float>(17.5 * std::numbers::pi / 180)) / 33;  // at the pole
    EXPECT_NEAR(out.at(16, 16, 0), pixel, pixel * 0.05f);
    EXPECT_NEAR(out.at(16, 16, 1), pixel, pixel * 0.05f);
    EXPECT_NEAR(out.at(16, 16, 2), 0, pixel * 0.05f);
}

constexpr const char* kPicture = R"(uniform picture: texture2d = 0 "a/file"
uniform tint: float = 0.5 "a/tint"
function pixel() -> (out: vector4) {
    %t = uniform texture2d picture
    %uv = attribute vector2 texcoord_0
    %zero = constant float 0
    %c = texture_level vector4 %t, %uv, %zero
    %k = uniform float tint
    %r = mul vector4 %c, %k
    return %r
})";

std::string pictureProgram() {
    std::string text = kPicture;
    text.replace(text.find(" = 0 "), 5, " ");
    return text;
}

TEST(Render, TexturesAndUniforms) {
    Drawing d(pictureProgram());
    const fs::path file = fs::temp_directory_path() / ("shaderx_oracle_test_" + std::to_string(::getpid()) + ".pfm");
    // Red is the row, from the top.
    Image picture = Image::ofFloats(1, 4, 3);
    for (int y = 0; y < 4; y++) picture.floats[picture.index(0, y, 0)] = static_cast<float>(y);
    ASSERT_TRUE(image::writePfm(file.string(), picture, d.diagnostics));
    scene::Texture texture;
    texture.uniform = "picture";
    texture.file = file.string();
    texture.filter = "closest";
    d.job.textures = {texture};
    Image out = d.render();
    EXPECT_EQ(out.at(16, 13, 0), 0.5f);  // v = 1 is the top row
    EXPECT_EQ(out.at(16, 19, 0), 1);
    d.job.uniforms = {{"tint", {2}}, {"u_envLightIntensity", {2}}, {"nobody", {1}}};
    out = d.render();
    EXPECT_EQ(out.at(16, 19, 0), 4);
    EXPECT_EQ(d.codes(), "unused-uniform unused-uniform ");
    fs::remove(file);
}

TEST(Render, MissingPicturesAreWarnings) {
    Drawing d(pictureProgram());
    EXPECT_EQ(d.render().at(16, 16, 0), 0.5f);
    EXPECT_EQ(d.codes(), "unbound-sampler ");
    scene::Texture texture;
    texture.uniform = "picture";
    texture.file = "/nowhere/at/all.png";
    texture.defaultColor[0] = 0.25f;
    d.job.textures = {texture};
    EXPECT_EQ(d.render().at(16, 16, 0), 0.125f);
    EXPECT_EQ(d.codes(), "unbound-sampler missing-texture ");
}

TEST(Render, Refuses) {
    Drawing d(kNormal);
    d.job.size = 0;
    EXPECT_FALSE(render(d.job, d.diagnostics));
    d.job.size = 8;
    d.job.output = "picture.unknown";
    EXPECT_FALSE(draw(d.job, d.diagnostics));
    d.job.environment = "/nowhere/at/all.hdr";
    EXPECT_FALSE(render(d.job, d.diagnostics));
    EXPECT_EQ(d.codes(), "bad-size unknown-output-format cannot-read-image ");
}

TEST(Render, SaysWhatTheInterpreterCannotRun) {
    Drawing d(R"(function pixel() -> (out: vector4) {
        %s = context point vertex_position
        %one = constant float 1
        %r = make vector4 %s, %one
        return %r
    })");
    EXPECT_FALSE(render(d.job, d.diagnostics));
    EXPECT_EQ(d.codes(), "no-value ");
}

}  // namespace
}  // namespace shaderx::oracle
