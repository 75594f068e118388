// Golden documents, drawn: whole shaders on a real driver. Stored means were measured with Mesa's llvmpipe.
#include <cmath>

#include "compile/compile.h"
#include "draw/draw.h"
#include "support.h"

namespace shaderx::tests {
namespace {

using image::Image;

class Render : public testing::Test {
  protected:
    void SetUp() override {
        Diagnostics loading;
        context_ = draw::Context::create(loading);
        if (!context_) GTEST_SKIP() << "no graphics driver here: " << loading.text();
    }

    // A golden document's first element at 64 pixels.
    Image render(const std::string& name, const std::string& environment, int samples) {
        Diagnostics diagnostics;
        doc::NoIncludes none;
        auto document = compiler_.read(name, fileText(testFolder("golden") / name), none, diagnostics);
        std::vector<doc::ElementId> elements;
        if (document) elements = compiler_.renderableElements(*document);
        if (elements.empty()) {
            ADD_FAILURE() << name << diagnostics.text();
            return {};
        }
        Result<Shader> shader = compiler_.generate(*document, elements[0], {}, diagnostics);
        draw::Job job;
        job.size = 64;
        job.samples = samples;
        job.environment = environment;
        if (shader) {
            job.vertex = shader->vertex;
            job.pixel = shader->pixel;
        }
        Result<Image> picture = context_->render(job, diagnostics);
        EXPECT_TRUE(picture) << diagnostics.text();
        return picture ? *picture : Image();
    }

    std::unique_ptr<draw::Context> context_;
    Compiler compiler_{builtinLibrary()};
};

// Mean colour of the pixels that show the sphere, and the largest value; no value is negative or not a number.
struct Summary {
    double mean[3] = {0, 0, 0};
    float largest = 0;
    int covered = 0;
};

Summary summarise(const Image& picture) {
    Summary s;
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++) {
            bool covered = picture.at(x, y, 3) == 1.0f;
            s.covered += covered;
            for (int c = 0; c < 3; c++) {
                float value = picture.at(x, y, c);
                EXPECT_TRUE(std::isfinite(value) && value >= 0) << x << " " << y << " " << c << ": " << value;
                if (!covered) continue;
                s.mean[c] += value;
                s.largest = std::max(s.largest, value);
            }
        }
    for (double& m : s.mean) m /= std::max(s.covered, 1);
    return s;
}

TEST_F(Render, GoldenMaterialsUnderTheSky) {
    struct Expected {
        const char* name;
        double mean[3];
    };
    for (const Expected& e :
         {Expected{"gold.mtlx", {0.485, 0.488, 0.333}}, Expected{"noise.mtlx", {0.213, 0.264, 0.442}}}) {
        Summary s = summarise(render(e.name, "", 64));
        EXPECT_GT(s.covered, 64 * 64 / 2) << e.name;
        for (int c = 0; c < 3; c++) EXPECT_NEAR(s.mean[c], e.mean[c], 0.05 * e.mean[c]) << e.name << " " << c;
    }
}

TEST_F(Render, NothingIsBrighterThanAWhiteSurrounding) {
    OwnFolder own;
    std::string white = own / "white.pfm";
    Image even = Image::ofFloats(16, 8, 3);
    for (float& v : even.floats) v = 1;
    Diagnostics diagnostics;
    ASSERT_TRUE(image::writePfm(white, even, diagnostics)) << diagnostics.text();
    // All but those that give off light of their own.
    for (const char* name :
         {"default_surface.mtlx", "plastic.mtlx", "gold.mtlx", "car_paint.mtlx", "glass.mtlx", "velvet.mtlx",
          "leaf.mtlx", "skin.mtlx", "soap_film.mtlx", "ghost.mtlx", "gltf.mtlx", "disney.mtlx"})
        for (int samples : {4, 64}) {
            Summary s = summarise(render(name, white, samples));
            EXPECT_LE(s.largest, 1.001f) << name << " with " << samples << " samples";
            EXPECT_GT(s.covered, 64 * 64 / 2) << name;
        }
}

}  // namespace
}  // namespace shaderx::tests
