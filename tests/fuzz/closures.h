// Random closure trees, and the light that they give by definition.
#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/fuzzer.h"
#include "passes/prune.h"
#include "passes/shade.h"
#include "passes/specialise.h"

namespace shaderx::fuzz {

// A module whose function `main` gives a random material and whose function `light` computes, without closures, what
// that must look like: each closure is made twice, as an operation and by its definition (passes/shade.h).
class ClosureTrial {
  public:
    explicit ClosureTrial(passes::Dice dice) : dice_(dice) {
        Diagnostics diagnostics;
        ensure(bool(ir::parse(leaves_.module, "leaves", kLeaves, diagnostics)), "the leaves are wrong");
        module.sources.push_back(&leaves_);
        for (int i = 0; i < 6; i++) {
            ir::Uniform u;
            u.name = names.intern(fmt::format("u{}", i));
            u.type = i < 4 ? ir::Type::Float : ir::Type::Color3;
            for (int c = 0; c < ir::componentCount(u.type); c++)
                u.values.push_back(std::bit_cast<std::uint32_t>(share()));
            module.uniforms.push_back(u);
        }
        material_.name = entry;
        light_.name = names.intern("light");
        ir::Builder m(module, material_), l(module, light_);
        material = &m, light = &l;
        makeAll();
        module.put(std::move(material_));
        module.put(std::move(light_));
        before_ = print(module);
        Diagnostics broken;
        expect(ir::validate(module, broken), broken.text() + before_);
        wanted_ = run(names.intern("light"));
    }

    void shade() {
        Diagnostics diagnostics;
        expect(passes::specialise(module, entry, {}, diagnostics), diagnostics.text() + before_);
        passes::prune(module, std::array{entry});
        passes::ShadeOptions options;
        options.skipsUnused = dice_.roll(2) != 0;
        expect(passes::shade(module, entry, names.intern("out1"), options, diagnostics), diagnostics.text() + before_);
        Diagnostics broken;
        expect(ir::validate(module, broken), broken.text() + before_ + print(module));
        expect(passes::specialise(module, entry, {}, diagnostics), diagnostics.text() + before_);
        expect(ir::validate(module, broken), broken.text() + before_ + print(module));
    }

    void expectLight(std::string_view pass) const {
        const ir::Value found = run(entry);
        for (int i = 0; i < 4; i++)
            expect(std::abs(found.f(i) - wanted_.f(i)) <= 1e-3f * (1 + std::abs(wanted_.f(i))),
                   fmt::format("after {}: component {} is {}, not {}, from\n{}\nto\n{}", pass, i, found.f(i),
                               wanted_.f(i), before_, print(module)));
    }

  private:
    // The leaves' functions, as a library has them.
    struct Leaves final : ir::FunctionSource {
        explicit Leaves(NameTable& names) : module(names) {}
        const ir::Function* find(Name name) override { return module.findOwn(name); }
        const ir::LeafInfo* findLeaf(Name name) override { return module.leaf(name); }
        ir::Module module;
    };

  public:
    NameTable names{};
    ir::Module module{names};
    Name entry = names.intern("main");

  private:
    static constexpr std::string_view kLeaves = R"(
leaf matte(weight: float, color: color3)
leaf glossy(weight: float, tint: color3, roughness: float)
leaf glow(color: color3)

function matte_environment(color: color3, N: vector3) -> (radiance: color3, albedo: color3) {
    %0 = param color3 color
    %1 = param vector3 N
    %2 = dot float %1, %1
    %3 = constant float 0.5
    %4 = mul color3 %0, %3
    %5 = mul color3 %4, %2
    %6 = mul color3 %0, %2
    return %5, %6
}
function glossy_environment(tint: color3, roughness: float, V: vector3) -> (radiance: color3, albedo: color3) {
    %0 = param color3 tint
    %1 = param float roughness
    %2 = param vector3 V
    %3 = dot float %2, %2
    %4 = mul float %1, %3
    %5 = mul color3 %0, %4
    %6 = constant float 0.25
    %7 = mul color3 %0, %6
    return %5, %7
}
function glow_emission(color: color3) -> (out: color3) {
    %0 = param color3 color
    return %0
}
)";

    // A number in both functions.
    struct Number {
        ir::ExprId in, as;
    };
    // A closure in the one, what it gives and lets through in the other.
    struct Closure {
        ir::ExprId in, radiance, passed;
    };

    std::uint32_t roll(std::uint32_t n) { return dice_.roll(n); }
    float share() {
        const std::uint32_t r = roll(12);
        return r < 2 ? 0.0f : r < 4 ? 1.0f : static_cast<float>(1 + roll(15)) / 16.0f;
    }

    Number both(ir::Op op, const Number& a, const Number& c) {
        return {material->op(op, {a.in, c.in}), light->op(op, {a.as, c.as})};
    }
    Number number(ir::Type type, int depth = 0) {
        const bool isFloat = type == ir::Type::Float;
        if (depth < 3) switch (roll(8)) {
                case 0:
                    return both(ir::Op::Mul, number(type, depth + 1), number(ir::Type::Float, depth + 1));
                case 1: {
                    const Number one{material->number(1), light->number(1)};
                    return both(ir::Op::Sub, one, number(ir::Type::Float, depth + 1), type);
                }
                case 2:
                    return both(ir::Op::Max, number(type, depth + 1), number(ir::Type::Float, depth + 1));
                default:
                    break;
            }
        if (roll(2)) {
            const ir::Uniform& u = module.uniforms[isFloat ? roll(4) : 4 + roll(2)];
            return {material->uniform(u.name, type), light->uniform(u.name, type)};
        }
        std::vector<std::uint32_t> words;
        for (int i = 0; i < ir::componentCount(type); i++)
            words.push_back(i && roll(2) ? words[0] : std::bit_cast<std::uint32_t>(share()));
        return {material->constant(type, words), light->constant(type, words)};
    }
    // The same with a result that must have the type.
    Number both(ir::Op op, const Number& a, const Number& c, ir::Type type) {
        const Number n = both(op, a, c);
        return {material->convert(n.in, type), light->convert(n.as, type)};
    }

    ir::ExprId mul(ir::ExprId a, ir::ExprId c) { return light->op(ir::Op::Mul, {a, c}); }
    ir::ExprId less(ir::ExprId a) { return light->op(ir::Op::Sub, {light->number(1), a}); }
    ir::ExprId mix(ir::ExprId a, ir::ExprId c, ir::ExprId t) {
        return light->op(ir::Op::Add, {mul(a, less(t)), mul(c, t)});
    }
    ir::ExprId black() { return light->constant(ir::Type::Color3, {0}); }
    ir::ExprId closure(ir::Op op, ir::Type type, std::initializer_list<ir::ExprId> o, std::string_view leaf = {}) {
        return material->emit(op, type, o, leaf.empty() ? 0 : names.intern(leaf).index);
    }

    ir::ExprId viewer() {
        ir::ExprId d =
            light->op(ir::Op::Sub, {light->convert(light->context(ir::Context::ViewPosition), ir::Type::Vector3),
                                    light->convert(light->context(ir::Context::PositionWorld), ir::Type::Vector3)});
        return light->op(ir::Op::Normalize, {d});
    }

    Closure bsdfLeaf() {
        const Number weight = number(ir::Type::Float), color = number(ir::Type::Color3);
        ir::ExprId in, call;
        if (roll(2)) {
            in = closure(ir::Op::Leaf, ir::Type::BSDF, {weight.in, color.in}, "matte");
            ir::ExprId normal = light->op(ir::Op::Normalize, {light->context(ir::Context::NormalWorld)});
            call = light->call(names.intern("matte_environment"), ir::Type::Tuple, std::array{color.as, normal});
        } else {
            const Number roughness = number(ir::Type::Float);
            in = closure(ir::Op::Leaf, ir::Type::BSDF, {weight.in, color.in, roughness.in}, "glossy");
            call = light->call(names.intern("glossy_environment"), ir::Type::Tuple,
                               std::array{color.as, roughness.as, viewer()});
        }
        return {in, mul(light->result(call, 0, ir::Type::Color3), weight.as),
                less(mul(light->result(call, 1, ir::Type::Color3), weight.as))};
    }

    Closure bsdf() {
        const auto any = [&]() -> const Closure& { return bsdfs_[roll(static_cast<std::uint32_t>(bsdfs_.size()))]; };
        if (bsdfs_.empty()) return bsdfLeaf();
        const std::uint32_t which = roll(6);
        if (which < 2) return bsdfLeaf();
        const Closure a = any(), c = any();
        if (which == 2) {
            const Number t = number(ir::Type::Float);
            return {closure(ir::Op::ClosureMix, ir::Type::BSDF, {a.in, c.in, t.in}), mix(a.radiance, c.radiance, t.as),
                    mix(a.passed, c.passed, t.as)};
        }
        if (which == 3) {
            ir::ExprId passed =
                light->op(ir::Op::Sub, {light->op(ir::Op::Add, {a.passed, c.passed}), light->number(1)});
            return {closure(ir::Op::ClosureAdd, ir::Type::BSDF, {a.in, c.in}),
                    light->op(ir::Op::Add, {a.radiance, c.radiance}),
                    light->op(ir::Op::Max, {passed, light->number(0)})};
        }
        if (which == 4) {
            const Number s = number(roll(2) ? ir::Type::Float : ir::Type::Color3);
            return {closure(ir::Op::ClosureScale, ir::Type::BSDF, {a.in, s.in}), mul(a.radiance, s.as), a.passed};
        }
        return {closure(ir::Op::ClosureLayer, ir::Type::BSDF, {a.in, c.in}),
                light->op(ir::Op::Add, {a.radiance, mul(c.radiance, a.passed)}), mul(a.passed, c.passed)};
    }

    Closure edf() {
        const auto any = [&]() -> const Closure& { return edfs_[roll(static_cast<std::uint32_t>(edfs_.size()))]; };
        const std::uint32_t which = edfs_.empty() ? 0 : roll(4);
        if (which == 0) {
            const Number color = number(ir::Type::Color3);
            return {closure(ir::Op::Leaf, ir::Type::EDF, {color.in}, "glow"), color.as, {}};
        }
        const Closure a = any(), c = any();
        const Number t = number(ir::Type::Float);
        if (which == 1)
            return {
                closure(ir::Op::ClosureMix, ir::Type::EDF, {a.in, c.in, t.in}), mix(a.radiance, c.radiance, t.as), {}};
        if (which == 2)
            return {closure(ir::Op::ClosureAdd, ir::Type::EDF, {a.in, c.in}),
                    light->op(ir::Op::Add, {a.radiance, c.radiance}),
                    {}};
        return {closure(ir::Op::ClosureScale, ir::Type::EDF, {a.in, t.in}), mul(a.radiance, t.as), {}};
    }

    // `radiance` of a surface has its opacity in it.
    Closure surface() {
        const Number opacity = number(ir::Type::Float);
        ir::ExprId thin = material->boolean(false);
        ir::ExprId in, radiance = black();
        ir::ExprId bsdfIn = material->null(ir::Type::BSDF), edfIn = material->null(ir::Type::EDF);
        if (roll(4)) {
            const Closure& b = bsdfs_.back();
            bsdfIn = b.in;
            radiance = mul(b.radiance, light->context(ir::Context::EnvironmentIntensity));
        }
        if (!edfs_.empty() && roll(2)) {
            edfIn = edfs_.back().in;
            radiance = light->op(ir::Op::Add, {radiance, edfs_.back().radiance});
        }
        in = closure(ir::Op::Surface, ir::Type::SurfaceShader, {bsdfIn, edfIn, opacity.in, thin});
        return {in, mul(radiance, opacity.as), {}};
    }

    void makeAll() {
        for (std::uint32_t i = 0, n = 1 + roll(10); i < n; i++) bsdfs_.push_back(bsdf());
        for (std::uint32_t i = 0, n = roll(4); i < n; i++) edfs_.push_back(edf());
        Closure s = surface();
        if (roll(3) == 0) {
            const Closure other = surface();
            const Number t = number(ir::Type::Float);
            s = {closure(ir::Op::ClosureMix, ir::Type::SurfaceShader, {s.in, other.in, t.in}),
                 mix(s.radiance, other.radiance, t.as),
                 {}};
        }
        material->addResult(names.intern("out"), s.in);
        light->addResult(names.intern("out"), light->make(ir::Type::Vector4, {s.radiance, light->number(1)}));
    }

    // The normal faces the viewer.
    struct World final : ir::Environment {
        bool context(ir::Context c, ir::Value& v) override {
            const float all = c == ir::Context::EnvironmentIntensity ? 0.5f
                              : c == ir::Context::PositionWorld      ? 0.25f
                                                                     : 1.0f;
            for (int i = 0; i < ir::componentCount(v.type); i++) v.set(i, all);
            return true;
        }
    };

    ir::Value run(Name function) const {
        World world;
        Diagnostics diagnostics;
        ir::Interpreter interpreter(module, diagnostics);
        std::vector<ir::Value> results(1);
        expect(interpreter.run(*module.findOwn(function), {}, results, world), diagnostics.text() + print(module));
        return results[0];
    }

    passes::Dice dice_;
    Leaves leaves_{names};
    ir::Function material_{}, light_{};
    ir::Builder *material = nullptr, *light = nullptr;
    std::vector<Closure> bsdfs_{}, edfs_{};
    std::string before_{};
    ir::Value wanted_{};
};

}  // namespace shaderx::fuzz
