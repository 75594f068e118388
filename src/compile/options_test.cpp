// Each option of `generate`, in texts; tests/render has those that show in pictures.
#include <gtest/gtest.h>

#include "compile/compile.h"

namespace shaderx {
namespace {

const std::string kCar =
    R"(<standard_surface name="s" type="surfaceshader"><input name="base" type="float" value="0.5"/>
    <input name="base_color" type="color3" nodename="paint"/></standard_surface>
    <image name="paint" type="color3"><input name="file" type="filename" value="paint.png"/></image>)";

struct Made {
    Shader shader;
    std::string codes;
};

Made make(const std::string& body, std::string_view element, const GenerateOptions& how) {
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    auto document =
        compiler.read("test.mtlx", "<materialx version=\"1.39\">\n" + body + "\n</materialx>\n", none, diagnostics);
    Made made;
    if (document)
        if (Result<Shader> shader = compiler.generate(*document, document->find(element), how, diagnostics))
            made.shader = *shader;
    made.shader.program = nullptr;
    for (const Diagnostic& d : diagnostics.all()) made.codes += d.code + " ";
    return made;
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

TEST(Options, EnvironmentSampledPrefilteredOrNone) {
    for (Interface interface : {Interface::Live, Interface::Baked}) {
        GenerateOptions how;
        how.interface = interface;
        Shader sampled = make(kCar, "s", how).shader;
        EXPECT_TRUE(has(sampled.pixel, "for (") && has(sampled.pixel, "u_envRadianceSamples"));
        how.environment = EnvironmentLight::Prefiltered;
        Shader looked = make(kCar, "s", how).shader;
        EXPECT_FALSE(has(looked.pixel, "for (") || has(looked.pixel, "u_envRadianceSamples")) << looked.pixel;
        EXPECT_TRUE(has(looked.pixel, "u_envRadianceMips") && has(looked.pixel, "u_envIrradiance"));
        how.environment = EnvironmentLight::None;
        Shader dark = make(kCar, "s", how).shader;
        EXPECT_FALSE(has(dark.pixel, "u_env")) << dark.pixel;
    }
}

TEST(Options, TexturesUpsideDown) {
    GenerateOptions how;
    EXPECT_TRUE(has(make(kCar, "s", how).shader.pixel, "texture(paint_file, vd.texcoord_0)"));
    how.flipV = true;
    std::string flipped = make(kCar, "s", how).shader.pixel;
    EXPECT_TRUE(has(flipped, "1.0 - vd.texcoord_0.y")) << flipped;
    EXPECT_TRUE(has(flipped, "texture(paint_file, ")) << flipped;  // the driver still finds the level of detail
    // The maps of the environment stay.
    how.interface = Interface::Baked;
    std::string plain = "<standard_surface name=\"s\" type=\"surfaceshader\"/>";
    GenerateOptions usual;
    usual.interface = Interface::Baked;
    EXPECT_EQ(make(plain, "s", how).shader.pixel, make(plain, "s", usual).shader.pixel);
}

TEST(Options, TransparencyGivesAlphaAndDiscards) {
    std::string ghost =
        "<standard_surface name=\"s\" type=\"surfaceshader\"><input name=\"opacity\" type=\"color3\" value=\"0.5, 0.5, "
        "0.25\"/></standard_surface>";
    GenerateOptions how;
    EXPECT_FALSE(has(make(ghost, "s", how).shader.pixel, "discard"));
    how.transparency = true;
    Shader shader = make(ghost, "s", how).shader;
    EXPECT_TRUE(has(shader.pixel, "< u_alphaThreshold)\n\t\tdiscard;")) << shader.pixel;
    // Whatever is no surface has no opacity.
    EXPECT_FALSE(has(make("<constant name=\"c\" type=\"color3\"/>", "c", how).shader.pixel, "discard"));
}

TEST(Options, BlocksAreLaidOutAsReflectionSays) {
    GenerateOptions how;
    Shader single = make(kCar, "s", how).shader;
    EXPECT_TRUE(single.blocks.empty());
    EXPECT_FALSE(has(single.pixel, "std140") || has(single.pixel, "binding"));
    how.blocks = true;
    Shader shader = make(kCar, "s", how).shader;
    EXPECT_TRUE(has(shader.pixel, "layout(std140) uniform PublicUniforms\n{\n\tfloat s_base;\n};")) << shader.pixel;
    EXPECT_TRUE(has(shader.pixel, "layout(std140) uniform PrivateUniforms\n{\n\tvec3 u_viewPosition;")) << shader.pixel;
    EXPECT_TRUE(has(shader.vertex, "layout(std140) uniform PrivateUniforms\n{\n\tvec3 u_viewPosition;"))
        << shader.vertex;
    ASSERT_EQ(shader.blocks.size(), 2u);
    EXPECT_EQ(shader.blocks[0].name, "PrivateUniforms");
    EXPECT_TRUE(shader.blocks[0].isVertex && shader.blocks[0].isPixel);
    EXPECT_FALSE(shader.blocks[1].isVertex);
    EXPECT_EQ(shader.blocks[1].size, 16u);
    EXPECT_EQ(shader.blocks[1].binding, -1);
}

TEST(Options, BindingsAreNumbered) {
    GenerateOptions how;
    how.bindingBase = 3;
    how.blocks = true;
    Shader shader = make(kCar, "s", how).shader;
    EXPECT_TRUE(shader.pixel.starts_with("#version 420\n") && shader.vertex.starts_with("#version 420\n"));
    EXPECT_TRUE(has(shader.vertex, "layout(std140, binding = 3) uniform PrivateUniforms"));
    EXPECT_TRUE(has(shader.pixel, "layout(std140, binding = 4) uniform PublicUniforms"));
    EXPECT_TRUE(has(shader.pixel, "layout(binding = 5) uniform sampler2D u_envRadiance;"));
    EXPECT_TRUE(has(shader.pixel, "layout(binding = 7) uniform sampler2D paint_file;"));
    EXPECT_EQ(shader.blocks[1].binding, 4);
    EXPECT_EQ(shader.textures[0].binding, 7);
    how.blocks = false;
    EXPECT_TRUE(has(make(kCar, "s", how).shader.pixel, "layout(binding = 5) uniform sampler2D paint_file;"));
}

TEST(Options, LengthsComeInTheUnitOfTheScene) {
    std::string grid =
        R"(<position name="p" type="vector3"/><multiply name="m" type="vector3"><input name="in1" type="vector3" nodename="p"/>
        <input name="in2" type="float" value="2.5" unittype="distance" unit="foot"/></multiply>)";
    GenerateOptions how;
    how.interface = Interface::Baked;
    EXPECT_TRUE(has(make(grid, "m", how).shader.pixel, "0.762")) << make(grid, "m", how).shader.pixel;
    how.unit = "inch";
    EXPECT_TRUE(has(make(grid, "m", how).shader.pixel, "30.0"));
    how.unit = "foot";
    EXPECT_TRUE(has(make(grid, "m", how).shader.pixel, "2.5"));
    how.unit = "meter";
    how.interface = Interface::Live;
    Shader live = make(grid, "m", how).shader;
    EXPECT_TRUE(has(live.pixel, "0.3048") && has(live.pixel, "uniform float m_in2 = 2.5;")) << live.pixel;
    how.unit = "furlong";
    EXPECT_EQ(make(grid, "m", how).codes, "unknown-scene-unit ");
}

TEST(Options, UnitsMayComeFromTheNodedefOrBeUnknown) {
    GenerateOptions how;
    how.interface = Interface::Baked;
    // The size of a picture is a distance, says the nodedef; an angle is not.
    std::string tiled =
        R"(<tiledimage name="t" type="color3"><input name="realworldtilesize" type="vector2" value="3, 3" unit="foot"/></tiledimage>)";
    EXPECT_TRUE(has(make(tiled, "t", how).shader.pixel, "0.9144")) << make(tiled, "t", how).shader.pixel;
    std::string unknown =
        R"(<position name="p" type="vector3"/><multiply name="m" type="vector3"><input name="in1" type="vector3" nodename="p"/>
        <input name="in2" type="float" value="2.5" unittype="distance" unit="cubit"/></multiply>)";
    EXPECT_EQ(make(unknown, "m", how).codes, "unknown-unit ");
}

}  // namespace
}  // namespace shaderx
