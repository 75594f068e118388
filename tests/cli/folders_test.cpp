// Options that say how strictly a document is taken, and what lies around documents: links, libraries, long names.
#include "support.h"

namespace shaderx::tests {
namespace {

class Folders : public testing::Test {
  protected:
    Ran shaderx(const std::string& arguments) {
        return runCommand(std::string("'") + SHADERX_PROGRAM + "' " + arguments, own_.path());
    }
    void store(const std::string& name, std::string_view content) {
        const fs::path file = own_.path() / name;
        fs::create_directories(file.parent_path());
        writeText(file, "<materialx version='1.39' xmlns:xi='http://www.w3.org/2001/XInclude'>\n" +
                            std::string(content) + "</materialx>\n");
    }
    // What validate and generate say alike: the code and a part of the message, or an empty text for nothing at all.
    void expectSaid(const std::string& arguments, int exitCode, std::string_view message) {
        for (const char* command : {"validate ", "generate -o out "}) {
            const Ran ran = shaderx(command + arguments);
            EXPECT_EQ(ran.exitCode, exitCode) << command << arguments << "\n" << ran.errors;
            EXPECT_NE(ran.errors.find(message), std::string::npos) << command << arguments << "\n" << ran.errors;
            if (message.empty()) {
                EXPECT_EQ(ran.errors, "") << command << arguments;
            }
        }
    }
    std::size_t written() const {
        const fs::path out = own_.path() / "out";
        return fs::exists(out) ? static_cast<std::size_t>(std::distance(fs::directory_iterator(out), {})) : 0;
    }

    OwnFolder own_;
};

TEST_F(Folders, StrictRefusesWhatIsWorthAWarning) {
    const std::string_view value =
        "<constant name='c' type='float'><input name='value' type='float' value='0.5, 1'/>"
        "</constant>\n<output name='o' type='float' nodename='c'/>\n";
    store("odd.mtlx", value);
    expectSaid("odd.mtlx --strict", 1, "odd.mtlx:2:66: error: odd float value of 'value'");
    EXPECT_EQ(written(), 0u);
    expectSaid("odd.mtlx", 0, "odd.mtlx:2:66: warning: odd float value of 'value'");
    EXPECT_EQ(written(), 3u);
    store("space.mtlx",
          "<constant name='c' type='color3'><input name='value' type='color3' value='1, 1, 1' "
          "colorspace='srbg_texture'/></constant>\n<output name='o' type='color3' nodename='c'/>\n");
    expectSaid("space.mtlx", 0, "warning: ");
    expectSaid("space.mtlx --strict", 1, "[unknown-colorspace]");
    store("right.mtlx", "<constant name='c' type='float'/>\n<output name='o' type='float' nodename='c'/>\n");
    expectSaid("right.mtlx --strict", 0, "");
}

TEST_F(Folders, UnknownNodesMayBeTakenForTheirReadersDefaults) {
    store("vendor.mtlx",
          "<hcatmullrom name='h' type='float'><input name='pos' type='float' value='1'/></hcatmullrom>\n"
          "<add name='a' type='float'><input name='in1' type='float' value='0.5'/>"
          "<input name='in2' type='float' nodename='h'/></add>\n"
          "<output name='o' type='float' nodename='a'/>\n");
    expectSaid("vendor.mtlx", 1, "vendor.mtlx:2:1: error: there is no node <hcatmullrom> [unknown-node]");
    EXPECT_EQ(written(), 0u);
    expectSaid("vendor.mtlx --unknown=default --strict", 1, "error: there is no node <hcatmullrom>");
    expectSaid("vendor.mtlx --unknown=default", 0, "vendor.mtlx:2:1: warning: there is no node <hcatmullrom>");
    EXPECT_NE(fileText(own_.path() / "out/vendor.o.frag").find("0.5"), std::string::npos);
}

TEST_F(Folders, LinksLeadOutOfTheSearchPathOnlyWhereAllowed) {
    store("elsewhere/part.mtlx", "<constant name='c' type='float'/><output name='o' type='float' nodename='c'/>\n");
    store("documents/linked.mtlx", "<xi:include href='part.mtlx'/>\n");
    store("documents/climbs.mtlx", "<xi:include href='../elsewhere/part.mtlx'/>\n");
    fs::create_symlink("../elsewhere/part.mtlx", own_.path() / "documents/part.mtlx");
    expectSaid("documents/linked.mtlx", 1, "linked.mtlx:2:13: error: cannot find the included file 'part.mtlx'");
    expectSaid("documents/linked.mtlx", 1, "--follow-links");
    EXPECT_EQ(written(), 0u);
    expectSaid("documents/linked.mtlx --follow-links", 0, "");
    EXPECT_EQ(written(), 3u);
    expectSaid("documents/linked.mtlx --path elsewhere", 0, "");
    fs::remove(own_.path() / "documents/part.mtlx");
    fs::create_directory_symlink("../elsewhere", own_.path() / "documents/folder");
    store("documents/linked.mtlx", "<xi:include href='folder/part.mtlx'/>\n");
    expectSaid("documents/linked.mtlx", 1, "[missing-include]");
    expectSaid("documents/linked.mtlx --follow-links", 0, "");
    fs::create_directory(own_.path() / "documents/real");
    fs::rename(own_.path() / "elsewhere/part.mtlx", own_.path() / "documents/real/part.mtlx");
    fs::create_symlink("real/part.mtlx", own_.path() / "documents/within.mtlx");
    store("documents/linked.mtlx", "<xi:include href='within.mtlx'/>\n");
    expectSaid("documents/linked.mtlx", 0, "");
}

TEST_F(Folders, LibrariesAreLookedThroughToTheBottom) {
    store("library/deep/down/tint.mtlx",
          "<nodedef name='ND_tint_of_folder' node='tint_of_folder'><output name='out' type='color3'/></nodedef>\n"
          "<nodegraph name='NG_tint_of_folder' nodedef='ND_tint_of_folder'><constant name='c' type='color3'/>"
          "<output name='out' type='color3' nodename='c'/></nodegraph>\n");
    store("uses.mtlx", "<tint_of_folder name='t' type='color3'/><output name='o' type='color3' nodename='t'/>\n");
    fs::create_directories(own_.path() / "nothing/in/here");
    expectSaid("uses.mtlx", 1, "hint: --library adds the definitions of a folder");
    expectSaid("uses.mtlx --library library", 0, "");
    EXPECT_EQ(written(), 3u);
    expectSaid("uses.mtlx --library library --library nothing", 0,
               "nothing: warning: the folder has no .mtlx and no .sl file [empty-library]");
    expectSaid("uses.mtlx --library library --library nothing --strict", 1, "[empty-library]");
    expectSaid("uses.mtlx --library nowhere", 1, "nowhere: error: cannot read this folder [cannot-read]");
}

TEST_F(Folders, NamesThatFitAreWrittenAndLongerOnesToldOf) {
    auto named = [&](std::size_t length) {  // the file of it is called n.xxx….frag
        store("n.mtlx", "<constant name='c' type='float'/><output name='" + std::string(length - 7, 'x') +
                            "' type='float' nodename='c'/>\n");
    };
    for (std::size_t length : {200u, 240u, 253u, 255u}) {
        named(length);
        fs::remove_all(own_.path() / "out");
        const Ran ran = shaderx("generate n.mtlx -o out");
        EXPECT_EQ(ran.exitCode, 0) << length << ran.errors;
        EXPECT_EQ(written(), 3u) << length;
    }
    named(256);
    fs::remove_all(own_.path() / "out");
    const Ran ran = shaderx("generate n.mtlx -o out");
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_NE(ran.errors.find("error: cannot write this file: File name too long [cannot-write]"), std::string::npos);
    EXPECT_EQ(written(), 0u);
}

TEST_F(Folders, OnlyLibrariesNameTheirBuilders) {
    store("b.mtlx",
          "<nodedef name='ND_b' node='b'><output name='out' type='float'/></nodedef>\n"
          "<implementation name='IM_b' nodedef='ND_b' builder='surface'/>\n"
          "<b name='n' type='float'/><output name='o' type='float' nodename='n'/>\n");
    expectSaid("b.mtlx", 1, "b.mtlx:3:44: error: 'builder' is for libraries only [reserved-attribute]");
    EXPECT_EQ(written(), 0u);
}

TEST_F(Folders, MaterialsThatAreNoneAreTold) {
    store("m.mtlx",
          "<standard_surface name='s' type='surfaceshader'/>\n"
          "<surfacematerial name='M' type='material'><input name='surfaceshader' type='surfaceshader' "
          "nodename='s'/></surfacematerial>\n"
          "<surfacematerial name='N' type='materail'><input name='surfaceshader' type='surfaceshader' "
          "nodename='s'/></surfacematerial>\n");
    const Ran ran = shaderx("generate m.mtlx -o out");
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_NE(ran.errors.find("m.mtlx:4:1: warning: 'N': <surfacematerial> has the type 'materail', not 'material' "
                              "[unrendered-material]"),
              std::string::npos)
        << ran.errors;
    EXPECT_EQ(written(), 3u);
}

}  // namespace
}  // namespace shaderx::tests
