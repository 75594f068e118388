// passes/topology: the uniforms that it finds are the module's, and baking them changes no value.
#include "passes/topology.h"

#include "fuzz/closures.h"
#include "passes/specialise.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::ClosureTrial t(passes::Dice(std::span(data, size)));
    Diagnostics diagnostics;
    fuzz::expect(passes::specialise(t.module, t.entry, {}, diagnostics), diagnostics.text());
    const std::string before = print(t.module);
    const std::unordered_set<Name> found = passes::topologyUniforms(t.module, *t.module.findOwn(t.entry));
    fuzz::expect(print(t.module) == before, "the module was changed");
    for (Name name : found) fuzz::expect(t.module.uniform(name) != nullptr, "no uniform of the module");
    fuzz::expect(passes::specialise(t.module, t.entry, found, diagnostics), diagnostics.text());
    Diagnostics broken;
    fuzz::expect(ir::validate(t.module, broken), broken.text() + print(t.module));
    t.shade();
    t.expectLight("topology");
    return 0;
}
