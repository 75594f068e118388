// The program as its users meet it: arguments, exit codes, messages and files. Each tests/errors/cli/NAME.mtlx has in
// NAME.expected what `validate` and `generate` say about it; SHADERX_BLESS=1 rewrites that.
#include <set>

#include "support.h"

namespace shaderx::tests {
namespace {

const std::string kProgram = std::string("'") + SHADERX_PROGRAM + "'";

Ran shaderx(const std::string& arguments, const fs::path& folder = {}) {
    return runCommand(kProgram + " " + arguments, folder);
}

fs::path golden(const std::string& name) { return testFolder("golden") / name; }

std::set<std::string> namesIn(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

// Whatever the input: an orderly end, nothing of ours broken, and a message if it failed.
void expectOrderly(const Ran& ran, const std::string& what) {
    EXPECT_TRUE(ran.exitCode == 0 || ran.exitCode == 1) << what << ": exit code " << ran.exitCode << "\n" << ran.errors;
    EXPECT_FALSE(contains(ran.errors, "internal")) << what << "\n" << ran.errors;
    if (ran.exitCode == 1) {
        EXPECT_TRUE(contains(ran.errors, "error: ")) << what << "\n" << ran.errors;
    }
}

class Messages : public testing::TestWithParam<fs::path> {};

TEST_P(Messages, AreAsExpected) {
    OwnFolder own;
    std::string said;
    for (std::string command : {std::string("validate "), "generate --out '" + own / "out" + "' "}) {
        Ran ran = shaderx(command + GetParam().filename().string(), GetParam().parent_path());
        said += command.substr(0, command.find(' ')) + ": exit code " + std::to_string(ran.exitCode) + "\n" +
                ran.output + ran.errors;
        said += "\n";
    }
    said += "written:";
    if (fs::exists(own / "out"))
        for (const std::string& name : namesIn(own / "out")) said += " " + name;
    fs::path expected = GetParam();
    expectFile(expected.replace_extension(".expected"), said + "\n");
}

INSTANTIATE_TEST_SUITE_P(All, Messages, testing::ValuesIn(filesOf(testFolder("errors/cli"), ".mtlx")), testName);

TEST(Arguments, HelpAndVersion) {
    Ran help = shaderx("--help"), version = shaderx("--version"), generate = shaderx("generate --help");
    EXPECT_EQ(help.exitCode, 0);
    for (const char* word : {"generate", "validate", "draw"}) EXPECT_TRUE(contains(help.output, word)) << help.output;
    EXPECT_EQ(help.errors, "");
    EXPECT_EQ(version.exitCode, 0);
    EXPECT_EQ(version.output.rfind("shaderx ", 0), 0u) << version.output;
    EXPECT_EQ(generate.exitCode, 0);
    for (const char* word : {"--out", "--element", "--interface", "--dump", "--path", "--library", "--target"})
        EXPECT_TRUE(contains(generate.output, word)) << generate.output;
}

TEST(Arguments, WrongUsageHasExitCode2AndSaysWhy) {
    std::string gold = "'" + golden("gold.mtlx").string() + "'";
    for (const std::string& arguments :
         {std::string(), std::string("paint"), std::string("generate"), "generate --colour " + gold,
          "generate --target cobol " + gold, "generate --interface dead " + gold, "generate --dump nothing " + gold,
          "draw " + gold, std::string("validate"), "draw --size 0 -o x.png " + gold,
          "draw --size many -o x.png " + gold}) {
        OwnFolder own;
        Ran ran = shaderx(arguments, own.path());
        EXPECT_EQ(ran.exitCode, 2) << arguments;
        EXPECT_NE(ran.errors, "") << arguments;
        EXPECT_EQ(namesIn(own.path()), (std::set<std::string>{})) << arguments;
    }
}

TEST(Arguments, UnknownOptionsAreNamed) {
    const std::string gold = "'" + golden("gold.mtlx").string() + "'";
    Ran ran = shaderx("draw " + gold + " -o x.png --mesh plane");
    EXPECT_EQ(ran.exitCode, 2);
    EXPECT_EQ(ran.errors, "shaderx: draw has no option '--mesh'\nRun with --help for more information.\n");
    ran = shaderx("generate --elemnt=gold " + gold);
    EXPECT_EQ(ran.exitCode, 2);
    EXPECT_TRUE(contains(ran.errors, "no option '--elemnt'\n  hint: did you mean '--element'?\n")) << ran.errors;
}

TEST(Arguments, UnknownElementsComeWithWhatThereIs) {
    const std::string two = "'" + golden("two_materials.mtlx").string() + "'";
    Ran ran = shaderx("generate --element shinny " + two + " -o -");
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "there is no element 'shinny' [unknown-element]\n  hint: did you mean 'shiny'?\n"))
        << ran.errors;
    EXPECT_TRUE(contains(shaderx("generate --element matt " + two + " -o -").errors, "hint: what it renders: "));
}

TEST(Validate, StrictRefusesWarningsButNotNotes) {
    const std::string folder = testFolder("errors/cli").string();
    const std::string warned = "'" + folder + "/ignored_volume.mtlx'", noted = "'" + folder + "/idle_value.mtlx'";
    EXPECT_EQ(shaderx("validate " + warned).exitCode, 0);
    Ran ran = shaderx("validate --strict " + warned);
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "error: a volume below a surface is not drawn on rasters")) << ran.errors;
    ran = shaderx("validate --strict " + noted);
    EXPECT_EQ(ran.exitCode, 0);
    EXPECT_TRUE(contains(ran.errors, "note: the values of ")) << ran.errors;
    // Warnings of reading refuse too, and nothing is written.
    OwnFolder own;
    writeText(own / "old.mtlx",
              "<materialx><constant name=\"c\" type=\"float\"/>"
              "<output name=\"o\" type=\"float\" nodename=\"c\"/></materialx>");
    EXPECT_EQ(shaderx("generate old.mtlx -o out", own.path()).exitCode, 0);
    EXPECT_EQ(shaderx("generate --strict old.mtlx -o strict", own.path()).exitCode, 1);
    EXPECT_FALSE(fs::exists(own.path() / "strict/old.o.frag"));
}

TEST(Inspect, SaysWhatHasNoEffect) {
    OwnFolder own;
    writeText(
        own / "d.mtlx",
        "<materialx version=\"1.39\"><constant name=\"lost\" type=\"float\"/><standard_surface name=\"s\" "
        "type=\"surfaceshader\"><input name=\"coat_color\" type=\"color3\" value=\"1, 0.5, 0\"/></standard_surface>"
        "<surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" "
        "nodename=\"s\"/></surfacematerial></materialx>");
    for (const char* options : {"", "--idle ", "--idle --interface baked "}) {
        Ran ran = shaderx(std::string("inspect ") + options + "d.mtlx", own.path());
        EXPECT_EQ(ran.exitCode, 0) << ran.errors;
        EXPECT_TRUE(contains(ran.errors, "nothing reads the node 'lost' [unused-node]")) << ran.errors;
        EXPECT_TRUE(contains(ran.output, "  values without effect\n    s/coat_color\n")) << ran.output;
    }
    EXPECT_EQ(shaderx("inspect --lobes d.mtlx", own.path()).errors, "");
}

TEST(Library, AFileOfFunctionsThatIsNamedHasToBeThere) {
    OwnFolder own;
    fs::create_directories(own.path() / "nodes");
    writeText(own / "nodes/split.sl", "float twice(float x) { return 2 * x; }\n");
    const std::string nodedef =
        "<nodedef name=\"ND_twice\" node=\"twice\"><input name=\"in\" type=\"float\" "
        "value=\"1\"/><output name=\"out\" type=\"float\"/></nodedef>";
    writeText(own / "nodes/n.mtlx", "<materialx version=\"1.39\">" + nodedef +
                                        "<implementation name=\"IM_twice\" nodedef=\"ND_twice\" file=\"spilt.sl\" "
                                        "function=\"twice\"/></materialx>");
    const std::string document =
        "<materialx version=\"1.39\"><twice name=\"t\" type=\"float\"/>"
        "<output name=\"o\" type=\"float\" nodename=\"t\"/></materialx>";
    writeText(own / "d.mtlx", document);
    Ran ran = shaderx("generate d.mtlx --library nodes -o -", own.path());
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "the library has no file 'spilt.sl' of functions [missing-source]")) << ran.errors;
    EXPECT_TRUE(contains(ran.errors, "did you mean 'split.sl'?")) << ran.errors;
    fs::rename(own.path() / "nodes/split.sl", own.path() / "nodes/spilt.sl");
    EXPECT_EQ(shaderx("generate d.mtlx --library nodes -o -", own.path()).exitCode, 0);
}

TEST(Unknown, NodesWithinDefinitionsMayTakeTheirDefaultsToo) {
    OwnFolder own;
    writeText(
        own / "d.mtlx",
        "<materialx version=\"1.39\"><nodedef name=\"ND_mine\" node=\"mine\"><output name=\"out\" type=\"float\"/>"
        "</nodedef><nodegraph name=\"NG_mine\" nodedef=\"ND_mine\"><vendors name=\"v\" type=\"float\"/>"
        "<add name=\"a\" type=\"float\"><input name=\"in1\" type=\"float\" nodename=\"v\"/>"
        "<input name=\"in2\" type=\"float\" value=\"0.5\"/></add>"
        "<output name=\"out\" type=\"float\" nodename=\"a\"/></nodegraph><mine name=\"m\" type=\"float\"/>"
        "<output name=\"o\" type=\"float\" nodename=\"m\"/></materialx>");
    Ran ran = shaderx("generate d.mtlx -o -", own.path());
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "there is no node <vendors>")) << ran.errors;
    ran = shaderx("generate d.mtlx --unknown default -o -", own.path());
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_TRUE(contains(ran.errors, "warning: there is no node <vendors>")) << ran.errors;
}

TEST(Generate, WritesThreeFilesForEachElement) {
    OwnFolder own;
    Ran ran = shaderx("generate '" + golden("two_materials.mtlx").string() + "' -o deep/er", own.path());
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_EQ(ran.output + ran.errors, "");
    EXPECT_EQ(
        namesIn(own.path() / "deep/er"),
        (std::set<std::string>{"two_materials.dull.frag", "two_materials.dull.json", "two_materials.dull.vert",
                               "two_materials.shiny.frag", "two_materials.shiny.json", "two_materials.shiny.vert"}));
    ran = shaderx("generate --element shiny '" + golden("two_materials.mtlx").string() + "' -o one", own.path());
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_EQ(namesIn(own.path() / "one").size(), 3u);
    ran = shaderx("generate --element matt '" + golden("two_materials.mtlx").string() + "' -o none", own.path());
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "there is no element 'matt'")) << ran.errors;
}

TEST(Generate, InterfacesDiffer) {
    OwnFolder own;
    for (const char* interface : {"complete", "live", "baked", "reduced"}) {
        Ran ran =
            shaderx("generate '" + golden("gold.mtlx").string() + "' --interface " + interface + " -o " + interface,
                    own.path());
        EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    }
    std::string live = fileText(own.path() / "live/gold.gold.frag"),
                baked = fileText(own.path() / "baked/gold.gold.frag");
    EXPECT_TRUE(contains(fileText(own.path() / "complete/gold.gold.frag"), "uniform float gold_shader_coat = 0.0;"));
    EXPECT_FALSE(contains(live, "gold_shader_coat"));
    EXPECT_TRUE(contains(live, "gold_shader_specular_roughness"));
    EXPECT_FALSE(contains(baked, "uniform vec3 gold_shader")) << baked;
    EXPECT_EQ(fileText(own.path() / "reduced/gold.gold.frag"), baked);
}

TEST(Generate, StandardInputAndOutput) {
    OwnFolder own;
    std::string gold = "'" + golden("gold.mtlx").string() + "'";
    Ran ran = shaderx("generate - -o - < " + gold, own.path());
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_EQ(namesIn(own.path()), (std::set<std::string>{}));
    Ran named = shaderx("generate " + gold + " -o -");
    EXPECT_EQ(ran.output, named.output);
    EXPECT_TRUE(contains(ran.output, "gl_Position") && contains(ran.output, "out1 = "));
    EXPECT_EQ(shaderx("generate - < " + gold, own.path()).exitCode, 0);
    EXPECT_TRUE(namesIn(own.path()).count("stdin.gold.frag"));
    EXPECT_EQ(shaderx("validate - < " + gold).exitCode, 0);
    EXPECT_EQ(shaderx("validate - < /dev/null").exitCode, 1);
}

TEST(Generate, GoodFilesAreWrittenBesideBrokenOnes) {
    OwnFolder own;
    std::string files;
    for (const fs::path& f : {golden("gold.mtlx"), testFolder("errors/cli") / "malformed.mtlx",
                              fs::path("nowhere.mtlx"), golden("plastic.mtlx")})
        files += " '" + f.string() + "'";
    Ran ran = shaderx("generate -o out" + files, own.path());
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_EQ(namesIn(own.path() / "out"),
              (std::set<std::string>{"gold.gold.frag", "gold.gold.json", "gold.gold.vert", "plastic.plastic.frag",
                                     "plastic.plastic.json", "plastic.plastic.vert"}));
    EXPECT_TRUE(contains(ran.errors, "malformed.mtlx:")) << ran.errors;
    EXPECT_TRUE(contains(ran.errors, "nowhere.mtlx: error: ")) << ran.errors;
}

TEST(Generate, EveryStageCanBeDumped) {
    OwnFolder own;
    for (const char* stage :
         {"read", "check", "graph", "lower", "specialise", "shade", "interface", "place", "legalise", "print"}) {
        Ran ran = shaderx("generate '" + golden("textured.mtlx").string() + "' --dump " + stage, own.path());
        EXPECT_EQ(ran.exitCode, 0) << stage << ran.errors;
        EXPECT_NE(ran.output, "") << stage;
        EXPECT_EQ(ran.errors, "") << stage;
    }
    EXPECT_EQ(namesIn(own.path()), (std::set<std::string>{}));
}

TEST(Generate, FoldersThatCannotBeWrittenLeaveNoHalfFiles) {
    OwnFolder own;
    std::string gold = "'" + golden("gold.mtlx").string() + "'";
    // A file stands where the folder should be.
    writeText(own / "file", "kept");
    Ran ran = shaderx("generate " + gold + " -o file", own.path());
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "file: error: ")) << ran.errors;
    EXPECT_EQ(fileText(own / "file"), "kept");
    EXPECT_EQ(shaderx("generate " + gold + " -o file/below", own.path()).exitCode, 1);
    EXPECT_EQ(shaderx("generate " + gold + " -o /proc/nothing", own.path()).exitCode, 1);
    // A folder stands where the last file should be.
    fs::create_directories(own / "out/gold.gold.json");
    ran = shaderx("generate " + gold + " -o out", own.path());
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "gold.gold.json: error: ")) << ran.errors;
    std::set<std::string> left = namesIn(own / "out");
    left.erase("gold.gold.json");
    EXPECT_EQ(left, (std::set<std::string>{}));
    // No space is left, on standard output.
    if (!fs::exists("/dev/full")) return;
    EXPECT_EQ(shaderx("generate " + gold + " -o - > /dev/full").exitCode, 1);
}

TEST(Generate, OptionsOfEngines) {
    std::string gold = golden("gold.mtlx").string(), textured = golden("textured.mtlx").string(),
                ghost = golden("ghost.mtlx").string();
    auto text = [&](const std::string& arguments) { return shaderx("generate -o - " + arguments).output; };
    EXPECT_TRUE(contains(text(gold), "u_envRadianceSamples"));
    EXPECT_FALSE(contains(text(gold + " --env prefilter"), "u_envRadianceSamples"));
    EXPECT_FALSE(contains(text(gold + " --env none"), "u_envRadiance"));
    EXPECT_TRUE(contains(text(textured + " --flip-v"), "1.0 - "));
    EXPECT_NE(text(textured + " --flip-v"), text(textured));
    EXPECT_TRUE(contains(text(ghost + " --transparency"), "discard;"));
    EXPECT_TRUE(contains(text(gold + " --blocks"), "layout(std140) uniform PublicUniforms"));
    EXPECT_TRUE(
        contains(text(gold + " --blocks --binding-base 4"), "layout(std140, binding = 4) uniform PrivateUniforms"));
    OwnFolder own;
    writeText(own / "long.mtlx",
              "<materialx version='1.39'><constant name='c' type='float'><input name='value' type='float' "
              "value='2' unittype='distance' unit='yard'/></constant>"
              "<output name='out' type='float' nodename='c'/></materialx>");
    EXPECT_TRUE(contains(text(own / "long.mtlx" + " --interface baked"), "1.8288"));
    EXPECT_TRUE(contains(text(own / "long.mtlx" + " --interface baked --unit inch"), "72"));
    Ran ran = shaderx("generate -o - --unit league " + gold);
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "[unknown-scene-unit]")) << ran.errors;
    for (const char* wrong : {"--env fog", "--binding-base -1", "--binding-base x"})
        EXPECT_EQ(shaderx("generate -o - " + std::string(wrong) + " " + gold).exitCode, 2) << wrong;
}

TEST(Inspect, TextOrJson) {
    std::string gold = golden("gold.mtlx").string(), glass = golden("glass.mtlx").string();
    Ran ran = shaderx("inspect --lobes " + gold);
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_TRUE(contains(ran.output, "  lobes that were removed\n")) << ran.output;
    EXPECT_FALSE(contains(ran.output, "cost of a pixel"));
    ran = shaderx("inspect --cost " + gold);
    EXPECT_TRUE(contains(ran.output, "cost of a pixel") && !contains(ran.output, "lobes that")) << ran.output;
    ran = shaderx("inspect --json " + gold + " " + glass);
    EXPECT_TRUE(ran.output.starts_with("[\n  {") && contains(ran.output, "\"cost\"")) << ran.output;
    EXPECT_EQ(shaderx("inspect nowhere.mtlx").exitCode, 1);
    EXPECT_EQ(shaderx("inspect --lobes").exitCode, 2);
}

TEST(Generate, LibrariesAndSearchPaths) {
    OwnFolder own;
    fs::create_directories(own / "nodes");
    fs::create_directories(own / "shared");
    writeText(
        own / "nodes/twice.mtlx",
        "<materialx version='1.39'><nodedef name='ND_twice' node='twice'><input name='in' type='float' value='0.125'/>"
        "<output name='out' type='float'/></nodedef>"
        "<implementation name='IM_twice' nodedef='ND_twice' file='twice.sl' function='twice'/></materialx>");
    writeText(own / "nodes/twice.sl", "float twice(float x) { return 2.0 * x; }\n");
    writeText(own / "shared/part.mtlx", "<materialx version='1.39'><twice name='t' type='float'/></materialx>");
    writeText(own / "main.mtlx",
              "<materialx version='1.39' xmlns:xi='http://www.w3.org/2001/XInclude'><xi:include href='part.mtlx'/>"
              "<output name='out' type='float' nodename='t'/></materialx>");
    Ran ran = shaderx("generate main.mtlx --library nodes --path shared -o -", own.path());
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_TRUE(contains(ran.output, "0.25")) << ran.output;
    EXPECT_EQ(shaderx("generate main.mtlx --path shared -o -", own.path()).exitCode, 1);
    EXPECT_EQ(shaderx("generate main.mtlx --library nodes -o -", own.path()).exitCode, 1);
    EXPECT_EQ(shaderx("generate main.mtlx --library nowhere --path shared -o -", own.path()).exitCode, 1);
}

TEST(Hostile, FilesThatAreNoDocuments) {
    OwnFolder own;
    std::string garbage;
    for (unsigned i = 0, x = 1; i < 20000; i++, x = x * 1664525u + 1013904223u) garbage += static_cast<char>(x >> 24);
    writeText(own / "empty.mtlx", "");
    writeText(own / "garbage.mtlx", garbage);
    writeText(own / "zeros.mtlx", std::string(5000, '\0'));
    writeText(own / "blank.mtlx", std::string(5000, ' '));
    fs::create_directories(own / "folder.mtlx");
    for (const char* name :
         {"empty.mtlx", "garbage.mtlx", "zeros.mtlx", "blank.mtlx", "folder.mtlx", "nowhere.mtlx", "/dev/zero"})
        for (const char* command : {"validate ", "generate -o out "}) {
            Ran ran = shaderx(std::string(command) + name, own.path());
            EXPECT_EQ(ran.exitCode, 1) << command << name;
            expectOrderly(ran, std::string(command) + name);
        }
    EXPECT_TRUE(!fs::exists(own / "out") || namesIn(own / "out").empty());
}

TEST(Hostile, TruncatedDocuments) {
    OwnFolder own;
    std::string text = fileText(golden("interface.mtlx"));
    ASSERT_GT(text.size(), 1000u);
    for (std::size_t length = 0; length < text.size() - 20; length += 50) {
        writeText(own / "part.mtlx", std::string_view(text).substr(0, length));
        Ran ran = shaderx("generate -o out part.mtlx", own.path());
        EXPECT_EQ(ran.exitCode, 1) << length;
        expectOrderly(ran, "the first " + std::to_string(length) + " bytes");
    }
    EXPECT_TRUE(namesIn(own / "out").empty());
}

TEST(Hostile, DamagedDocuments) {
    OwnFolder own;
    std::string text = fileText(golden("user_graph.mtlx"));
    for (std::size_t at = 0; at < text.size(); at += 101)
        for (char c : {'\0', '<', '"', '\xff'}) {
            std::string damaged = text;
            damaged[at] = c;
            writeText(own / "damaged.mtlx", damaged);
            expectOrderly(shaderx("generate -o out damaged.mtlx", own.path()), "byte " + std::to_string(at));
        }
}

TEST(Hostile, DeepNesting) {
    OwnFolder own;
    for (int depth : {100, 1000, 100000}) {
        std::string open, close, graphs = "<materialx version='1.39'>";
        for (int i = 0; i < depth; i++) open += "<nodegraph name='g'>", close += "</nodegraph>";
        writeText(own / "deep.mtlx", graphs + open + "<output name='o' type='float'/>" + close + "</materialx>");
        writeText(own / "open.mtlx", graphs + open);
        for (const char* command : {"validate deep.mtlx", "generate -o out deep.mtlx", "validate open.mtlx"})
            expectOrderly(shaderx(command, own.path()), command + std::to_string(depth));
    }
}

TEST(Hostile, LongChainsAndManyUsers) {
    OwnFolder own;
    std::string chain = "<materialx version='1.39'>", tree = chain;
    for (int i = 0; i < 5000; i++)
        chain += "<sin name='n" + std::to_string(i) + "' type='float'>" +
                 (i ? "<input name='in' type='float' nodename='n" + std::to_string(i - 1) + "'/>" : std::string()) +
                 "</sin>";
    chain += "<output name='o' type='float' nodename='n4999'/></materialx>";
    // Every node reads the one before it twice: 2⁶⁰ paths.
    for (int i = 0; i < 60; i++) {
        tree += "<multiply name='n" + std::to_string(i) + "' type='vector3'>";
        for (const char* in : {"in1", "in2"})
            tree += std::string("<input name='") + in + "' type='vector3' " +
                    (i ? "nodename='n" + std::to_string(i - 1) + "'/>" : std::string("value='0.5, 0.25, 0.125'/>"));
        tree += "</multiply>";
    }
    tree += "<output name='o' type='vector3' nodename='n59'/></materialx>";
    writeText(own / "chain.mtlx", chain);
    writeText(own / "tree.mtlx", tree);
    for (const char* command : {"validate chain.mtlx", "generate -o out chain.mtlx", "validate tree.mtlx",
                                "generate -o out tree.mtlx", "generate -o out --interface baked tree.mtlx"}) {
        Ran ran = shaderx(command, own.path());
        EXPECT_EQ(ran.exitCode, 0) << command << "\n" << ran.errors;
    }
}

TEST(Hostile, NamesLikeThoseOfBuiltInVariables) {
    OwnFolder own;
    writeText(own / "prefix.mtlx",
              "<materialx version='1.39'><noise2d name='gl_Position' type='float'/>"
              "<sin name='gl_FragCoord' type='float'><input name='in' type='float' nodename='gl_Position'/></sin>"
              "<max name='gl_' type='float'><input name='in1' type='float' nodename='gl_FragCoord'/>"
              "<input name='in2' type='float' nodename='gl_Position'/></max>"
              "<output name='gl_FragColor' type='float' nodename='gl_'/></materialx>");
    Ran ran = shaderx("generate prefix.mtlx -o -", own.path());
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
}

TEST(Hostile, OddNamesOfElementsStayInTheFolder) {
    OwnFolder own;
    writeText(
        own / "odd.mtlx",
        "<materialx version='1.39'><constant name='c' type='float'/><output name='../../up' type='float' nodename='c'/>"
        "<output name='a b;c' type='float' nodename='c'/></materialx>");
    fs::create_directories(own / "a/b/out");
    Ran ran = shaderx("generate ../../odd.mtlx -o out", own.path() / "a/b");
    expectOrderly(ran, "odd names");
    EXPECT_EQ(namesIn(own / "a/b"), (std::set<std::string>{"out"}));
    EXPECT_EQ(namesIn(own / "a"), (std::set<std::string>{"b"}));
}

}  // namespace
}  // namespace shaderx::tests
