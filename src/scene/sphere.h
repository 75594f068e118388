// The sphere and the camera: numbers only, no driver.
#pragma once

#include <array>
#include <string>
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
