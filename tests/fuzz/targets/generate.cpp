// The whole compiler. A text is a document as it is, right or wrong; any other bytes make a random document, which is
// right and must generate.
#include "compile/compile.h"
#include "fuzz/fuzzer.h"
#include "fuzz/random_document.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const fuzz::NodeTable nodes(builtinLibrary());
    static const std::vector<std::string> pictures{"grey.png", "colour.png"};
    const bool isText = size > 0 && data[0] == '<';
    const std::string text = isText ? std::string(fuzz::textOf(data, size))
                                    : fuzz::randomDocument(nodes, passes::Dice(std::span(data, size)), pictures);
    Compiler compiler(builtinLibrary());
    Diagnostics diagnostics;
    doc::NoIncludes none;
    const auto document = compiler.read("fuzz.mtlx", text, none, diagnostics);
    const bool isValid = document && compiler.validate(*document, diagnostics);
    fuzz::expect(!diagnostics.hasInternal() && (isText || isValid), diagnostics.text() + text);
    if (!document) return 0;
    for (doc::ElementId element : compiler.renderableElements(*document))
        for (Interface interface : {Interface::Live, Interface::Baked, Interface::Complete}) {
            Diagnostics found;
            GenerateOptions options;
            options.interface = interface;
            const Result<Shader> shader = compiler.generate(*document, element, options, found);
            fuzz::expect(!found.hasInternal() && (shader || found.hasErrors()), found.text() + text);
            fuzz::expect(isText || shader, found.text() + text);
        }
    return 0;
}
