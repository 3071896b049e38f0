// SPDX-License-Identifier: Apache-2.0
// The exact fallback: traces a ray that float32 could not decide in double, down the top-level tree
// and through the pages in host memory. Its answers equal those of the CPU KD-tree
// (kdtree/traverse.h) bit for bit, because both test with core/exact/triangle.h every triangle that
// could be hit.
#pragma once

#include "gpu/page/page_walk.h"
#include "kdtree/approach.h"
#include "plugin/build/built_scene.h"

namespace ovc {

/// Returns the nearest hit of a valid ray, or with kAnyHit some hit. Any thread.
template <bool kAnyHit>
Hit trace_exactly(const BuiltScene& scene, const PreparedRay& p) {
    Nearest nearest = scene.nearest_of(p);
    Approach approach(p, scene.level1.bounds);
    const auto limit = [&] { return approach.limit(nearest); };
    const auto test = [&](uint32_t number) {
        const TriangleId id = scene.numbers.id(number);
        const bool hit = scene.offer(nearest, p, id);
        if (hit)
            approach.note_hit(scene.soup.triangle(id));
        return hit && kAnyHit;
    };
    if (!scene.pages.empty())
        walk_tree(scene.top, scene.pages, scene_leaf(scene.level1.bounds), approach.ray(),
                  approach.ray().ray.t_min, test, limit);
    return kAnyHit ? nearest.unrounded_hit() : nearest.hit();
}

} // namespace ovc
