// passes/stages leaves the pixel's program as it is and gives it a vertex program that hands over what it reads.
#include "passes/stages.h"

#include "fuzz/fuzzer.h"
#include "passes/specialise.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Program t(data, size, ir::Type::Vector4, false);
    Diagnostics diagnostics;
    fuzz::expect(passes::specialise(t.module, t.entry, {}, diagnostics), diagnostics.text() + t.before);
    const Name vertex = t.names.intern("@vertex");
    const passes::ShaderInterface interface = passes::makeStages(t.module, t.entry, vertex);
    fuzz::expectNothing(t.problemAfter("stages"));
    const ir::Function* f = t.module.findOwn(vertex);
    fuzz::expect(f && f->results.size() == interface.varyings.size() + 1,
                 "varyings without results of the vertex stage");
    for (std::size_t k = 0; k < interface.varyings.size(); k++)
        fuzz::expect(f->results[k + 1].type == interface.varyings[k].type, "a varying of another type");
    return 0;
}
