// Hostile input that needs the file system: run through the program, with limits of time and memory.
#include <set>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "support.h"

namespace shaderx::tests {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

// Runs the program with at most 1 GB (which the sanitizers' own memory exceeds), 60 s and no core files.
Ran shaderx(const std::string& arguments, const fs::path& folder) {
    std::string limits = kSanitized ? "" : "ulimit -v 1048576; ";
    return runCommand("sh -c \"ulimit -t 60; ulimit -c 0; " + limits + "exec '" SHADERX_PROGRAM "' " + arguments + "\"",
                      folder);
}

std::set<std::string> namesIn(const fs::path& folder) {
    std::set<std::string> names;
    std::error_code none;
    for (const auto& entry : fs::recursive_directory_iterator(folder, none))
        names.insert(fs::relative(entry.path(), folder).string());
    return names;
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

void expectRefused(const Ran& ran, std::string_view part, const std::string& what) {
    EXPECT_EQ(ran.exitCode, 1) << what << "\n" << ran.errors.substr(0, 2000);
    EXPECT_TRUE(contains(ran.errors, "error: ")) << what;
    EXPECT_TRUE(contains(ran.errors, part)) << what << "\n" << ran.errors.substr(0, 2000);
    EXPECT_FALSE(contains(ran.errors, "internal")) << what << "\n" << ran.errors.substr(0, 2000);
}

std::string wrapped(std::string_view inside) {
    return "<materialx version='1.39' xmlns:xi='http://www.w3.org/2001/XInclude'>\n" + std::string(inside) +
           "</materialx>\n";
}

const std::string kGraph =
    "<constant name='c' type='float'><input name='value' type='float' value='0.25'/></constant>"
    "<output name='o' type='float' nodename='c'/>\n";

// A folder `in` for documents and libraries, and one `out`, below one that shows if anything is written beside them.
struct Hostile : testing::Test {
    OwnFolder own;
    fs::path in = own.path() / "in";
    std::set<std::string> before;
    void SetUp() override {
        fs::create_directories(in);
        fs::create_directories(own.path() / "out");
        writeText(own / "secret.mtlx", wrapped("<constant name='secret' type='float'/>"));
    }
    void put(const std::string& name, const std::string& text) { writeText(in / name, text); }
    Ran generate(const std::string& arguments) { return shaderx("generate " + arguments + " -o ../out", in); }
    std::set<std::string> written() { return namesIn(own.path() / "out"); }
};

using Includes = Hostile;

TEST_F(Includes, OfItselfAndInRings) {
    put("a.mtlx", wrapped("<xi:include href='a.mtlx'/>" + kGraph));
    put("b.mtlx", wrapped("<xi:include href='c.mtlx'/>" + kGraph));
    put("c.mtlx", wrapped("<xi:include href='sub/../b.mtlx'/>"));
    fs::create_directories(in / "sub");
    fs::create_symlink("a.mtlx", in / "link.mtlx");
    put("d.mtlx", wrapped("<xi:include href='link.mtlx'/>" + kGraph));
    for (const char* name : {"a.mtlx", "b.mtlx", "d.mtlx"}) expectRefused(generate(name), "include-cycle", name);
    EXPECT_TRUE(written().empty());
}

TEST_F(Includes, OfWhatIsNoFile) {
    fs::create_directories(in / "folder.mtlx");
    ASSERT_EQ(::mkfifo((in / "fifo.mtlx").c_str(), 0600), 0);
    fs::create_symlink("loop.mtlx", in / "loop.mtlx");
    for (std::string href : {".", "..", "folder.mtlx", "fifo.mtlx", "loop.mtlx", "/dev/zero", "/dev/stdin",
                             "/proc/self/mem", "nowhere.mtlx", "", "http://example.com/a.mtlx", "file:///etc/passwd"}) {
        put("a.mtlx", wrapped("<xi:include href='" + href + "'/>" + kGraph));
        expectRefused(generate("a.mtlx"), "missing-include", href);
    }
    for (const char* name : {"folder.mtlx", "fifo.mtlx", "loop.mtlx", "/dev/zero", "nowhere.mtlx"})
        expectRefused(generate(name), "cannot-read", name);
    EXPECT_TRUE(written().empty());
}

TEST_F(Includes, OutsideOfTheFolderAndTheSearchPaths) {
    fs::create_directories(in / "sub/deep");
    writeText(in / "sub/deep/part.mtlx", wrapped("<xi:include href='../beside.mtlx'/>"));
    writeText(in / "sub/beside.mtlx", wrapped("<constant name='beside' type='float'/>"));
    for (const std::string& href :
         {std::string("../secret.mtlx"), own / "secret.mtlx", std::string("sub/../../secret.mtlx"),
          std::string("/etc/passwd"), std::string("..\\secret.mtlx")}) {
        put("a.mtlx", wrapped("<xi:include href='" + href + "'/>" + kGraph));
        expectRefused(generate("a.mtlx"), "missing-include", href);
    }
    EXPECT_TRUE(written().empty());
    // What stands below the document is taken, and what a search path allows.
    put("b.mtlx", wrapped("<xi:include href='sub/deep/part.mtlx'/>" + kGraph));
    EXPECT_EQ(generate("b.mtlx").exitCode, 0);
    put("a.mtlx", wrapped("<xi:include href='../secret.mtlx'/>" + kGraph));
    EXPECT_EQ(generate("a.mtlx --path ..").exitCode, 0);
    EXPECT_EQ(generate("'" + in.string() + "/a.mtlx' --path '" + own.path().string() + "'").exitCode, 0);
}

using Output = Hostile;

TEST_F(Output, StaysInTheFolder) {
    std::string elements;
    for (std::string name : {"../../x", "/tmp/x", "..", ".", "a/b", "con", "a&#10;b", "-o", "x.frag", "é", "&#0009;"})
        elements += "<output name='" + name + "' type='float' nodename='c'/>";
    elements += "<output name='" + std::string(5000, 'n') + "' type='float' nodename='c'/>";
    put("odd.mtlx", wrapped("<constant name='c' type='float'/>" + elements));
    std::set<std::string> beside = namesIn(own.path());
    Ran ran = generate("odd.mtlx");
    EXPECT_LE(ran.exitCode, 1) << ran.errors;
    EXPECT_FALSE(contains(ran.errors, "internal")) << ran.errors;
    std::set<std::string> outside = namesIn(own.path());
    for (const std::string& name : written()) {
        EXPECT_TRUE(name.starts_with("odd.")) << name;
        outside.erase("out/" + name);
    }
    EXPECT_EQ(outside, beside);
    EXPECT_FALSE(written().empty());
}

// Tests may run as root, for whom modes are no obstacle: only what is one for everybody.
TEST_F(Output, ThatCannotBeWritten) {
    put("a.mtlx", wrapped(kGraph));
    writeText(own / "file", "kept");
    for (std::string to : {"../file", "../file/below", "/proc/none", "/dev/null", "/dev/null/x"}) {
        expectRefused(shaderx("generate a.mtlx -o " + to, in), "cannot-write", to);
    }
    EXPECT_EQ(fileText(own / "file"), "kept");
    if (fs::exists("/dev/full")) expectRefused(shaderx("generate a.mtlx -o - > /dev/full", in), "cannot-write", "full");
    // A folder where a file should be: no part is left.
    for (const char* end : {"vert", "frag", "json"}) {
        fs::path folder = own.path() / end;
        fs::create_directories(folder / (std::string("a.o.") + end));
        expectRefused(shaderx("generate a.mtlx -o ../" + std::string(end), in), "cannot-write", end);
        EXPECT_EQ(namesIn(folder), (std::set<std::string>{std::string("a.o.") + end}));
    }
    // No room: files may hold 100 bytes.
    Ran full = runCommand(
        "sh -c \"trap '' XFSZ; ulimit -f 0; exec '" SHADERX_PROGRAM "' generate a.mtlx -o ../out 2>&1\"", in);
    EXPECT_EQ(full.exitCode, 1) << full.output;
    EXPECT_TRUE(written().empty());
    // A folder that is not there is made; one without permission is an error but for root.
    EXPECT_EQ(shaderx("generate a.mtlx -o ../new/er", in).exitCode, 0);
    fs::create_directories(own / "shut");
    fs::permissions(own / "shut", fs::perms::owner_read | fs::perms::owner_exec);
    if (::geteuid() != 0) expectRefused(shaderx("generate a.mtlx -o ../shut", in), "cannot-write", "a shut folder");
    fs::permissions(own / "shut", fs::perms::owner_all);
}

TEST_F(Output, FailedElementsLeaveNoFile) {
    put("a.mtlx", wrapped(kGraph + "<nothing name='n' type='float'/><output name='p' type='float' nodename='n'/>"));
    Ran ran = generate("a.mtlx");
    expectRefused(ran, "unknown-node", "a bad element");
    EXPECT_EQ(written(), (std::set<std::string>{"a.o.frag", "a.o.json", "a.o.vert"}));
}

using Limits = Hostile;

TEST_F(Limits, AreOptions) {
    put("a.mtlx", wrapped(kGraph));
    for (const char* limit : {"elements=2", "nesting=1", "attributes=1", "attribute-bytes=2", "file-bytes=20"})
        expectRefused(generate(std::string("a.mtlx --limit ") + limit), "[limit]", limit);
    put("b.mtlx", wrapped("<xi:include href='a.mtlx'/>"));
    expectRefused(generate("b.mtlx --limit include-depth=0"), "[limit]", "include-depth");
    EXPECT_EQ(generate("b.mtlx --limit include-depth=2 --limit elements=100").exitCode, 0);
    put("c.mtlx", wrapped("<standard_surface name='s' type='surfaceshader'/><surfacematerial name='m' type='material'>"
                          "<input name='surfaceshader' type='surfaceshader' nodename='s'/></surfacematerial>"));
    expectRefused(generate("c.mtlx --limit depth=1"), "[limit]", "depth");
    // Each graph uses the one below twice, with other values: two to the tenth of the lowest.
    std::string graphs;
    for (int i = 0; i <= 10; i++) {
        const std::string n = std::to_string(i), below = i ? "g" + std::to_string(i - 1) : "sin";
        const std::string input = i ? "a" : "in";
        graphs += "<nodedef name='ND_g" + n + "' node='g" + n + "'><input name='a' type='float' value='0.5'/>" +
                  "<output name='out' type='float'/></nodedef><nodegraph name='NG_g" + n + "' nodedef='ND_g" + n + "'>";
        for (const char* side : {"x", "y"})
            graphs += std::string("<multiply name='m") + side + "' type='float'><input name='in1' type='float' " +
                      "interfacename='a'/><input name='in2' type='float' value='0." + (side[0] == 'x' ? "3" : "7") +
                      "'/></multiply>" + "<" + below + " name='" + side + "' type='float'><input name='" + input +
                      "' type='float' nodename='m" + side + "'/></" + below + ">";
        graphs +=
            "<add name='s' type='float'><input name='in1' type='float' nodename='x'/>"
            "<input name='in2' type='float' nodename='y'/></add><output name='out' type='float' nodename='s'/>"
            "</nodegraph>";
    }
    put("d.mtlx", wrapped(graphs + "<texcoord name='t' type='vector2'/><extract name='e' type='float'>"
                                   "<input name='in' type='vector2' nodename='t'/></extract>"
                                   "<g10 name='g' type='float'><input name='a' type='float' nodename='e'/></g10>"
                                   "<output name='o' type='float' nodename='g'/>"));
    expectRefused(generate("d.mtlx --limit expressions=1"), "[limit]", "expressions");
    EXPECT_EQ(generate("c.mtlx --limit depth=60 --limit expressions=100000").exitCode, 0);
    for (const char* wrong : {"", "elements", "elements=", "elements=x", "elements=-1", "nothing=1", "elements=1e9",
                              "elements=99999999999", "elements=99999999999999999999"})
        EXPECT_EQ(generate("a.mtlx --limit '" + std::string(wrong) + "'").exitCode, 2) << wrong;
}

TEST_F(Limits, EndlessInput) {
    // Standard input that never ends is cut at the limit.
    Ran ran = shaderx("validate - --limit file-bytes=1000000 < /dev/zero", in);
    expectRefused(ran, "[limit]", "zeros for ever");
}

using Libraries = Hostile;

// A library with one .sl file and a node for its function `f`.
struct Sl : Hostile {
    Ran with(const std::string& code) {
        fs::create_directories(in / "lib");
        put("lib/n.sl", code);
        put("lib/n.mtlx",
            wrapped(
                "<nodedef name='ND_n' node='user_node'><input name='a' type='float' value='0.5'/><output name='out' "
                "type='float'/></nodedef><implementation name='IM_n' nodedef='ND_n' file='n.sl' function='f'/>"));
        put("a.mtlx", wrapped("<texcoord name='t' type='vector2'/><extract name='e' type='float'><input name='in' "
                              "type='vector2' nodename='t'/></extract><user_node name='x' type='float'><input name='a' "
                              "type='float' nodename='e'/></user_node><output name='o' type='float' nodename='x'/>"));
        return generate("a.mtlx --library lib");
    }
};

TEST_F(Sl, Good) { EXPECT_EQ(with("float f(float a) { return a * 2.0; }").exitCode, 0); }

TEST_F(Sl, DeepAndHuge) {
    std::string deep(100000, '('), shut(100000, ')'), minus, braces(100000, '{'), ifs, terms = "a";
    for (int i = 0; i < 100000; i++) minus += "- ";
    for (int i = 0; i < 20000; i++) ifs += "if (a > 0.5) ";
    for (int i = 0; i < 20000; i++) terms += " + a";
    expectRefused(with("float f(float a) { return " + deep + "a" + shut + "; }"), "too-deep", "parentheses");
    expectRefused(with("float f(float a) { return " + minus + "a; }"), "too-deep", "signs");
    expectRefused(with("float f(float a) { " + braces), "too-deep", "braces");
    expectRefused(with("float f(float a) { " + ifs + " return a; return a; }"), "too-deep", "ifs");
    EXPECT_LE(with("float f(float a) { return " + terms + "; }").exitCode, 1);
    expectRefused(with("float f(float a) { return a; }" + std::string(20 << 20, ' ')), "too-large", "20 MB");
    expectRefused(with("float f(float a) { /* " + std::string(1 << 20, '*')), "unterminated-comment", "a comment");
    expectRefused(with(std::string(1 << 20, 'f')), "error", "a name");
    expectRefused(with("float f(float a) { return 1" + std::string(1 << 20, '0') + ".0; }"), "error", "a number");
    expectRefused(with(std::string(5000, '\0')), "error", "zeros");
    expectRefused(with("float f(float \xff) { return 1; }"), "error", "no UTF-8");
    EXPECT_TRUE(written().empty() || written().size() == 3);
}

TEST_F(Sl, Recursion) {
    expectRefused(with("float f(float a) { return f(a); }"), "recursion", "itself");
    expectRefused(with("float g(float a); float f(float a) { return g(a); } float g(float a) { return f(a); }"),
                  "error", "two");
}

TEST_F(Sl, DiamondsAndTowersOfCalls) {
    std::string twice = "float g0(float a) { return sin(a); }\n", once = twice;
    for (int i = 1; i <= 30; i++) {
        std::string n = std::to_string(i), m = std::to_string(i - 1);
        twice += "float g" + n + "(float a) { return g" + m + "(a + 0.1) * g" + m + "(sin(a) * 0.7); }\n";
    }
    for (int i = 1; i <= 5000; i++)
        once += "float g" + std::to_string(i) + "(float a) { return sin(g" + std::to_string(i - 1) + "(a)); }\n";
    Ran diamond = with(twice + "float f(float a) { return g30(a); }");
    EXPECT_LE(diamond.exitCode, 1) << diamond.errors;
    EXPECT_TRUE(diamond.exitCode == 0 || contains(diamond.errors, "[limit]")) << diamond.errors;
    Ran tower = with(once + "float f(float a) { return g5000(a); }");
    EXPECT_LE(tower.exitCode, 1) << tower.errors;
    EXPECT_TRUE(tower.exitCode == 0 || contains(tower.errors, "[limit]")) << tower.errors;
    // Each level with other constants: as many clones as there are ways.
    std::string clones = "float g0(float a, float b) { return sin(a * b) + cos(a + b) * sin(b) + a * a * b + 3.0; }\n";
    for (int i = 1; i <= 30; i++) {
        std::string n = std::to_string(i), m = std::to_string(i - 1);
        clones += "float g" + n + "(float a, float b) { return sin(g" + m + "(a, b * 2.0 + 1.0) + cos(g" + m +
                  "(a, b * 3.0 + 2.0)) * sin(a)); }\n";
    }
    Ran many = with(clones + "float f(float a) { return g30(a, 0.1); }");
    EXPECT_LE(many.exitCode, 1) << many.errors;
    EXPECT_TRUE(many.exitCode == 0 || contains(many.errors, "[limit]")) << many.errors;
}

TEST_F(Sl, Loops) {
    EXPECT_LE(
        with("float f(float a) { float s = 0.0; for (int i = 0; i < 2000000000; i++) s += a; return s; }").exitCode, 1);
    EXPECT_LE(with("float f(float a) { float s = 0.0; for (int i = 0; i < 10; i += 0) s += a; return s; }").exitCode,
              1);
    EXPECT_LE(with("float f(float a) { float s = 0.0; while (true) s += a; return s; }").exitCode, 1);
}

TEST_F(Libraries, ThatAreNone) {
    put("a.mtlx", wrapped(kGraph));
    fs::create_directories(in / "lib");
    ASSERT_EQ(::mkfifo((in / "lib/fifo.sl").c_str(), 0600), 0);
    expectRefused(generate("a.mtlx --library lib"), "cannot-read", "a pipe");
    fs::remove(in / "lib/fifo.sl");
    fs::create_directories(in / "lib/folder.mtlx");
    expectRefused(generate("a.mtlx --library lib"), "cannot-read", "a folder");
    fs::remove(in / "lib/folder.mtlx");
    for (std::string name : {"nowhere", "a.mtlx", "/dev/zero"})
        expectRefused(generate("a.mtlx --library " + name), "cannot-read", name);
    // Odd file names are names.
    put("lib/a b<&\".mtlx", wrapped("<nodedef name='ND' node='n'><output name='out' type='float'/></nodedef>"));
    EXPECT_EQ(generate("a.mtlx --library lib").exitCode, 0);
    put("lib/bad.mtlx", "<materialx><xi:include href='../../secret.mtlx'/></materialx>");
    expectRefused(generate("a.mtlx --library lib"), "missing-include", "out of a library");
}

using Pictures = Hostile;

// Damaged pictures are told of; the rest is drawn.
TEST_F(Pictures, Truncated) {
    put("a.mtlx", wrapped("<image name='i' type='color3'><input name='file' type='filename' value='p'/></image><output "
                          "name='o' type='color3' nodename='i'/>"));
    // A whole picture of each kind that the program itself writes, then pieces of it.
    for (const char* kind : {"png", "exr", "pfm"}) {
        Ran made = shaderx("draw a.mtlx --with interpreter --size 16 --samples 1 -o ../whole." + std::string(kind), in);
        if (contains(made.errors, "no-module")) GTEST_SKIP() << "there is nothing to draw with";
        std::string whole = fileText(own / ("whole." + std::string(kind)));
        ASSERT_GT(whole.size(), 100u) << made.errors;
        for (std::size_t length :
             {std::size_t{0}, std::size_t{1}, std::size_t{9}, whole.size() / 3, whole.size() / 2}) {
            writeText(in / "p", whole.substr(0, length));
            Ran ran = shaderx("draw a.mtlx --with interpreter --size 8 --samples 1 -o ../out/p.pfm", in);
            EXPECT_LE(ran.exitCode, 1) << kind << " " << length << ran.errors;
            EXPECT_FALSE(contains(ran.errors, "internal")) << ran.errors;
            EXPECT_TRUE(contains(ran.errors, "[")) << kind << " " << length;
        }
    }
    const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999 +X 99999999\n";
    const std::string jpeg("\xFF\xD8\xFF\xE0\0\x10JFIF\0\1\1\0\0\1\0\1\0\0\xFF\xC0\0\x11\x08\xFF\xFF\xFF\xFF\3", 31);
    const std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x08\2\0\0\0\0\0\0\0", 33);
    for (const std::string& text : {hdr, jpeg, png, std::string("P"), std::string("PF\n9999999 9999999\n-1\n")}) {
        writeText(in / "p", text);
        Ran ran = shaderx("draw a.mtlx --with interpreter --size 8 --samples 1 -o ../out/p.pfm", in);
        EXPECT_LE(ran.exitCode, 1) << ran.errors;
        EXPECT_FALSE(contains(ran.errors, "internal")) << ran.errors;
        EXPECT_TRUE(contains(ran.errors, "[")) << text.substr(0, 8);
    }
}

// Numbers of turns come from the document: what it draws ends all the same.
TEST_F(Pictures, OfMoreOctavesThanAnyoneHasTimeFor) {
    for (const char* node : {"fractal2d", "fractal3d"}) {
        put("a.mtlx", wrapped("<" + std::string(node) +
                              " name='f' type='color3'><input name='octaves' type='integer' "
                              "value='2147483647'/></" +
                              node + "><output name='o' type='color3' nodename='f'/>"));
        for (const char* how :
             {"gl --interface live", "interpreter --interface live", "interpreter --interface baked"}) {
            Ran ran = shaderx("draw a.mtlx --size 8 --samples 1 -o ../out/p.pfm --with " + std::string(how), in);
            if (contains(ran.errors, "no-module") || contains(ran.errors, "no-driver")) continue;
            EXPECT_EQ(ran.exitCode, 0) << node << " " << how << "\n" << ran.errors;
        }
    }
}

}  // namespace
}  // namespace shaderx::tests
