// SPDX-License-Identifier: Apache-2.0
// walk_scene() takes a ray, or several together, through all pages of a scene, wherever these lie.
#pragma once

#include "gpu/page/page_walk.h"
#include "plugin/build/built_scene.h"
#include "plugin/leaf_store/leaf_store.h"

namespace ovc {

/// As walk_tree_together(), after a visit to each far triangle. A page that cannot be read holds
/// nothing, and the store knows of that.
template <class Prepared, class Visit, class Limit>
bool walk_scene_together(const BuiltScene& scene, RaySet all, Prepared&& prepared, Visit&& visit,
                         Limit&& limit) {
    if (scene.pages.empty())
        return false;
    for (const FarTriangle& far : scene.far.triangles)
        if (visit(far.number, all))
            return true;
    const auto walk = [&](auto&& units_of) {
        return walk_tree_together(scene.top, units_of, scene.top.scene_in(scene.level1.bounds), all,
                                  prepared, visit, limit);
    };
    // Two walks, so that the one in memory asks nothing at its links.
    if (!scene.store)
        return walk([&](uint32_t page) { return scene.pages[page].view().data(); });
    PageCache::Pin here;
    return walk([&](uint32_t page) {
        here.release(); // a thread holds one page at a time
        here = scene.store->page(scene.pages[page].stored_number);
        return here.texels().data();
    });
}

/// The same with one ray. Calls visit(i) and limit(enter).
template <class Visit, class Limit>
bool walk_scene(const BuiltScene& scene, const PreparedRay& p, Visit&& visit, Limit&& limit) {
    return walk_scene_together(
        scene, 1, [&](uint32_t) -> const PreparedRay& { return p; },
        [&](uint32_t i, RaySet) { return visit(i); },
        [&](uint32_t, double enter) { return limit(enter); });
}

} // namespace ovc
