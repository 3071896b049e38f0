// SPDX-License-Identifier: Apache-2.0
// A scene in leaves whose pages and top-level tree lie in one array, as they lie in the pool of a
// device that has room for all.
#pragma once

#include "gpu/page/top_level.h"
#include "gpu/trace/local_ray.h"
#include "kdtree/partition.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

struct PooledScene {
    Level1 level1;
    std::vector<Page> pages;
    TopLevel top;
    std::vector<uvec4> pool;

    /// The soup need not outlive this.
    PooledScene(const Soup& soup, uint32_t leaves) {
        Box bounds;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        level1 = partition(soup, ids, bounds, uint32_t(ids.size() / leaves + 1));
        share_frame(level1);
        const Numbering numbers(soup);
        for (const Leaf& leaf : level1.leaves)
            pages.push_back(build_page(soup, numbers, leaf));
        top = build_top_level(pages, kLinksPerPage * pages.size());
        Page tree = top.tree;
        std::vector<uint32_t> first_units;
        uint32_t unit = uint32_t(top.room() / OVC_UNIT_BYTES);
        for (const Page& page : pages) {
            first_units.push_back(unit);
            unit += uint32_t(page.bytes() / OVC_UNIT_BYTES);
        }
        pool.resize(size_t(unit) * OVC_UNIT_TEXELS);
        for (uint32_t leaf = 0; leaf < pages.size(); ++leaf) {
            for (const Link& link : top.links_of(leaf))
                tree.texels[size_t(link.unit) * OVC_UNIT_TEXELS + 3].x =
                    first_units[leaf] + link.first_child;
            copy_relocated(pages[leaf].view(), first_units[leaf],
                           std::span(pool).subspan(size_t(first_units[leaf]) * OVC_UNIT_TEXELS,
                                                   pages[leaf].view().size()));
        }
        const std::span<const uvec4> units = tree.view();
        std::copy(units.begin(), units.end(), pool.begin());
    }

    /// Returns the rays in the frame that all pages share.
    PagedVector<LocalRay> local_rays(std::span<const Ray> rays, bool any_hit) const {
        PagedVector<LocalRay> local;
        LocalTime time;
        const Leaf scene = scene_leaf(level1.bounds);
        for (const Ray& ray : rays)
            local.push_back(local_ray(scene, ray, OVC_NO_TRIANGLE, any_hit, time));
        return local;
    }
};

} // namespace ovc
