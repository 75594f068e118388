#include "passes/stages.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <unordered_map>
#include <unordered_set>

#include "passes/copy.h"

namespace shaderx::passes {

using namespace ir;

namespace {

// What a set of functions reads.
struct Reads {
    std::vector<bool> contexts = std::vector<bool>(kContexts);
    std::vector<std::pair<Name, Type>> attributes;
    std::unordered_set<Name> uniforms;
    std::unordered_map<Name, std::size_t> attributeNumbers;
    bool isMixed = false;  // an attribute is read with several numbers of components

    void add(const Function& f) {
        for (const Expr& e : f.exprs) {
            if (e.op > Op::Uniform) continue;
            if (e.op == Op::Context) contexts[e.payload] = true;
            if (e.op == Op::Attribute) addAttribute(Name(e.payload), e.type);
            if (e.op == Op::Uniform) uniforms.insert(Name(e.payload));
        }
    }

    // One attribute is carried once, with as many components as any reader wants.
    void addAttribute(Name name, Type type) {
        const auto [it, isNew] = attributeNumbers.insert({name, attributes.size()});
        if (isNew) attributes.emplace_back(name, type);
        Type& carried = attributes[it->second].second;
        if (componentCount(carried) == componentCount(type)) return;
        isMixed = true;
        if (componentCount(carried) < componentCount(type)) carried = type;
    }
    Type carried(Name name) const { return attributes[attributeNumbers.at(name)].second; }

    StageUniforms stage(const Module& module) const {
        StageUniforms s;
        for (int c = 0; c < kContexts; c++) {
            ContextSource source = info(static_cast<Context>(c)).source;
            if (contexts[static_cast<std::size_t>(c)] &&
                (source == ContextSource::Uniform || source == ContextSource::Texture))
                s.contexts.push_back(static_cast<Context>(c));
        }
        for (const Uniform& u : module.uniforms)
            if (uniforms.count(u.name)) s.uniforms.push_back(u.name);
        return s;
    }
};

// Reads the first components of an attribute that is carried with more.
void narrowReads(Module& module, Function& f, const Reads& reads) {
    Function fresh = headOf(f);
    Builder b(module, fresh);
    Copy copy(f, b);
    for (std::uint32_t i = 0; i < f.exprs.size(); i++) {
        const Expr& e = f.exprs[i];
        const Type carried = e.op == Op::Attribute ? reads.carried(Name(e.payload)) : e.type;
        const int n = componentCount(e.type);
        if (componentCount(carried) == n) {
            copy.one(ExprId(i));
            continue;
        }
        const ExprId whole = b.attribute(Name(e.payload), carried);
        copy.set(ExprId(i), b.convert(b.swizzle(whole, swizzleMask(n, 0, 1 % n, 2 % n)), e.type));
    }
    for (const ResultValue& r : f.results) b.addResult(r.name, copy[r.value]);
    compact(fresh);
    f = std::move(fresh);
}

struct VertexMaker {
    Module& module;
    Builder& b;

    ExprId input(Context c) { return b.context(c); }
    ExprId worldPosition() {
        ExprId p = b.make(Type::Vector4, {input(Context::VertexPosition), b.number(1)});
        ExprId world = b.op(Op::MulMatrix, {b.context(Context::WorldMatrix), p});
        b.hint(world, module.names->intern("positionWorld"));
        return world;
    }
    ExprId worldNormal() {
        ExprId m = b.make(Type::Matrix33, {b.context(Context::WorldInverseTransposeMatrix)});
        return b.op(Op::Normalize, {b.op(Op::MulMatrix, {m, input(Context::VertexNormal)})});
    }
    ExprId worldTangent() {
        ExprId m = b.make(Type::Matrix33, {b.context(Context::WorldMatrix)});
        return b.op(Op::Normalize, {b.op(Op::MulMatrix, {m, input(Context::VertexTangent)})});
    }

    ExprId value(Context c) {
        switch (c) {
            case Context::PositionWorld:
                return b.convert(b.swizzle(worldPosition(), swizzleMask(3, 0, 1, 2)), Type::Point);
            case Context::NormalWorld:
                return worldNormal();
            case Context::TangentWorld:
                return worldTangent();
            case Context::BitangentWorld:
                return b.op(Op::Cross, {worldNormal(), worldTangent()});
            case Context::PositionObject:
                return input(Context::VertexPosition);
            case Context::NormalObject:
                return input(Context::VertexNormal);
            case Context::TangentObject:
                return input(Context::VertexTangent);
            case Context::BitangentObject:
                return b.op(Op::Cross, {input(Context::VertexNormal), input(Context::VertexTangent)});
            default:
                return b.null(info(c).type);  // not carried from the vertex
        }
    }
};

}  // namespace

std::string inputName(std::string_view attribute) { return "i_" + std::string(attribute); }

ShaderInterface makeStages(Module& module, Name pixel, Name vertex) {
    ShaderInterface made;
    made.pixel = pixel;
    made.vertex = vertex;
    Reads reads;
    for (const auto& f : module.functions) reads.add(*f);
    made.pixelUniforms = reads.stage(module);
    for (auto& f : module.functions)
        if (reads.isMixed) narrowReads(module, *f, reads);

    Function f;
    f.name = vertex;
    Builder b(module, f);
    VertexMaker maker{module, b};
    ExprId clip = b.op(Op::MulMatrix, {b.context(Context::ViewProjectionMatrix), maker.worldPosition()});
    b.addResult(module.names->intern("position"), clip);
    for (int c = 0; c < kContexts; c++) {
        Context context = static_cast<Context>(c);
        if (!reads.contexts[static_cast<std::size_t>(c)] || info(context).source != ContextSource::Vertex) continue;
        made.varyings.push_back({module.names->intern(info(context).host), info(context).type});
        b.addResult(made.varyings.back().name, maker.value(context));
    }
    auto byText = [&](const auto& x, const auto& y) {
        return module.names->text(x.first) < module.names->text(y.first);
    };
    std::sort(reads.attributes.begin(), reads.attributes.end(), byText);
    for (auto [name, type] : reads.attributes) {
        made.varyings.push_back({name, type});
        b.addResult(name, b.attribute(name, type));
    }

    compact(f);
    Reads vertexReads;
    vertexReads.add(f);
    made.vertexUniforms = vertexReads.stage(module);
    for (int c = 0; c < kContexts; c++) {
        const ContextInfo& i = info(static_cast<Context>(c));
        if (vertexReads.contexts[static_cast<std::size_t>(c)] && i.source == ContextSource::Input)
            made.inputs.push_back({module.names->intern(i.host), i.type});
    }
    for (auto [name, type] : reads.attributes) {
        made.inputs.push_back({module.names->intern(inputName(module.names->text(name))), type});
        for (const AttributeDefault& usual : module.attributeDefaults)
            if (usual.attribute == name && usual.type == type && made.inputs.back().value.empty())
                made.inputs.back().value = usual.words;
    }
    module.put(std::move(f));
    return made;
}

std::vector<Context> blockContexts(const ShaderInterface& interface) {
    std::vector<Context> all;
    const auto &vertex = interface.vertexUniforms.contexts, &pixel = interface.pixelUniforms.contexts;
    std::set_union(vertex.begin(), vertex.end(), pixel.begin(), pixel.end(), std::back_inserter(all));
    std::erase_if(all, [](Context c) { return info(c).type == Type::Texture2D; });
    return all;
}

std::vector<Name> blockUniforms(const Module& module, const ShaderInterface& interface) {
    std::vector<Name> all;
    for (Name name : interface.pixelUniforms.uniforms)
        if (const Uniform* u = module.uniform(name); u && u->type != Type::Texture2D) all.push_back(name);
    return all;
}

std::uint32_t placeMember(Type type, std::uint32_t& end) {
    const TypeInfo& t = info(type);
    // A matrix is its columns, each as wide as four numbers.
    std::uint32_t align = t.columns > 1 || t.rows > 2 ? 16 : t.rows * 4u;
    std::uint32_t size = t.columns > 1 ? t.columns * 16u : t.rows * 4u;
    std::uint32_t at = (end + align - 1) / align * align;
    end = at + size;
    return at;
}

std::vector<std::uint32_t> defaultOf(Context c) {
    const ContextInfo& i = info(c);
    std::vector<std::uint32_t> words(static_cast<std::size_t>(componentCount(i.type)), 0);
    const std::uint32_t one = std::bit_cast<std::uint32_t>(1.0f), minusOne = std::bit_cast<std::uint32_t>(-1.0f);
    if (isMatrix(i.type))
        for (std::size_t k = 0; k < words.size(); k += info(i.type).rows + 1u) words[k] = one;
    switch (c) {
        case Context::EnvironmentMatrix:
            words[0] = words[10] = minusOne;
            break;  // half a turn about y
        case Context::EnvironmentIntensity:
            words[0] = one;
            break;
        case Context::EnvironmentMips:
            words[0] = 1;
            break;
        case Context::EnvironmentSamples:
            words[0] = 16;
            break;
        case Context::AlphaThreshold:
            words[0] = std::bit_cast<std::uint32_t>(0.001f);
            break;
        default:
            break;  // zero or the unit matrix
    }
    return words;
}

}  // namespace shaderx::passes
