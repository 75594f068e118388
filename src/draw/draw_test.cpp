#include "draw/draw.h"

#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "scene/sky.h"
#include "scene/sphere.h"

namespace shaderx::draw {
namespace {

namespace fs = std::filesystem;
using image::Image;
using namespace scene;

// Passes on position, normal and texture coordinates.
constexpr const char* kVertex = R"(#version 330
uniform mat4 u_worldMatrix;
uniform mat4 u_viewProjectionMatrix;
in vec3 i_position;
in vec3 i_normal;
in vec2 i_texcoord_0;
out vec3 normal;
out vec2 uv;
void main() {
    normal = i_normal;
    uv = i_texcoord_0;
    gl_Position = u_viewProjectionMatrix * (u_worldMatrix * vec4(i_position, 1.0));
}
)";

std::string pixelShader(const std::string& declarations, const std::string& value) {
    return "#version 330\nin vec3 normal;\nin vec2 uv;\nout vec4 out1;\n" + declarations +
           "\nvoid main() { out1 = " + value + "; }\n";
}

class Drawing : public testing::Test {
  protected:
    void SetUp() override {
        Diagnostics loading;
        context_ = Context::create(loading);
        if (!context_) GTEST_SKIP() << "no graphics driver here: " << loading.text();
        folder_ = fs::temp_directory_path() / ("shaderx_draw_test_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override {
        if (!folder_.empty()) fs::remove_all(folder_);
    }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    Job job(const std::string& declarations, const std::string& value, int size = 65) const {
        Job out;
        out.vertex = kVertex;
        out.pixel = pixelShader(declarations, value);
        out.size = size;
        return out;
    }
    // The picture's middle pixel, which sees the sphere along its z axis.
    std::vector<float> middle(const Job& what) {
        const Result<Image> out = context_->render(what, diagnostics_);
        if (!out) return {};
        const float* pixel = &out->floats[out->index(what.size / 2, what.size / 2, 0)];
        return {pixel, pixel + 4};
    }
    std::string codes() const {
        std::string out;
        for (const Diagnostic& d : diagnostics_.all()) out += d.code + " ";
        return out;
    }

    std::unique_ptr<Context> context_;
    fs::path folder_;
    Diagnostics diagnostics_;
};

TEST_F(Drawing, TheSphereStandsUprightOnNothing) {
    const Result<Image> out = context_->render(job("", "vec4(normal * 0.5 + 0.5, 1.0)", 64), diagnostics_);
    ASSERT_TRUE(out) << diagnostics_.text();
    ASSERT_TRUE(diagnostics_.all().empty()) << diagnostics_.text();
    EXPECT_EQ(out->at(0, 0, 3), 0);
    EXPECT_EQ(out->at(0, 0, 0), 0);
    EXPECT_NEAR(out->at(32, 32, 2), 1, 2e-3);
    EXPECT_GT(out->at(32, 10, 1), 0.75);  // above: y up
    EXPECT_LT(out->at(32, 53, 1), 0.25);
    EXPECT_GT(out->at(53, 32, 0), 0.75);  // to the right: x
    EXPECT_LT(out->at(10, 32, 0), 0.25);
    // The disc of a unit sphere seen from a distance of 4: tan of its half angle is 1/√15.
    double covered = 0;
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) covered += out->at(x, y, 3);
    const double radius = 32 / std::sqrt(15.0) / std::tan(17.5 * 3.14159265 / 180);
    EXPECT_NEAR(covered, 3.14159265 * radius * radius, 0.02 * covered);
}

TEST_F(Drawing, UniformsHaveTheirNamesAndCanBeReplaced) {
    Job what = job("uniform vec3 u_viewPosition; uniform int u_envRadianceSamples; uniform int u_envRadianceMips;",
                   "vec4(u_viewPosition.z, float(u_envRadianceSamples), float(u_envRadianceMips), 1.0)");
    what.samples = 7;
    EXPECT_EQ(middle(what), (std::vector<float>{4, 7, 10, 1}));
    what = job("struct Light { int type; vec3 color; }; uniform Light u_lightData[2]; uniform mat4 u_envMatrix;",
               "vec4(u_lightData[1].color * float(u_lightData[1].type), u_envMatrix[0][0])");
    what.uniforms = {
        {"u_lightData[1].type", {2}}, {"u_lightData[1].color", {1, 2, 3}}, {"u_envMatrix", {1, 2}}, {"u_nothing", {1}}};
    EXPECT_EQ(middle(what), (std::vector<float>{2, 4, 6, -1}));
    EXPECT_EQ(codes(), "bad-uniform-value unused-uniform ");
}

TEST_F(Drawing, TexturesLieWithTheirBottomRowAtZero) {
    Image picture = Image::ofBytes(2, 2, 3);
    picture.bytes = {255, 0, 0, 255, 0, 0, 0, 0, 255, 0, 255, 255};  // red above, blue and cyan below
    ASSERT_TRUE(writePng(path("t.png"), picture, diagnostics_));
    Job what = job("uniform sampler2D image_file;", "textureLod(image_file, vec2(0.75, 0.25), 0.0)");
    what.textures = {{"image_file", path("t.png"), "periodic", "periodic", "closest", {0, 0, 0, 0}, "image"}};
    EXPECT_EQ(middle(what), (std::vector<float>{0, 1, 1, 1}));
    what.pixel = pixelShader("uniform sampler2D image_file;", "textureLod(image_file, vec2(1.75, 0.75), 0.0)");
    EXPECT_EQ(middle(what), (std::vector<float>{1, 0, 0, 1}));
    what.textures[0].uAddress = "constant";
    what.textures[0].defaultColor[1] = 0.5f;
    EXPECT_EQ(middle(what), (std::vector<float>{0, 0.5f, 0, 0}));
    EXPECT_EQ(codes(), "");
}

TEST_F(Drawing, FloatTexturesKeepTheirValues) {
    Image picture = Image::ofFloats(1, 1, 1);
    picture.floats = {1234.5f};
    ASSERT_TRUE(writeExr(path("t.exr"), picture, diagnostics_));
    Job what = job("uniform sampler2D image_file;", "texture(image_file, uv)");
    what.textures = {{"image_file", path("t.exr"), "clamp", "mirror", "linear", {0, 0, 0, 0}, ""}};
    EXPECT_EQ(middle(what), (std::vector<float>{1234.5f, 1234.5f, 1234.5f, 1}));
}

TEST_F(Drawing, MissingTexturesAreWarnings) {
    Job what = job("uniform sampler2D a; uniform sampler2D b; uniform sampler2D c;",
                   "texture(a, uv) + texture(b, uv) * texture(c, uv)");
    what.textures = {{"a", path("absent.png"), "", "", "", {0.25f, 0.5f, 1, 0}, "NG/image1"},
                     {"c", "", "", "", "", {1, 2, 4, 1}, "NG/image2"}};
    EXPECT_EQ(middle(what), (std::vector<float>{1.25f, 2.5f, 5, 1}));
    EXPECT_EQ(codes(), "missing-texture unbound-sampler ");
    EXPECT_FALSE(diagnostics_.hasErrors());
    EXPECT_EQ(diagnostics_.all()[0].path, "NG/image1");
}

TEST_F(Drawing, BrokenShadersAreDiagnosticsWithTheDriversLog) {
    Job what = job("", "nothing");
    what.vertex = "#version 330\nvoid main() { gl_Position = 1; }\n";
    EXPECT_FALSE(context_->render(what, diagnostics_));
    EXPECT_EQ(codes(), "driver-rejected driver-rejected ");
    EXPECT_FALSE(diagnostics_.all()[1].notes.empty());
    EXPECT_NE(diagnostics_.text().find("nothing"), std::string::npos);
    Job unlinked = job("", "vec4(1.0)");
    unlinked.pixel = "#version 330\nin vec4 uv;\nout vec4 out1;\nvoid main() { out1 = uv; }\n";  // a vec2 elsewhere
    EXPECT_FALSE(context_->render(unlinked, diagnostics_));
    EXPECT_EQ(diagnostics_.all().back().code, "driver-rejected");
    EXPECT_FALSE(context_->render(Job{}, diagnostics_));
    EXPECT_EQ(middle(job("", "vec4(0.5)"))[0], 0.5f) << "a good job after bad ones";
}

TEST_F(Drawing, RefusesBadSizesAndNames) {
    for (const int size : {0, -3, 1 << 20}) EXPECT_FALSE(context_->render(job("", "vec4(1.0)", size), diagnostics_));
    EXPECT_EQ(codes(), "bad-size bad-size bad-size ");
    Job what = job("", "vec4(1.0)");
    what.output = path("a.jpg");
    EXPECT_FALSE(context_->draw(what, diagnostics_));
    EXPECT_EQ(diagnostics_.all().back().code, "unknown-output-format");
    what.output = path("a.exr");
    what.environment = path("absent.hdr");
    EXPECT_FALSE(context_->draw(what, diagnostics_));
    EXPECT_EQ(diagnostics_.all().back().code, "cannot-read-image");
}

TEST_F(Drawing, WritesPictures) {
    Job what = job("", "vec4(0.25, 0.5, 2.0, 1.0)");
    for (const char* name : {"a.exr", "a.pfm", "a.PNG"}) {
        what.output = path(name);
        what.samples = 16;
        what.exposure = -1;
        ASSERT_TRUE(context_->draw(what, diagnostics_)) << diagnostics_.text();
        const Result<Image> out = image::readImage(what.output, diagnostics_);
        ASSERT_TRUE(out);
        const bool png = !out->isFloat;
        EXPECT_NEAR(out->at(32, 32, 0), png ? image::linearToSrgb(0.125f) : 0.25f, png ? 0.002 : 0);
        EXPECT_EQ(out->at(32, 32, 2), png ? 1 : 2);
    }
}

TEST_F(Drawing, SupersamplingAveragesCoverage) {
    Job what = job("", "vec4(1.0)", 32);
    what.supersample = 4;
    const Result<Image> out = context_->render(what, diagnostics_);
    ASSERT_TRUE(out);
    int partly = 0;
    for (int i = 0; i < 32 * 32; i++) {
        const float alpha = out->floats[static_cast<std::size_t>(i) * 4 + 3];
        partly += alpha > 0 && alpha < 1;
    }
    EXPECT_GT(partly, 30);
    EXPECT_EQ(out->at(16, 16, 0), 1);
}

TEST_F(Drawing, AnEnvironmentIsReadFromAFile) {
    Image sky = Image::ofFloats(128, 64, 3);
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 128; x++)
            for (int c = 0; c < 3; c++) sky.floats[sky.index(x, y, c)] = y < 32 ? 2.0f : 0.0f;  // light from above
    sky.floats[0] = NAN;
    ASSERT_TRUE(writeExr(path("sky.exr"), sky, diagnostics_));
    Job what =
        job("uniform sampler2D u_envRadiance; uniform sampler2D u_envIrradiance; uniform int u_envRadianceMips;",
            "vec4(textureLod(u_envRadiance, vec2(0.3, 0.1), 0.0).x, texture(u_envIrradiance, vec2(0.3, 0.02)).x, "
            "texture(u_envIrradiance, vec2(0.3, 0.5)).x, float(u_envRadianceMips))");
    what.environment = path("sky.exr");
    const std::vector<float> out = middle(what);
    ASSERT_EQ(out.size(), 4u) << diagnostics_.text();
    EXPECT_EQ(out[0], 2);
    EXPECT_NEAR(out[1], 2, 0.01);
    EXPECT_NEAR(out[2], 1, 0.05);  // half the sky at the horizon
    EXPECT_EQ(out[3], 8);
}

TEST_F(Drawing, ContextsDoNotDisturbEachOther) {
    const Job what = job("", "vec4(0.75)");
    {
        const std::unique_ptr<Context> other = Context::create(diagnostics_);
        ASSERT_TRUE(other);
        EXPECT_TRUE(other->render(what, diagnostics_));
    }
    EXPECT_EQ(middle(what), (std::vector<float>{0.75f, 0.75f, 0.75f, 0.75f}));
}

TEST(Sky, MeanIrradianceIsMeanRadiance) {
    const Environment sky = builtInSky();
    EXPECT_EQ(sky.radiance.width, 512);
    double means[2] = {};
    const Image* maps[] = {&sky.radiance, &sky.irradiance};
    for (int i = 0; i < 2; i++) {
        double sum = 0, weights = 0;
        for (int y = 0; y < maps[i]->height; y++)
            for (int x = 0; x < maps[i]->width; x++) {
                const double weight = std::sin((y + 0.5) / maps[i]->height * 3.14159265);
                sum += weight * maps[i]->at(x, y, 1);
                weights += weight;
            }
        means[i] = sum / weights;
    }
    EXPECT_NEAR(means[0], means[1], 2e-3 * means[0]);
}

TEST(Scene, InversesAreInverse) {
    const auto find = [all = sceneMatrices()](const std::string& name) {
        for (const NamedMatrix& m : all)
            if (m.uniform == name) return m.value;
        return Matrix{};
    };
    for (const char* pair : {"u_projection", "u_view", "u_world"}) {
        const Matrix a = find(std::string(pair) + "Matrix"), b = find(std::string(pair) + "InverseMatrix");
        for (std::size_t c = 0; c < 4; c++)
            for (std::size_t r = 0; r < 4; r++) {
                float sum = 0;
                for (std::size_t k = 0; k < 4; k++) sum += a[k * 4 + r] * b[c * 4 + k];
                EXPECT_NEAR(sum, c == r ? 1 : 0, 1e-5) << pair;
            }
    }
}

}  // namespace
}  // namespace shaderx::draw
