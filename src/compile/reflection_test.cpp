#include "compile/reflection.h"

#include <limits>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "compile/compile.h"
#include "compile/json.h"

namespace shaderx {
namespace {

using Json = nlohmann::json;

// The shader of an element of a document that is given by its body.
Shader shaderOf(const std::string& body, std::string_view element, const GenerateOptions& how = {}) {
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    std::string text = "<materialx version=\"1.39\">\n" + body + "\n</materialx>\n";
    auto document = compiler.read("test.mtlx", text, none, diagnostics);
    Result<Shader> shader = Failure{};
    if (document) shader = compiler.generate(*document, document->find(element), how, diagnostics);
    EXPECT_TRUE(shader) << diagnostics.text();
    Shader out = shader ? *shader : Shader();
    out.program = nullptr;  // it must not outlive the compiler
    return out;
}

std::map<std::string, Json> byKey(const Json& list, const char* key) {
    std::map<std::string, Json> all;
    for (const Json& x : list) all[x[key].get<std::string>()] = x;
    return all;
}

TEST(Reflection, ValuesSayWhatAnEditorShows) {
    Json json = Json::parse(shaderOf(R"(
        <standard_surface name="s" type="surfaceshader">
          <input name="base" type="float" value="0.5"/>
          <input name="specular_IOR" type="float" value="1.4" uisoftmax="2" uiname="Glassiness"/>
          <input name="specular_color" type="color3" value="1, 0.5, 0.25" colorspace="srgb_texture"/>
          <input name="coat" type="float" value="0"/>
          <input name="coat_color" type="color3" value="1, 0, 0"/>
          <input name="thin_walled" type="boolean" value="false"/>
        </standard_surface>)",
                                     "s")
                                .reflection());
    std::map<std::string, Json> uniforms = byKey(json["uniforms"], "name"), fixed = byKey(json["regenerate"], "path");
    EXPECT_EQ(uniforms["s_base"], Json::parse(R"({"name": "s_base", "type": "float", "value": 0.5, "kind": "live",
        "path": "s/base", "stages": ["pixel"], "uiname": "Base", "uifolder": "Base", "uimin": 0, "uimax": 1})"));
    EXPECT_EQ(uniforms["s_specular_IOR"]["uiname"], "Glassiness");  // the document's own goes before the nodedef's
    EXPECT_EQ(uniforms["s_specular_IOR"]["uisoftmin"], 1);
    EXPECT_EQ(uniforms["s_specular_IOR"]["uisoftmax"], 2);
    EXPECT_EQ(uniforms["s_specular_color"]["colorspace"], "srgb_texture");
    EXPECT_EQ(uniforms["s_specular_color"]["uimax"], Json::array({1, 1, 1}));
    EXPECT_EQ(uniforms["u_viewPosition"]["semantic"], "view_position");
    EXPECT_EQ(fixed["s/coat"], Json::parse(R"({"path": "s/coat", "type": "float", "value": 0, "uiname": "Coat",
        "uifolder": "Coat", "uimin": 0, "uimax": 1})"));
    EXPECT_EQ(fixed["s/thin_walled"]["value"], false);
    EXPECT_EQ(fixed["s/thin_walled"]["uiadvanced"], true);
    EXPECT_EQ(fixed.count("s/coat_color"), 0u);  // without a coat it has no effect
    EXPECT_EQ(uniforms.count("s_coat_color"), 0u);
}

TEST(Reflection, ChoicesAndTextsNeedNewCode) {
    Json json = Json::parse(shaderOf(R"x(
        <nodedef name="ND_pick" node="pick"><input name="which" type="integer" value="0" uniform="true" enum="red, blue"
          enumvalues="0, 1" uiname="Which"/><output name="out" type="color3"/></nodedef>
        <implementation name="IM_pick" nodedef="ND_pick" sourcecode="{{which}} == 0 ? color(1.0, 0.0, 0.0) : color(0.0, 0.0, 1.0)"/>
        <position name="p" type="vector3"><input name="space" type="string" value="world"/></position>
        <convert name="c" type="color3"><input name="in" type="vector3" nodename="p"/></convert>
        <pick name="k" type="color3"><input name="which" type="integer" value="1"/></pick>
        <add name="sum" type="color3"><input name="in1" type="color3" nodename="c"/><input name="in2" type="color3" nodename="k"/></add>)x",
                                     "sum")
                                .reflection());
    std::map<std::string, Json> fixed = byKey(json["regenerate"], "path");
    EXPECT_EQ(fixed["p/space"]["value"], "world");
    EXPECT_EQ(fixed["k/which"]["value"], 1);
    EXPECT_EQ(fixed["k/which"]["enum"], Json::array({"red", "blue"}));
    EXPECT_EQ(fixed["k/which"]["enumvalues"], Json::array({"0", "1"}));
}

TEST(Reflection, OtherNamesOfMaterialX) {
    Json json = Json::parse(shaderOf(R"(
        <nodegraph name="g"><input name="amount" type="float" value="0.5"/>
          <multiply name="a" type="float"><input name="in1" type="float" interfacename="amount"/><input name="in2" type="float" value="0.25"/></multiply>
          <add name="b" type="float"><input name="in1" type="float" nodename="a"/><input name="in2" type="float" interfacename="amount"/></add>
          <output name="out" type="float" nodename="b"/></nodegraph>
        <nodegraph name="h"><multiply name="a" type="float"><input name="in1" type="float" nodegraph="g" output="out"/><input name="in2" type="float" value="0.125"/></multiply>
          <output name="out" type="float" nodename="a"/></nodegraph>
        <output name="o" type="float" nodegraph="h" output="out"/>)",
                                     "o")
                                .reflection());
    std::map<std::string, Json> uniforms = byKey(json["uniforms"], "name");
    EXPECT_EQ(uniforms["g_amount"]["aliases"], Json::array({"a_in1", "b_in2"}));
    EXPECT_EQ(uniforms["a_in2"]["aliases"], Json());
    EXPECT_EQ(uniforms["a_in22"]["aliases"], Json::array({"a_in2"}));
}

TEST(Reflection, TexturesSayHowTheyAreRead) {
    Json json = Json::parse(shaderOf(R"(<image name="wood" type="color3">
        <input name="file" type="filename" value="wood.png" colorspace="srgb_texture"/>
        <input name="uaddressmode" type="string" value="clamp"/><input name="filtertype" type="string" value="closest"/>
        </image>)",
                                     "wood")
                                .reflection());
    Json wood = byKey(json["samplers"], "name")["wood_file"];
    EXPECT_EQ(wood["file"], "wood.png");
    EXPECT_EQ(wood["uaddressmode"], "clamp");
    EXPECT_EQ(wood["vaddressmode"], "periodic");
    EXPECT_EQ(wood["filtertype"], "closest");
    EXPECT_EQ(wood["colorspace"], "srgb_texture");
    EXPECT_EQ(json["regenerate"], Json::array());  // a sampler's modes are no part of the program
    EXPECT_EQ(wood["uiname"], "Filename");
    EXPECT_EQ(byKey(json["inputs"], "name")["i_texcoord_0"]["semantic"], "texcoord_0");
}

std::string surface(const char* base, const char* coat, const char* name = "s") {
    return std::string("<standard_surface name=\"") + name +
           "\" type=\"surfaceshader\"><input name=\"base\" type=\"float\" value=\"" + base +
           "\"/><input name=\"coat\" type=\"float\" value=\"" + coat + "\"/></standard_surface>";
}

TEST(Reflection, TopologyIsEqualWhereOnlyLiveValuesDiffer) {
    std::uint64_t one = shaderOf(surface("0.5", "0.25"), "s").topology;
    EXPECT_EQ(one, shaderOf(surface("0.123456", "0.5"), "s").topology);
    EXPECT_NE(one, shaderOf(surface("0.5", "0"), "s").topology);
    EXPECT_NE(one, shaderOf(surface("0.5", "0.25", "t"), "t").topology);  // uniforms are called otherwise
    GenerateOptions baked;
    baked.interface = Interface::Baked;
    EXPECT_NE(shaderOf(surface("0.5", "0.25"), "s", baked).topology,
              shaderOf(surface("0.6", "0.25"), "s", baked).topology);
    EXPECT_EQ(shaderOf(surface("0.5", "0.25"), "s", baked).topology,
              shaderOf(surface("0.5", "0.25", "t"), "t", baked).topology);
}

TEST(Reflection, HashesAreTheSameEverywhere) {
    EXPECT_EQ(stableHash(""), 0u);
    EXPECT_EQ(stableHash("ShaderX compiles materials"), 0x6aac34eb1bf05bf4u);
    EXPECT_NE(stableHash("a"), stableHash(std::string_view("a\0", 2)));
}

TEST(Json, AnyTextAndNumber) {
    JsonWriter json;
    json.openObject();
    json.key("text");
    json.text("\"\\\n\x01 \xc3\xa9 \xff \xed\xa0\x80 \xf0\x9f\x98\x80");
    json.key("control");
    json.text("\x7f\u009b\u202e");
    json.key("numbers");
    json.openShortArray();
    for (float v : {0.0f, -1.0f, 0.1f, 1e30f, -2.5e-20f, std::numeric_limits<float>::infinity()}) json.number(v);
    json.closeArray();
    json.key("none");
    json.openArray();
    json.closeArray();
    json.closeObject();
    const std::string written = json.take();
    EXPECT_NE(written.find("\"\\u007f\\u009b\\u202e\""), std::string::npos) << written;  // no terminal obeys it
    Json parsed = Json::parse(written);
    EXPECT_EQ(parsed["text"], "\"\\\n\x01 \xc3\xa9 \xef\xbf\xbd \xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd \xf0\x9f\x98\x80");
    EXPECT_EQ(parsed["numbers"][2].get<float>(), 0.1f);
    EXPECT_EQ(parsed["numbers"][3].get<float>(), 1e30f);
    EXPECT_EQ(parsed["numbers"][4].get<float>(), -2.5e-20f);
    EXPECT_TRUE(parsed["numbers"][5].is_null());
    EXPECT_TRUE(parsed["none"].empty());
}

}  // namespace
}  // namespace shaderx
