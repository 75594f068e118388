// Pictures as the driver's textures.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "draw/driver.h"
#include "draw/job.h"
#include "image/image.h"

namespace shaderx::draw {

// What a sampler uniform reads: a texture, and how it is read.
struct Bound {
    GLuint texture = 0, sampler = 0;
};

// The textures of one job, or of a context. Files are read once. Frees what it made.
class TextureSet {
  public:
    explicit TextureSet(const Gl& gl) : gl_(gl) {}
    ~TextureSet();
    TextureSet(const TextureSet&) = delete;
    TextureSet& operator=(const TextureSet&) = delete;

    // A map of the environment: the picture's first row at v = 0, repeating, linear, with or without levels.
    Bound addMap(const image::Image& map, bool levels);
    // A material's picture: its bottom row at v = 0, all levels, values as in the file. One that cannot be read is a
    // warning and a picture of the default colour.
    Bound addMaterial(const Texture& texture, Diagnostics& diagnostics);
    // A picture of one colour.
    Bound addColour(const float (&rgba)[4]);

  private:
    GLuint upload(const image::Image& picture, bool levels);
    GLuint load(const Texture& texture, Diagnostics& diagnostics);
    GLuint addSampler(GLint u, GLint v, GLint minify, GLint magnify, const float* border);

    const Gl& gl_;
    std::map<std::string, GLuint> files_;  // 0: could not be read
    std::vector<GLuint> textures_, samplers_;
};

}  // namespace shaderx::draw
