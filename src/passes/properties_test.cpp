// Random programs give the same values before and after every pass.
#include <cstdlib>
#include <unordered_set>

#include <gtest/gtest.h>

#include "passes/expand.h"
#include "passes/gather.h"
#include "passes/place.h"
#include "passes/prune.h"
#include "passes/random_trial.h"
#include "passes/specialise.h"

namespace shaderx::passes {
namespace {

using namespace ir;

std::string problem(std::uint32_t seed) {
    RandomTrial t(Dice(seed), 3 + seed / 8 % 40);
    if (std::string e = t.start(); !e.empty()) return e;
    const std::array entries{t.entry};
    if (seed % 3 == 0) {  // some go without specialise, so that prune meets all that a module may hold
        prune(t.module, entries);
        if (std::string e = t.problemAfter("prune at once"); !e.empty()) return e;
    }
    Diagnostics diagnostics;
    if (!specialise(t.module, t.entry, {}, diagnostics)) return diagnostics.text();
    if (std::string e = t.problemAfter("specialise"); !e.empty()) return e;
    prune(t.module, entries);
    if (std::string e = t.problemAfter("prune"); !e.empty()) return e;
    std::unordered_set<Name> baked;
    for (const Uniform& u : t.module.uniforms) baked.insert(u.name);
    if (seed % 2 && !specialise(t.module, t.entry, baked, diagnostics)) return diagnostics.text();
    if (std::string e = t.problemAfter("specialise of all uniforms"); !e.empty()) return e;
    if (seed % 2 == 0) expandToLongWork(t.module, t.entry);
    if (std::string e = t.problemAfter("expansion to long work"); !e.empty()) return e;
    gather(t.module, t.entry);
    if (std::string e = t.problemAfter("gather"); !e.empty()) return e;
    expandCalledOnce(t.module, t.entry);
    if (std::string e = t.problemAfter("expansion of what is called once"); !e.empty()) return e;
    PlaceOptions how;
    how.longestText = seed % 5 ? 90 : 30;
    for (auto& f : t.module.functions) place(*f, how);
    return t.problemAfter("place");
}

TEST(Properties, PassesKeepValues) {
    const char* more = std::getenv("SHADERX_TRIALS");  // SHADERX_TRIALS=100000 looks longer
    const std::uint32_t trials = more ? static_cast<std::uint32_t>(std::atoi(more)) : 600;
    for (std::uint32_t seed = 0; seed < trials && !HasFailure(); seed++)
        EXPECT_EQ(problem(seed), "") << "seed " << seed;
}

}  // namespace
}  // namespace shaderx::passes
