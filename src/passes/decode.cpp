#include "passes/decode.h"

#include <algorithm>
#include <string>
#include <vector>

#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

bool isRead(const Expr& e) { return e.op == Op::TextureLevel || e.op == Op::TextureGrad; }

// The conversion of a texture, none where it is no parameter that has one.
Name conversionOf(const Function& f, ExprId texture, std::span<const Name> conversions) {
    const Expr& e = f[texture];
    return e.op == Op::Param && e.payload < conversions.size() ? conversions[e.payload] : Name();
}

// What a call's function has to convert.
std::vector<Name> conversionsOfCall(const Function& f, const Expr& call, std::span<const Name> conversions) {
    std::vector<Name> passed;
    for (ExprId argument : f.operandsOf(call)) passed.push_back(conversionOf(f, argument, conversions));
    return passed;
}

bool isAny(std::span<const Name> conversions) {
    return std::any_of(conversions.begin(), conversions.end(), [](Name n) { return static_cast<bool>(n); });
}

Name nameOfCopy(NameTable& names, Name function, std::span<const Name> conversions) {
    std::string text(names.text(function));
    for (Name n : conversions) text.append(1, '@').append(names.text(n));
    return names.intern(text);
}

}  // namespace

bool isPlainRead(const Function& f) {
    int reads = 0;
    for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
        const Expr& e = f.exprs[i];
        if (isRead(e)) reads++;
        if (e.op != Op::Call) continue;
        for (ExprId argument : f.operandsOf(e))
            if (f[argument].type == Type::Texture2D) return false;
    }
    return reads <= 1;
}

Name decodeReads(Module& module, Name function, std::span<const Name> conversions) {
    const Name name = nameOfCopy(*module.names, function, conversions);
    if (module.find(name)) return name;
    const Function* found = module.find(function);
    if (!found) return {};
    const Function from = *found;  // the module may move its own
    Function fresh = headOf(from);
    fresh.name = name;
    Builder b(module, fresh);
    Copy copy(from, b);
    for (std::uint32_t i = 0; i < from.exprs.size(); i++) {
        const ExprId id(i);
        const Expr& e = from.exprs[i];
        copy.one(id);
        if (isRead(e)) {
            const Name conversion = conversionOf(from, from.operand(id, 0), conversions);
            const ExprId read = copy[id];
            if (conversion) copy.set(id, b.call(conversion, Type::Color4, std::span(&read, 1)));
        } else if (e.op == Op::Call) {
            const std::vector<Name> passed = conversionsOfCall(from, e, conversions);
            if (!isAny(passed)) continue;
            const Name callee = decodeReads(module, Name(e.payload), passed);
            if (!callee) return {};
            const std::span<const ExprId> operands = copy.operands(id);
            copy.set(id, b.call(callee, e.type, std::vector<ExprId>(operands.begin(), operands.end())));
        }
    }
    for (const ResultValue& r : from.results) b.addResult(r.name, copy[r.value]);
    compact(fresh);
    module.put(std::move(fresh));
    return name;
}

}  // namespace shaderx::passes
