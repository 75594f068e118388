// passes/prune keeps programs valid and their values.
#include "passes/prune.h"

#include "fuzz/fuzzer.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Program t(data, size);
    passes::prune(t.module, std::array{t.entry});
    fuzz::expectNothing(t.problemAfter("prune"));
    const std::string once = print(t.module);
    passes::prune(t.module, std::array{t.entry});
    fuzz::expect(print(t.module) == once, "pruning again prunes more of\n" + once);
    return 0;
}
