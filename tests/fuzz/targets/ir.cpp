// Bytes as a program's text: what parses and is valid prints, parses back to the same, and runs or is refused.
#include "fuzz/fuzzer.h"
#include "ir/interpret_wide.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    NameTable names;
    ir::Module module(names);
    Diagnostics diagnostics;
    const auto functions = ir::parse(module, "fuzz.ir", fuzz::textOf(data, size), diagnostics);
    fuzz::expect(functions || diagnostics.hasErrors(), "nothing parsed, and no error");
    if (!functions) return 0;
    const std::string text = print(module);
    ir::Module second(names);
    Diagnostics rereading;
    fuzz::expect(bool(ir::parse(second, "printed.ir", text, rereading)), rereading.text() + text);
    const std::string more = print(second);
    fuzz::expect(more == text, text + "\nbecame\n" + more);
    if (!ir::validate(module, diagnostics)) return 0;

    ir::InterpreterOptions options;
    options.maxSteps = 20000;
    ir::Interpreter interpreter(module, diagnostics, options);
    passes::RandomWorld world;
    for (const ir::Function* f : *functions) {
        std::vector<ir::Value> arguments(f->params.size()), results(f->results.size());
        for (std::size_t i = 0; i < arguments.size(); i++) arguments[i].type = f->params[i].type;
        interpreter.run(*f, arguments, results, world);
        (void)ir::WideProgram::prepare(module, *f, diagnostics);
    }
    return 0;
}
