// What the tests with hostile input share: compiling a text in this process, and what is expected whatever the text is.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compile/compile.h"
#include "support.h"

namespace shaderx::tests {

constexpr std::string_view kHead =
    "<?xml version=\"1.0\"?>\n<materialx version=\"1.39\" xmlns:xi=\"http://www.w3.org/2001/XInclude\">\n";

inline std::string wrapped(std::string_view inside) {
    return std::string(kHead) + std::string(inside) + "</materialx>\n";
}

// Documents by the names that includes give them.
struct Texts final : doc::Resolver {
    std::map<std::string, std::string, std::less<>> texts;
    std::optional<doc::ResolvedFile> resolve(std::string_view href, std::string_view) override {
        auto it = texts.find(href);
        if (it == texts.end()) return {};
        return doc::ResolvedFile{it->first, {}, it->second};
    }
};

// What became of a document: of everything in it that can be rendered, or of one element.
struct Outcome {
    bool isRead = false, isValid = false;
    std::vector<Shader> shaders;
    std::size_t failed = 0;        // elements that gave no shader
    std::string errors;            // of reading and generating
    std::vector<std::string> bad;  // what must never be
};

struct How {
    doc::Resolver* resolver = nullptr;
    Interface interface = Interface::Live;
    std::string element;  // empty: all that can be rendered
    doc::ReadOptions read;
    GenerateOptions generate;
};

// An error must say where; none may be a bug of ours.
inline void checkMessages(const Diagnostics& diagnostics, Outcome& out) {
    for (const Diagnostic& d : diagnostics.all()) {
        if (d.severity == Severity::Internal) out.bad.push_back("internal error: " + format(d));
        if (d.severity == Severity::Error && d.where.line == 0) out.bad.push_back("no place: " + format(d));
    }
    out.errors += diagnostics.text();
}

// Text of a shader: printable, whatever the document holds. Names of elements stand in comments and may be UTF-8.
inline void checkText(const std::string& text, Outcome& out) {
    bool inComment = false;
    char last = '\n';
    for (char c : text) {
        if (last == '/' && c == '/') inComment = true;
        if (c == '\n') inComment = false;
        auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 && c != '\n' && c != '\t') out.bad.push_back("a control character in the text");
        if (byte >= 0x80 && !inComment) out.bad.push_back("a byte outside of ASCII in the code");
        last = c;
    }
}

inline Outcome compile(const std::string& text, How how = {}) {
    Outcome out;
    Compiler compiler(builtinLibrary());
    doc::NoIncludes none;
    Diagnostics reading, checking;
    auto document = compiler.read("t.mtlx", text, how.resolver ? *how.resolver : none, reading, how.read);
    checkMessages(reading, out);
    if (!document && !reading.hasErrors()) out.bad.push_back("not read, and nobody says why");
    if (!document) return out;
    out.isRead = true;
    out.isValid = compiler.validate(*document, checking);
    checkMessages(checking, out);
    out.errors = reading.text();
    std::vector<doc::ElementId> elements = compiler.renderableElements(*document);
    if (!how.element.empty()) elements = {document->find(how.element)};
    how.generate.interface = how.interface;
    for (doc::ElementId element : elements) {
        Diagnostics generating;
        Result<Shader> shader = compiler.generate(*document, element, how.generate, generating);
        checkMessages(generating, out);
        if (!shader && !generating.hasErrors()) out.bad.push_back("no shader, and nobody says why");
        if (!shader) out.failed++;
        if (!shader) continue;
        checkText(shader->vertex, out);
        checkText(shader->pixel, out);
        out.shaders.push_back(*shader);
    }
    return out;
}

inline void expectOrderly(const Outcome& out, std::string_view what) {
    for (const std::string& bad : out.bad) ADD_FAILURE() << what << ": " << bad;
}

// An error of that code, and no shader.
inline void expectRefused(const Outcome& out, std::string_view code, std::string_view what) {
    expectOrderly(out, what);
    EXPECT_TRUE(out.shaders.empty()) << what;
    EXPECT_NE(out.errors.find("[" + std::string(code) + "]"), std::string::npos) << what << "\n" << out.errors;
}

// A compiler of the shading language takes every shader.
inline void expectCompiles(const std::vector<Shader>& shaders, std::string_view what) {
    static const bool have = runCommand("glslangValidator --version").exitCode == 0;
    if (!have || shaders.empty()) return;
    OwnFolder own;
    std::string files;
    for (std::size_t i = 0; i < shaders.size(); i++) {
        std::string name = std::to_string(i);
        writeText(own / (name + ".vert"), shaders[i].vertex);
        writeText(own / (name + ".frag"), shaders[i].pixel);
        files += " " + name + ".vert " + name + ".frag";
    }
    Ran ran = runCommand("glslangValidator" + files, own.path());
    EXPECT_EQ(ran.exitCode, 0) << what << ":\n" << ran.output.substr(0, 4000);
}

// The project's own documents.
inline std::vector<fs::path> ownDocuments() {
    std::vector<fs::path> all = filesOf(testFolder("golden"), ".mtlx");
    for (const fs::path& p : filesOf(fs::path(SHADERX_SOURCE_DIR) / "examples", ".mtlx")) all.push_back(p);
    return all;
}

}  // namespace shaderx::tests
