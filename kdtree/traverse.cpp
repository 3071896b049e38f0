// SPDX-License-Identifier: Apache-2.0
// The CPU KDT: walk.h visits leaves, and core/exact/triangle.h tests their triangles.
#include "kdtree/traverse.h"

#include "core/system/parallel.h"
#include "kdtree/approach.h"
#include "kdtree/walk.h"

#include <cassert>
#include <optional>

namespace ovc {
namespace {

/// Any hit and nearest hit differ in when they stop, and in nothing else.
template <bool kAnyHit>
Hit trace(const KdTree& tree, const Soup& soup, const Ray& ray, const Exclusion& without) {
    if (!ray.valid())
        return {};
    const PreparedRay p(ray, without);
    std::optional<Triangle> triangle_after;
    if (const TriangleId id = without.after.id;
        id.mesh < soup.chunks.size() && id.prim < soup.chunks[id.mesh].size())
        triangle_after = soup.triangle(id);
    Nearest nearest(p, triangle_after ? &*triangle_after : nullptr);
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

/// Returns whether the hit counts for a ray with this sieve.
bool counts(const Soup& soup, const RaySieve& sieve, const Hit& hit) {
    if (!sees(sieve.mask, soup.chunks[hit.id.mesh].mask()))
        return false;
    uint8_t keep = 1;
    return !sieve.filter || (sieve.filter->keep({&sieve.name, 1}, {&hit, 1}, {&keep, 1}) && keep);
}

} // namespace

Hit intersect(const KdTree& tree, const Soup& soup, const Ray& ray, const Exclusion& without,
              const RaySieve& sieve) {
    Exclusion more = without;
    while (true) {
        const Hit hit = trace</* kAnyHit= */ false>(tree, soup, ray, more);
        if (!hit.is_hit() || sieve.passes_all() || counts(soup, sieve, hit))
            return hit;
        more.after = HitPlace(hit);
        more.after.is_certain = true;
    }
}

bool occluded(const KdTree& tree, const Soup& soup, const Ray& ray, const Exclusion& without,
              const RaySieve& sieve) {
    if (!sieve.passes_all()) // any hit might not count
        return intersect(tree, soup, ray, without, sieve).is_hit();
    return trace</* kAnyHit= */ true>(tree, soup, ray, without).is_hit();
}

void intersect(const KdTree& tree, const Soup& soup, std::span<const Ray> rays,
               const Exclusions& without, std::span<Hit> hits) {
    assert(hits.size() == rays.size() && without.are_for(rays.size()));
    parallel_for(rays.size(), kGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            hits[i] = intersect(tree, soup, rays[i], without[i], without.sieves[i]);
    });
}

void occluded(const KdTree& tree, const Soup& soup, std::span<const Ray> rays,
              const Exclusions& without, std::span<uint8_t> occluded_out) {
    assert(occluded_out.size() == rays.size() && without.are_for(rays.size()));
    parallel_for(rays.size(), kGrain, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            occluded_out[i] = occluded(tree, soup, rays[i], without[i], without.sieves[i]);
    });
}

} // namespace ovc
