#include "table/world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace shaderx::table {

using namespace ir;

const std::vector<float>& picture(int index) {
    static const std::array<std::vector<float>, kPictures> all = [] {
        std::array<std::vector<float>, kPictures> made;
        std::mt19937 random(17);
        for (auto& p : made)
            for (int i = 0; i < kPictureSize * kPictureSize * 4; i++)
                p.push_back(static_cast<float>(random() % 1000) / 1000.0f);
        return made;
    }();
    return all[static_cast<std::size_t>(index)];
}

std::string pictureName(int index) { return "table_picture" + std::to_string(index); }

static void fill(Value& v, std::string_view name) {
    std::mt19937 random(hashText(name));
    const TypeInfo& t = info(v.type);
    float length = 0;
    for (int i = 0; i < componentCount(v.type); i++) {
        float x = static_cast<float>(random() % 2001) / 1000.0f - 1.0f;
        if (t.columns > 1) x = x * 0.3f + (i % (t.rows + 1) == 0 ? 1.0f : 0.0f);
        v.set(i, x);
        length += x * x;
    }
    const bool isDirection =
        name.find("ormal") != name.npos || name.find("angent") != name.npos || name.find("irection") != name.npos;
    for (int i = 0; isDirection && t.columns == 1 && i < t.rows; i++) v.set(i, v.f(i) / std::sqrt(length));
}

Value contextValue(Context c) {
    Value v;
    v.type = info(c).type;
    switch (info(v.type).scalar) {
        case Scalar::Boolean:
            v.words[0] = 1;
            return v;
        case Scalar::Integer:
            v.words[0] = c == Context::EnvironmentSamples ? 4 : c == Context::EnvironmentMips ? 3 : 0;
            return v;
        case Scalar::Float:
        case Scalar::None:
            break;
    }
    fill(v, info(c).host);
    return v;
}

Value attributeValue(std::string_view name, Type type) {
    Value v;
    v.type = type;
    fill(v, name);
    return v;
}

bool World::context(Context c, Value& v) {
    v = contextValue(c);
    return true;
}

bool World::attribute(Name name, Value& v) {
    v = attributeValue(names_.text(name), v.type);
    return true;
}

bool World::texture(const TextureRead& read, Value& v) {
    int index = read.texture.context == Context::EnvironmentRadiance ? kParameterPictures : kParameterPictures + 1;
    if (read.texture.kind == TextureRef::Kind::None) return false;
    if (read.texture.kind == TextureRef::Kind::Uniform)
        for (index = 0; index < kParameterPictures - 1 && pictureName(index) != names_.text(read.texture.uniform);)
            index++;
    const std::vector<float>& from = picture(index);
    int low[2], high[2];
    float part[2];
    for (int i = 0; i < 2; i++) {
        float at = read.uv[i] * kPictureSize - 0.5f;
        if (!(std::fabs(at) < 1e6f)) {  // nowhere
            for (int c = 0; c < componentCount(v.type); c++) v.set(c, std::numeric_limits<float>::quiet_NaN());
            return true;
        }
        low[i] = static_cast<int>(std::floor(at));
        part[i] = at - std::floor(at);
        high[i] = (low[i] + 1) & (kPictureSize - 1);
        low[i] &= kPictureSize - 1;
    }
    auto texel = [&](int x, int y, int c) { return from[static_cast<std::size_t>((y * kPictureSize + x) * 4 + c)]; };
    for (int c = 0; c < std::min(4, componentCount(v.type)); c++) {
        const float near = texel(low[0], low[1], c) + part[0] * (texel(high[0], low[1], c) - texel(low[0], low[1], c));
        const float far =
            texel(low[0], high[1], c) + part[0] * (texel(high[0], high[1], c) - texel(low[0], high[1], c));
        v.set(c, near + part[1] * (far - near));
    }
    return true;
}

bool World::textureSize(const TextureRef&, Value& v) {
    v.set(0, kPictureSize);
    v.set(1, kPictureSize);
    return true;
}

}  // namespace shaderx::table
