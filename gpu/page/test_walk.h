// SPDX-License-Identifier: Apache-2.0
// What walks on the CPU find in a page, or in all pages under a top-level tree, for tests.
#pragma once

#include "gpu/page/page_walk.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace ovc::test {

/// Returns the nearest hit among the triangles of a soup that walk(visit, limit) offers.
template <class Walk>
Hit nearest_by(const Soup& soup, const PreparedRay& p, Walk&& walk) {
    const Numbering numbers(soup);
    Nearest nearest(p);
    walk(
        [&](uint32_t number, RaySet) {
            const TriangleId id = numbers.id(number);
            nearest.offer(soup.triangle(id), id);
            return false;
        },
        [&](uint32_t, double) { return nearest.limit(); });
    return nearest.hit();
}

/// Returns the nearest hit in a page. leaf: its box and frame.
inline Hit nearest_in_page(const Soup& soup, const Page& page, const Leaf& leaf,
                           const PreparedRay& p) {
    return nearest_by(soup, p, [&](auto&& visit, auto&& limit) {
        walk_units(
            page.view(), 0, NoPages(), 1, [&](uint32_t) { return walked_ray(leaf, p); }, visit,
            [](uint32_t, RaySet) { return false; }, limit);
    });
}

/// Returns the nearest hit in all pages. scene: their box and frame.
inline Hit nearest_in_pages(const Soup& soup, const TopLevel& top, std::span<const Page> pages,
                            const Leaf& scene, const PreparedRay& p) {
    return nearest_by(soup, p, [&](auto&& visit, auto&& limit) {
        walk_tree_together(
            top, [&](uint32_t page) { return pages[page].view().data(); }, scene, 1,
            [&](uint32_t) -> const PreparedRay& { return p; }, visit, limit);
    });
}

/// Sends rays through the page of a leaf and through its triangles one by one, and expects the same
/// hits.
inline void expect_brute_force(const std::string& name, const Soup& soup, const Page& page,
                               const Leaf& leaf, std::span<const Ray> rays) {
    for (size_t i = 0; i < rays.size(); ++i) {
        if (!rays[i].valid())
            continue;
        const Hit found = nearest_in_page(soup, page, leaf, PreparedRay(rays[i]));
        const Hit expected = brute_force(soup, leaf.triangles, rays[i]);
        ASSERT_TRUE(same(expected, found)) << name << " ray " << i << ": " << describe(expected)
                                           << " but found " << describe(found);
    }
}

} // namespace ovc::test
