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
        if (scene.normals_of(scene.meshes[m]).empty())
            triangles += scene.soup.chunks[m].size();
    return triangles;
}

/// True when the material of some mesh has it.
template <class Has>
static bool any_material(const Scene& scene, Has&& has) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(), [&](const MeshInfo& mesh) {
        return mesh.material < scene.materials.size() && has(scene.materials[mesh.material]);
    });
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
    summary.needs.refraction =
        any_material(scene, [](const Material& m) { return m.transmission > 0; });
    // Where light is let through it may be reflected totally.
    summary.needs.reflection = summary.needs.refraction ||
                               any_material(scene, [](const Material& m) { return m.mirror > 0; });
    if (flat > 0)
        summary.left_out.push_back({"vertex normals", flat * 3 * sizeof(vec3)});
    summary.left_out.push_back({"texture coordinates", summary.triangles * 3 * sizeof(vec2)});
    if (!summary.needs.reflection)
        summary.left_out.push_back({"reflection rays", 0});
    if (!summary.needs.refraction)
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
