// Options of `generate` that show in pictures, drawn by a driver and by the interpreter.
#include <bit>
#include <cmath>

#include "compile/compile.h"
#include "draw/draw.h"
#include "oracle/render.h"
#include "support.h"

namespace shaderx::tests {
namespace {

using image::Image;

float largestDifference(const Image& a, const Image& b) {
    float largest = 0;
    for (std::size_t i = 0; i < a.floats.size(); i++) largest = std::max(largest, std::abs(a.floats[i] - b.floats[i]));
    return largest;
}

class OptionsDrawn : public testing::Test {
  protected:
    void SetUp() override {
        Diagnostics loading;
        context_ = draw::Context::create(loading);
        if (!context_) GTEST_SKIP() << "no graphics driver here: " << loading.text();
        settings_.size = 48;
        settings_.samples = 32;
    }

    // The first element of a document, by the driver; the interpreter must see the same.
    Image render(const std::string& text, const GenerateOptions& how) {
        Diagnostics diagnostics;
        doc::NoIncludes none;
        Compiler compiler(builtinLibrary());
        auto document = compiler.read("test.mtlx", text, none, diagnostics);
        Result<Shader> shader = Failure{};
        if (document)
            shader = compiler.generate(*document, compiler.renderableElements(*document).at(0), how, diagnostics);
        if (!shader) {
            ADD_FAILURE() << diagnostics.text();
            return {};
        }
        scene::Settings settings = settings_;
        for (const TextureBinding& t : shader->textures)
            settings.textures.push_back({t.uniform, own_ / t.file, t.uAddress, t.vAddress, t.filter, {}, t.path});
        for (const UniformBinding& u : shader->uniforms)
            if (u.block >= 0) {
                scene::UniformValue value{u.name, {}};
                for (std::uint32_t w : u.value)
                    value.values.push_back(ir::info(u.type).scalar == ir::Scalar::Float
                                               ? std::bit_cast<float>(w)
                                               : static_cast<float>(static_cast<int>(w)));
                settings.defaults.push_back(value);
            }
        Result<Image> driver = context_->render(draw::Job{settings, shader->vertex, shader->pixel}, diagnostics);
        Result<Image> interpreted =
            oracle::render({settings, &shader->program->module, &shader->program->interface}, diagnostics);
        EXPECT_EQ(diagnostics.text(), "");
        if (!driver || !interpreted) return {};
        EXPECT_LT(largestDifference(*driver, *interpreted), 0.02f);
        return *driver;
    }
    Image renderGolden(const char* name, const GenerateOptions& how) {
        return render(fileText(testFolder("golden") / name), how);
    }

    // Writes a picture whose rows all differ, or the same with its bottom row first.
    void writeStripes(const std::string& name, bool upsideDown) {
        Image picture = Image::ofBytes(4, 16, 3);
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 4; x++)
                for (int c = 0; c < 3; c++) {
                    int row = upsideDown ? 15 - y : y;
                    picture.bytes[static_cast<std::size_t>((y * 4 + x) * 3 + c)] =
                        static_cast<std::uint8_t>(row * 16 + c);
                }
        Diagnostics diagnostics;
        EXPECT_TRUE(writePng(own_ / name, picture, diagnostics)) << diagnostics.text();
    }

    OwnFolder own_;
    scene::Settings settings_;
    std::unique_ptr<draw::Context> context_;
};

constexpr int kMiddle = 24;

float middle(const Image& picture, int c) { return picture.at(kMiddle, kMiddle, c); }

TEST_F(OptionsDrawn, BlocksChangeNothing) {
    for (const char* name : {"car_paint.mtlx", "noise.mtlx", "ghost.mtlx"}) {
        GenerateOptions how;
        Image plain = renderGolden(name, how);
        how.blocks = true;
        EXPECT_EQ(largestDifference(plain, renderGolden(name, how)), 0) << name;
        how.bindingBase = 2;
        EXPECT_EQ(largestDifference(plain, renderGolden(name, how)), 0) << name;
    }
}

TEST_F(OptionsDrawn, TexturesUpsideDown) {
    std::string document =
        "<materialx version=\"1.39\"><image name=\"i\" type=\"color3\">"
        "<input name=\"file\" type=\"filename\" value=\"stripes.png\"/></image>"
        "<output name=\"o\" type=\"color3\" nodename=\"i\"/></materialx>";
    writeStripes("stripes.png", false);
    GenerateOptions how;
    Image plain = render(document, how);
    how.flipV = true;
    Image flipped = render(document, how);
    EXPECT_GT(largestDifference(plain, flipped), 0.5f);
    writeStripes("stripes.png", true);
    EXPECT_LT(largestDifference(plain, render(document, how)), 0.005f);
}

TEST_F(OptionsDrawn, TransparencyShows) {
    GenerateOptions how;
    EXPECT_EQ(middle(renderGolden("ghost.mtlx", how), 3), 1);
    how.transparency = true;
    Image ghost = renderGolden("ghost.mtlx", how);
    EXPECT_NEAR(middle(ghost, 3), 0.5f, 1e-3);
    EXPECT_GT(middle(ghost, 0), 0.01f);
    std::string clear =
        "<materialx version=\"1.39\"><standard_surface name=\"s\" type=\"surfaceshader\">"
        "<input name=\"opacity\" type=\"color3\" value=\"0, 0, 0\"/></standard_surface>"
        "<surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" "
        "type=\"surfaceshader\" nodename=\"s\"/></surfacematerial></materialx>";
    Image nothing = render(clear, how);
    for (float v : nothing.floats) ASSERT_EQ(v, 0);  // the ground keeps its alpha of 0: nothing was written
    how.transparency = false;
    EXPECT_EQ(middle(render(clear, how), 3), 1);
}

TEST_F(OptionsDrawn, PrefilteredMapsAreNearSamples) {
    // Where the maps are the same everywhere, blurring them changes nothing: what differs are the fits of the albedo.
    Image even = Image::ofFloats(16, 8, 3);
    for (float& v : even.floats) v = 1;
    Diagnostics diagnostics;
    ASSERT_TRUE(image::writePfm(own_ / "white.pfm", even, diagnostics)) << diagnostics.text();
    settings_.environment = own_ / "white.pfm";
    for (const char* name : {"default_surface.mtlx", "gold.mtlx", "plastic.mtlx", "soap_film.mtlx", "glass.mtlx"}) {
        GenerateOptions how;
        Image sampled = renderGolden(name, how);
        how.environment = EnvironmentLight::Prefiltered;
        Image looked = renderGolden(name, how);
        EXPECT_LT(largestDifference(sampled, looked), 0.04f) << name;
        for (float v : looked.floats) ASSERT_LE(v, 1.001f) << name;
    }
    // Under the sky one look-up is not the mean of many.
    settings_.environment.clear();
    GenerateOptions how;
    Image sampled = renderGolden("default_surface.mtlx", how);
    how.environment = EnvironmentLight::Prefiltered;
    EXPECT_GT(largestDifference(sampled, renderGolden("default_surface.mtlx", how)), 0.01f);
}

TEST_F(OptionsDrawn, NoEnvironmentLeavesEmission) {
    GenerateOptions how;
    how.environment = EnvironmentLight::None;
    Image dark = renderGolden("gold.mtlx", how);
    for (int c = 0; c < 3; c++) EXPECT_EQ(middle(dark, c), 0);
    EXPECT_EQ(middle(dark, 3), 1);
    EXPECT_GT(middle(renderGolden("lamp.mtlx", how), 0), 0.1f);
}

TEST_F(OptionsDrawn, LengthsComeInTheUnitOfTheScene) {
    std::string document =
        "<materialx version=\"1.39\"><constant name=\"c\" type=\"float\">"
        "<input name=\"value\" type=\"float\" value=\"0.5\" unittype=\"distance\" unit=\"foot\"/>"
        "</constant><output name=\"o\" type=\"float\" nodename=\"c\"/></materialx>";
    GenerateOptions how;
    EXPECT_NEAR(middle(render(document, how), 0), 0.1524f, 1e-5);
    how.unit = "yard";
    EXPECT_NEAR(middle(render(document, how), 0), 0.5f / 3, 1e-5);
}

}  // namespace
}  // namespace shaderx::tests
