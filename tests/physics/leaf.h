// Calls the functions of the library's closure leaves through the interpreter.
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compile/compile.h"
#include "ir/builder.h"
#include "ir/interpret.h"
#include "passes/specialise.h"

namespace shaderx::tests {

struct Vec {
    double x = 0, y = 0, z = 0;
};
inline Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator*(double k, Vec a) { return {k * a.x, k * a.y, k * a.z}; }
inline double dot(Vec a, Vec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(Vec a) { return std::sqrt(dot(a, a)); }
inline Vec normalize(Vec a) { return (1 / length(a)) * a; }
inline Vec reflect(Vec v, Vec h) { return 2 * dot(v, h) * h + -1.0 * v; }

constexpr double kPi = 3.14159265358979323846;

// A world whose light grows along a direction, another for each channel. Seen by a matte surface, it grows 2/3 as much.
inline Vec lightFrom(Vec d) {
    return {1 + 0.8 * d.z, 1 + 0.5 * d.x - 0.4 * d.y, 1 - 0.6 * d.x + 0.3 * d.y - 0.5 * d.z};
}

// What a leaf's node is given, by name. Words and switches are known while compiling; numbers are not.
struct Inputs {
    std::map<std::string, std::string> words = {};
    std::map<std::string, bool> switches = {};
    std::map<std::string, std::vector<float>> numbers = {};
    // `roughness` is one number, and the leaf can see that.
    bool isotropic = false;
    // Of the surface, per unit of length; the functions that ask for derivatives see it.
    float curvature = 0;
};

// The library that the program comes with.
struct BuiltIn {
    NameTable names{namesOf(builtinLibrary())};
    std::unique_ptr<Library> library = openLibrary(names, builtinLibrary());

    // The leaves, which are those whose name makes that of a function by adding "_environment".
    std::vector<std::string> leaves() {
        const std::string_view end = "_environment";
        std::vector<std::string> all;
        for (const sl::Signature& s : library->signatures()) {
            const std::string name(names.text(s.name));
            if (name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0)
                all.push_back(name.substr(0, name.size() - end.size()));
        }
        return all;
    }
};

// One function of the library, specialised as a shader's would be. The surface faces z, its tangent is x.
class Call {
  public:
    Call(BuiltIn& builtIn, const std::string& function, const Inputs& inputs) : module_(builtIn.names) {
        module_.sources.push_back(builtIn.library.get());
        build(builtIn.names.intern(function), builtIn.names.intern("the call"), inputs);
        if (failed()) return;
        interpreter_ = std::make_unique<ir::Interpreter>(module_, diagnostics_);
        entry_ = module_.find(builtIn.names.intern("the call"));
        results_.resize(4 * entry_->results.size());
        for (int i = 0; i < 4; i++) lanes_[i].place = {i % 2, i / 2};
        set(inputs);
    }

    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

    bool failed() const { return diagnostics_.hasErrors(); }
    std::string errors() const { return diagnostics_.text(); }

    // Changes numbers; what the function does not ask for is ignored.
    void set(const Inputs& inputs) {
        for (const auto& [name, values] : inputs.numbers) number(name, values);
        for (const char* normal : {"N", "normal"}) {
            for (int i = 0; i < 4; i++) {
                const Vec n = normalize({i % 2 * inputs.curvature, i / 2 * inputs.curvature, 1});
                put(normal, i, {float(n.x), float(n.y), float(n.z)});
            }
        }
        number("X", {1, 0, 0});
    }
    void number(const std::string& name, const std::vector<float>& values) {
        for (int i = 0; i < 4; i++) put(name, i, values);
    }
    void vector(const std::string& name, Vec v) { number(name, {float(v.x), float(v.y), float(v.z)}); }

    // The first three numbers of the result.
    Vec run() {
        bool fine = false;
        if (derivatives_) {
            ir::Environment* lanes[4] = {&lanes_[0], &lanes_[1], &lanes_[2], &lanes_[3]};
            fine = interpreter_->runQuad(*entry_, arguments_, results_, lanes);
        } else {
            fine = interpreter_->run(*entry_, {arguments_.data(), slots_.size()},
                                     {results_.data(), results_.size() / 4}, lanes_[0]);
        }
        if (!fine) ADD_FAILURE() << errors();
        const ir::Value& r = results_[0];
        return ir::componentCount(r.type) == 1 ? Vec{r.f(0), r.f(0), r.f(0)} : Vec{r.f(0), r.f(1), r.f(2)};
    }

  private:
    struct Lane final : ir::Environment {
        std::pair<int, int> place;
        bool context(ir::Context c, ir::Value& value) override {
            switch (c) {
                case ir::Context::PositionWorld:
                    value.set(0, static_cast<float>(place.first));
                    value.set(1, static_cast<float>(place.second));
                    value.set(2, 0);
                    return true;
                case ir::Context::EnvironmentSamples:
                    value.words[0] = 1024;
                    return true;
                case ir::Context::EnvironmentMips:
                    value.words[0] = 1;
                    return true;
                case ir::Context::EnvironmentMatrix:
                    for (int i = 0; i < 16; i++) value.set(i, i % 5 == 0 ? 1.0f : 0.0f);
                    return true;
                default:
                    return false;
            }
        }
        bool texture(const ir::TextureRead& read, ir::Value& value) override {
            const double azimuth = 2 * kPi * (read.uv[0] - 0.5), height = kPi * (0.5 - read.uv[1]);
            const Vec d{std::cos(height) * std::sin(azimuth), std::sin(height), -std::cos(height) * std::cos(azimuth)};
            const bool even = read.texture.context == ir::Context::EnvironmentIrradiance;
            const Vec light = lightFrom((even ? 2.0 / 3 : 1) * d);
            for (int i = 0; i < 4; i++) value.set(i, static_cast<float>(i == 0 ? light.x : i == 1 ? light.y : light.z));
            return true;
        }
    };

    // The function, with words and switches filled in, and with the others as parameters.
    void build(Name function, Name entry, const Inputs& inputs) {
        const ir::Function* callee = module_.find(function);
        if (!callee) {
            diagnostics_.error("no-function",
                               "the library has no function " + std::string(module_.names->text(function)));
            return;
        }
        ir::Function& f = module_.add(entry);
        std::vector<ir::Type> types;
        for (const ir::Param& p : callee->params) {
            const std::string name(module_.names->text(p.name));
            if (p.type == ir::Type::String || p.type == ir::Type::Boolean) continue;
            const bool one = inputs.isotropic && name == "roughness" && p.type == ir::Type::Vector2;
            slots_[name] = f.params.size();
            f.params.push_back({p.name, one ? ir::Type::Float : p.type});
        }
        ir::Builder b(module_, f);
        std::vector<ir::ExprId> arguments;
        for (const ir::Param& p : callee->params) {
            const std::string name(module_.names->text(p.name));
            if (p.type == ir::Type::String) {
                arguments.push_back(b.string(module_.names->intern(inputs.words.at(name))));
            } else if (p.type == ir::Type::Boolean) {
                arguments.push_back(b.boolean(inputs.switches.at(name)));
            } else {
                const ir::ExprId value = b.param(static_cast<std::uint32_t>(slots_[name]));
                arguments.push_back(b.type(value) == p.type ? value : b.make(p.type, {value, value}));
            }
        }
        const ir::Type type = callee->results[0].type;
        const bool single = callee->results.size() == 1;
        const ir::ExprId call = b.call(function, single ? type : ir::Type::Tuple, arguments);
        b.addResult(module_.names->intern("out"), single ? call : b.result(call, 0, type));
        if (!passes::specialise(module_, entry, {}, diagnostics_)) return;
        for (const auto& own : module_.functions)
            for (const ir::Expr& e : own->exprs) derivatives_ |= e.op == ir::Op::Ddx || e.op == ir::Op::Ddy;
        arguments_.resize(4 * slots_.size());
        for (int i = 0; i < 4; i++)
            for (std::size_t k = 0; k < slots_.size(); k++)
                arguments_[i * slots_.size() + k].type = module_.find(entry)->params[k].type;
    }

    void put(const std::string& name, int lane, const std::vector<float>& values) {
        const auto slot = slots_.find(name);
        if (slot == slots_.end()) return;
        ir::Value& v = arguments_[lane * slots_.size() + slot->second];
        for (std::size_t i = 0; i < values.size(); i++) v.set(static_cast<int>(i), values[i]);
    }

    ir::Module module_;
    Diagnostics diagnostics_;
    std::unique_ptr<ir::Interpreter> interpreter_;
    const ir::Function* entry_ = nullptr;
    std::map<std::string, std::size_t> slots_;
    std::vector<ir::Value> arguments_, results_;  // of four lanes
    Lane lanes_[4];
    bool derivatives_ = false;
};

}  // namespace shaderx::tests
