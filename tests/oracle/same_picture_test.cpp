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

// Draws every element of a document both ways. How many there were.
int compareAll(draw::Context& context, const fs::path& file, Interface interface, const scene::Settings& scene,
               Diagnostics& diagnostics) {
    Compiler compiler(builtinLibrary());
    doc::FileResolver resolver(std::vector<std::string>{});
    auto document = compiler.read(file.string(), fileText(file), resolver, diagnostics);
    EXPECT_TRUE(document) << diagnostics.text();
    if (!document) return 0;
    GenerateOptions how;
    how.interface = interface;
    const auto elements = compiler.renderableElements(*document);
    for (const auto element : elements) {
        const std::string name = file.filename().string() + " " + document->path(element);
        Result<Shader> shader = compiler.generate(*document, element, how, diagnostics);
        EXPECT_TRUE(shader) << name << diagnostics.text();
        if (!shader) continue;
        scene::Settings settings = scene;
        for (const TextureBinding& t : shader->textures)
            settings.textures.push_back(
                {t.uniform, (file.parent_path() / t.file).string(), t.uAddress, t.vAddress, t.filter, {}, t.path});
        Result<Image> driver = context.render(draw::Job{settings, shader->vertex, shader->pixel}, diagnostics);
        Result<Image> ours =
            oracle::render({settings, &shader->program->module, &shader->program->interface}, diagnostics);
        EXPECT_TRUE(driver && ours) << name << diagnostics.text();
        if (!driver || !ours) continue;
        EXPECT_LT(difference(*driver, *ours), 1e-3) << name;
    }
    return static_cast<int>(elements.size());
}

TEST_P(Oracle, DrawsWhatTheDriverDraws) {
    scene::Settings settings;
    settings.size = 32;
    settings.samples = 64;
    Diagnostics diagnostics;
    const fs::path file = fs::path(SHADERX_SOURCE_DIR) / "examples" / GetParam().file;
    EXPECT_EQ(compareAll(*context_, file, GetParam().interface, settings, diagnostics), 1);
    EXPECT_EQ(diagnostics.text(), "");
}

INSTANTIATE_TEST_SUITE_P(
    Examples, Oracle,
    testing::Values(Case{"ceramic.mtlx", Interface::Live}, Case{"lacquered_wood.mtlx", Interface::Live},
                    Case{"lacquered_wood.mtlx", Interface::Complete}, Case{"soap_film.mtlx", Interface::Complete},
                    Case{"peach.mtlx", Interface::Live}, Case{"anodised_titanium.mtlx", Interface::Live}),
    [](const auto& which) {
        std::string name = fs::path(which.param.file).stem().string();
        return name + (which.param.interface == Interface::Live ? "_live" : "_complete");
    });

// MaterialX's example materials, a path each; an empty one where they are not here.
std::vector<fs::path> materialXExamples() {
    const fs::path folder = fs::path(SHADERX_SOURCE_DIR) / "../shared/resources/Materials/Examples";
    std::vector<fs::path> files;
    if (fs::is_directory(folder))
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().extension() == ".mtlx") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    if (files.empty()) files.emplace_back();
    return files;
}

class OracleOfMaterialX : public testing::TestWithParam<fs::path> {};

// Few samples: one that goes astray shows the more.
TEST_P(OracleOfMaterialX, DrawsWhatTheDriverDraws) {
    if (GetParam().empty()) GTEST_SKIP() << "MaterialX's example materials are not here";
    Diagnostics diagnostics;
    auto context = draw::Context::create(diagnostics);
    if (!context) GTEST_SKIP() << "no graphics driver here: " << diagnostics.text();
    scene::Settings settings;
    settings.size = 32;
    settings.samples = 16;
    EXPECT_GT(compareAll(*context, GetParam(), Interface::Live, settings, diagnostics), 0);
    EXPECT_FALSE(diagnostics.hasErrors()) << diagnostics.text();
}

INSTANTIATE_TEST_SUITE_P(All, OracleOfMaterialX, testing::ValuesIn(materialXExamples()), testName);

}  // namespace
}  // namespace shaderx::tests
