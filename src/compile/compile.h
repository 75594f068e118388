// ShaderX: a compiler for materials. This is its public interface.
//
//     shaderx::Compiler compiler(shaderx::builtinLibrary());
//     shaderx::Diagnostics diagnostics;
//     auto document = compiler.newDocument();                       // or compiler.read("gold.mtlx", text, …)
//     auto shader = document->append(document->root(), "standard_surface", "gold");
//     document->set(shader, "type", "surfaceshader");
//     auto metalness = document->append(shader, "input", "metalness");
//     document->set(metalness, "type", "float");
//     document->set(metalness, "value", "1");
//     auto generated = compiler.generate(*document, shader, {}, diagnostics);
//     if (generated) use(generated->vertex, generated->pixel);
//     else           std::fputs(diagnostics.text().c_str(), stderr);
//
// There is no global state: compilers do not know of each other. One compiler serves one thread. Nothing is thrown.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "compile/library.h"
#include "doc/check.h"
#include "doc/color_spaces.h"
#include "doc/document.h"
#include "doc/read.h"
#include "doc/upgrade.h"
#include "graph/lower.h"
#include "passes/cost.h"
#include "passes/lobes.h"
#include "passes/stages.h"

namespace shaderx {

using graph::Interface;

// The interface of a name, "reduced" being another one for baked; false where there is none.
bool interfaceNamed(std::string_view name, Interface& interface);

// The stages of a compilation, in order; see docs/pipeline.md.
enum class StageName : std::uint8_t { Read, Check, Graph, Lower, Specialise, Shade, Interface, Place, Legalise, Print };
std::string_view nameOf(StageName stage);
bool stageNamed(std::string_view name, StageName& stage);

// Receives the program as text after each stage that it asks for.
class DumpSink {
  public:
    virtual ~DumpSink() = default;
    virtual bool wants(StageName stage) = 0;
    virtual void dump(StageName stage, const std::string& text) = 0;
};

// How the environment lights what is drawn.
enum class EnvironmentLight : std::uint8_t {
    Samples,      // u_envRadianceSamples directions a pixel and lobe, importance sampled from mipmaps
    Prefiltered,  // one look-up a lobe, from a map whose levels the host has blurred
    None,
};

struct GenerateOptions {
    Interface interface = Interface::Live;
    EnvironmentLight environment = EnvironmentLight::Samples;
    bool flipV = false;         // textures are read at 1 - v, for hosts that load pictures with the top row first
    bool transparency = false;  // alpha from opacity; below u_alphaThreshold pixels are discarded
    bool blocks = false;        // uniforms stand in the blocks PrivateUniforms and PublicUniforms, laid out as std140
    int bindingBase = -1;       // of blocks and samplers, which the text numbers from here on; below 0 it numbers none
    std::string_view unit = "meter";             // what one unit of distance is in the scene, as a <unitdef> calls it
    std::string_view colorspace = "lin_rec709";  // what shading works in, and the pixel stage gives: any space by name
    bool strict = false;                         // an element of which there is a warning is refused
    bool unknownIsDefault = false;  // what reads a node that nothing defines takes its default, with a warning
    DumpSink* dumps = nullptr;
    // Limits; beyond them generating is an error.
    std::uint32_t maxDepth = 128;           // nodes and functions made of others, within each other
    std::size_t maxExpressions = 1u << 20;  // that these expand to, beside those of the document's own nodes
};

// What a user interface shows of a value: texts as the document or the nodedef writes them, empty where it says
// nothing.
struct UiHints {
    std::string name, folder;
    std::string min, max, softMin, softMax, step;
    std::string choices, choiceValues;  // with commas between them
    bool isAdvanced = false;
};

// What is known of a value of the document beside the value itself.
struct ValueDescription {
    std::string colorspace, unit, unitType;
    std::vector<std::string> aliases;  // what MaterialX calls the uniform, where it is not called so here
    UiHints ui;
};

// A uniform of a shader: one that the host supplies, or a live value of the document.
struct UniformBinding : ValueDescription {
    std::string name;  // as the text has it
    ir::Type type = ir::Type::Float;
    std::vector<std::uint32_t> value;  // its default, by its bits; none of textures
    std::string_view semantic;         // what the host is to supply, "view_position"; empty for values of the document
    std::string path;                  // of the input in the document; empty for what the host supplies
    bool isVertex = false, isPixel = false;  // the stages that read it
    int block = -1;                          // which of Shader::blocks it stands in
    std::uint32_t offset = 0;                // where in the block, in bytes
    int binding = -1;                        // of a texture, where the text numbers it
};

// A value that is part of the program, although the interface is not baked, because it decides what the program
// consists of: to change it, generate again.
struct FixedValue : ValueDescription {
    std::string path;
    ir::Type type = ir::Type::Float;
    std::vector<std::uint32_t> value;  // its bits
    std::string text;                  // of strings, which have no bits
};

// A uniform block, laid out as std140.
struct BlockBinding {
    std::string name;
    std::uint32_t size = 0;  // in bytes
    int binding = -1;        // where the text numbers it
    bool isVertex = false, isPixel = false;
};

// An attribute of the vertex stage.
struct VertexInputBinding {
    std::string name;
    ir::Type type;
    std::vector<std::uint32_t>
        value;  // what it is to be where a mesh lacks it, by its bits; empty where nothing says so
};

// A texture that a shader reads, and how.
struct TextureBinding : ValueDescription {
    std::string uniform;  // the sampler
    std::string file;     // as the document says it, prefixes included, relative to the document; may be empty
    std::string uAddress, vAddress, filter;
    std::vector<float> defaultColor;
    std::string path;  // of the input in the document
    int binding = -1;  // where the text numbers it
};

// The program behind a shader's text, for whoever runs it on the CPU: legalised and placed, the entry functions named
// in the interface. It refers to the compiler's names and must not outlive the compiler.
struct Program {
    ir::Module module;
    passes::ShaderInterface interface;
};

struct Shader {
    std::string element;         // its path in the document
    std::string vertex, pixel;   // source texts
    std::string output;          // the variable that the pixel stage writes
    std::uint64_t topology = 0;  // a hash of the texts but for live values, the same in every run and on every machine
    std::vector<UniformBinding> uniforms;
    std::vector<BlockBinding> blocks;
    std::vector<FixedValue> regenerate;
    std::vector<std::string> withoutEffect;  // paths of values that nothing reads while those of `regenerate` stay; not
                                             // known of a baked interface
    std::vector<VertexInputBinding> inputs;
    std::vector<TextureBinding> textures;
    std::shared_ptr<const Program> program;

    // All of this but texts and program, as JSON; see docs/pipeline.md.
    std::string reflection() const;
};

// The image of the project's own node library.
std::span<const std::uint8_t> builtinLibrary();

class Compiler {
  public:
    // A compiler whose nodes are those of a library's image; an empty one gives a compiler without nodes.
    explicit Compiler(std::span<const std::uint8_t> libraryImage);
    ~Compiler();
    Compiler(const Compiler&) = delete;
    Compiler& operator=(const Compiler&) = delete;

    // Adds a user's library from the texts of its files; it goes before those added earlier.
    bool addLibrary(std::vector<LibraryFile> files, Diagnostics& diagnostics);

    NameTable& names();
    // An empty document.
    std::unique_ptr<doc::Document> newDocument();
    // Reads a document and what it includes, and brings it to the current version; `edits` takes up what that changed.
    // Null after errors.
    std::unique_ptr<doc::Document> read(std::string_view file, std::string text, doc::Resolver& resolver,
                                        Diagnostics& diagnostics, const doc::ReadOptions& limits = {},
                                        std::vector<doc::Edit>* edits = nullptr);
    // Reports every mistake of a document: what the check of the document finds, and what compiling all that it renders
    // and defines would say.
    bool validate(const doc::Document& document, Diagnostics& diagnostics, const GenerateOptions& options = {});
    // A colour space of the libraries, by name or alias; none where there is none of that name.
    std::optional<doc::ColorSpace> colorSpace(std::string_view name) const;
    // What can be rendered: materials, or the outputs of a document without any.
    std::vector<doc::ElementId> renderableElements(const doc::Document& document);
    // Compiles what is upstream of an element: an output, a node, a nodegraph, a shader or a material. Errors anywhere
    // else in the document do not matter.
    Result<Shader> generate(const doc::Document& document, doc::ElementId element, const GenerateOptions& options,
                            Diagnostics& diagnostics);
    // The same for several elements of one document, one after the other: each goes to `done` with what was found. What
    // they have in common is made once; the shaders are those that they would be alone.
    using Done = std::function<void(doc::ElementId element, Result<Shader> shader, const Diagnostics& diagnostics)>;
    void generate(const doc::Document& document, std::span<const doc::ElementId> elements,
                  const GenerateOptions& options, const Done& done);

    // Why the shader of an element is as it is. Which lobes the material has, with which weights, and what removed the
    // others; none where the element is no material.
    Result<std::vector<passes::Lobe>> lobes(const doc::Document& document, doc::ElementId element,
                                            const GenerateOptions& options, Diagnostics& diagnostics);
    // What each node of the document costs a pixel.
    Result<std::vector<passes::NodeCost>> costs(const doc::Document& document, doc::ElementId element,
                                                const GenerateOptions& options, Diagnostics& diagnostics);

  private:
    struct Batch;
    bool checkDefinitions(Batch& batch, const doc::Document& document, const GenerateOptions& options,
                          Diagnostics& diagnostics);
    template <class Run>
    bool compile(Batch& batch, const doc::Document& document, doc::ElementId element, const GenerateOptions& options,
                 Diagnostics& diagnostics, Run&& run);

    struct State;
    std::unique_ptr<State> state_;
};

// Makes a library's image from its files, for Compiler's constructor. Empty after errors.
std::vector<std::uint8_t> packLibrary(std::vector<LibraryFile> files, Diagnostics& diagnostics);

}  // namespace shaderx
