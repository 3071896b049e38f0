// SPDX-License-Identifier: Apache-2.0
// One look at every triangle, and at each instance of a mesh.
#include "host/scene/scene_summary.h"

#include "core/system/parallel.h"
#include "core/transform.h"
#include "host/arguments/memory_size.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ovc {

struct Census {
    Dropped dropped;
    Box bounds;
};

static Census sum_of(Census a, const Census& b) {
    a.dropped.not_finite += b.dropped.not_finite;
    a.dropped.degenerate += b.dropped.degenerate;
    a.bounds.add(b.bounds);
    return a;
}

static Census count(const Chunk& chunk) {
    return parallel_reduce(
        chunk.size(), Census{},
        [&](size_t first, size_t last, Census census) {
            for_each_triangle(chunk, uint32_t(first), uint32_t(last),
                              [&](const Triangle& triangle) {
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
                              });
            return census;
        },
        sum_of);
}

namespace {

/// Looks at each mesh once, for all of its instances.
class Instances {
public:
    /// Returns whether the chunk is an instance of which nothing is dropped, and that lies within
    /// the bounds.
    bool adds_nothing(const Chunk& chunk, const Box& bounds) {
        const Transform* transform = chunk.transform();
        if (!transform || chunk.size() == 0)
            return false;
        const auto [place, is_new] = meshes_.try_emplace(chunk.mesh_key());
        if (is_new)
            place->second = count(chunk.unplaced());
        const Census& mesh = place->second;
        Box box = bounds;
        box.add(placed_box(mesh.bounds, transform));
        const bool is_inside = box.lo == bounds.lo && box.hi == bounds.hi;
        return is_inside && mesh.dropped.total() == 0 && is_well_placed(mesh.bounds, transform);
    }

private:
    std::map<Chunk::MeshKey, Census> meshes_;
};

} // namespace

static Census count(const Soup& soup) {
    Census all;
    Instances instances;
    for (const Chunk& chunk : soup.chunks)
        if (!instances.adds_nothing(chunk, all.bounds))
            all = sum_of(all, count(chunk));
    return all;
}

/// Returns the box with what can be hit of the chunk in it, too.
static Box grown(const Box& before, const Chunk& chunk) {
    return parallel_reduce(
        chunk.size(), before,
        [&](size_t first, size_t last, Box box) {
            for_each_triangle(chunk, uint32_t(first), uint32_t(last), [&](const Triangle& t) {
                // Most lie within what was found so far, and then it does not matter what they are.
                const bool is_inside =
                    box.contains(t[0]) && box.contains(t[1]) && box.contains(t[2]);
                if (!is_inside && triangle_fault(t) == TriangleFault::None)
                    box.add(bounds_of(t));
            });
            return box;
        },
        [](Box a, const Box& b) {
            a.add(b);
            return a;
        });
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
    const Census census = count(scene.soup);
    summary.dropped = census.dropped;
    summary.bounds = census.bounds;

    summary.needs = needs_of(scene);
    summary.left_out = left_out_of(scene, summary.needs);
    return summary;
}

Result<SceneSummary> summarize(const Scene& scene, const TriangleStore& store) {
    constexpr uint64_t kPart = 16384; // triangles in memory at once
    SceneSummary summary;
    summary.triangles = store.triangles();
    summary.meshes = store.meshes();
    Census all;
    std::vector<vec3> corners;
    for (size_t m = 0; m < store.meshes(); ++m)
        for (uint64_t first = 0; first < store.corners(m); first += corners.size()) {
            corners.resize(std::min(3 * kPart, store.corners(m) - first));
            if (!store.read_corners(m, first, corners))
                return *store.error();
            all = sum_of(all, count(Chunk::borrowing(scene.soup.chunks[m].origin(), corners)));
        }
    summary.dropped = all.dropped;
    summary.bounds = all.bounds;
    return summary;
}

Needs needs_of(const Scene& scene, const Query& query) {
    Needs needs;
    needs.vertex_normals = triangles_without_normals(scene) < scene.soup.triangle_count();
    needs.refraction = any_material(scene, [](const Material& m) { return m.transmission > 0; });
    // Where light is let through it may be reflected totally.
    needs.reflection =
        needs.refraction || any_material(scene, [](const Material& m) { return m.mirror > 0; });
    needs.shadows = query.shadows;
    needs.certified = query.certified;
    needs.several_leaves = query.leaves > 1;
    return needs;
}

std::vector<LeftOut> left_out_of(const Scene& scene, const Needs& needs) {
    std::vector<LeftOut> left_out;
    const auto unless = [&](bool needed, const char* what, uint64_t bytes) {
        if (!needed)
            left_out.push_back({what, bytes});
    };
    uint64_t normals = 0, texture_coordinates = 0;
    for (const MeshInfo& mesh : scene.meshes) {
        normals += mesh.normals_left_out;
        texture_coordinates += mesh.texture_coordinates_left_out;
    }
    unless(normals == 0, "vertex normals", normals * sizeof(vec3));
    unless(texture_coordinates == 0, "texture coordinates", texture_coordinates * sizeof(vec2));
    unless(needs.reflection, "reflection rays", 0);
    unless(needs.refraction, "refraction rays", 0);
    unless(needs.shadows, "shadow rays", 0);
    unless(needs.several_leaves, "queues of rays", 0);
    unless(needs.certified, "proofs of answers", 0);
    return left_out;
}

std::string omissions_text(const std::vector<Omission>& omissions) {
    std::vector<std::string> items;
    for (const Omission& omission : omissions)
        items.push_back(fmt::format("{} ({})", omission.sentence, omission.count));
    return items.empty() ? ""
                         : fmt::format("not drawn as its author meant: {}", fmt::join(items, "; "));
}

std::string left_out_text(const std::vector<LeftOut>& left_out) {
    std::vector<std::string> items;
    for (const LeftOut& item : left_out)
        items.push_back(item.bytes ? fmt::format("{} ({})", item.what, human_bytes(item.bytes))
                                   : item.what);
    return fmt::format("{}", fmt::join(items, ", "));
}

Box hittable_bounds(const Soup& soup) {
    Box bounds;
    Instances instances;
    for (const Chunk& chunk : soup.chunks)
        if (!instances.adds_nothing(chunk, bounds))
            bounds = grown(bounds, chunk);
    return bounds;
}

} // namespace ovc
