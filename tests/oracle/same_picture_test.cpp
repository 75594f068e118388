// Whole materials drawn twice: the text by a driver, the program by the interpreter. The pictures must be the same.
#include <cmath>

#include "compile/compile.h"
#include "doc/file_resolver.h"
#include "draw/draw.h"
#include "oracle/render.h"
#include "support.h"

namespace shaderx::tests {
namespace {

using image::Image;

struct Case {
    const char* file;
    Interface interface;
};

class Oracle : public testing::TestWithParam<Case> {
  protected:
    void SetUp() override {
        Diagnostics loading;
        context_ = draw::Context::create(loading);
        if (!context_) GTEST_SKIP() << "no graphics driver here: " << loading.text();
    }

    std::unique_ptr<draw::Context> context_;
    Compiler compiler_{builtinLibrary()};
};

// Root of the mean squared difference of the colours, values beyond 4 taken as 4.
double difference(const Image& a, const Image& b) {
    double sum = 0;
    for (int y = 0; y < a.height; y++)
        for (int x = 0; x < a.width; x++)
            for (int c = 0; c < 3; c++) {
                const double d = std::clamp(a.at(x, y, c), -4.0f, 4.0f) - std::clamp(b.at(x, y, c), -4.0f, 4.0f);
                sum += d * d;
            }
    return std::sqrt(sum / (3.0 * a.width * a.height));
}

TEST_P(Oracle, DrawsWhatTheDriverDraws) {
    fs::path folder = fs::path(SHADERX_SOURCE_DIR) / "examples", file = folder / GetParam().file;
    Diagnostics diagnostics;
    doc::FileResolver resolver(std::vector<std::string>{});
    auto document = compiler_.read(file.string(), fileText(file), resolver, diagnostics);
    ASSERT_TRUE(document) << diagnostics.text();
    GenerateOptions how;
    how.interface = GetParam().interface;
    Result<Shader> shader =
        compiler_.generate(*document, compiler_.renderableElements(*document).at(0), how, diagnostics);
    ASSERT_TRUE(shader) << diagnostics.text();
    scene::Settings settings;
    settings.size = 32;
    settings.samples = 64;
    for (const TextureBinding& t : shader->textures)
        settings.textures.push_back(
            {t.uniform, (folder / t.file).string(), t.uAddress, t.vAddress, t.filter, {}, t.path});
    Result<Image> driver = context_->render(draw::Job{settings, shader->vertex, shader->pixel}, diagnostics);
    Result<Image> ours = oracle::render({settings, &shader->program->module, &shader->program->interface}, diagnostics);
    ASSERT_TRUE(driver && ours) << diagnostics.text();
    EXPECT_EQ(diagnostics.text(), "");
    EXPECT_LT(difference(*driver, *ours), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Examples, Oracle,
                         testing::Values(Case{"ceramic.mtlx", Interface::Live},
                                         Case{"lacquered_wood.mtlx", Interface::Live},
                                         Case{"lacquered_wood.mtlx", Interface::Complete},
                                         Case{"soap_film.mtlx", Interface::Complete}),
                         [](const auto& which) {
                             std::string name = fs::path(which.param.file).stem().string();
                             return name + (which.param.interface == Interface::Live ? "_live" : "_complete");
                         });

}  // namespace
}  // namespace shaderx::tests
