// Bytes as the source of a library: what compiles is valid, and can be run.
#include "fuzz/fuzzer.h"
#include "sl/compile.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    NameTable names;
    ir::Module module(names);
    Diagnostics diagnostics;
    std::vector<sl::Signature> made;
    const sl::SourceFile file{"fuzz.sl", fuzz::textOf(data, size)};
    const bool good = sl::compile(module, std::span(&file, 1), {}, made, diagnostics);
    fuzz::expect(good != diagnostics.hasErrors(), "an error that nobody reports, or one of no consequence");
    if (good) {
        Diagnostics found;
        fuzz::expect(ir::validate(module, found), found.text() + print(module));
    }
    // The same as an inline expression of two parameters.
    ir::Module inlineModule(names);
    Diagnostics inlineDiagnostics, found;
    const ir::Param params[] = {{names.intern("in1"), ir::Type::Color3}, {names.intern("in2"), ir::Type::Float}};
    const ir::Param result{names.intern("out"), ir::Type::Color3};
    if (sl::compileInline(inlineModule, names.intern("f"), params, std::span(&result, 1), file, {}, inlineDiagnostics))
        fuzz::expect(ir::validate(inlineModule, found), found.text() + print(inlineModule));
    return 0;
}
