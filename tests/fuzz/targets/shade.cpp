// passes/shade: a closure tree becomes the light that its definition gives.
#include "fuzz/closures.h"

using namespace shaderx;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    fuzz::ClosureTrial t(passes::Dice(std::span(data, size)));
    t.shade();
    t.expectLight("shade");
    return 0;
}
