// For tests: compiles sources and runs their functions.
#pragma once

#include <bit>
#include <initializer_list>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ir/interpret.h"
#include "ir/text.h"
#include "ir/validate.h"
#include "sl/compile.h"

namespace shaderx::sl {

// A module compiled from sources, its IR checked.
struct TestProgram {
    NameTable names;
    ir::Module module{names};
    std::vector<Signature> made;
    Diagnostics diagnostics;
    bool good = false;

    explicit TestProgram(std::initializer_list<std::string_view> sources) {
        std::vector<SourceFile> files;
        for (std::string_view s : sources) files.push_back({"test" + std::to_string(files.size()) + ".sl", s});
        good = compile(module, files, {}, made, diagnostics);
        EXPECT_NE(good, diagnostics.hasErrors());
        if (good) {
            EXPECT_TRUE(ir::validate(module, diagnostics)) << diagnostics.text();
        }
    }
    const ir::Function& operator[](std::string_view name) {
        const ir::Function* f = module.findOwn(names.intern(name));
        static const ir::Function none;
        EXPECT_TRUE(f) << name << "\n" << diagnostics.text();
        return f ? *f : none;
    }
    // All components of all results.
    std::vector<float> run(std::string_view name, std::initializer_list<float> numbers, ir::Environment& world) {
        const ir::Function& f = (*this)[name];
        std::vector<ir::Value> args, results(f.results.size());
        const float* next = numbers.begin();
        for (const ir::Param& p : f.params) {
            ir::Value v;
            v.type = p.type;
            bool isFloat = ir::info(p.type).scalar == ir::Scalar::Float;
            for (int i = 0; i < ir::componentCount(p.type); i++, next++) {
                if (isFloat)
                    v.set(i, *next);
                else
                    v.words[i] = static_cast<std::uint32_t>(static_cast<int>(*next));
            }
            args.push_back(v);
        }
        EXPECT_EQ(next, numbers.end());
        ir::Interpreter interpreter(module, diagnostics);
        EXPECT_TRUE(interpreter.run(f, args, results, world)) << diagnostics.text();
        std::vector<float> out;
        for (const ir::Value& r : results)
            for (int i = 0; i < ir::componentCount(r.type); i++)
                out.push_back(ir::info(r.type).scalar == ir::Scalar::Float ? r.f(i) : static_cast<float>(r.i(i)));
        return out;
    }
    std::vector<float> run(std::string_view name, std::initializer_list<float> numbers) {
        ir::Environment nothing;
        return run(name, numbers, nothing);
    }
    float number(std::string_view name, std::initializer_list<float> numbers) {
        std::vector<float> all = run(name, numbers);
        EXPECT_EQ(all.size(), 1u);
        return all.empty() ? 0 : all[0];
    }
};

}  // namespace shaderx::sl
