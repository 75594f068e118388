#include "compile/compile.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "doc/file_resolver.h"

namespace shaderx {
namespace {

namespace fs = std::filesystem;
using doc::ElementId;
using Json = nlohmann::json;

std::string fileText(const fs::path& file) { return doc::readFile(file.string()).value_or(""); }

std::string wrap(const std::string& body) { return "<materialx version=\"1.39\">\n" + body + "\n</materialx>\n"; }

// A compiler with the built-in library, and what a test says to it.
struct Session {
    Compiler compiler{builtinLibrary()};
    Diagnostics diagnostics;
    std::unique_ptr<doc::Document> document;

    explicit Session(const std::string& text = {}) {
        if (!text.empty()) read(text);
    }
    void read(const std::string& text, const std::string& file = "test.mtlx") {
        doc::NoIncludes none;
        document = compiler.read(file, text, none, diagnostics);
        ASSERT_TRUE(document) << diagnostics.text();
    }
    Result<Shader> generate(std::string_view path, Interface interface = Interface::Live) {
        GenerateOptions how;
        how.interface = interface;
        return compiler.generate(*document, document->find(path), how, diagnostics);
    }
    std::string codes() const {
        std::string out;
        for (const Diagnostic& d : diagnostics.all()) out += d.code + " ";
        return out;
    }
};

std::string bytesOf(const Shader& s) { return s.element + "\n" + s.vertex + "\n" + s.pixel + "\n" + s.reflection(); }

// The bytes of all that can be rendered in a document, in the order given by `reversed`.
std::string bytesOf(Compiler& compiler, const doc::Document& document, Interface interface, bool reversed = false) {
    std::vector<ElementId> elements = compiler.renderableElements(document);
    if (reversed) std::reverse(elements.begin(), elements.end());
    std::vector<std::string> all;
    GenerateOptions how;
    how.interface = interface;
    for (ElementId e : elements) {
        Diagnostics diagnostics;
        Result<Shader> shader = compiler.generate(document, e, how, diagnostics);
        EXPECT_TRUE(shader) << diagnostics.text();
        all.push_back(shader ? bytesOf(*shader) : "none");
    }
    if (reversed) std::reverse(all.begin(), all.end());
    std::string out;
    for (const std::string& s : all) out += s;
    return out;
}

// The documents of the golden tests serve as samples here.
std::vector<fs::path> samples() {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(fs::path(SHADERX_SOURCE_DIR) / "tests/golden"))
        if (entry.path().extension() == ".mtlx") all.push_back(entry.path());
    std::sort(all.begin(), all.end());
    return all;
}

std::unique_ptr<doc::Document> readSample(Compiler& compiler, const fs::path& file) {
    doc::FileResolver files;
    Diagnostics diagnostics;
    auto document = compiler.read(file.string(), fileText(file), files, diagnostics);
    EXPECT_TRUE(document) << diagnostics.text();
    return document;
}

TEST(Compile, StagesHaveNames) {
    for (int i = 0; i <= static_cast<int>(StageName::Print); i++) {
        StageName stage = static_cast<StageName>(i), found{};
        EXPECT_TRUE(stageNamed(nameOf(stage), found));
        EXPECT_EQ(found, stage);
    }
    StageName none{};
    EXPECT_FALSE(stageNamed("paint", none));
    EXPECT_FALSE(stageNamed("", none));
}

TEST(Compile, GraphMadeWithoutXmlGivesTheSameBytes) {
    Session fromXml(wrap(R"(
        <nodegraph name="dots"><input name="size" type="float" value="0.25"/>
          <noise2d name="cloud" type="float"><input name="amplitude" type="float" interfacename="size"/></noise2d>
          <output name="out" type="float" nodename="cloud"/></nodegraph>
        <standard_surface name="gold" type="surfaceshader">
          <input name="metalness" type="float" value="0.9"/>
          <input name="specular_roughness" type="float" nodegraph="dots" output="out"/></standard_surface>)"));

    Session made;
    made.document = made.compiler.newDocument();
    doc::Document& d = *made.document;
    auto add = [&](ElementId parent, std::string_view category, std::string_view name, std::string_view type) {
        ElementId e = d.append(parent, category, name);
        if (!type.empty()) d.set(e, "type", type);
        return e;
    };
    ElementId dots = add(d.root(), "nodegraph", "dots", "");
    d.set(add(dots, "input", "size", "float"), "value", "0.25");
    ElementId cloud = add(dots, "noise2d", "cloud", "float");
    d.set(add(cloud, "input", "amplitude", "float"), "interfacename", "size");
    d.set(add(dots, "output", "out", "float"), "nodename", "cloud");
    ElementId gold = add(d.root(), "standard_surface", "gold", "surfaceshader");
    d.set(add(gold, "input", "metalness", "float"), "value", "0.9");
    ElementId roughness = add(gold, "input", "specular_roughness", "float");
    d.set(roughness, "nodegraph", "dots");
    d.set(roughness, "output", "out");

    EXPECT_TRUE(made.compiler.validate(d, made.diagnostics)) << made.diagnostics.text();
    for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete}) {
        Result<Shader> a = fromXml.generate("gold", interface), b = made.generate("gold", interface);
        ASSERT_TRUE(a && b) << fromXml.diagnostics.text() << made.diagnostics.text();
        EXPECT_EQ(bytesOf(*a), bytesOf(*b));
    }
}

TEST(Compile, TheSameBytesEveryTimeInAnyOrderByAnyCompiler) {
    std::vector<fs::path> files = samples();
    ASSERT_GT(files.size(), 10u);
    Compiler one(builtinLibrary()), other(builtinLibrary());
    std::map<fs::path, std::string> first;
    for (const fs::path& file : files)
        if (auto d = readSample(one, file)) {
            first[file] = bytesOf(one, *d, Interface::Live);
            EXPECT_EQ(bytesOf(one, *d, Interface::Live, true), first[file]) << file.filename();
        }
    // The other compiler knows other names and has done other things when it meets a document.
    std::reverse(files.begin(), files.end());
    for (const fs::path& file : files)
        if (auto d = readSample(other, file)) {
            bytesOf(other, *d, Interface::Baked, true);
            EXPECT_EQ(bytesOf(other, *d, Interface::Live), first[file]) << file.filename();
        }
}

// What elements compiled together have in common is made once, and shows nowhere.
TEST(Compile, TogetherElementsAreWhatTheyAreAlone) {
    std::size_t several = 0;
    for (const fs::path& file : samples())
        for (Interface interface : {Interface::Live, Interface::Baked}) {
            Compiler compiler(builtinLibrary());
            auto document = readSample(compiler, file);
            ASSERT_TRUE(document);
            for (bool reversed : {false, true}) {
                std::vector<ElementId> elements = compiler.renderableElements(*document);
                if (reversed) std::reverse(elements.begin(), elements.end());
                several += elements.size() > 1;
                GenerateOptions how;
                how.interface = interface;
                std::vector<std::string> all;
                compiler.generate(*document, elements, how,
                                  [&](ElementId e, Result<Shader> shader, const Diagnostics& diagnostics) {
                                      EXPECT_TRUE(e == elements[all.size()]);
                                      EXPECT_TRUE(shader) << diagnostics.text();
                                      all.push_back(shader ? bytesOf(*shader) : "none");
                                  });
                if (reversed) std::reverse(all.begin(), all.end());
                std::string out;
                for (const std::string& one : all) out += one;
                EXPECT_EQ(out, bytesOf(compiler, *document, interface)) << file;
            }
        }
    EXPECT_GT(several, 0u);
}

TEST(Compile, LibraryFromTextsGivesTheBytesOfTheBuiltInOne) {
    std::vector<LibraryFile> files;
    for (const auto& entry : fs::directory_iterator(fs::path(SHADERX_SOURCE_DIR) / "nodes"))
        if (entry.path().extension() == ".mtlx" || entry.path().extension() == ".sl")
            files.push_back({entry.path().filename().string(), fileText(entry.path())});
    ASSERT_GT(files.size(), 20u);
    Compiler builtin(builtinLibrary()), fromTexts({});
    Diagnostics diagnostics;
    ASSERT_TRUE(fromTexts.addLibrary(files, diagnostics)) << diagnostics.text();
    for (const fs::path& file : samples()) {
        auto a = readSample(builtin, file), b = readSample(fromTexts, file);
        if (!a || !b) continue;
        for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete})
            EXPECT_EQ(bytesOf(builtin, *a, interface), bytesOf(fromTexts, *b, interface)) << file.filename();
    }
}

TEST(Compile, PackedLibraryIsTheSameWhateverTheOrderOfItsFiles) {
    std::vector<LibraryFile> files{
        {"a.mtlx", wrap(R"(<nodedef name="ND_twice" node="twice"><input name="in" type="float" value="1"/>
            <output name="out" type="float"/></nodedef>
            <implementation name="IM_twice" nodedef="ND_twice" file="b.sl" function="twice"/>)")},
        {"b.sl", "float twice(float x) { return 2.0 * x; }\n"},
        {"c.mtlx", wrap(R"(<nodedef name="ND_once" node="once"><input name="in" type="float" value="1"/>
            <output name="out" type="float"/></nodedef>
            <implementation name="IM_once" nodedef="ND_once" sourcecode="{{in}}"/>)")}};
    Diagnostics diagnostics;
    std::vector<std::uint8_t> image = packLibrary(files, diagnostics);
    ASSERT_FALSE(image.empty()) << diagnostics.text();
    std::reverse(files.begin(), files.end());
    EXPECT_EQ(packLibrary(files, diagnostics), image);

    Compiler compiler(image);
    doc::NoIncludes none;
    auto d = compiler.read("test.mtlx",
                           wrap(R"(<twice name="a" type="float"><input name="in" type="float" value="0.25"/></twice>
        <once name="b" type="float"><input name="in" type="float" nodename="a"/></once>)"),
                           none, diagnostics);
    ASSERT_TRUE(d) << diagnostics.text();
    GenerateOptions baked;
    baked.interface = Interface::Baked;
    Result<Shader> shader = compiler.generate(*d, d->find("b"), baked, diagnostics);
    ASSERT_TRUE(shader) << diagnostics.text();
    EXPECT_NE(shader->pixel.find("vec4(0.5, 0.5, 0.5, 1.0)"), std::string::npos) << shader->pixel;
}

TEST(Compile, DamagedImagesAreNoLibraries) {
    std::span<const std::uint8_t> image = builtinLibrary();
    ASSERT_GT(image.size(), 1000u);
    for (std::size_t length : {std::size_t(0), std::size_t(1), std::size_t(16), image.size() / 2, image.size() - 1}) {
        Compiler compiler(image.first(length));
        Diagnostics diagnostics;
        doc::NoIncludes none;
        auto d = compiler.read("test.mtlx", wrap(R"(<texcoord name="uv" type="vector2"/>)"), none, diagnostics);
        ASSERT_TRUE(d);
        EXPECT_FALSE(compiler.generate(*d, d->find("uv"), {}, diagnostics)) << length;
        EXPECT_FALSE(diagnostics.hasInternal()) << diagnostics.text();
    }
}

// The uniforms that a text declares, with their types; samplers too.
std::map<std::string, std::string> declaredUniforms(const std::string& text) {
    std::map<std::string, std::string> all;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string uniform, type, name;
        words >> uniform >> type >> name;
        if (uniform != "uniform") continue;
        while (!name.empty() && (name.back() == ';' || name.back() == ']')) name.pop_back();
        all[name.substr(0, name.find('['))] = type;
    }
    return all;
}

std::set<std::string> reflectedUniforms(const std::string& reflection, const std::string& stage) {
    std::set<std::string> all;
    Json json = Json::parse(reflection);
    for (const Json& u : json["uniforms"])
        if (std::count(u["stages"].begin(), u["stages"].end(), stage)) all.insert(u["name"].get<std::string>());
    if (stage == "pixel")
        for (const Json& s : json["samplers"]) all.insert(s["name"].get<std::string>());
    return all;
}

TEST(Compile, ReflectionListsTheUniformsThatTheTextsDeclare) {
    Compiler compiler(builtinLibrary());
    for (const fs::path& file : samples()) {
        auto d = readSample(compiler, file);
        if (!d) continue;
        for (ElementId e : compiler.renderableElements(*d))
            for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete}) {
                GenerateOptions how;
                how.interface = interface;
                Diagnostics diagnostics;
                Result<Shader> shader = compiler.generate(*d, e, how, diagnostics);
                ASSERT_TRUE(shader) << diagnostics.text();
                for (auto [text, stage] : {std::pair(&shader->pixel, "pixel"), std::pair(&shader->vertex, "vertex")}) {
                    std::set<std::string> declared;
                    for (const auto& [name, type] : declaredUniforms(*text)) declared.insert(name);
                    EXPECT_EQ(reflectedUniforms(shader->reflection(), stage), declared)
                        << file.filename() << " " << stage;
                }
                for (const TextureBinding& t : shader->textures)
                    EXPECT_EQ(declaredUniforms(shader->pixel)[t.uniform], "sampler2D") << file.filename() << t.uniform;
            }
    }
}

TEST(Compile, BakedShadersHaveNoValueUniforms) {
    Compiler compiler(builtinLibrary());
    std::size_t live = 0;
    for (const fs::path& file : samples()) {
        auto d = readSample(compiler, file);
        if (!d) continue;
        for (ElementId e : compiler.renderableElements(*d))
            for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete}) {
                GenerateOptions how;
                how.interface = interface;
                Diagnostics diagnostics;
                Result<Shader> shader = compiler.generate(*d, e, how, diagnostics);
                ASSERT_TRUE(shader) << diagnostics.text();
                Json reflection = Json::parse(shader->reflection());
                for (const Json& u : reflection["uniforms"]) {
                    bool isLive = u["kind"] == "live";
                    live += isLive;
                    EXPECT_TRUE(interface != Interface::Baked || !isLive) << file.filename() << " " << u;
                    // A live uniform says where it comes from, or would if the document said so.
                    std::string path = isLive ? u["path"].get<std::string>() : "";
                    if (interface == Interface::Complete) path = path.substr(0, path.rfind('/'));
                    EXPECT_TRUE(!isLive || d->find(path)) << file.filename() << " " << u;
                }
            }
    }
    EXPECT_GT(live, 50u);
}

// The text of a shader without the defaults of its uniforms.
std::string withoutDefaults(const std::string& text) {
    std::istringstream lines(text);
    std::string line, out;
    while (std::getline(lines, line)) {
        if (line.rfind("uniform ", 0) == 0) line = line.substr(0, line.find(" = "));
        out += line + "\n";
    }
    return out;
}

TEST(Compile, ALiveShaderFitsAllDocumentsThatDifferInItsValues) {
    auto text = [](int i) {
        auto number = [&](int k) { return std::to_string(0.05 + 0.9 * ((i * 37 + k * 11) % 1000) / 1000.0); };
        return wrap(
            "<standard_surface name=\"s\" type=\"surfaceshader\"><input name=\"base_color\" type=\"color3\" "
            "value=\"" +
            number(0) + ", " + number(1) + ", " + number(2) +
            "\"/><input name=\"specular_roughness\" type=\"float\" value=\"" + number(3) +
            "\"/><input name=\"coat\" type=\"float\" value=\"" + number(4) + "\"/></standard_surface>");
    };
    Session s;
    std::set<std::string> texts, defaults;
    for (int i = 0; i < 1000; i++) {
        s.read(text(i));
        Result<Shader> shader = s.generate("s");
        ASSERT_TRUE(shader) << s.diagnostics.text();
        texts.insert(withoutDefaults(shader->pixel));
        defaults.insert(shader->pixel);
    }
    EXPECT_EQ(texts.size(), 1u);
    EXPECT_EQ(defaults.size(), 1000u);
}

TEST(Compile, ACompleteInterfaceHasAllInputs) {
    Session s(wrap(R"(
        <nodegraph name="g"><input name="much" type="float" value="0.25"/>
          <noise3d name="grain" type="float"><input name="amplitude" type="float" interfacename="much"/></noise3d>
          <image name="photo" type="color3"/>
          <output name="grain_out" type="float" nodename="grain"/><output name="photo_out" type="color3" nodename="photo"/></nodegraph>
        <standard_surface name="s" type="surfaceshader">
          <input name="coat" type="float" nodegraph="g" output="grain_out"/>
          <input name="base_color" type="color3" nodegraph="g" output="photo_out"/>
          <input name="metalness" type="float" value="1"/></standard_surface>)"));
    Result<Shader> complete = s.generate("s", Interface::Complete), live = s.generate("s");
    ASSERT_TRUE(complete && live) << s.diagnostics.text();
    auto uniforms = declaredUniforms(complete->pixel);
    // Authored or not, zero or one, of the shader or of the nodes before it.
    for (const char* name : {"s_metalness", "s_base", "s_specular_IOR", "s_transmission", "s_thin_film_thickness",
                             "s_sheen_color", "g_much", "grain_pivot"})
        EXPECT_TRUE(uniforms.count(name)) << name << "\n" << complete->pixel;
    EXPECT_EQ(uniforms["s_thin_walled"], "bool");
    EXPECT_EQ(uniforms["photo_file"], "sampler2D");
    EXPECT_NE(complete->pixel.find("uniform float s_specular_roughness = 0.2;"), std::string::npos);
    EXPECT_NE(complete->pixel.find("uniform float s_metalness = 1.0;"), std::string::npos);
    // What is connected, what comes from the geometry and texts are none.
    for (const char* name : {"s_coat", "s_base_color", "s_normal", "grain_amplitude", "grain_position",
                             "photo_texcoord", "photo_uaddressmode"})
        EXPECT_FALSE(uniforms.count(name)) << name;
    EXPECT_FALSE(declaredUniforms(live->pixel).count("s_metalness"));
}

TEST(Compile, InterfacesHaveNames) {
    Interface interface = Interface::Live;
    EXPECT_TRUE(interfaceNamed("reduced", interface) && interface == Interface::Baked);
    EXPECT_TRUE(interfaceNamed("complete", interface) && interface == Interface::Complete);
    EXPECT_TRUE(interfaceNamed("live", interface) && interface == Interface::Live);
    EXPECT_FALSE(interfaceNamed("whole", interface));
}

TEST(Compile, AllKindsOfElementsByPath) {
    Session s(wrap(R"(
        <nodegraph name="g"><texcoord name="uv" type="vector2"/>
          <separate2 name="parts" type="multioutput"><input name="in" type="vector2" nodename="uv"/></separate2>
          <output name="x" type="float" nodename="parts" output="outx"/>
          <output name="y" type="float" nodename="parts" output="outy"/></nodegraph>
        <standard_surface name="shader" type="surfaceshader"><input name="base" type="float" nodegraph="g" output="y"/></standard_surface>
        <surfacematerial name="material" type="material"><input name="surfaceshader" type="surfaceshader" nodename="shader"/></surfacematerial>
        <output name="o" type="float" nodegraph="g" output="y"/>)"));
    std::map<std::string, std::string> pixel;
    for (const char* path : {"o", "g/y", "g/x", "g", "g/parts", "g/uv", "shader", "material"}) {
        Result<Shader> shader = s.generate(path);
        ASSERT_TRUE(shader) << path << s.diagnostics.text();
        EXPECT_EQ(shader->element, path);
        pixel[path] = shader->pixel.substr(shader->pixel.find("void main()"));
        EXPECT_NE(shader->vertex.find("gl_Position"), std::string::npos);
    }
    EXPECT_NE(pixel["g/x"].find(".x"), std::string::npos);
    EXPECT_NE(pixel["g/y"].find(".y"), std::string::npos);
    EXPECT_EQ(pixel["shader"], pixel["material"]);
    // Where an element has several outputs, the first is shown.
    EXPECT_NE(pixel["g"].find(".x"), std::string::npos);
    EXPECT_NE(pixel["g/parts"].find(".x"), std::string::npos);
}

struct Wrong {
    const char *name, *body, *element, *codes;
    unsigned line;  // of the first message
};

class WrongDocuments : public testing::TestWithParam<Wrong> {};

TEST_P(WrongDocuments, AreReportedWithTheirPlace) {
    const Wrong& w = GetParam();
    Session s(wrap(w.body));
    EXPECT_NO_THROW({ EXPECT_FALSE(s.generate(w.element)); });
    EXPECT_EQ(s.codes(), w.codes) << s.diagnostics.text();
    for (const Diagnostic& d : s.diagnostics.all()) {
        EXPECT_EQ(d.where.file, "test.mtlx") << format(d);
        EXPECT_GT(d.where.line, 0u) << format(d);
        EXPECT_GT(d.where.column, 0u) << format(d);
        EXPECT_NE(d.path, "") << format(d);
        EXPECT_FALSE(d.message.empty() || d.message.back() == '.' ||
                     std::isupper(static_cast<unsigned char>(d.message[0])));
    }
    ASSERT_FALSE(s.diagnostics.all().empty());
    EXPECT_EQ(s.diagnostics.all()[0].where.line, w.line) << s.diagnostics.text();
}

// The body starts in line 2.
constexpr Wrong kWrong[] = {
    {"MaterialWithoutShader", "<surfacematerial name='m' type='material'/>", "m", "no-shader ", 2},
    {"EmptyNodegraph", "<nodegraph name='g'/>", "g", "no-output ", 2},
    {"UnknownNode", "\n<paint name='p' type='color3'/>", "p", "unknown-node ", 3},
    {"UnknownUpstream",
     "<sin name='a' type='float'>\n<input name='in' type='float' nodename='p'/></sin>\n<paint name='p' type='float'/>",
     "a", "unknown-node ", 4},
    {"Dangling", "<sin name='a' type='float'>\n<input name='in' type='float' nodename='nobody'/></sin>", "a",
     "dangling-nodename ", 3},
    {"DanglingOutput", "<output name='o' type='float' nodename='nobody'/>", "o", "dangling-nodename ", 2},
    {"Cycle",
     "<sin name='a' type='float'><input name='in' type='float' nodename='b'/></sin>\n"
     "<cos name='b' type='float'><input name='in' type='float' nodename='a'/></cos>",
     "a", "cycle ", 2},
    {"SelfCycle", "<sin name='a' type='float'><input name='in' type='float' nodename='a'/></sin>", "a", "cycle ", 2},
    {"OutputsInACircle",
     "<output name='a' type='float' output='b' nodegraph='g'/>\n<nodegraph name='g'><input name='i' type='float' "
     "nodegraph='g'/>"
     "<output name='b' type='float' interfacename='i'/></nodegraph>",
     "a", "cycle ", 3},
    {"NoImplementation",
     "<nodedef name='ND' node='hollow'><input name='in' type='float' value='1'/><output name='out' "
     "type='float'/></nodedef>\n"
     "<hollow name='h' type='float'/>",
     "h", "no-implementation ", 3},
    {"ForeignImplementation",
     "<nodedef name='ND' node='foreign'><output name='out' type='float'/></nodedef>\n"
     "<implementation name='IM' nodedef='ND' file='foreign.osl' function='foreign' target='genosl'/><foreign name='h' "
     "type='float'/>",
     "h", "no-implementation ", 3},
    {"NodeThatIsMadeOfItself",
     "<nodedef name='ND' node='ring'><input name='in' type='float' value='1'/><output name='out' "
     "type='float'/></nodedef>\n"
     "<nodegraph name='NG' nodedef='ND'><ring name='r' type='float'/><output name='out' type='float' "
     "nodename='r'/></nodegraph>\n"
     "<ring name='h' type='float'/>",
     "h", "cycle ", 3},
    {"BadValue", "<sin name='a' type='float'>\n<input name='in' type='float' value='much'/></sin>", "a", "bad-value ",
     3},
    {"BadValues",
     "<add name='a' type='float'>\n<input name='in1' type='float' value='much'/>\n<input name='in2' type='float' "
     "value='more'/>\n</add>",
     "a", "bad-value bad-value ", 3},
};

std::string nameOfWrong(const testing::TestParamInfo<Wrong>& which) { return which.param.name; }

INSTANTIATE_TEST_SUITE_P(All, WrongDocuments, testing::ValuesIn(kWrong), nameOfWrong);

TEST(Compile, MistakesInInlineTextAreLocatedInIt) {
    Session s(wrap(
        R"(<nodedef name="ND" node="bad"><input name="in" type="float" value="1"/><output name="out" type="float"/></nodedef>
        <implementation name="IM" nodedef="ND" sourcecode="{{in}} + {{nothing}}"/><bad name="h" type="float"/>)"));
    EXPECT_FALSE(s.generate("h"));
    ASSERT_EQ(s.diagnostics.all().size(), 1u) << s.diagnostics.text();
    const Location& where = s.diagnostics.all()[0].where;
    EXPECT_EQ(where.file, "test.mtlx");
    EXPECT_EQ(where.line, 3u);
    EXPECT_EQ(where.column, 69u);
    EXPECT_EQ(s.diagnostics.all()[0].path, "IM");
}

TEST(Compile, MistakesInInlineTextWithReferencesAreAtTheAttribute) {
    Session s(wrap(
        R"(<nodedef name="ND" node="bad"><input name="in" type="float" value="1"/><output name="out" type="float"/></nodedef>
        <implementation name="IM" nodedef="ND" sourcecode="{{in}}&#10; + {{nothing}}"/><bad name="h" type="float"/>)"));
    EXPECT_FALSE(s.generate("h"));
    ASSERT_EQ(s.diagnostics.all().size(), 1u) << s.diagnostics.text();
    EXPECT_EQ(s.diagnostics.all()[0].where.line, 3u);
    EXPECT_EQ(s.diagnostics.all()[0].where.column, 48u);
}

TEST(Compile, ErrorsElsewhereInTheDocumentDoNotMatter) {
    Session s(wrap(R"(<texcoord name="uv" type="vector2"/><paint name="p" type="color3"/>
        <sin name="a" type="float"><input name="in" type="float" nodename="nobody"/></sin>)"));
    EXPECT_TRUE(s.generate("uv")) << s.diagnostics.text();
    EXPECT_TRUE(s.diagnostics.all().empty()) << s.diagnostics.text();
}

// All nodes of the library, each alone with nothing given; those that nothing implements yet say so.
TEST(Compile, EveryNodeOfTheLibrary) {
    Compiler compiler(builtinLibrary());
    int compiled = 0, refused = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(SHADERX_SOURCE_DIR) / "nodes")) {
        if (entry.path().extension() != ".mtlx") continue;
        auto library = readSample(compiler, entry.path());
        if (!library) continue;
        Name nodedef = library->known().nodedef, output = library->known().output, node = library->known().node;
        for (ElementId def : doc::children(*library, library->root())) {
            if ((*library)[def].category != nodedef) continue;
            std::vector<Name> types;
            for (ElementId port : doc::children(*library, def))
                if ((*library)[port].category == output)
                    types.push_back(library->attribute(port, library->known().type));
            auto d = compiler.newDocument();
            ElementId made = d->append(d->root(), library->attributeText(def, node), "n");
            if (types.empty()) types.push_back(library->known().surfaceshader);  // a version that inherits its output
            d->set(made, "type", types.size() > 1 ? "multioutput" : library->text(types[0]));
            d->set(made, "nodedef", library->text((*library)[def].name));
            for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete}) {
                GenerateOptions how;
                how.interface = interface;
                Diagnostics diagnostics;
                bool ok = static_cast<bool>(compiler.generate(*d, made, how, diagnostics));
                (ok ? compiled : refused)++;
                EXPECT_EQ(ok, !diagnostics.hasErrors());
                for (const Diagnostic& e : diagnostics.all())
                    EXPECT_TRUE(e.code == "no-implementation" || e.code == "no-shader" || e.code == "ignored-volume")
                        << library->text((*library)[def].name) << ": " << format(e);
            }
        }
    }
    EXPECT_GT(compiled, 1000);
    EXPECT_LT(refused, compiled / 10);
}

// Whatever is connected to whatever: a shader or an error that says where, but nothing of ours breaks.
TEST(Compile, AnyTypeConnectedToAnyInput) {
    const std::pair<const char*, const char*> makers[] = {{"constant", "float"},
                                                          {"constant", "color3"},
                                                          {"constant", "color4"},
                                                          {"constant", "vector2"},
                                                          {"constant", "vector3"},
                                                          {"constant", "vector4"},
                                                          {"constant", "boolean"},
                                                          {"constant", "integer"},
                                                          {"constant", "string"},
                                                          {"constant", "filename"},
                                                          {"constant", "matrix33"},
                                                          {"constant", "matrix44"},
                                                          {"sheen_bsdf", "BSDF"},
                                                          {"uniform_edf", "EDF"},
                                                          {"anisotropic_vdf", "VDF"},
                                                          {"standard_surface", "surfaceshader"},
                                                          {"displacement", "displacementshader"},
                                                          {"separate2", "multioutput"},
                                                          {"surfacematerial", "material"}};
    const std::array<const char*, 3> users[] = {{"sin", "float", "in"},
                                                {"multiply", "color3", "in1"},
                                                {"normalize", "vector2", "in"},
                                                {"transpose", "matrix33", "in"},
                                                {"not", "boolean", "in"},
                                                {"switch", "float", "which"},
                                                {"fractal3d", "float", "octaves"},
                                                {"texcoord", "vector2", "index"},
                                                {"normal", "vector3", "space"},
                                                {"image", "color3", "file"},
                                                {"image", "color3", "uaddressmode"},
                                                {"geompropvalue", "float", "geomprop"},
                                                {"mix", "BSDF", "fg"},
                                                {"multiply", "BSDF", "in2"},
                                                {"layer", "BSDF", "top"},
                                                {"layer", "BSDF", "base"},
                                                {"dielectric_bsdf", "BSDF", "scatter_mode"},
                                                {"surface", "surfaceshader", "bsdf"},
                                                {"surface", "surfaceshader", "edf"},
                                                {"surfacematerial", "material", "surfaceshader"},
                                                {"surfacematerial", "material", "displacementshader"}};
    Compiler compiler(builtinLibrary());
    for (const auto& [maker, type] : makers)
        for (const auto& [user, result, input] : users)
            for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete}) {
                auto d = compiler.newDocument();
                auto add = [&](ElementId parent, std::string_view category, std::string_view name,
                               std::string_view of) {
                    ElementId e = d->append(parent, category, name);
                    d->set(e, "type", of);
                    return e;
                };
                add(d->root(), maker, "made", type);
                ElementId element = add(d->root(), user, "used", result);
                d->set(add(element, "input", input, type), "nodename", "made");
                if (std::string_view(result) == "BSDF") {
                    element = add(d->root(), "surface", "whole", "surfaceshader");
                    d->set(add(element, "input", "bsdf", "BSDF"), "nodename", "used");
                }
                GenerateOptions how;
                how.interface = interface;
                Diagnostics diagnostics;
                bool ok = static_cast<bool>(compiler.generate(*d, element, how, diagnostics));
                EXPECT_EQ(ok, !diagnostics.hasErrors()) << type << " to " << user << "." << input;
                EXPECT_FALSE(diagnostics.hasInternal()) << type << " to " << user << "." << input << diagnostics.text();
            }
}

TEST(Compile, UserLibraryGoesBeforeTheBuiltInOne) {
    Session s;
    ASSERT_TRUE(s.compiler.addLibrary(
        {{"mine.mtlx", wrap(R"(<nodedef name="ND_my_sin" node="sin"><input name="in" type="float" value="0"/>
        <output name="out" type="float"/></nodedef>
        <implementation name="IM_my_sin" nodedef="ND_my_sin" file="mine.sl" function="my_sin"/>)")},
         {"mine.sl", "float my_sin(float x) { return x * 3.0; }\n"}},
        s.diagnostics))
        << s.diagnostics.text();
    s.read(wrap(R"(<sin name="a" type="float"><input name="in" type="float" value="0.25"/></sin>)"));
    Result<Shader> shader = s.generate("a", Interface::Baked);
    ASSERT_TRUE(shader) << s.diagnostics.text();
    EXPECT_NE(shader->pixel.find("0.75"), std::string::npos) << shader->pixel;
}

TEST(Compile, UserLibraryMayUseTheNamesOfTheBuiltInOne) {
    Session s;
    ASSERT_TRUE(s.compiler.addLibrary(
        {{"mine.mtlx", wrap(R"(<nodedef name="ND_standard_surface_surfaceshader" node="standard_surface">
            <input name="base_color" type="color3" value="0, 0, 0"/><output name="out" type="surfaceshader"/></nodedef>
        <nodegraph name="NG_glow" nodedef="ND_standard_surface_surfaceshader">
            <uniform_edf name="glow" type="EDF"><input name="color" type="color3" interfacename="base_color"/></uniform_edf>
            <surface name="s" type="surfaceshader"><input name="edf" type="EDF" nodename="glow"/></surface>
            <output name="out" type="surfaceshader" nodename="s"/></nodegraph>)")}},
        s.diagnostics))
        << s.diagnostics.text();
    s.read(wrap(R"(<standard_surface name="s" type="surfaceshader">
        <input name="base_color" type="color3" value="0.25, 0.5, 0.75"/></standard_surface>)"));
    for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete}) {
        Result<Shader> shader = s.generate("s", interface);
        ASSERT_TRUE(shader) << s.diagnostics.text();
        const char* color =
            interface == Interface::Baked ? "out1 = vec4(0.25, 0.5, 0.75, 1.0);" : "out1 = vec4(s_base_color, 1.0);";
        EXPECT_NE(shader->pixel.find(color), std::string::npos) << shader->pixel;
    }
}

// A node of a library comes to its shader by its complete form, the same node of a document by the whole way.
TEST(Compile, CompleteFormIsWhatTheWholeWayMakes) {
    const std::string node = R"(<nodedef name="ND_varnish" node="varnish">
            <input name="tint" type="color3" value="0.5, 0.5, 0.5"/><input name="gloss" type="float" value="0.25"/>
            <input name="normal" type="vector3" defaultgeomprop="Nworld"/><output name="out" type="surfaceshader"/></nodedef>
        <nodegraph name="NG_varnish" nodedef="ND_varnish">
            <oren_nayar_diffuse_bsdf name="wood" type="BSDF"><input name="color" type="color3" interfacename="tint"/>
                <input name="normal" type="vector3" interfacename="normal"/></oren_nayar_diffuse_bsdf>
            <combine2 name="alpha" type="vector2"><input name="in1" type="float" interfacename="gloss"/>
                <input name="in2" type="float" interfacename="gloss"/></combine2>
            <dielectric_bsdf name="coat" type="BSDF"><input name="weight" type="float" interfacename="gloss"/>
                <input name="roughness" type="vector2" nodename="alpha"/>
                <input name="normal" type="vector3" interfacename="normal"/></dielectric_bsdf>
            <layer name="both" type="BSDF"><input name="top" type="BSDF" nodename="coat"/>
                <input name="base" type="BSDF" nodename="wood"/></layer>
            <surface name="s" type="surfaceshader"><input name="bsdf" type="BSDF" nodename="both"/></surface>
            <output name="out" type="surfaceshader" nodename="s"/></nodegraph>)";
    const std::string plain = R"(<varnish name="v" type="surfaceshader"/>)";
    const std::string bent =
        R"(<normalize name="n" type="vector3"><input name="in" type="vector3" value="1, 2, 3"/></normalize>
        <varnish name="v" type="surfaceshader"><input name="normal" type="vector3" nodename="n"/></varnish>)";
    for (const std::string& user : {plain, bent}) {
        Session whole, form;
        ASSERT_TRUE(form.compiler.addLibrary({{"mine.mtlx", wrap(node)}}, form.diagnostics)) << form.diagnostics.text();
        form.read(wrap(user));
        whole.read(wrap(node + user));
        Result<Shader> a = form.generate("v", Interface::Complete), b = whole.generate("v", Interface::Complete);
        ASSERT_TRUE(a && b) << form.diagnostics.text() << whole.diagnostics.text();
        EXPECT_EQ(a->pixel, b->pixel);
        EXPECT_EQ(a->vertex, b->vertex);
        EXPECT_NE(a->pixel.find("for (int"), std::string::npos);
    }
}

TEST(Compile, MistakesOfALibraryAreReported) {
    Session s;
    EXPECT_FALSE(s.compiler.addLibrary({{"bad.mtlx", "<materialx version=\"1.39\"><nodedef"}}, s.diagnostics));
    EXPECT_FALSE(s.compiler.addLibrary({{"bad.sl", "float f(float x) { return y; }\n"}}, s.diagnostics));
    ASSERT_GE(s.diagnostics.all().size(), 2u);
    EXPECT_EQ(s.diagnostics.all().front().where.file, "bad.mtlx");
    EXPECT_EQ(s.diagnostics.all().back().where.file, "bad.sl");
    // The compiler is as it was before.
    s.diagnostics = {};
    s.read(wrap(R"(<texcoord name="uv" type="vector2"/>)"));
    EXPECT_TRUE(s.generate("uv")) << s.diagnostics.text();
}

// Keeps the text of every stage.
struct AllDumps final : DumpSink {
    std::map<StageName, std::string> texts;
    std::vector<StageName> order;
    bool wants(StageName) override { return true; }
    void dump(StageName stage, const std::string& text) override {
        texts[stage] = text;
        order.push_back(stage);
    }
};

TEST(Compile, DumpsShowEveryStageOnceAndChangeNothing) {
    Session s(wrap(
        R"(<standard_surface name="shader" type="surfaceshader"><input name="coat" type="float" value="0.5"/></standard_surface>)"));
    Result<Shader> without = s.generate("shader");
    AllDumps dumps;
    GenerateOptions how;
    how.dumps = &dumps;
    Result<Shader> with = s.compiler.generate(*s.document, s.document->find("shader"), how, s.diagnostics);
    ASSERT_TRUE(without && with) << s.diagnostics.text();
    EXPECT_EQ(bytesOf(*without), bytesOf(*with));
    EXPECT_EQ(dumps.texts.size(), 10u);
    EXPECT_EQ(dumps.order.size(), 10u);
    EXPECT_EQ(dumps.order.front(), StageName::Read);
    EXPECT_EQ(dumps.order.back(), StageName::Print);
    for (const auto& [stage, text] : dumps.texts) EXPECT_FALSE(text.empty()) << nameOf(stage);
}

TEST(Compile, TopologyIsBakedAndTheRestIsLive) {
    Session s(wrap(R"(<standard_surface name="shader" type="surfaceshader">
        <input name="coat" type="float" value="0"/><input name="metalness" type="float" value="1"/>
        <input name="thin_walled" type="boolean" value="false"/><input name="specular_roughness" type="float" value="0.3"/>
        <input name="base" type="float" value="0.9"/></standard_surface>)"));
    Result<Shader> shader = s.generate("shader");
    ASSERT_TRUE(shader) << s.diagnostics.text();
    std::set<std::string> live;
    Json reflection = Json::parse(shader->reflection());
    for (const Json& u : reflection["uniforms"])
        if (u["kind"] == "live") live.insert(u["name"].get<std::string>());
    EXPECT_EQ(live, (std::set<std::string>{"shader_base", "shader_specular_roughness"}));
}

TEST(Compile, TexturesAreListedWithTheirFiles) {
    Session s(R"(<materialx version="1.39" fileprefix="pictures/">
        <image name="wood" type="color3"><input name="file" type="filename" value="wood.png"/>
          <input name="uaddressmode" type="string" value="clamp"/><input name="default" type="color3" value="1, 0.5, 0"/></image>
        <image name="none" type="color3"/>
        <add name="both" type="color3"><input name="in1" type="color3" nodename="wood"/><input name="in2" type="color3" nodename="none"/></add>
        </materialx>)");
    Result<Shader> shader = s.generate("both");
    ASSERT_TRUE(shader) << s.diagnostics.text();
    ASSERT_EQ(shader->textures.size(), 2u);
    std::map<std::string, TextureBinding> by;
    for (const TextureBinding& t : shader->textures) by[t.uniform] = t;
    EXPECT_EQ(by["wood_file"].file, "pictures/wood.png");
    EXPECT_EQ(by["wood_file"].uAddress, "clamp");
    EXPECT_EQ(by["wood_file"].vAddress, "periodic");
    EXPECT_EQ(by["wood_file"].path, "wood/file");
    EXPECT_EQ(by["wood_file"].defaultColor, (std::vector<float>{1, 0.5f, 0}));
    EXPECT_EQ(by["none_file"].file, "");
}

}  // namespace
}  // namespace shaderx
