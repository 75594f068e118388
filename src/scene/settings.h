// What is to be drawn, but for the material's program.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace shaderx::scene {

// The picture behind one sampler uniform of a material.
struct Texture {
    std::string uniform;
    std::string file;  // a path as it can be opened; empty: the default colour
    std::string uAddress = "periodic",
                vAddress = "periodic";  // constant (default colour), black, clamp, periodic, mirror
    std::string filter = "linear";      // closest, linear, cubic (drawn as linear)
    float defaultColor[4] = {0, 0, 0, 0};
    // For messages: the input's path in the document, and its place there.
    std::string documentPath;
    Location where{};
};

// Replaces the value a uniform would have: as many values as it has components (matrices column by column), or a
// multiple of it for an array. Integers and booleans are rounded. `u_lightData[0].intensity` is a name too.
struct UniformValue {
    std::string name;
    std::vector<float> values;
};

// The space that a shader works in where that is not linear Rec. 709: the light of the scene is taken to it, and
// pictures for displays from it.
struct WorkingSpace {
    enum class Curve { Linear, Srgb, Gamma };
    std::array<float, 9> toRec709, fromRec709;  // of linear values, row by row
    Curve curve = Curve::Linear;                // how values are encoded
    float gamma = 1;
};

struct Settings {
    std::vector<Texture> textures;
    int size = 512;           // pixels a side
    int samples = 1024;       // u_envRadianceSamples
    std::string environment;  // latitude-longitude picture of radiance; empty: the built-in sky
    float exposure = 0;       // in stops, for .png only
    std::string output;       // .png (sRGB), .exr or .pfm (what the shader gives, in its working space)
    std::optional<WorkingSpace> working;
    std::vector<UniformValue> uniforms;
    // What vertex attributes are that the sphere lacks; 0 where nothing says so.
    std::vector<UniformValue> attributes;
    // Values that uniforms in blocks have unless the scene or `uniforms` sets them: such uniforms have no defaults of
    // their own.
    std::vector<UniformValue> defaults;
    // Pixels are averaged from supersample × supersample drawn ones. 0: 2 for a .png that stays cheap, otherwise 1.
    int supersample = 0;
};

}  // namespace shaderx::scene
