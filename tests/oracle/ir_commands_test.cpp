// The commands that read, show and run programs in the text form of the IR.
#include "support.h"

namespace shaderx::tests {
namespace {

Ran shaderx(const std::string& arguments) { return runCommand(std::string("'") + SHADERX_PROGRAM + "' " + arguments); }

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

constexpr std::string_view kProgram = R"(# Schlick's approximation.
function schlick(f0: color3, cosine: float) -> (out: color3, grazing: boolean) {
    %0 = param color3 f0
    %1 = param float cosine
    %2 = constant float 1
    %3 "grazing" = sub float %2, %1
    %4 = constant float 5
    %5 = pow float %3, %4
    %6 = mix color3 %0, %2, %5
    %7 = less boolean %1, %5
    return %6, %7
}

function twice(n: integer) -> (out: integer) {
    %0 = param integer n
    %1 = add integer %0, %0
    return %1
}
)";

struct IrCommands : testing::Test {
    OwnFolder own;
    std::string file = own / "program.ir";
    void SetUp() override { writeText(file, kProgram); }
};

TEST_F(IrCommands, IrPrintsWhatItRead) {
    Ran ran = shaderx("ir '" + file + "'");
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_EQ(ran.output, kProgram);
    Ran again = shaderx("ir - < '" + file + "'");
    EXPECT_EQ(again.output, kProgram);
}

TEST_F(IrCommands, IrTellsWhatIsWrongAndWhere) {
    writeText(file,
              "function f(a: float) -> (r: float) {\n    %0 = param float a\n    %1 = frobnicate float %0\n    return "
              "%1\n}\n");
    Ran ran = shaderx("ir '" + file + "'");
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "program.ir:3:")) << ran.errors;
    writeText(file,
              "function f(a: vector3) -> (r: float) {\n    %0 = param vector3 a\n    %1 = cross float %0, %0\n    "
              "return %1\n}\n");
    ran = shaderx("ir '" + file + "'");
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_TRUE(contains(ran.errors, "program.ir:3:5: error: ")) << ran.errors;
    EXPECT_EQ(shaderx("ir '" + own / "missing.ir" + "'").exitCode, 1);
    EXPECT_EQ(shaderx("ir").exitCode, 2);
}

TEST_F(IrCommands, EvalRunsAFunction) {
    Ran ran = shaderx("eval '" + file + "' --function schlick 0.5,0,0.25 0");
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_EQ(ran.output, "out = 1, 1, 1\ngrazing = true\n");
    ran = shaderx("eval '" + file + "' --function schlick ' 0.5, 0 ,0.25' 1");
    EXPECT_EQ(ran.output, "out = 0.5, 0, 0.25\ngrazing = false\n");
    ran = shaderx("eval - -21 < '" + file + "'");  // the last function
    EXPECT_EQ(ran.output, "out = -42\n") << ran.errors;
}

TEST_F(IrCommands, EvalTellsWhatIsWrong) {
    struct {
        const char *arguments, *code;
    } const cases[] = {{"--function schlik 1,1,1 0", "did you mean 'schlick'?"},
                       {"--function schlick 1,1,1", "argument-count"},
                       {"--function schlick 1,1 0", "bad-argument"},
                       {"--function schlick 1,1,1,1 0", "bad-argument"},
                       {"--function schlick 1,x,1 0", "bad-argument"},
                       {"--function twice 1.5", "bad-argument"}};
    for (const auto& c : cases) {
        Ran ran = shaderx("eval '" + file + "' " + c.arguments);
        EXPECT_EQ(ran.exitCode, 1) << c.arguments;
        EXPECT_TRUE(contains(ran.errors, c.code)) << ran.errors;
        EXPECT_EQ(ran.output, "");
    }
}

TEST_F(IrCommands, DrawKnowsTwoWays) {
    EXPECT_EQ(shaderx("draw x.mtlx -o x.png --with pencil").exitCode, 2);
    std::string material = (fs::path(SHADERX_SOURCE_DIR) / "examples" / "velvet.mtlx").string();
    Ran ran = shaderx("draw '" + material + "' --with interpreter --size 16 --samples 8 -o '" + own / "a.exr" + "'");
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_TRUE(fs::exists(own / "a.exr"));
}

TEST_F(IrCommands, DrawSaysWhichMaterialItTakesAndWhereAMissingTextureIsNamed) {
    writeText(own / "two.mtlx", R"(<materialx version="1.39">
  <image name="i" type="color3"><input name="file" type="filename" value="absent.png" /></image>
  <surface_unlit name="s" type="surfaceshader"><input name="emission_color" type="color3" nodename="i" /></surface_unlit>
  <surfacematerial name="a" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s" /></surfacematerial>
  <surfacematerial name="b" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s" /></surfacematerial>
</materialx>
)");
    const Ran ran = shaderx("draw '" + own / "two.mtlx" + "' --size 4 --with interpreter -o '" + own / "x.pfm" + "'");
    EXPECT_EQ(ran.exitCode, 0) << ran.errors;
    EXPECT_TRUE(contains(ran.errors,
                         "two.mtlx:4:3: note: 'a' is drawn, the first of 2 elements [first-of-several]\n"
                         "  at: a\n  hint: --element draws another: b\n"))
        << ran.errors;
    EXPECT_TRUE(contains(ran.errors, "two.mtlx:2:68: warning: cannot read '")) << ran.errors;
    EXPECT_TRUE(contains(ran.errors, "the node's default colour is drawn [missing-texture]\n  at: i/file\n"))
        << ran.errors;
}

}  // namespace
}  // namespace shaderx::tests
