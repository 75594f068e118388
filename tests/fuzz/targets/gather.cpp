// passes/gather keeps programs valid and their values.
#include "passes/gather.h"

#include "fuzz/fuzzer.h"
#include "passes/specialise.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Program t(data, size);
    Diagnostics diagnostics;
    fuzz::expect(passes::specialise(t.module, t.entry, {}, diagnostics), diagnostics.text() + t.before);
    passes::gather(t.module, t.entry);
    fuzz::expectNothing(t.problemAfter("gather"));
    return 0;
}
