// passes/place gives every function a valid body, whatever its options are.
#include "passes/place.h"

#include "fuzz/fuzzer.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::Program t(data, size);
    passes::PlaceOptions how;
    how.longestText = 20 + static_cast<int>(t.random.roll(100));
    how.names = t.random.roll(2) ? &t.names : nullptr;
    for (auto& f : t.module.functions) {
        how.isEntry = f->name == t.entry;
        passes::place(*f, how);
    }
    fuzz::expectNothing(t.problemAfter("place"));
    return 0;
}
