// A target's legalise keeps programs valid and their values, and leaves nothing that its printer cannot print.
#include "fuzz/fuzzer.h"
#include "passes/place.h"
#include "passes/prune.h"
#include "passes/specialise.h"
#include "targets/glsl/glsl.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Program t(data, size, ir::Type::Vector4, false);
    Diagnostics diagnostics;
    fuzz::expect(passes::specialise(t.module, t.entry, {}, diagnostics), diagnostics.text() + t.before);
    passes::prune(t.module, std::array{t.entry});
    const passes::ShaderInterface interface = passes::makeStages(t.module, t.entry, t.names.intern("@vertex"));
    for (auto& f : t.module.functions) glsl::legalise(*f);
    // Roles of vectors go with it: the numbers are what stays.
    for (std::vector<ir::Value>& results : t.wanted)
        for (ir::Value& v : results) v.type = ir::Type::Vector4;
    fuzz::expectNothing(t.problemAfter("legalise"));
    for (auto& f : t.module.functions) passes::place(*f, {f->name == t.entry, 90, &t.names});
    const glsl::Sources sources = glsl::print(t.module, interface, "fuzz");
    fuzz::expect(!sources.pixel.empty() && !sources.vertex.empty(), "no text");
    return 0;
}
