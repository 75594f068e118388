// What functions under test ask of the world: the same fixed values for the interpreter and for the driver.
#pragma once

#include <vector>

#include "ir/interpret.h"

namespace shaderx::table {

constexpr int kPictureSize = 8;  // pixels a side
// Textures 0 … 3 are those of parameters, then come the radiance and the irradiance of the environment.
constexpr int kPictures = 6;
constexpr int kParameterPictures = 4;

// RGBA of a picture, bottom row first: smooth enough to be compared, no two channels alike.
const std::vector<float>& picture(int index);

// The uniform that stands for a parameter's texture.
std::string pictureName(int index);

// The value of a context or of a geometric attribute. Directions have unit length, matrices are well conditioned.
ir::Value contextValue(ir::Context c);
ir::Value attributeValue(std::string_view name, ir::Type type);

// All of it for the interpreter.
class World final : public ir::Environment {
  public:
    explicit World(NameTable& names) : names_(names) {}
    bool context(ir::Context c, ir::Value& v) override;
    bool attribute(Name name, ir::Value& v) override;
    bool texture(const ir::TextureRead& read, ir::Value& v) override;
    bool textureSize(const ir::TextureRef& ref, ir::Value& v) override;

  private:
    NameTable& names_;
};

}  // namespace shaderx::table
