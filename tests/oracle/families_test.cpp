// Nodes that are graphs. Of closures: each is drawn as the closures that it stands for, written out, by the
// interpreter. Of textures: how these are read comes from the inputs of the node, whatever it calls them.
#include <cmath>
#include <limits>

#include "compile/compile.h"
#include "oracle/render.h"
#include "support.h"

namespace shaderx::tests {
namespace {

using image::Image;

struct Pair {
    const char* name;
    const char* node;        // of the family, called x
    const char* writtenOut;  // x again, of plain closures
};

// Two closures to combine.
constexpr const char* kParts = R"(
  <oren_nayar_diffuse_bsdf name="matte" type="BSDF"><input name="color" type="color3" value="0.2, 0.5, 0.8"/></oren_nayar_diffuse_bsdf>
  <dielectric_bsdf name="gloss" type="BSDF"><input name="roughness" type="vector2" value="0.1, 0.1"/></dielectric_bsdf>
  <uniform_edf name="red" type="EDF"><input name="color" type="color3" value="0.8, 0.2, 0.1"/></uniform_edf>
  <uniform_edf name="blue" type="EDF"><input name="color" type="color3" value="0.1, 0.2, 0.9"/></uniform_edf>
)";

const Pair
    kPairs
        [] =
            {
                {"Add",
                 R"(<LamaAdd name="x" type="BSDF"><input name="material1" type="BSDF" nodename="matte"/><input name="material2" type="BSDF" nodename="gloss"/><input name="weight1" type="float" value="0.4"/><input name="weight2" type="float" value="0.5"/></LamaAdd>)",
                 R"(<multiply name="m" type="BSDF"><input name="in1" type="BSDF" nodename="matte"/><input name="in2" type="float" value="0.4"/></multiply>
        <multiply name="g" type="BSDF"><input name="in1" type="BSDF" nodename="gloss"/><input name="in2" type="float" value="0.5"/></multiply>
        <add name="x" type="BSDF"><input name="in1" type="BSDF" nodename="m"/><input name="in2" type="BSDF" nodename="g"/></add>)"},
                {"Mix",
                 R"(<LamaMix name="x" type="BSDF"><input name="material1" type="BSDF" nodename="matte"/><input name="material2" type="BSDF" nodename="gloss"/><input name="mix" type="float" value="0.3"/></LamaMix>)",
                 R"(<mix name="x" type="BSDF"><input name="bg" type="BSDF" nodename="matte"/><input name="fg" type="BSDF" nodename="gloss"/><input name="mix" type="float" value="0.3"/></mix>)"},
                {"AddEmission",
                 R"(<LamaAdd name="x" type="EDF"><input name="material1" type="EDF" nodename="red"/><input name="material2" type="EDF" nodename="blue"/><input name="weight2" type="float" value="0.5"/></LamaAdd>)",
                 R"(<uniform_edf name="x" type="EDF"><input name="color" type="color3" value="0.85, 0.3, 0.55"/></uniform_edf>)"},
                {"MixEmission",
                 R"(<LamaMix name="x" type="EDF"><input name="material1" type="EDF" nodename="red"/><input name="material2" type="EDF" nodename="blue"/><input name="mix" type="float" value="0.25"/></LamaMix>)",
                 R"(<uniform_edf name="x" type="EDF"><input name="color" type="color3" value="0.625, 0.2, 0.3"/></uniform_edf>)"},
                {"Emission",
                 R"(<LamaEmission name="x" type="EDF"><input name="color" type="color3" value="0.8, 0.2, 0.1"/></LamaEmission>)",
                 R"(<uniform_edf name="x" type="EDF"><input name="color" type="color3" value="0.8, 0.2, 0.1"/></uniform_edf>)"},
                {"Layer",
                 R"(<LamaLayer name="x" type="BSDF"><input name="materialTop" type="BSDF" nodename="gloss"/><input name="materialBase" type="BSDF" nodename="matte"/><input name="topMix" type="float" value="0.5"/></LamaLayer>)",
                 R"(<multiply name="g" type="BSDF"><input name="in1" type="BSDF" nodename="gloss"/><input name="in2" type="float" value="0.5"/></multiply>
        <layer name="x" type="BSDF"><input name="top" type="BSDF" nodename="g"/><input name="base" type="BSDF" nodename="matte"/></layer>)"},
                {"Conductor",
                 R"(<LamaConductor name="x" type="BSDF"><input name="fresnelMode" type="integer" value="1"/><input name="tint" type="color3" value="0.9, 0.5, 0.4"/><input name="IOR" type="vector3" value="1.5, 2, 0.6"/><input name="extinction" type="vector3" value="1, 3, 4"/><input name="roughness" type="float" value="0.5"/><input name="anisotropy" type="float" value="0.5"/></LamaConductor>)",
                 R"(<conductor_bsdf name="c" type="BSDF"><input name="ior" type="color3" value="1.5, 2, 0.6"/><input name="extinction" type="color3" value="1, 3, 4"/><input name="roughness" type="vector2" value="0.25, 0.5625"/></conductor_bsdf>
        <multiply name="x" type="BSDF"><input name="in1" type="BSDF" nodename="c"/><input name="in2" type="color3" value="0.9, 0.5, 0.4"/></multiply>)"},
                {"ConductorTurned",
                 R"(<LamaConductor name="x" type="BSDF"><input name="fresnelMode" type="integer" value="1"/><input name="roughness" type="float" value="0.5"/><input name="anisotropy" type="float" value="-0.5"/><input name="anisotropyRotation" type="float" value="0.2"/></LamaConductor>)",
                 R"(<tangent name="t" type="vector3"><input name="space" type="string" value="world"/></tangent>
        <normal name="n" type="vector3"><input name="space" type="string" value="world"/></normal>
        <rotate3d name="turned" type="vector3"><input name="in" type="vector3" nodename="t"/><input name="amount" type="float" value="-72"/><input name="axis" type="vector3" nodename="n"/></rotate3d>
        <conductor_bsdf name="x" type="BSDF"><input name="tangent" type="vector3" nodename="turned"/><input name="ior" type="color3" value="0.18, 0.42, 1.37"/><input name="extinction" type="color3" value="3.42, 2.35, 1.77"/><input name="roughness" type="vector2" value="0.25, 0.0625"/></conductor_bsdf>)"},
                {"Dielectric",
                 R"(<LamaDielectric name="x" type="BSDF"><input name="reflectionTint" type="color3" value="1, 0.4, 0.3"/><input name="transmissionTint" type="color3" value="0.2, 0.8, 0.9"/><input name="roughness" type="float" value="0.5"/></LamaDielectric>)",
                 R"(<dielectric_bsdf name="t" type="BSDF"><input name="tint" type="color3" value="0.2, 0.8, 0.9"/><input name="roughness" type="vector2" value="0.25, 0.25"/><input name="scatter_mode" type="string" value="T"/></dielectric_bsdf>
        <dielectric_bsdf name="r" type="BSDF"><input name="tint" type="color3" value="1, 0.4, 0.3"/><input name="roughness" type="vector2" value="0.25, 0.25"/></dielectric_bsdf>
        <layer name="x" type="BSDF"><input name="top" type="BSDF" nodename="r"/><input name="base" type="BSDF" nodename="t"/></layer>)"},
                {"GeneralizedSchlick", R"(<LamaGeneralizedSchlick name="x" type="BSDF"><input name="fresnelMode" type="integer" value="1"/><input name="IOR" type="vector3" value="1.5, 2, 3"/><input name="reflectivity90" type="color3" value="0.9, 1, 0.6"/><input name="reflectivityProfile" type="float" value="0.5"/><input name="roughness" type="float" value="0.5"/><input name="transmissionTint" type="color3" value="0.2, 0.8, 0.9"/></LamaGeneralizedSchlick>)",
                 R"(<generalized_schlick_bsdf name="t" type="BSDF"><input name="color0" type="color3" value="0.04, 0.11111111, 0.25"/><input name="color90" type="color3" value="0.9, 1, 0.6"/><input name="exponent" type="float" value="2"/><input name="roughness" type="vector2" value="0.25, 0.25"/><input name="scatter_mode" type="string" value="T"/></generalized_schlick_bsdf>
        <multiply name="tt" type="BSDF"><input name="in1" type="BSDF" nodename="t"/><input name="in2" type="color3" value="0.2, 0.8, 0.9"/></multiply>
        <generalized_schlick_bsdf name="r" type="BSDF"><input name="color0" type="color3" value="0.04, 0.11111111, 0.25"/><input name="color90" type="color3" value="0.9, 1, 0.6"/><input name="exponent" type="float" value="2"/><input name="roughness" type="vector2" value="0.25, 0.25"/></generalized_schlick_bsdf>
        <layer name="x" type="BSDF"><input name="top" type="BSDF" nodename="r"/><input name="base" type="BSDF" nodename="tt"/></layer>)"},
                {"Iridescence",
                 R"(<LamaIridescence name="x" type="BSDF"><input name="relativeFilmThickness" type="float" value="0.25"/><input name="filmIOR" type="float" value="1.6"/><input name="roughness" type="float" value="0.3"/></LamaIridescence>)",
                 R"(<dielectric_bsdf name="x" type="BSDF"><input name="ior" type="float" value="1"/><input name="thinfilm_thickness" type="float" value="500"/><input name="thinfilm_ior" type="float" value="1.6"/><input name="roughness" type="vector2" value="0.09, 0.09"/><input name="scatter_mode" type="string" value="RT"/></dielectric_bsdf>)"},
                {"Diffuse",
                 R"(<LamaDiffuse name="x" type="BSDF"><input name="color" type="color3" value="0.8, 0.5, 0.2"/><input name="roughness" type="float" value="0.8"/><input name="energyCompensation" type="float" value="0.25"/></LamaDiffuse>)",
                 R"(<oren_nayar_diffuse_bsdf name="a" type="BSDF"><input name="color" type="color3" value="0.8, 0.5, 0.2"/><input name="roughness" type="float" value="0.32"/></oren_nayar_diffuse_bsdf>
        <oren_nayar_diffuse_bsdf name="b" type="BSDF"><input name="color" type="color3" value="0.8, 0.5, 0.2"/><input name="roughness" type="float" value="0.32"/><input name="energy_compensation" type="boolean" value="true"/></oren_nayar_diffuse_bsdf>
        <mix name="x" type="BSDF"><input name="bg" type="BSDF" nodename="a"/><input name="fg" type="BSDF" nodename="b"/><input name="mix" type="float" value="0.25"/></mix>)"},
                {"Translucent",
                 R"(<LamaTranslucent name="x" type="BSDF"><input name="color" type="color3" value="0.8, 0.5, 0.2"/><input name="roughness" type="float" value="0.8"/></LamaTranslucent>)",
                 R"(<translucent_bsdf name="x" type="BSDF"><input name="color" type="color3" value="0.8, 0.5, 0.2"/></translucent_bsdf>)"},
                {"SSS",
                 R"(<LamaSSS name="x" type="BSDF"><input name="color" type="color3" value="0.8, 0.4, 0.3"/><input name="sssRadius" type="color3" value="1, 0.5, 0.25"/><input name="sssScale" type="float" value="100"/><input name="sssUnitLength" type="float" value="0.01"/></LamaSSS>)",
                 R"(<subsurface_bsdf name="x" type="BSDF"><input name="color" type="color3" value="0.8, 0.4, 0.3"/><input name="radius" type="color3" value="1, 0.5, 0.25"/></subsurface_bsdf>)"},
                {"Sheen",
                 R"(<LamaSheen name="x" type="BSDF"><input name="color" type="color3" value="0.5, 0.8, 0.3"/><input name="roughness" type="float" value="0.5"/></LamaSheen>)",
                 R"(<sheen_bsdf name="x" type="BSDF"><input name="color" type="color3" value="0.5, 0.8, 0.3"/><input name="roughness" type="float" value="0.3025"/></sheen_bsdf>)"},
};

class Lama : public testing::TestWithParam<Pair> {};

Image pictureOf(const std::string& body, const std::string& environment = {}) {
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    auto document =
        compiler.read("test.mtlx", "<materialx version=\"1.39\">" + body + "</materialx>", none, diagnostics);
    GenerateOptions how;
    how.interface = Interface::Baked;
    Result<Shader> shader = document ? compiler.generate(*document, document->find("M"), how, diagnostics) : Failure{};
    EXPECT_TRUE(shader) << diagnostics.text();
    if (!shader) return {};
    scene::Settings settings;
    settings.size = 24;
    settings.samples = 16;
    settings.environment = environment;
    Result<Image> picture =
        oracle::render({settings, &shader->program->module, &shader->program->interface}, diagnostics);
    EXPECT_TRUE(picture) << diagnostics.text();
    EXPECT_EQ(diagnostics.text(), "");
    return picture ? *picture : Image();
}

std::string material(const std::string& body) {
    const char* port = body.find("EDF\"") != std::string::npos ? "edf" : "bsdf";
    const char* type = port == std::string("edf") ? "EDF" : "BSDF";
    return kParts + body + "<surface name=\"s\" type=\"surfaceshader\"><input name=\"" + port + "\" type=\"" + type +
           "\" nodename=\"x\"/></surface><surfacematerial name=\"M\" type=\"material\"><input name=\"surfaceshader\" "
           "type=\"surfaceshader\" nodename=\"s\"/></surfacematerial>";
}

double largestDifference(const Image& a, const Image& b) {
    if (a.width == 0 || a.width != b.width || a.height != b.height) return std::numeric_limits<double>::infinity();
    double largest = 0;
    for (int y = 0; y < a.height; y++)
        for (int x = 0; x < a.width; x++)
            for (int c = 0; c < 4; c++)
                largest = std::max(largest, std::fabs(static_cast<double>(a.at(x, y, c)) - b.at(x, y, c)));
    return largest;
}

TEST_P(Lama, IsTheClosuresWrittenOut) {
    EXPECT_LT(largestDifference(pictureOf(material(GetParam().node)), pictureOf(material(GetParam().writtenOut))),
              1e-4);
}

INSTANTIATE_TEST_SUITE_P(All, Lama, testing::ValuesIn(kPairs), [](const auto& which) { return which.param.name; });

TEST(LamaSurface, ShowsItsFrontWithItsPresence) {
    const Image found = pictureOf(std::string(kParts) + R"(<LamaSurface name="M" type="material">
        <input name="materialFront" type="BSDF" nodename="matte"/><input name="presence" type="float" value="0.4"/></LamaSurface>)");
    const Image plain = pictureOf(std::string(kParts) + R"(<surface name="s" type="surfaceshader">
        <input name="bsdf" type="BSDF" nodename="matte"/><input name="opacity" type="float" value="0.4"/></surface>
        <surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial>)");
    EXPECT_LT(largestDifference(found, plain), 1e-6);
}

// In a world of radiance 1 a body that absorbs nothing cannot be seen.
TEST(LamaDielectric, ClearGlassVanishesInAFurnace) {
    OwnFolder own;
    const std::string white = own / "white.pfm";
    Image even = Image::ofFloats(16, 8, 3);
    for (float& v : even.floats) v = 1;
    Diagnostics diagnostics;
    ASSERT_TRUE(image::writePfm(white, even, diagnostics)) << diagnostics.text();
    for (const char* glass :
         {R"(<LamaDielectric name="x" type="BSDF"/>)", R"(<LamaGeneralizedSchlick name="x" type="BSDF"/>)",
          R"(<LamaIridescence name="x" type="BSDF"/>)"}) {
        const Image picture = pictureOf(material(glass), white);
        for (int y = 0; y < picture.height; y++)
            for (int x = 0; x < picture.width; x++)
                for (int c = 0; c < 3 && picture.at(x, y, 3) == 1; c++)
                    EXPECT_NEAR(picture.at(x, y, c), 1, 1e-3) << glass << " " << x << " " << y;
    }
}

struct Reading {
    const char* name;
    const char* node;  // called x, with one output to look at
    const char* output;
    const char *u, *v, *filter;
    std::vector<float> defaultColor;
};

class TextureNode : public testing::TestWithParam<Reading> {};

TEST_P(TextureNode, SaysHowItsTextureIsRead) {
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    auto document = compiler.read(
        "test.mtlx", std::string("<materialx version=\"1.39\">") + GetParam().node + GetParam().output + "</materialx>",
        none, diagnostics);
    ASSERT_TRUE(document) << diagnostics.text();
    Result<Shader> shader = compiler.generate(*document, document->find("o"), {}, diagnostics);
    ASSERT_TRUE(shader) << diagnostics.text();
    ASSERT_EQ(shader->textures.size(), 1u);
    EXPECT_EQ(shader->textures[0].uAddress, GetParam().u);
    EXPECT_EQ(shader->textures[0].vAddress, GetParam().v);
    EXPECT_EQ(shader->textures[0].filter, GetParam().filter);
    EXPECT_EQ(shader->textures[0].defaultColor, GetParam().defaultColor);
}

constexpr const char* kRgb = R"(<output name="o" type="color3" nodename="x" output="rgb"/>)";
INSTANTIATE_TEST_SUITE_P(
    All, TextureNode,
    testing::Values(
        Reading{"Usd",
                R"(<UsdUVTexture name="x" type="multioutput"><input name="file" type="filename" value="a.png"/>
            <input name="wrapS" type="string" value="mirror"/><input name="wrapT" type="string" value="repeat"/>
            <input name="fallback" type="color4" value="0.1, 0.2, 0.3, 0.4"/></UsdUVTexture>)",
                kRgb,
                "mirror",
                "periodic",
                "linear",
                {0.1f, 0.2f, 0.3f, 0.4f}},
        Reading{"UsdBlack",
                R"(<UsdUVTexture name="x" type="multioutput"><input name="file" type="filename" value="a.png"/>
            <input name="wrapS" type="string" value="black"/><input name="wrapT" type="string" value="useMetadata"/></UsdUVTexture>)",
                kRgb,
                "black",
                "black",
                "linear",
                {0, 0, 0, 1}},
        Reading{"UsdPlain",
                R"(<UsdUVTexture name="x" type="multioutput"><input name="file" type="filename" value="a.png"/>
            <input name="wrapS" type="string" value="clamp"/></UsdUVTexture>)",
                kRgb,
                "clamp",
                "periodic",
                "linear",
                {0, 0, 0, 1}},
        Reading{"Gltf",
                R"(<gltf_colorimage name="x" type="multioutput"><input name="file" type="filename" value="a.png"/>
            <input name="uaddressmode" type="string" value="clamp"/><input name="filtertype" type="string" value="closest"/>
            <input name="default" type="color4" value="1, 0.5, 0.25, 1"/></gltf_colorimage>)",
                R"(<output name="o" type="color3" nodename="x" output="outcolor"/>)",
                "clamp",
                "periodic",
                "closest",
                {1, 0.5f, 0.25f, 1}},
        Reading{"Compounds",
                R"(
            <nodedef name="ND_outer" node="outer"><input name="picture" type="filename" value=""/><input name="edge" type="string" value="mirror"/><output name="out" type="color4"/></nodedef>
            <nodegraph name="NG_outer" nodedef="ND_outer">
              <inner name="i" type="color4"><input name="map" type="filename" interfacename="picture"/><input name="wrap" type="string" interfacename="edge"/></inner>
              <output name="out" type="color4" nodename="i"/></nodegraph>
            <nodedef name="ND_inner" node="inner"><input name="map" type="filename" value=""/><input name="wrap" type="string" value="periodic"/><output name="out" type="color4"/></nodedef>
            <nodegraph name="NG_inner" nodedef="ND_inner">
              <image name="t" type="color4"><input name="file" type="filename" interfacename="map"/><input name="uaddressmode" type="string" interfacename="wrap"/><input name="vaddressmode" type="string" value="clamp"/></image>
              <output name="out" type="color4" nodename="t"/></nodegraph>
            <outer name="x" type="color4"><input name="picture" type="filename" value="a.png"/></outer>)",
                R"(<output name="o" type="color4" nodename="x"/>)",
                "mirror",
                "clamp",
                "linear",
                {}}),
    [](const auto& which) { return which.param.name; });

}  // namespace
}  // namespace shaderx::tests
