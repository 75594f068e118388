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

TEST(Upgrade, LeavesNewDocumentsAlone) {
    std::string body = R"(<swizzle name="s" type="float" channels="r" />)";
    EXPECT_EQ(upgraded(body, nullptr, "1.39"), body);
}

}  // namespace
}  // namespace shaderx::doc
