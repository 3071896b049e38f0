// SPDX-License-Identifier: Apache-2.0
// The CPU KDT: leaves visited by walk.h, triangles tested by core/triangle.h.
#include "kdtree/traverse.h"

#include "core/parallel.h"
#include "kdtree/walk.h"

#include <cassert>

namespace ovc {
namespace {

/// Any hit and nearest hit differ in when they stop, and in nothing else.
template <bool kAnyHit>
Hit trace(const KdTree& tree, const Soup& soup, const Ray& ray, TriangleId skip) {
    Hit best;
    if (!ray.valid())
        return best;
    PreparedRay p(ray, skip);
    walk(
        tree.nodes, tree.bounds, p,
        [&](const KdNode& leaf, double, double) {
            for (const TriangleId id : tree.triangles(leaf))
                if (const auto hit = intersect(p, soup.triangle(id), id);
                    hit && hit->nearer_than(best)) {
                    best = *hit;
                    p.ray.t_max = best.t; // not below: an equal t with a smaller id may follow
                    if (kAnyHit)
                        return true;
                }
            return false;
        },
        [&] { return p.ray.t_max; });
    return best;
}

constexpr size_t kGrain = 64; // rays a task

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
