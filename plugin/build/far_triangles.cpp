// SPDX-License-Identifier: Apache-2.0
#include "plugin/build/far_triangles.h"

#include "kdtree/far_search.h"
#include "plugin/build/built_scene.h"

#include <algorithm>

namespace ovc {
namespace {

/// Each ray is tested with all of them, eight rays at a time.
constexpr size_t kMaxOfScene = FarSearch::kMax;
/// A leaf reaches far if it is at least this part of the scene.
constexpr double kMinReach = 1.0 / 4;

/// Returns the triangles of the leaf; none where they are not few, not far, or one is too thin.
std::vector<NumberedTriangle> far_triangles_of(const BuiltScene& scene, const Leaf& leaf) {
    if (leaf.list().size() > kMaxOfScene ||
        max_component(leaf.box.extent()) < kMinReach * max_component(scene.level1.bounds.extent()))
        return {};
    std::vector<NumberedTriangle> all;
    for (const TriangleId id : leaf.list()) {
        const NumberedTriangle one{scene.soup.triangle(id), scene.numbers.of(id)};
        if (!far_triangle(one.corners, one.number))
            return {};
        all.push_back(one);
    }
    return all;
}

bool contains(std::span<const NumberedTriangle> triangles, uint32_t number) {
    return std::ranges::find(triangles, number, &NumberedTriangle::number) != triangles.end();
}

} // namespace

FarTriangles far_triangles_of(const BuiltScene& scene) {
    // Pages of meshes that came to rest hang in one tree with those of level 1.
    if (std::ranges::any_of(scene.shared, &SharedMesh::is_home))
        return {};
    FarTriangles far;
    std::vector<NumberedTriangle> triangles;
    // The parts that the top-level tree is left with. A mesh without hittable triangles is none.
    auto left = std::ranges::count_if(
        scene.shared, [](const SharedMesh& mesh) { return !mesh.scene.pages.empty(); });
    for (const LeafRange& part : parts_of(scene.level1)) {
        std::vector<NumberedTriangle> own;
        if (part.count == 1)
            own = far_triangles_of(scene, scene.level1.leaves[part.first]);
        if (own.empty() || triangles.size() + own.size() > kMaxOfScene) {
            ++left;
            continue;
        }
        far.leaves.push_back(part.first);
        for (const NumberedTriangle& triangle : own) // leaves share triangles
            if (!contains(triangles, triangle.number))
                triangles.push_back(triangle);
    }
    far.triangles = far_triangles(triangles); // all of them: none is too thin
    return left > 0 ? far : FarTriangles();
}

} // namespace ovc
