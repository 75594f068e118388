// For tests: a random program whose values must survive a pass.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "ir/text.h"
#include "ir/validate.h"
#include "passes/random_programs.h"

namespace shaderx::passes {

struct RandomTrial {
    Dice dice;
    NameTable names{};
    ir::Module module{names};
    RandomProgram random{module, dice};
    Name entry = names.intern("main");
    std::vector<std::vector<ir::Value>> inputs{}, wanted{};
    std::string before{};

    // Functions of about so many operations; the entry with one result of a type, or with any.
    RandomTrial(Dice d, std::size_t operations, ir::Type result = ir::Type::Void, bool hasParams = true) : dice(d) {
        for (std::uint32_t k = 0, n = random.roll(4); k < n; k++) random.function(fmt::format("f{}", k), operations);
        const ir::Function& f = random.function("main", operations, result, hasParams);
        for (int i = 0; i < 6; i++) {
            inputs.emplace_back();
            for (const ir::Param& p : f.params) inputs.back().push_back(random.argument(p.type));
        }
        before = print(module);
    }

    // What is wrong with the program as it was made; empty if nothing. To be called first.
    std::string start() {
        Diagnostics diagnostics;
        if (!validate(module, diagnostics)) return diagnostics.text() + before;
        std::string problem;
        wanted = run(problem);
        return problem;
    }

    // What a pass has broken: the program is valid and gives the same values; empty if nothing.
    std::string problemAfter(std::string_view pass) const {
        Diagnostics diagnostics;
        std::string problem;
        if (!validate(module, diagnostics)) problem = diagnostics.text();
        const auto found = problem.empty() ? run(problem) : std::vector<std::vector<ir::Value>>{};
        const std::vector<Sample>& samples = random.resultsOf(entry);
        for (std::size_t i = 0; i < found.size(); i++)
            for (std::size_t k = 0; k < found[i].size() && problem.empty(); k++)
                if (!same(wanted[i][k], found[i][k], samples[k].error))
                    problem = fmt::format("input {}, result {}: {} became {}, error {}\n", i, k, wanted[i][k].f(0),
                                          found[i][k].f(0), samples[k].error);
        if (problem.empty()) return {};
        return fmt::format("{}after {}, from\n{}\nto\n{}", problem, pass, before, print(module));
    }

  private:
    std::vector<std::vector<ir::Value>> run(std::string& problem) const {
        Diagnostics diagnostics;
        ir::Interpreter interpreter(module, diagnostics);
        RandomWorld world;
        std::vector<std::vector<ir::Value>> all;
        const ir::Function& f = *module.findOwn(entry);
        for (const std::vector<ir::Value>& in : inputs) {
            all.emplace_back(f.results.size());
            if (!interpreter.run(f, in, all.back(), world)) problem = diagnostics.text();
        }
        return all;
    }

    static bool same(const ir::Value& a, const ir::Value& b, float error) {
        if (a.type != b.type) return false;
        for (int i = 0; i < ir::componentCount(a.type); i++) {
            const bool isFloat = ir::info(a.type).scalar == ir::Scalar::Float;
            if (isFloat ? std::abs(a.f(i) - b.f(i)) > 8 * error : a.words[i] != b.words[i]) return false;
        }
        return true;
    }
};

}  // namespace shaderx::passes
