// SPDX-License-Identifier: Apache-2.0
// One look at every triangle.
#include "host/scene_summary.h"

#include "core/parallel.h"

namespace ovc {

struct Census {
    Dropped dropped;
    Box bounds;
};

static Census join(Census a, const Census& b) {
    a.dropped.not_finite += b.dropped.not_finite;
    a.dropped.degenerate += b.dropped.degenerate;
    a.bounds.add(b.bounds);
    return a;
}

static Census count(const Chunk& chunk) {
    return parallel_reduce(
        chunk.size(), Census{},
        [&](size_t first, size_t last, Census census) {
            for (size_t prim = first; prim < last; ++prim) {
                const Triangle triangle = chunk.triangle(uint32_t(prim));
                switch (triangle_fault(triangle)) {
                case TriangleFault::NotFinite:
                    ++census.dropped.not_finite;
                    break;
                case TriangleFault::Degenerate:
                    ++census.dropped.degenerate;
                    break;
                case TriangleFault::None:
                    census.bounds.add(bounds_of(triangle));
                    break;
                }
            }
            return census;
        },
        join);
}

static uint64_t triangles_without_normals(const Scene& scene) {
    uint64_t triangles = 0;
    for (size_t m = 0; m < scene.meshes.size(); ++m)
        if (scene.meshes[m].normals.empty())
            triangles += scene.soup.chunks[m].size();
    return triangles;
}

static bool any_mirror(const Scene& scene) {
    for (const MeshInfo& mesh : scene.meshes)
        if (mesh.material < scene.materials.size() && scene.materials[mesh.material].mirror > 0)
            return true;
    return false;
}

SceneSummary summarize(const Scene& scene) {
    SceneSummary summary;
    summary.triangles = scene.soup.triangle_count();
    summary.meshes = scene.soup.chunks.size();
    Census census;
    for (const Chunk& chunk : scene.soup.chunks)
        census = join(census, count(chunk));
    summary.dropped = census.dropped;
    summary.bounds = census.bounds;

    const uint64_t flat = triangles_without_normals(scene);
    summary.needs.vertex_normals = flat < summary.triangles;
    summary.needs.reflection = any_mirror(scene);
    if (flat > 0)
        summary.left_out.push_back({"vertex normals", flat * 3 * sizeof(vec3)});
    summary.left_out.push_back({"texture coordinates", summary.triangles * 3 * sizeof(vec2)});
    if (!summary.needs.reflection)
        summary.left_out.push_back({"reflection rays", 0});
    summary.left_out.push_back({"refraction rays", 0});
    return summary;
}

Box hittable_bounds(const Soup& soup) {
    Box bounds;
    for (const Chunk& chunk : soup.chunks)
        bounds.add(count(chunk).bounds);
    return bounds;
}

} // namespace ovc
