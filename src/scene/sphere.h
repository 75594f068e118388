// The sphere and the camera: numbers only, no driver.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace shaderx::scene {

using Matrix = std::array<float, 16>;  // column by column

// A mesh with one array an attribute.
struct Mesh {
    std::vector<float> positions, normals, tangents, bitangents;  // 3 each
    std::vector<float> texcoords;                                 // 2; v = 0 is the south pole
    std::vector<float> colors;                                    // 4: u, 1 - v, 0.5, 1
    std::vector<unsigned> triangles;                              // counter-clockwise from outside
};

// The arrays of a mesh that vertex attributes are bound to.
enum class MeshArray : int { None = -1, Positions, Normals, Tangents, Bitangents, Texcoords, Colors };
constexpr int kMeshArrays = 6;
inline constexpr int kMeshComponents[kMeshArrays] = {3, 3, 3, 3, 2, 4};

// What an attribute of the vertex stage is bound to, by the name that hosts know: i_normal, i_texcoord_0, and texture
// coordinates by the names that other tools give them as primitive variables (st in USD and Houdini, uv, map1 in Maya,
// UVMap in Blender, TEXCOORD_0 in glTF).
MeshArray meshArrayOf(std::string_view attribute);
const std::vector<float>& valuesOf(const Mesh& mesh, MeshArray array);

// The unit sphere about the origin, `around` × `down` patches, y up; tangents point to growing u.
Mesh makeSphere(int around, int down);

struct NamedMatrix {
    std::string uniform;
    Matrix value;
};

constexpr float kEyeDistance = 4;  // along z, in metres

// The matrices of the white paper's Figure 7, and u_envMatrix.
std::vector<NamedMatrix> sceneMatrices();

}  // namespace shaderx::scene
