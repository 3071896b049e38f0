// SPDX-License-Identifier: Apache-2.0
// walk_scene() takes a ray through all pages of a scene, wherever these lie.
#pragma once

#include "gpu/page/page_walk.h"
#include "plugin/build/built_scene.h"
#include "plugin/leaf_store/leaf_store.h"

#include <utility>

namespace ovc {

/// As walk_tree(), from the ray's t_min on. A page that cannot be read holds nothing, and the store
/// knows of that.
template <class Visit, class Limit>
bool walk_scene(const BuiltScene& scene, const PreparedRay& ray, Visit&& visit, Limit&& limit) {
    if (scene.pages.empty())
        return false;
    const Leaf around = scene_leaf(scene.level1.bounds);
    if (!scene.store)
        return walk_tree(scene.top, scene.pages, around, ray, ray.ray.t_min, visit, limit);
    PageCache::Pin here;
    const auto units_of = [&](uint32_t page) {
        here.release(); // a thread holds one page at a time
        here = scene.store->page(scene.pages[page].stored_number);
        return here.texels().data();
    };
    return walk_tree(scene.top, units_of, around, ray, ray.ray.t_min, visit, limit);
}

} // namespace ovc
