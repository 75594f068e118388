// Each tests/passes/PASS/NAME.ir is a program; NAME.expected is what the pass makes of it, or what it says about it.
// SHADERX_BLESS=1 rewrites the expected files. A first line that begins with #! carries options:
//
//     #! entry NAME      the entry, else "main"
//     #! baked NAME...   specialise: uniforms to bake
//     #! isEntry         place: as an entry; the functions are placed as they are otherwise
//     #! skipsUnused     shade: says where long functions are needed
//     #! noEnvironment   shade: without light from the environment
//     #! transparency    shade: alpha says how much of a surface is there
//     #! longest NUMBER  place: the longest text of an expression
//     #! invalid         the program breaks the rules of the IR before the pass
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "ir/builder.h"
#include "ir/text.h"
#include "ir/validate.h"
#include "passes/expand.h"
#include "passes/flip.h"
#include "passes/gather.h"
#include "passes/place.h"
#include "passes/prune.h"
#include "passes/shade.h"
#include "passes/specialise.h"
#include "passes/stages.h"
#include "passes/topology.h"

namespace shaderx::passes {
namespace {

using namespace ir;

std::filesystem::path folder() { return std::filesystem::path(SHADERX_SOURCE_DIR) / "tests/passes"; }

std::string contents(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return in ? text.str() : "(no such file)";
}

struct Options {
    std::string entry = "main";
    std::vector<std::string> baked;
    PlaceOptions place;
    ShadeOptions shade;
    bool invalid = false;
};

Options optionsOf(const std::string& text) {
    Options o;
    if (text.rfind("#! ", 0) != 0) return o;
    std::istringstream words(text.substr(3, text.find('\n') - 2));
    std::string word;
    bool baking = false;
    while (words >> word) {
        if (word == "entry")
            words >> o.entry;
        else if (word == "noEnvironment")
            o.shade.environment = false;
        else if (word == "transparency")
            o.shade.transparency = true;
        else if (word == "isEntry")
            o.place.isEntry = true;
        else if (word == "skipsUnused")
            o.shade.skipsUnused = true;
        else if (word == "longest")
            words >> o.place.longestText;
        else if (word == "invalid")
            o.invalid = true;
        else if (word == "baked")
            baking = true;
        else if (baking)
            o.baked.push_back(word);
        else
            ADD_FAILURE() << "no such option: " << word;
    }
    return o;
}

// The function without what its results do not need, so that what a pass leaves behind does not show.
Function tidied(Module& module, const Function& f) {
    Function fresh;
    fresh.name = f.name;
    fresh.params = f.params;
    fresh.loops = f.loops;
    fresh.isInline = f.isInline;
    fresh.comment = f.comment;
    Builder b(module, fresh);
    std::vector<bool> live = reachable(f);
    std::vector<ExprId> map(f.exprs.size());
    for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
        if (!live[i]) continue;
        const Expr& e = f.exprs[i];
        std::vector<ExprId> operands;
        for (ExprId o : f.operandsOf(e)) operands.push_back(map[o.index]);
        if (e.op == Op::Constant && componentCount(e.type))
            map[i] = b.constant(e.type, f.constantWords(ExprId(i)));
        else
            map[i] = b.emitRaw(e.op, e.type, operands, e.payload);
        if (!fresh.hints[map[i].index]) fresh.hints[map[i].index] = f.hints[i];
    }
    for (const ResultValue& r : f.results) b.addResult(r.name, map[r.value.index]);
    return fresh;
}

// The functions that the entry needs, callees first.
std::string printReached(Module& module, Name entry) {
    std::vector<Name> order, todo{entry};
    while (!todo.empty()) {
        Name name = todo.back();
        todo.pop_back();
        order.erase(std::remove(order.begin(), order.end(), name), order.end());
        order.push_back(name);
        const Function& f = *module.findOwn(name);
        std::vector<bool> live = reachable(f);
        for (std::size_t i = 0; i < f.exprs.size(); i++)
            if (live[i] && f.exprs[i].op == Op::Call) todo.push_back(Name(f.exprs[i].payload));
        EXPECT_LT(order.size(), 1000u);
    }
    std::string text;
    for (std::size_t i = order.size(); i-- > 0;)
        text += print(module, tidied(module, *module.findOwn(order[i]))) + (i ? "\n" : "");
    return text;
}

std::string join(const Module& module, const std::vector<Name>& names) {
    std::string text;
    for (Name n : names) text += " " + std::string(module.names->text(n));
    return text;
}

std::string describe(const Module& module, const StageUniforms& s) {
    std::string text;
    for (Context c : s.contexts) text += " " + std::string(info(c).name);
    return text + join(module, s.uniforms) + "\n";
}

std::string stages(Module& module, Name entry) {
    Name vertex = module.names->intern("vertex");
    ShaderInterface made = makeStages(module, entry, vertex);
    std::string text = "pixel uniforms:" + describe(module, made.pixelUniforms);
    text += "vertex uniforms:" + describe(module, made.vertexUniforms) + "inputs:";
    auto add = [&](const auto& x) {
        text += " " + std::string(info(x.type).name) + " " + std::string(module.names->text(x.name));
    };
    for (const VertexInput& i : made.inputs) add(i);
    text += "\nvaryings:";
    for (const Varying& v : made.varyings) add(v);
    return text + "\n\n" + print(module, *module.findOwn(vertex));
}

// What a pass makes of a program, or what it says about it.
std::string outcome(const std::string& pass, Module& module, const Options& o, Diagnostics& diagnostics) {
    NameTable& names = *module.names;
    Name entry = names.intern(o.entry);
    if (pass == "specialise") {
        std::unordered_set<Name> baked;
        for (const std::string& b : o.baked) baked.insert(names.intern(b));
        return specialise(module, entry, baked, diagnostics) ? printReached(module, entry) : "";
    }
    if (pass == "shade")
        return shade(module, entry, names.intern("out1"), o.shade, diagnostics) ? printReached(module, entry) : "";
    if (pass == "gather" || pass == "expand_to_long_work" || pass == "expand_called_once") {
        (pass == "gather" ? gather : pass == "expand_called_once" ? expandCalledOnce : expandToLongWork)(module, entry);
        return printReached(module, entry);
    }
    if (pass == "flip") {
        flipTextures(module);
        return print(module);
    }
    if (pass == "prune") {
        prune(module, std::array{entry});
        return print(module);
    }
    if (pass == "topology") {
        std::string text;
        std::unordered_set<Name> found = topologyUniforms(module, *module.findOwn(entry));
        for (const Uniform& u : module.uniforms)
            text += std::string(names.text(u.name)) + (found.count(u.name) ? ": baked\n" : ": live\n");
        return text;
    }
    if (pass == "stages") {
        for (auto& f : module.functions) compact(*f);
        return stages(module, entry);
    }
    if (pass == "place") {
        for (auto& f : module.functions) place(*f, o.place);
        return print(module);
    }
    ADD_FAILURE() << "no such pass: " << pass;
    return "";
}

std::string runCase(const std::string& pass, const std::filesystem::path& file) {
    std::string text = contents(file);
    Options o = optionsOf(text);
    NameTable names;
    Module module(names);
    Diagnostics diagnostics;
    bool good = static_cast<bool>(parse(module, file.filename().string(), text, diagnostics));
    if (good && !o.invalid) good = validate(module, diagnostics);
    EXPECT_TRUE(good) << diagnostics.text();
    if (!good) return "";
    std::string found = outcome(pass, module, o, diagnostics);
    if (!diagnostics.hasErrors()) {
        Diagnostics broken;
        EXPECT_TRUE(validate(module, broken)) << broken.text() << print(module);
    }
    return found + diagnostics.text();
}

TEST(Passes, MakeWhatIsExpected) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder()))
        if (entry.path().extension() == ".ir") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    EXPECT_GT(files.size(), 30u);
    for (const auto& file : files) {
        SCOPED_TRACE(file.string());
        std::string found = runCase(file.parent_path().filename().string(), file);
        std::filesystem::path expected = file;
        expected.replace_extension(".expected");
        if (std::getenv("SHADERX_BLESS")) std::ofstream(expected, std::ios::binary) << found;
        EXPECT_EQ(found, contents(expected));
    }
}

}  // namespace
}  // namespace shaderx::passes
