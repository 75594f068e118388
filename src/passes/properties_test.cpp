// Random programs give the same values before and after every pass.
#include <cstdlib>
#include <unordered_set>

#include <gtest/gtest.h>

#include "ir/text.h"
#include "ir/validate.h"
#include "passes/expand.h"
#include "passes/gather.h"
#include "passes/place.h"
#include "passes/prune.h"
#include "passes/random_programs.h"
#include "passes/specialise.h"

namespace shaderx::passes {
namespace {

using namespace ir;

struct Trial {
    std::uint32_t seed;
    NameTable names{};
    Module module{names};
    RandomProgram random{module, seed};
    Name entry = names.intern("main");
    std::vector<std::vector<Value>> inputs{}, wanted{};
    std::string before{};

    explicit Trial(std::uint32_t s) : seed(s) {
        std::size_t size = 3 + seed / 8 % 40;
        for (std::uint32_t k = 0, n = random.roll(4); k < n; k++) random.function("f" + std::to_string(k), size);
        const Function& f = random.function("main", size);
        for (int i = 0; i < 6; i++) {
            inputs.emplace_back();
            for (const Param& p : f.params) inputs.back().push_back(random.argument(p.type));
        }
        before = print(module);
    }

    std::vector<std::vector<Value>> run() {
        Diagnostics diagnostics;
        Interpreter interpreter(module, diagnostics);
        RandomWorld world;
        std::vector<std::vector<Value>> all;
        const Function& f = *module.findOwn(entry);
        for (const std::vector<Value>& in : inputs) {
            all.emplace_back(f.results.size());
            EXPECT_TRUE(interpreter.run(f, in, all.back(), world)) << diagnostics.text();
        }
        return all;
    }

    bool same(const Value& a, const Value& b, float error) const {
        if (a.type != b.type) return false;
        for (int i = 0; i < componentCount(a.type); i++) {
            bool isFloat = info(a.type).scalar == Scalar::Float;
            if (isFloat ? std::abs(a.f(i) - b.f(i)) > 8 * error : a.words[i] != b.words[i]) return false;
        }
        return true;
    }

    // Valid, and the same values as at first.
    bool check(std::string_view pass) {
        Diagnostics diagnostics;
        bool good = validate(module, diagnostics);
        EXPECT_TRUE(good) << diagnostics.text();
        if (good) {
            auto found = run();
            const auto& samples = random.resultsOf(entry);
            for (std::size_t i = 0; i < wanted.size() && good; i++)
                for (std::size_t k = 0; k < wanted[i].size() && good; k++) {
                    good = same(wanted[i][k], found[i][k], samples[k].error);
                    EXPECT_TRUE(good) << "input " << i << ", result " << k << ": " << wanted[i][k].f(0) << " became "
                                      << found[i][k].f(0) << ", error " << samples[k].error;
                }
        }
        EXPECT_TRUE(good) << "seed " << seed << " after " << pass << "\nfrom\n" << before << "\nto\n" << print(module);
        return good;
    }

    bool passes() {
        Diagnostics diagnostics;
        EXPECT_TRUE(validate(module, diagnostics)) << "seed " << seed << "\n" << diagnostics.text() << before;
        if (diagnostics.hasErrors()) return false;
        wanted = run();
        const std::array entries{entry};
        if (seed % 3 == 0) {  // some go without specialise, so that prune meets all that a module may hold
            prune(module, entries);
            if (!check("prune at once")) return false;
        }
        EXPECT_TRUE(specialise(module, entry, {}, diagnostics)) << diagnostics.text();
        if (!check("specialise")) return false;
        prune(module, entries);
        if (!check("prune")) return false;
        std::unordered_set<Name> baked;
        for (const Uniform& u : module.uniforms) baked.insert(u.name);
        if (seed % 2) {
            EXPECT_TRUE(specialise(module, entry, baked, diagnostics)) << diagnostics.text();
        }
        if (!check("specialise of all uniforms")) return false;
        if (seed % 2 == 0) expandToLongWork(module, entry);
        if (!check("expansion to long work")) return false;
        gather(module, entry);
        if (!check("gather")) return false;
        expandCalledOnce(module, entry);
        if (!check("expansion of what is called once")) return false;
        PlaceOptions how;
        how.longestText = seed % 5 ? 90 : 30;
        for (auto& f : module.functions) place(*f, how);
        return check("place");
    }
};

TEST(Properties, PassesKeepValues) {
    const char* more = std::getenv("SHADERX_TRIALS");  // SHADERX_TRIALS=100000 looks longer
    const std::uint32_t trials = more ? static_cast<std::uint32_t>(std::atoi(more)) : 600;
    for (std::uint32_t seed = 0; seed < trials && !HasFailure(); seed++) EXPECT_TRUE(Trial(seed).passes());
}

}  // namespace
}  // namespace shaderx::passes
