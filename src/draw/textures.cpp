#include "draw/textures.h"

#include <algorithm>

#include <fmt/format.h>

#include "scene/picture.h"

namespace shaderx::draw {

using image::Image;

TextureSet::~TextureSet() {
    gl_.deleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
    gl_.deleteSamplers(static_cast<GLsizei>(samplers_.size()), samplers_.data());
}

GLuint TextureSet::upload(const Image& picture, bool levels) {
    const Image rgba = toRgba(picture);
    GLuint texture = 0;
    gl_.genTextures(1, &texture);
    textures_.push_back(texture);
    gl_.bindTexture(GL_TEXTURE_2D, texture);
    const void* values = rgba.isFloat ? static_cast<const void*>(rgba.floats.data()) : rgba.bytes.data();
    gl_.texImage2D(GL_TEXTURE_2D, 0, rgba.isFloat ? GL_RGBA32F : GL_RGBA8, rgba.width, rgba.height, 0, GL_RGBA,
                   rgba.isFloat ? GL_FLOAT : GL_UNSIGNED_BYTE, values);
    if (levels)
        gl_.generateMipmap(GL_TEXTURE_2D);
    else
        gl_.texParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    return texture;
}

GLuint TextureSet::addSampler(GLint u, GLint v, GLint minify, GLint magnify, const float* border) {
    GLuint sampler = 0;
    gl_.genSamplers(1, &sampler);
    samplers_.push_back(sampler);
    gl_.samplerParameteri(sampler, GL_TEXTURE_WRAP_S, u);
    gl_.samplerParameteri(sampler, GL_TEXTURE_WRAP_T, v);
    gl_.samplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, minify);
    gl_.samplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, magnify);
    if (border) gl_.samplerParameterfv(sampler, GL_TEXTURE_BORDER_COLOR, border);
    return sampler;
}

Bound TextureSet::addMap(const Image& map, bool levels) {
    const GLuint texture = upload(map, levels);
    return {texture,
            addSampler(GL_REPEAT, GL_REPEAT, levels ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR, GL_LINEAR, nullptr)};
}

Bound TextureSet::addColour(const float (&rgba)[4]) {
    Image picture = Image::ofFloats(1, 1, 4);
    std::copy(std::begin(rgba), std::end(rgba), picture.floats.begin());
    return addMap(picture, false);
}

GLuint TextureSet::load(const Texture& texture, Diagnostics& diagnostics) {
    if (const auto known = files_.find(texture.file); known != files_.end()) return known->second;
    GLuint& out = files_[texture.file];
    Diagnostics reading;
    Result<Image> picture = image::readImage(texture.file, reading);
    if (!picture) {
        scene::warnOfMissing(texture, reading, diagnostics);
        return 0;
    }
    GLint maxSide = 0;
    gl_.getIntegerv(GL_MAX_TEXTURE_SIZE, &maxSide);
    if (picture->width > maxSide || picture->height > maxSide) {
        Diagnostic& warning = diagnostics.warning(
            "texture-reduced", fmt::format("the picture of {}×{} pixels is halved to fit the driver's {} a side",
                                           picture->width, picture->height, maxSide));
        warning.where.file = texture.file;
        warning.path = texture.documentPath;
    }
    while (picture->width > maxSide || picture->height > maxSide) picture = halved(*picture);
    return out = upload(flipped(*picture), true);
}

static GLint wrapOf(const std::string& address) {
    if (address == "constant" || address == "black") return GL_CLAMP_TO_BORDER;
    if (address == "clamp") return GL_CLAMP_TO_EDGE;
    if (address == "mirror") return GL_MIRRORED_REPEAT;
    return GL_REPEAT;
}

Bound TextureSet::addMaterial(const Texture& texture, Diagnostics& diagnostics) {
    const GLuint loaded = texture.file.empty() ? 0 : load(texture, diagnostics);
    if (!loaded) return addColour(texture.defaultColor);
    const bool closest = texture.filter == "closest";
    const bool isBlack = texture.uAddress == "black" || texture.vAddress == "black";
    const float black[4] = {0, 0, 0, 0};
    return {loaded, addSampler(wrapOf(texture.uAddress), wrapOf(texture.vAddress),
                               closest ? GL_NEAREST_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR,
                               closest ? GL_NEAREST : GL_LINEAR, isBlack ? black : texture.defaultColor)};
}

}  // namespace shaderx::draw
