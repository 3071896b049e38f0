// SPDX-License-Identifier: Apache-2.0
// Meshes are cut and placed here, not by Assimp's own steps: those end the process on a face
// without corners, and leave mirrored meshes inside out.
#include "importers/mesh/assimp_meshes.h"

#include "importers/file/available_memory.h"
#include "importers/file/text.h"
#include "importers/mesh/polygon.h"
#include "importers/pbrt/interpret/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace ovc {

namespace {

using Corners = std::array<uint32_t, 3>; // of a triangle: indices of vertices

/// The corners and normals of a triangle.
constexpr uint64_t kTriangleBytes = 6 * sizeof(vec3);

struct PlacedMesh {
    const aiMesh* mesh;
    dmat4 to_world;
};

dvec3 from(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

dmat4 from(const aiMatrix4x4& m) {
    return {m.a1, m.b1, m.c1, 0, m.a2, m.b2, m.c2, 0, m.a3, m.b3, m.c3, 0, m.a4, m.b4, m.c4, 1};
}

/// Returns the meshes in the order of a walk that goes down before it goes on.
std::vector<PlacedMesh> placed_meshes(const aiScene& found) {
    struct Open {
        const aiNode* node;
        dmat4 to_world;
    };
    std::vector<PlacedMesh> placed;
    std::vector<Open> open;
    if (found.mRootNode)
        open.push_back({found.mRootNode, from(found.mRootNode->mTransformation)});
    while (!open.empty()) {
        const auto [node, to_world] = open.back();
        open.pop_back();
        for (unsigned m = 0; m < node->mNumMeshes; ++m)
            if (node->mMeshes[m] < found.mNumMeshes)
                placed.push_back({found.mMeshes[node->mMeshes[m]], to_world});
        for (unsigned c = node->mNumChildren; c-- > 0;)
            open.push_back(
                {node->mChildren[c], to_world * from(node->mChildren[c]->mTransformation)});
    }
    return placed;
}

uint64_t triangle_count(const aiMesh& mesh) {
    uint64_t count = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
        count += std::max(mesh.mFaces[f].mNumIndices, 2u) - 2;
    return count;
}

bool has_its_vertices(const aiFace& face, const aiMesh& mesh) {
    return std::all_of(face.mIndices, face.mIndices + face.mNumIndices,
                       [&](unsigned vertex) { return vertex < mesh.mNumVertices; });
}

/// Cuts the faces into triangles, wound as the faces are.
std::vector<Corners> triangles_of(const aiMesh& mesh) {
    std::vector<Corners> triangles;
    triangles.reserve(triangle_count(mesh));
    std::vector<dvec3> polygon;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices < 3 || !has_its_vertices(face, mesh))
            continue;
        polygon.clear();
        for (unsigned i = 0; i < face.mNumIndices; ++i)
            polygon.push_back(from(mesh.mVertices[face.mIndices[i]]));
        const size_t first = triangles.size();
        triangulate(polygon, triangles);
        for (size_t t = first; t < triangles.size(); ++t)
            for (uint32_t& corner : triangles[t])
                corner = face.mIndices[corner];
    }
    return triangles;
}

/// Returns one normal per corner; none if one is missing or not finite, or if all triangles are
/// flat, because then they say nothing new.
std::vector<vec3> normals_from(const aiMesh& mesh, std::span<const Corners> triangles,
                               const dmat4& to_world) {
    if (!mesh.HasNormals())
        return {};
    const dmat3 turn = pbrt::normal_matrix(to_world);
    std::vector<vec3> normals;
    bool smooth = false;
    for (const Corners& triangle : triangles) {
        for (const uint32_t vertex : triangle) {
            const dvec3 normal = turn * from(mesh.mNormals[vertex]);
            const double length = glm::length(normal);
            if (!(length > 0) || !std::isfinite(length))
                return {};
            normals.emplace_back(normal / length);
        }
        smooth = smooth || normals.end()[-1] != normals.end()[-2] ||
                 normals.end()[-2] != normals.end()[-3];
    }
    return smooth ? normals : std::vector<vec3>();
}

/// Returns the texture coordinates of the set, one per corner; none if the mesh has no such set.
std::vector<vec2> uv_from(const aiMesh& mesh, std::span<const Corners> triangles, uint32_t set) {
    std::vector<vec2> uv;
    if (!mesh.HasTextureCoords(set))
        return uv;
    for (const Corners& triangle : triangles)
        for (const uint32_t vertex : triangle) {
            const aiVector3D& at = mesh.mTextureCoords[set][vertex];
            uv.emplace_back(std::isfinite(at.x) ? at.x : 0, std::isfinite(at.y) ? at.y : 0);
        }
    return uv;
}

void add_mesh(Scene& scene, const PlacedMesh& placed, uint32_t material,
              const AssimpMaterial& of_material, bool wants_uv) {
    const aiMesh& mesh = *placed.mesh;
    std::vector<Corners> triangles = triangles_of(mesh);
    if (triangles.empty())
        return;
    // A mirror turns a mesh with what is its front.
    if (pbrt::swaps_handedness(placed.to_world))
        for (Corners& triangle : triangles)
            std::swap(triangle[1], triangle[2]);
    std::vector<vec3> corners;
    corners.reserve(triangles.size() * 3);
    for (const Corners& triangle : triangles)
        for (const uint32_t vertex : triangle)
            corners.emplace_back(
                pbrt::point_through(placed.to_world, from(mesh.mVertices[vertex])));
    const uint64_t count = corners.size();
    scene.add_mesh(mesh.mName.length > 0 ? mesh.mName.C_Str() : scene.name, material,
                   Chunk::owning(dvec3(0), std::move(corners)),
                   normals_from(mesh, triangles, placed.to_world));
    MeshInfo& info = scene.meshes.back();
    info.normals_left_out = mesh.HasNormals() && info.normals.empty() ? count : 0;
    if (wants_uv)
        info.uv = uv_from(mesh, triangles, of_material.uv_set);
    if (info.uv.empty())
        info.texture_coordinates_left_out = mesh.HasTextureCoords(0) ? count : 0;
    else
        info.cutout = of_material.cutout;
}

} // namespace

Result<Done> add_meshes(const aiScene& found, std::span<const AssimpMaterial> materials,
                        const std::vector<bool>& on_uv, Scene& scene) {
    const std::vector<PlacedMesh> placed = placed_meshes(found);
    uint64_t count = 0;
    for (const PlacedMesh& each : placed)
        count += triangle_count(*each.mesh);
    if (count > available_memory() / kTriangleBytes)
        return Error{fmt::format("found {} of {} bytes, more than the memory that is free",
                                 counted(count, "triangle"), kTriangleBytes)};
    for (const PlacedMesh& each : placed) {
        const uint32_t named = each.mesh->mMaterialIndex;
        const uint32_t material = named < materials.size() ? named : 0;
        if (!materials[material].is_cut_away)
            add_mesh(scene, each, material, materials[material],
                     on_uv[material] || materials[material].cutout != kNone);
    }
    return Done{};
}

} // namespace ovc
