#include "scene/sphere.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace shaderx::scene {

using std::numbers::pi;

MeshArray meshArrayOf(std::string_view attribute) {
    constexpr std::string_view kPrefixes[kMeshArrays] = {"i_position",  "i_normal",   "i_tangent",
                                                         "i_bitangent", "i_texcoord", "i_color"};
    for (int i = 0; i < kMeshArrays; i++)
        if (attribute.starts_with(kPrefixes[i])) return static_cast<MeshArray>(i);
    constexpr std::string_view kProperty = "i_geomprop_";
    constexpr std::string_view kTexcoords[] = {
        "st",  "st0", "st1",  "st_0",  "st_1",  "uv",       "uv0",        "uv1",        "uv_0",       "uv_1",
        "UV0", "UV1", "map1", "UVMap", "UVSet", "texcoord", "texcoord_0", "texcoord_1", "TEXCOORD_0", "TEXCOORD_1"};
    if (!attribute.starts_with(kProperty)) return MeshArray::None;
    attribute.remove_prefix(kProperty.size());
    const bool isTexcoord = std::find(std::begin(kTexcoords), std::end(kTexcoords), attribute) != std::end(kTexcoords);
    return isTexcoord ? MeshArray::Texcoords : MeshArray::None;
}

const std::vector<float>& valuesOf(const Mesh& mesh, MeshArray array) {
    const std::vector<float>* const arrays[kMeshArrays] = {&mesh.positions,  &mesh.normals,   &mesh.tangents,
                                                           &mesh.bitangents, &mesh.texcoords, &mesh.colors};
    return *arrays[static_cast<int>(array)];
}

Mesh makeSphere(int around, int down) {
    Mesh mesh;
    const auto add3 = [](std::vector<float>& to, float x, float y, float z) { to.insert(to.end(), {x, y, z}); };
    for (int j = 0; j <= down; j++)
        for (int i = 0; i <= around; i++) {
            const float u = static_cast<float>(i) / static_cast<float>(around);
            const float v = static_cast<float>(j) / static_cast<float>(down);
            // Angles are products in double precision: single precision would leave the seam open.
            const float theta = static_cast<float>(v * pi), phi = static_cast<float>(u * 2 * pi);
            const float st = std::sin(theta), ct = std::cos(theta), sp = std::sin(phi), cp = std::cos(phi);
            const float nx = -st * sp, ny = ct, nz = -st * cp;
            const float tx = -cp, ty = 0, tz = sp;
            add3(mesh.positions, nx, ny, nz);
            add3(mesh.normals, nx, ny, nz);
            add3(mesh.tangents, tx, ty, tz);
            add3(mesh.bitangents, ny * tz - nz * ty, nz * tx - nx * tz, nx * ty - ny * tx);
            mesh.texcoords.insert(mesh.texcoords.end(), {u, 1 - v});
            mesh.colors.insert(mesh.colors.end(), {u, v, 0.5f, 1});
        }
    const unsigned row = static_cast<unsigned>(around) + 1;
    for (unsigned j = 0; j < static_cast<unsigned>(down); j++)
        for (unsigned i = 0; i + 1 < row; i++) {
            const unsigned above = j * row + i, below = above + row;
            mesh.triangles.insert(mesh.triangles.end(), {above, below, above + 1, above + 1, below, below + 1});
        }
    return mesh;
}

static Matrix diagonal(float x, float y, float z) { return {x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1}; }

static Matrix translation(float z) {
    Matrix out = diagonal(1, 1, 1);
    out[14] = z;
    return out;
}

static Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t c = 0; c < 4; c++)
        for (std::size_t r = 0; r < 4; r++)
            for (std::size_t k = 0; k < 4; k++) out[c * 4 + r] += a[k * 4 + r] * b[c * 4 + k];
    return out;
}

static Matrix transposed(const Matrix& a) {
    Matrix out{};
    for (std::size_t c = 0; c < 4; c++)
        for (std::size_t r = 0; r < 4; r++) out[c * 4 + r] = a[r * 4 + c];
    return out;
}

std::vector<NamedMatrix> sceneMatrices() {
    const float nearPlane = 0.1f, farPlane = 50;
    const float scale = 1 / std::tan(static_cast<float>(17.5 * pi / 180));  // half of 35°
    const float a = (farPlane + nearPlane) / (nearPlane - farPlane);
    const float b = 2 * farPlane * nearPlane / (nearPlane - farPlane);
    const Matrix projection{scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, a, -1, 0, 0, b, 0};
    const Matrix unprojection{1 / scale, 0, 0, 0, 0, 1 / scale, 0, 0, 0, 0, 0, 1 / b, 0, 0, -1, a / b};
    const Matrix identity = diagonal(1, 1, 1), view = translation(-kEyeDistance),
                 viewInverse = translation(kEyeDistance);
    const Matrix viewProjection = product(projection, view);
    return {
        {"u_worldMatrix", identity},
        {"u_worldInverseMatrix", identity},
        {"u_worldTransposeMatrix", identity},
        {"u_worldInverseTransposeMatrix", identity},
        {"u_viewMatrix", view},
        {"u_viewInverseMatrix", viewInverse},
        {"u_viewTransposeMatrix", transposed(view)},
        {"u_viewInverseTransposeMatrix", transposed(viewInverse)},
        {"u_projectionMatrix", projection},
        {"u_projectionInverseMatrix", unprojection},
        {"u_projectionTransposeMatrix", transposed(projection)},
        {"u_projectionInverseTransposeMatrix", transposed(unprojection)},
        {"u_worldViewMatrix", view},
        {"u_viewProjectionMatrix", viewProjection},
        {"u_worldViewProjectionMatrix", viewProjection},
        {"u_envMatrix", diagonal(-1, 1, -1)},
    };
}

}  // namespace shaderx::scene
