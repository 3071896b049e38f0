// SPDX-License-Identifier: Apache-2.0
// The exact fallback: a ray that float32 could not decide, traced in double down the top-level
// tree and through the pages in host memory, or from cell to cell of level 1 where pages share no
// frame. Equals the CPU KDT of kdtree/traverse.h bit for bit, because both test with
// core/triangle.h every triangle that could be hit.
#pragma once

#include "gpu/page_walk.h"
#include "kdtree/approach.h"
#include "kdtree/walk.h"
#include "plugin/built_scene.h"

namespace ovc {

/// The nearest hit, or with kAnyHit some hit, of a valid ray.
template <bool kAnyHit>
Hit trace_exactly(const BuiltScene& scene, const PreparedRay& p) {
    const Level1& level1 = scene.level1;
    Nearest nearest(p);
    Approach approach(p, level1.bounds);
    const auto limit = [&] { return approach.limit(nearest); };
    const auto test = [&](uint32_t number) {
        const TriangleId id = scene.seen(number, p.skip);
        const Triangle triangle = scene.soup.triangle(id);
        const bool hit = nearest.offer(triangle, id);
        if (hit)
            approach.note_hit(triangle);
        return hit && kAnyHit;
    };
    const auto result = [&] { return kAnyHit ? nearest.unrounded_hit() : nearest.hit(); };
    if (!scene.top.empty()) {
        walk_tree(scene.top.tree, scene.pages, scene_leaf(level1.bounds), approach.ray(),
                  approach.ray().ray.t_min, test, limit);
        return result();
    }
    walk(
        level1.nodes, level1.bounds, approach.ray(),
        [&](const KdNode& cell, double, double) {
            for (uint32_t l = cell.first(); l < cell.first() + cell.count(); ++l) {
                if (walk_page(scene.pages[l], level1.leaves[l], approach.ray(),
                              approach.ray().ray.t_min, test, limit))
                    return true;
            }
            return false;
        },
        limit);
    return result();
}

} // namespace ovc
