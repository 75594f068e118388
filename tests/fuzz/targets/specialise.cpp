// passes/specialise keeps programs valid and their values.
#include "passes/specialise.h"

#include "fuzz/fuzzer.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Program t(data, size);
    Diagnostics diagnostics;
    fuzz::expect(passes::specialise(t.module, t.entry, {}, diagnostics), diagnostics.text() + t.before);
    fuzz::expectNothing(t.problemAfter("specialise"));
    std::unordered_set<Name> baked;
    for (const ir::Uniform& u : t.module.uniforms)
        if (t.random.roll(2)) baked.insert(u.name);
    fuzz::expect(passes::specialise(t.module, t.entry, baked, diagnostics), diagnostics.text() + t.before);
    fuzz::expectNothing(t.problemAfter("specialise with baked uniforms"));
    return 0;
}
