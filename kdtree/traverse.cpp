// SPDX-License-Identifier: Apache-2.0
// The CPU KDT: walk.h visits leaves, and core/exact/triangle.h tests their triangles.
#include "kdtree/traverse.h"

#include "core/system/parallel.h"
#include "kdtree/approach.h"
#include "kdtree/walk.h"

#include <cassert>

namespace ovc {
namespace {

/// Any hit and nearest hit differ in when they stop, and in nothing else.
template <bool kAnyHit>
Hit trace(const KdTree& tree, const Soup& soup, const Ray& ray, TriangleId skip) {
    if (!ray.valid())
        return {};
    const PreparedRay p(ray, skip);
    Nearest nearest(p);
    Approach approach(p, tree.bounds);
    walk(
        tree.nodes, tree.bounds, approach.ray(),
        [&](const KdNode& leaf, double, double) {
            for (const TriangleId id : tree.triangles(leaf)) {
                const Triangle triangle = soup.triangle(id);
                if (!nearest.offer(triangle, id))
                    continue;
                if (kAnyHit)
                    return true;
                approach.note_hit(triangle);
            }
            return false;
        },
        [&] { return approach.limit(nearest); });
    return kAnyHit ? nearest.unrounded_hit() : nearest.hit();
}

constexpr size_t kGrain = 64; // rays per task

TriangleId skip_of(std::span<const TriangleId> skip, size_t i) {
    return skip.empty() ? TriangleId{} : skip[i];
}

} // namespace

Hit intersect(const KdTree& tree, const Soup& soup, const Ray& ray, TriangleId skip) {
    return trace</* kAnyHit= */ false>(tree, soup, ray, skip);
}

bool occluded(const KdTree& tree, const Soup& soup, const Ray& ray, TriangleId skip) {
    return trace</* kAnyHit= */ true>(tree, soup, ray, skip).is_hit();
}

void intersect(const KdTree& tree, const Soup& soup, std::span<const Ray> rays,
               std::span<const TriangleId> skip, std::span<Hit> hits) {
    assert(hits.size() == rays.size() && (skip.empty() || skip.size() == rays.size()));
    parallel_for(rays.size(), kGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            hits[i] = intersect(tree, soup, rays[i], skip_of(skip, i));
    });
}

void occluded(const KdTree& tree, const Soup& soup, std::span<const Ray> rays,
              std::span<const TriangleId> skip, std::span<uint8_t> occluded_out) {
    assert(occluded_out.size() == rays.size() && (skip.empty() || skip.size() == rays.size()));
    parallel_for(rays.size(), kGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            occluded_out[i] = occluded(tree, soup, rays[i], skip_of(skip, i));
    });
}

} // namespace ovc
