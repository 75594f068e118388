#include "doc/upgrade.h"

#include <gtest/gtest.h>

#include "doc/test_documents.h"
#include "doc/write.h"

namespace shaderx::doc {
namespace {

// The body of the upgraded document, blanks between elements removed.
std::string upgraded(const std::string& body, std::string* warnings = nullptr, const char* version = "1.38") {
    NameTable names;
    Document d(names);
    readInto(d, wrap(body, version));
    Diagnostics diagnostics;
    upgrade(d, diagnostics);
    EXPECT_FALSE(diagnostics.hasErrors());
    if (warnings)
        *warnings = diagnostics.text();
    else
        EXPECT_EQ(diagnostics.text(), "");
    std::string text = write(d), out;
    std::size_t begin = text.find('>', text.find("<materialx")) + 1, end = text.rfind("</materialx>");
    for (std::size_t i = begin; i < end; i++) {
        if (text[i] == '\n')
            while (i + 1 < end && text[i + 1] == ' ') i++;
        else
            out += text[i];
    }
    return out;
}

TEST(Upgrade, Swizzles) {
    EXPECT_EQ(
        upgraded(
            R"(<swizzle name="s" type="float"><input name="in" type="color3" nodename="a"/><input name="channels" type="string" value="g"/></swizzle>)"),
        R"(<extract name="s" type="float"><input name="in" type="color3" nodename="a" /><input name="index" type="integer" value="1" /></extract>)");
    EXPECT_EQ(
        upgraded(
            R"(<swizzle name="s" type="color3" nodedef="ND_x"><input name="in" type="color4" nodename="a"/><input name="channels" type="string" value="rgb"/></swizzle>)"),
        R"(<convert name="s" type="color3"><input name="in" type="color4" nodename="a" /></convert>)");
    EXPECT_EQ(
        upgraded(
            R"(<swizzle name="s" type="vector2"><input name="in" type="color3" value="1, 2, 3"/><input name="channels" type="string" value="b1"/></swizzle>)"),
        R"(<combine2 name="s" type="vector2"><input name="in1" type="float" nodename="s_separate" output="outb" /><input name="in2" type="float" value="1" /></combine2>)"
        R"(<separate3 name="s_separate" type="multioutput"><input name="in" type="color3" value="1, 2, 3" /></separate3>)");
    EXPECT_EQ(
        upgraded(
            R"(<swizzle name="s" type="color3"><input name="in" type="float" nodename="a"/><input name="channels" type="string" value="rrr"/></swizzle>)"),
        R"(<combine3 name="s" type="color3"><input name="in1" type="float" nodename="a" /><input name="in2" type="float" nodename="a" /><input name="in3" type="float" nodename="a" /></combine3>)");
    std::string warnings;
    upgraded(
        R"(<swizzle name="s" type="float"><input name="in" type="color3"/><input name="channels" type="string" value="a"/></swizzle>)",
        &warnings);
    EXPECT_NE(warnings.find("[cannot-upgrade]"), std::string::npos);
}

TEST(Upgrade, Channels) {
    EXPECT_EQ(
        upgraded(
            R"(<image name="i" type="color4"/><add name="a" type="float"><input name="in1" type="float" nodename="i" channels="a"/></add>)"),
        R"(<image name="i" type="color4" /><add name="a" type="float"><input name="in1" type="float" nodename="a_in1_channels" /></add>)"
        R"(<extract name="a_in1_channels" type="float"><input name="in" type="color4" nodename="i" /><input name="index" type="integer" value="3" /></extract>)");
    std::string warnings;
    std::string kept = upgraded(
        R"(<add name="a" type="float"><input name="in1" type="float" nodename="no" channels="a"/></add>)", &warnings);
    EXPECT_NE(kept.find("channels=\"a\""), std::string::npos);
    EXPECT_NE(warnings.find("[cannot-upgrade]"), std::string::npos);
}

TEST(Upgrade, RenamedInputsAndNodes) {
    EXPECT_EQ(
        upgraded(
            R"(<atan2 name="a" type="float"><input name="in1" type="float" value="1"/><input name="in2" type="float" value="2"/></atan2>)"),
        R"(<atan2 name="a" type="float"><input name="iny" type="float" value="1" /><input name="inx" type="float" value="2" /></atan2>)");
    EXPECT_EQ(
        upgraded(
            R"(<normalmap name="n" type="vector3" nodedef="ND_normalmap"><input name="space" type="string" value="tangent"/></normalmap>)"),
        R"(<normalmap name="n" type="vector3" nodedef="ND_normalmap_float" />)");
    EXPECT_EQ(
        upgraded(
            R"(<normalmap name="n" type="vector3"><input name="in" type="vector3" nodename="i"/><input name="space" type="string" value="object"/></normalmap>)"),
        R"(<normalize name="n" type="vector3"><input name="in" type="vector3" nodename="n_unpacked" /></normalize>)"
        R"(<multiply name="n_double" type="vector3"><input name="in1" type="vector3" nodename="i" /><input name="in2" type="float" value="2" /></multiply>)"
        R"(<subtract name="n_unpacked" type="vector3"><input name="in1" type="vector3" nodename="n_double" /><input name="in2" type="float" value="1" /></subtract>)");
    EXPECT_EQ(
        upgraded(
            R"(<subsurface_bsdf name="s" type="BSDF"><input name="radius" type="vector3" value="1, 1, 1"/></subsurface_bsdf>)"),
        R"(<subsurface_bsdf name="s" type="BSDF"><input name="radius" type="color3" value="1, 1, 1" /></subsurface_bsdf>)");
    EXPECT_EQ(
        upgraded(R"(<rotate name="r" type="vector3"><parameter name="axis" type="vector3" value="0, 1, 1"/></rotate>)",
                 nullptr, "1.36"),
        R"(<rotate3d name="r" type="vector3"><input name="axis" type="vector3" value="0, 1, 1" /></rotate3d>)");
}

TEST(Upgrade, BooleanSwitchesAndOldNodes) {
    EXPECT_EQ(
        upgraded(
            R"(<switch name="s" type="float"><input name="in1" type="float" value="1"/><input name="in2" type="float" value="2"/><parameter name="which" type="boolean" value="true"/></switch>)",
            nullptr, "1.36"),
        R"(<ifequal name="s" type="float"><input name="in2" type="float" value="1" /><input name="in1" type="float" value="2" /><input name="value1" type="boolean" value="true" /><input name="value2" type="boolean" value="true" /></ifequal>)");
    // A choice beyond the inputs of 1.38 gave 0; so do those inputs of 1.39 that say nothing.
    std::string body =
        R"(<switch name="s" type="float"><input name="in1" type="float" value="1" /><input name="which" type="float" value="7" /></switch>)";
    EXPECT_EQ(upgraded(body), body);
    EXPECT_EQ(
        upgraded(
            R"(<atan2 name="a" type="float"><input name="in1" type="float" value="1"/><input name="in2" type="float" value="2"/></atan2>)",
            nullptr, "1.37"),
        R"(<atan2 name="a" type="float"><input name="inx" type="float" value="1" /><input name="iny" type="float" value="2" /></atan2>)");
    EXPECT_EQ(
        upgraded(
            R"(<compare name="c" type="float"><input name="intest" type="float" nodename="t"/><parameter name="cutoff" type="float" value="0.5"/><input name="in1" type="float" value="1"/><input name="in2" type="float" value="2"/></compare>)",
            nullptr, "1.36"),
        R"(<ifgreater name="c" type="float"><input name="value1" type="float" nodename="t" /><input name="value2" type="float" value="0.5" /><input name="in2" type="float" value="1" /><input name="in1" type="float" value="2" /></ifgreater>)");
    EXPECT_EQ(
        upgraded(
            R"(<geomattrvalue name="g" type="float" attrname="dirt"/><geomattrvalue name="h" type="string" attrname="kind"/>)",
            nullptr, "1.36"),
        R"(<geompropvalue name="g" type="float"><input name="geomprop" type="string" value="dirt" /></geompropvalue>)"
        R"(<geompropvalueuniform name="h" type="string"><input name="geomprop" type="string" value="kind" /></geompropvalueuniform>)");
    std::string warnings;
    upgraded(R"(<fresnel name="f" type="float"/>)", &warnings, "1.37");
    EXPECT_NE(warnings.find("<fresnel> has no counterpart in 1.39 [cannot-upgrade]"), std::string::npos) << warnings;
}

TEST(Upgrade, WordsOfTheFirstVersions) {
    EXPECT_EQ(
        upgraded(
            R"(<opgraph name="g"><constant name="c" type="vector"><parameter name="color" type="vector" value="1, 2, 3"/></constant><add name="a" type="vector"><parameter name="in1" type="opgraphnode" value="c"/></add><output name="o" type="vector"><parameter name="in" type="opgraphnode" value="a"/></output></opgraph>)",
            nullptr, "1.22"),
        R"(<nodegraph name="g"><constant name="c" type="vector3"><input name="value" type="vector3" value="1, 2, 3" /></constant>)"
        R"(<add name="a" type="vector3"><input name="in1" type="vector3" nodename="c" /></add><output name="o" type="vector3" nodename="a" /></nodegraph>)");
    EXPECT_EQ(
        upgraded(
            R"(<collection name="c"><collectionadd name="x" geom="/a"/><collectionadd name="y" geom="/b"/><collectionremove name="z" geom="/c"/></collection><look name="l"><materialassign name="M" geom="*"/></look><look name="k"><lookinherit name="i" look="l"/></look>)",
            nullptr, "1.26"),
        R"(<collection name="c" includegeom="/a,/b" excludegeom="/c" /><look name="l"><materialassign name="M" geom="/" material="M" /></look><look name="k" inherit="l" />)");
    EXPECT_EQ(
        upgraded(
            R"(<image name="i" type="color3"><parameter name="file" type="filename" value="a.%UDIM.%UVTILE.tif"/></image>)",
            nullptr, "1.35"),
        R"(<image name="i" type="color3"><input name="file" type="filename" value="a.&lt;UDIM&gt;.&lt;UVTILE&gt;.tif" /></image>)");
    EXPECT_EQ(
        upgraded(
            R"(<mix name="m" type="float"><input name="mask" type="float" value="1"/></mix><hueshift name="h" type="color3"><parameter name="amount" type="float" value="0.2"/></hueshift>)",
            nullptr, "1.35"),
        R"(<mix name="m" type="float"><input name="mix" type="float" value="1" /></mix><hsvadjust name="h" type="color3"><input name="amount" type="vector3" value="0.2, 1, 1" /></hsvadjust>)");
    EXPECT_EQ(
        upgraded(
            R"(<scale name="s" type="vector2"><input name="in" type="vector2" nodename="t"/><parameter name="amount" type="float" value="2"/></scale>)",
            nullptr, "1.35"),
        R"(<place2d name="s" type="vector2"><input name="texcoord" type="vector2" nodename="t" /><input name="scale" type="vector2" value="2, 2" /><input name="pivot" type="vector2" value="0.5, 0.5" /></place2d>)");
}

TEST(Upgrade, Definitions) {
    EXPECT_EQ(
        upgraded(
            R"(<nodedef name="ND_a" node="a" type="float" defaultinput="in"><input name="in" type="float"/><parameter name="p" type="integer" value="1"/></nodedef><geominfo name="i" geom="/a"><geomattr name="id" type="integer" value="1"/></geominfo><backdrop name="b"><parameter name="note" type="string" value="x"/></backdrop>)",
            nullptr, "1.36"),
        R"(<nodedef name="ND_a" node="a"><input name="in" type="float" /><input name="p" type="integer" value="1" uniform="true" /><output name="out" type="float" defaultinput="in" /></nodedef>)"
        R"(<geominfo name="i" geom="/a"><geomprop name="id" type="integer" value="1" /></geominfo><backdrop name="b" note="x" />)");
}

TEST(Upgrade, Color2) {
    EXPECT_EQ(
        upgraded(
            R"(<constant name="c" type="color2" nodedef="ND_constant_color2"><parameter name="value" type="color2" value="1, 2"/></constant><add name="a" type="float"><input name="in1" type="float" nodename="c" channels="a"/></add>)",
            nullptr, "1.37"),
        R"(<constant name="c" type="vector2"><input name="value" type="vector2" value="1, 2" /></constant><add name="a" type="float"><input name="in1" type="float" nodename="a_in1_channels" /></add>)"
        R"(<extract name="a_in1_channels" type="float"><input name="in" type="vector2" nodename="c" /><input name="index" type="integer" value="1" /></extract>)");
    EXPECT_EQ(
        upgraded(
            R"(<separate name="s" type="multioutput"><input name="in" type="color2" nodename="c"/></separate><add name="a" type="float"><input name="in1" type="float" nodename="s" output="outa"/></add>)",
            nullptr, "1.36"),
        R"(<separate2 name="s" type="multioutput"><input name="in" type="vector2" nodename="c" /></separate2><add name="a" type="float"><input name="in1" type="float" nodename="s" output="outy" /></add>)");
    EXPECT_EQ(
        upgraded(
            R"(<combine2 name="c" type="color4"><input name="in1" type="color2" value="1, 2"/><input name="in2" type="color2" value="3, 4"/></combine2>)",
            nullptr, "1.37"),
        R"(<convert name="c" type="color4"><input name="in" type="vector4" nodename="c_vector" /></convert>)"
        R"(<combine2 name="c_vector" type="vector4"><input name="in1" type="vector2" value="1, 2" /><input name="in2" type="vector2" value="3, 4" /></combine2>)");
}

TEST(Upgrade, Materials) {
    std::string bound = upgraded(
        R"(<material name="M" colorspace="acescg"><!-- paint --><shaderref name="S" node="plastic" version="1.0.0"><bindinput name="base_color" type="color3" nodegraph="g" output="o"/><bindparam name="roughness" type="float" value="0.3"/><bindtoken name="t" type="string" value="x"/></shaderref></material><look name="l"><materialassign name="a" material="M" geom="/"/></look>)",
        nullptr, "1.37");
    EXPECT_EQ(
        bound,
        R"(<surfacematerial name="M" colorspace="acescg" type="material"><!-- paint --><input name="surfaceshader" type="surfaceshader" nodename="S" /></surfacematerial>)"
        R"(<plastic name="S" version="1.0.0" type="surfaceshader" colorspace="acescg"><input name="base_color" type="color3" nodegraph="g" output="o" /><input name="roughness" type="float" value="0.3" /><token name="t" type="string" value="x" /></plastic>)"
        R"(<look name="l"><materialassign name="a" material="M" geom="/" /></look>)");
    // Types are those of the definitions.
    EXPECT_EQ(
        upgraded(
            R"(<nodedef name="ND_b" node="bumps" type="displacementshader"/><material name="M"><shaderref name="S" node="plastic"/><shaderref name="D" nodedef="ND_b"/></material>)",
            nullptr, "1.36"),
        R"(<nodedef name="ND_b" node="bumps"><output name="out" type="displacementshader" /></nodedef>)"
        R"(<surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="S" /><input name="displacementshader" type="displacementshader" nodename="D" /></surfacematerial>)"
        R"(<plastic name="S" type="surfaceshader" /><bumps name="D" nodedef="ND_b" type="displacementshader" />)");
    std::string warnings;
    std::string kept = upgraded(R"(<material name="M"><shaderref name="S"/></material>)", &warnings, "1.37");
    EXPECT_EQ(kept, R"(<surfacematerial name="M" type="material"><shaderref name="S" /></surfacematerial>)");
    EXPECT_NE(warnings.find("test.mtlx:1:46: warning: nothing says which node the shader 'S' is [cannot-upgrade]"),
              std::string::npos)
        << warnings;
}

TEST(Upgrade, MaterialsThatInherit) {
    const char* parent =
        R"(<material name="P"><shaderref name="S" node="plastic"><bindinput name="base" type="float" value="1"/><bindinput name="sheen" type="float" value="2"/></shaderref></material>)";
    const char* expected =
        R"(<surfacematerial name="P" type="material"><input name="surfaceshader" type="surfaceshader" nodename="S" /></surfacematerial>)"
        R"(<plastic name="S" type="surfaceshader"><input name="base" type="float" value="1" /><input name="sheen" type="float" value="2" /></plastic>)";
    EXPECT_EQ(
        upgraded(
            std::string(parent) +
                R"(<material name="C" inherit="P"/><material name="B" inherit="P"><shaderref name="T" node="plastic"><bindinput name="sheen" type="float" value="3"/></shaderref></material>)",
            nullptr, "1.36"),
        std::string(expected) +
            R"(<surfacematerial name="C" type="material"><input name="surfaceshader" type="surfaceshader" nodename="C_S" /></surfacematerial>)"
            R"(<plastic name="C_S" type="surfaceshader"><input name="base" type="float" value="1" /><input name="sheen" type="float" value="2" /></plastic>)"
            R"(<surfacematerial name="B" type="material"><input name="surfaceshader" type="surfaceshader" nodename="T" /></surfacematerial>)"
            R"(<plastic name="T" type="surfaceshader"><input name="base" type="float" value="1" /><input name="sheen" type="float" value="3" /></plastic>)");
    EXPECT_NE(
        upgraded(std::string(parent) + R"(<material name="C"><materialinherit name="i" material="P"/></material>)",
                 nullptr, "1.35")
            .find(R"(<surfacematerial name="C" type="material"><input name="surfaceshader")"),
        std::string::npos);
    std::string warnings;
    upgraded(R"(<material name="A" inherit="B"/><material name="B" inherit="A"/>)", &warnings, "1.37");
    EXPECT_NE(warnings.find("the material inherits itself"), std::string::npos) << warnings;
}

TEST(Upgrade, ShadersAndOverrides) {
    const char* shader =
        R"(<shader name="S" shadertype="surface" shaderprogram="plastic"><input name="base" type="float" value="0.5" publicname="gain"/><input name="base_color" type="color3" opgraph="g" graphoutput="o"/></shader>)";
    const char* node =
        R"(<plastic name="S" type="surfaceshader"><input name="base" type="float" value="0.5" publicname="gain" /><input name="base_color" type="color3" nodegraph="g" output="o" /></plastic>)";
    EXPECT_EQ(
        upgraded(
            std::string(shader) +
                R"(<material name="M"><shaderref name="S" shadertype="surface"/></material><material name="N"><shaderref name="S" shadertype="surface"/><override name="gain" type="float" value="0.9"/></material>)",
            nullptr, "1.26"),
        std::string(node) +
            R"(<surfacematerial name="M" type="material"><input name="surfaceshader" type="surfaceshader" nodename="S" /></surfacematerial>)"
            R"(<surfacematerial name="N" type="material"><input name="surfaceshader" type="surfaceshader" nodename="N_S" /></surfacematerial>)"
            R"(<plastic name="N_S" type="surfaceshader"><input name="base" type="float" value="0.9" publicname="gain" /><input name="base_color" type="color3" nodegraph="g" output="o" /></plastic>)");
    // A value inside of a graph: the material gets a graph of its own.
    std::string graph = upgraded(
        R"(<nodegraph name="g"><constant name="c" type="color3"><parameter name="value" type="color3" value="0, 0, 0" publicname="tint"/></constant><output name="o" type="color3" nodename="c"/></nodegraph><material name="M"><shaderref name="S" node="plastic"><bindinput name="base_color" type="color3" nodegraph="g" output="o"/></shaderref><override name="tint" type="color3" value="1, 0, 0"/></material>)",
        nullptr, "1.35");
    EXPECT_NE(
        graph.find(
            R"(<nodegraph name="g_M"><constant name="c" type="color3"><input name="value" type="color3" value="1, 0, 0" publicname="tint" />)"),
        std::string::npos)
        << graph;
    EXPECT_NE(graph.find(R"(nodegraph="g_M" output="o")"), std::string::npos) << graph;
    std::string warnings;
    upgraded(
        R"(<material name="M"><shaderref name="S" node="plastic"/><override name="no" type="float" value="1"/></material>)",
        &warnings, "1.35");
    EXPECT_NE(warnings.find("has the public name 'no'"), std::string::npos) << warnings;
}

TEST(Upgrade, ClosuresThatLieOnOthers) {
    EXPECT_EQ(
        upgraded(
            R"(<dielectric_brdf name="d" type="BSDF"><input name="roughness" type="vector2" value="0.1, 0.1"/><input name="base" type="BSDF" nodename="b"/></dielectric_brdf>)",
            nullptr, "1.37"),
        R"(<dielectric_bsdf name="d_top" type="BSDF"><input name="roughness" type="vector2" value="0.1, 0.1" /></dielectric_bsdf>)"
        R"(<layer name="d" type="BSDF"><input name="top" type="BSDF" nodename="d_top" /><input name="base" type="BSDF" nodename="b" /></layer>)");
    EXPECT_EQ(
        upgraded(
            R"(<dielectric_btdf name="d" type="BSDF"><input name="interior" type="VDF" nodename="v"/></dielectric_btdf>)",
            nullptr, "1.37"),
        R"(<dielectric_bsdf name="d_top" type="BSDF"><input name="roughness" type="vector2" value="0, 0" /><input name="scatter_mode" type="string" value="T" /></dielectric_bsdf>)"
        R"(<layer name="d" type="BSDF"><input name="top" type="BSDF" nodename="d_top" /><input name="base" type="VDF" nodename="v" /></layer>)");
    EXPECT_EQ(
        upgraded(
            R"(<diffuse_brdf name="a" type="BSDF"/><diffuse_btdf name="b" type="BSDF"/><burley_diffuse_brdf name="c" type="BSDF"/><sheen_brdf name="e" type="BSDF"><input name="base" type="BSDF" value=""/></sheen_brdf><subsurface_brdf name="f" type="BSDF"><input name="radius" type="vector3" value="1, 1, 1"/></subsurface_brdf>)",
            nullptr, "1.37"),
        R"(<oren_nayar_diffuse_bsdf name="a" type="BSDF" /><translucent_bsdf name="b" type="BSDF" /><burley_diffuse_bsdf name="c" type="BSDF" /><sheen_bsdf name="e" type="BSDF" />)"
        R"(<subsurface_bsdf name="f" type="BSDF"><input name="radius" type="color3" value="1, 1, 1" /></subsurface_bsdf>)");
}

TEST(Upgrade, ConductorsAndRates) {
    EXPECT_EQ(
        upgraded(
            R"(<conductor_brdf name="c" type="BSDF"><input name="reflectivity" type="color3" value="0.9, 0.8, 0.7"/><input name="roughness" type="vector2" nodename="r"/></conductor_brdf>)",
            nullptr, "1.36"),
        R"(<conductor_bsdf name="c" type="BSDF"><input name="roughness" type="vector2" nodename="r" /><input name="ior" type="color3" nodename="c_artistic_ior" output="ior" /><input name="extinction" type="color3" nodename="c_artistic_ior" output="extinction" /></conductor_bsdf>)"
        R"(<artistic_ior name="c_artistic_ior" type="multioutput"><input name="reflectivity" type="color3" value="0.9, 0.8, 0.7" /></artistic_ior>)");
    EXPECT_EQ(
        upgraded(
            R"(<absorption_vdf name="a" type="VDF"><input name="absorption" type="color3" value="1, 2, 3"/></absorption_vdf><anisotropic_vdf name="b" type="VDF"><input name="scattering" type="color3" nodename="c"/></anisotropic_vdf>)"),
        R"(<absorption_vdf name="a" type="VDF"><input name="absorption" type="vector3" value="1, 2, 3" /></absorption_vdf>)"
        R"(<anisotropic_vdf name="b" type="VDF"><input name="scattering" type="vector3" nodename="b_scattering_vector3" /></anisotropic_vdf>)"
        R"(<convert name="b_scattering_vector3" type="vector3"><input name="in" type="color3" nodename="c" /></convert>)");
    EXPECT_EQ(
        upgraded(
            R"(<artistic_ior name="a" type="multioutput"/><add name="x" type="vector3"><input name="in1" type="vector3" nodename="a" output="ior"/></add>)",
            nullptr, "1.37"),
        R"(<artistic_ior name="a" type="multioutput" /><add name="x" type="vector3"><input name="in1" type="vector3" nodename="x_in1_vector" /></add>)"
        R"(<convert name="x_in1_vector" type="vector3"><input name="in" type="color3" nodename="a" output="ior" /></convert>)");
}

const std::string kFilm =
    R"(<thin_film_bsdf name="film" type="BSDF"><input name="thickness" type="float" value="400"/><input name="ior" type="float" nodename="n"/></thin_film_bsdf>)";
const std::string kCoat =
    R"(<input name="thinfilm_thickness" type="float" value="400" /><input name="thinfilm_ior" type="float" nodename="n" />)";
const std::string kOnX =
    R"(<layer name="l" type="BSDF"><input name="top" type="BSDF" nodename="film"/><input name="base" type="BSDF" nodename="x"/></layer><surface name="s" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="l"/></surface>)";
const std::string kReadsX =
    R"(<surface name="s" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="x" /></surface>)";

TEST(Upgrade, ThinFilms) {
    EXPECT_EQ(upgraded(kFilm + R"(<conductor_bsdf name="x" type="BSDF"/>)" + kOnX),
              R"(<conductor_bsdf name="x" type="BSDF">)" + kCoat + "</conductor_bsdf>" + kReadsX);
    // Through a mix; pure transmission has no film, and diffuse closures have none.
    EXPECT_EQ(
        upgraded(
            kFilm +
            R"(<mix name="x" type="BSDF"><input name="fg" type="BSDF" nodename="a"/><input name="bg" type="BSDF" nodename="b"/></mix><dielectric_bsdf name="a" type="BSDF"><input name="scatter_mode" type="string" value="T"/></dielectric_bsdf><multiply name="b" type="BSDF"><input name="in1" type="BSDF" nodename="c"/></multiply><generalized_schlick_bsdf name="c" type="BSDF"/>)" +
            kOnX),
        R"(<mix name="x" type="BSDF"><input name="fg" type="BSDF" nodename="a" /><input name="bg" type="BSDF" nodename="b" /></mix><dielectric_bsdf name="a" type="BSDF"><input name="scatter_mode" type="string" value="T" /></dielectric_bsdf><multiply name="b" type="BSDF"><input name="in1" type="BSDF" nodename="c" /></multiply><generalized_schlick_bsdf name="c" type="BSDF">)" +
            kCoat + "</generalized_schlick_bsdf>" + kReadsX);
    // What others read without the film is copied first.
    EXPECT_EQ(
        upgraded(
            kFilm +
            R"(<conductor_bsdf name="x" type="BSDF"/><surface name="t" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="x"/></surface>)" +
            kOnX),
        R"(<conductor_bsdf name="x" type="BSDF" /><conductor_bsdf name="x_film" type="BSDF">)" + kCoat +
            R"(</conductor_bsdf><surface name="t" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="x" /></surface>)"
            R"(<surface name="s" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="x_film" /></surface>)");
}

TEST(Upgrade, ThinFilmsInGraphs) {
    std::string graph =
        R"(<nodegraph name="g"><conductor_bsdf name="c" type="BSDF"/><output name="o" type="BSDF" nodename="c"/></nodegraph>)";
    std::string onGraph =
        R"(<layer name="l" type="BSDF"><input name="top" type="BSDF" nodename="film"/><input name="base" type="BSDF" nodegraph="g" output="o"/></layer><surface name="s" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="l"/></surface>)";
    EXPECT_EQ(
        upgraded(kFilm + graph + onGraph),
        R"(<nodegraph name="g"><conductor_bsdf name="c" type="BSDF"><input name="thinfilm_thickness" type="float" value="400" /><input name="thinfilm_ior" type="float" interfacename="thinfilm_ior" /></conductor_bsdf><output name="o" type="BSDF" nodename="c" /><input name="thinfilm_ior" type="float" nodename="n" /></nodegraph>)"
        R"(<surface name="s" type="surfaceshader"><input name="bsdf" type="BSDF" nodegraph="g" output="o" /></surface>)");
    std::string warnings;
    upgraded(kFilm + R"(<my_closure name="x" type="BSDF"/>)" + kOnX, &warnings);
    EXPECT_NE(warnings.find("the film does not reach all closures below it"), std::string::npos) << warnings;
    warnings.clear();
    upgraded(kFilm, &warnings);
    EXPECT_NE(warnings.find("this thin film lies on nothing"), std::string::npos) << warnings;
}

TEST(Upgrade, SurfacesOfTwoSides) {
    EXPECT_EQ(
        upgraded(
            R"(<thin_surface name="t" type="surfaceshader"><input name="front_bsdf" type="BSDF" nodename="f"/><input name="back_bsdf" type="BSDF" nodename="b"/></thin_surface><surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodename="t"/></surfacematerial>)"),
        R"(<surface name="t" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="f" /><input name="thin_walled" type="boolean" value="true" /></surface>)"
        R"(<surface name="t_back" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="b" /><input name="thin_walled" type="boolean" value="true" /></surface>)"
        R"(<surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodename="t" /><input name="backsurfaceshader" type="surfaceshader" nodename="t_back" /></surfacematerial>)");
}

TEST(Upgrade, FilesWithoutAVersion) {
    struct Case {
        const char *body, *version;
    };
    constexpr Case kCases[] = {
        {R"(<standard_surface name="s" type="surfaceshader"/>)", "1.39"},
        {R"(<swizzle name="s" type="float"/>)", "1.38"},
        {R"(<material name="m"/>)", "1.37"},
        {R"(<add name="a" type="color2"/>)", "1.37"},
        {R"(<compare name="c" type="float"/>)", "1.36"},
        {R"(<nodedef name="ND_compare" node="compare"/><compare name="c" type="float"/>)", "1.39"},
        {R"(<image name="i" type="color3"><parameter name="file" type="filename" value="a.%UDIM.tif"/></image>)",
         "1.35"},
        {R"(<opgraph name="g"/>)", "1.26"},
        {R"(<constant name="c" type="float"><parameter name="color" type="float" value="1"/></constant>)", "1.25"},
    };
    for (const Case& c : kCases)
        for (const char* root : {"<materialx>", "<materialx version=\"\">"}) {
            NameTable names;
            Document d(names);
            readInto(d, std::string(root) + c.body + "</materialx>");
            Diagnostics diagnostics;
            upgrade(d, diagnostics);
            std::string expected =
                std::string("test.mtlx:1:1: warning: the file has no version: it is read as one of ") + c.version +
                " [assumed-version]";
            EXPECT_EQ(diagnostics.text().substr(0, expected.size()), expected) << c.body;
            EXPECT_EQ(d.attributeText(d.root(), d.known().version), "1.39") << c.body;
        }
}

TEST(Upgrade, TellsItsEdits) {
    NameTable names;
    Document d(names);
    readInto(d, "<materialx version=\"1.36\">\n <rotate name=\"r\" type=\"vector3\"/>\n</materialx>");
    Diagnostics diagnostics;
    std::vector<Edit> edits;
    upgrade(d, diagnostics, {nullptr, &edits});
    ASSERT_EQ(edits.size(), 2u);
    EXPECT_EQ(edits[0].where.line, 2u);
    EXPECT_EQ(edits[0].path, "r");
    EXPECT_EQ(edits[0].was, "<rotate name=\"r\">");
    EXPECT_EQ(edits[0].now, "<rotate3d name=\"r\">");
    EXPECT_EQ(edits[1].was, "version '1.36'");
}

TEST(Upgrade, BitangentsAreThoseOfTheOtherTwo) {
    EXPECT_EQ(
        upgraded(
            R"(<normalmap name="n" type="vector3"><input name="tangent" type="vector3" nodename="t"/></normalmap>)"),
        R"(<normalmap name="n" type="vector3"><input name="tangent" type="vector3" nodename="t" /><input name="bitangent" type="vector3" nodename="n_bitangent" /></normalmap>)"
        R"(<normalize name="n_bitangent" type="vector3"><input name="in" type="vector3" nodename="n_bitangent_cross" /></normalize>)"
        R"(<normal name="n_world_normal" type="vector3"><input name="space" type="string" value="world" /></normal>)"
        R"(<crossproduct name="n_bitangent_cross" type="vector3"><input name="in1" type="vector3" nodename="n_world_normal" /><input name="in2" type="vector3" nodename="t" /></crossproduct>)");
}

TEST(Upgrade, NamesThatNoNodeCanHaveAreLeftAndTold) {
    std::string warnings;
    const std::string made =
        upgraded(R"(<material name="M"><shaderref name="S" node="&lt;UVTILE>" /></material>)", &warnings, "1.36");
    EXPECT_EQ(made.find("<<"), std::string::npos) << made;
    EXPECT_NE(warnings.find("no node can be called '<UVTILE>'"), std::string::npos) << warnings;
}

TEST(Upgrade, LeavesNewDocumentsAlone) {
    std::string body = R"(<swizzle name="s" type="float" channels="r" />)";
    EXPECT_EQ(upgraded(body, nullptr, "1.39"), body);
}

}  // namespace
}  // namespace shaderx::doc
