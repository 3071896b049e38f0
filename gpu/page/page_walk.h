// SPDX-License-Identifier: Apache-2.0
// The kernel's traversal on the CPU, in double. It finds the triangles of a page, or of all pages
// under the top-level tree, that a ray may meet. The exact fallback uses it; it follows
// shaders/traverse.glsl.
#pragma once

#include "core/exact/triangle.h"
#include "gpu/bvh/bvh.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/page.h"
#include "gpu/page/top_level.h"
#include "shaders/layout.h"

#include <array>
#include <cassert>

namespace ovc {

/// A ray in the frame of a tree, with the bound of its rounding errors there.
struct WalkedRay {
    PreparedRay ray; // t is the same in every frame
    double margin;
};

/// Converts a ray to the frame of a leaf, with the error bound around its box.
inline WalkedRay walked_ray(const Leaf& leaf, const PreparedRay& p) {
    WalkedRay walked{p, p.margin(leaf.box) * leaf.frame.scale};
    walked.ray.ray.org = leaf.frame.to_local(p.ray.org);
    walked.ray.ray.dir = p.ray.dir * leaf.frame.scale;
    walked.ray.inv_dir = p.inv_dir / leaf.frame.scale;
    return walked;
}
/// Converts a ray to the frame behind a portal. The factor 4 is for the matrix, which rounds three
/// more products a coordinate.
inline WalkedRay walked_ray(const Portal& portal, const PreparedRay& p) {
    return {portal.local_ray(p), 4 * p.margin(portal.bounds) * portal.stretch()};
}

/// Calls visit(i) -> bool (true: stop) for the number i of each triangle whose packed box, widened
/// by the ray's rounding margin, the ray meets within [from, limit()], and enter_portal(number) ->
/// bool for each portal that it meets so. Goes to the nearest children first, as the kernel does; t
/// is that of the ray itself. Returns true when one of the calls stopped it. tree: the units of a
/// page or of a top-level tree; header: the number of the header's unit in them; pages: those that
/// the tree's links lead to.
template <class Visit, class Enter, class Limit>
bool walk_units(std::span<const uvec4> tree, uint32_t header, std::span<const Page> pages,
                const WalkedRay& walked, double from, Visit&& visit, Enter&& enter_portal,
                Limit&& limit) {
    const uvec4* const units_of_tree = tree.data();
    const auto start = tree.subspan(size_t(header) * OVC_UNIT_TEXELS);
    const GridHeader grid = header_of(start);
    const dvec3 grid_cell(grid.cell);
    const dvec3 grid_org = dvec3(grid.middle) - double(kGridMiddle) * grid_cell;

    struct Entry {
        const uvec4* units; // the array in which the unit and its children are counted
        uint32_t unit;
        double enter;
    };
    // Each level leaves up to three siblings, and the last one its next node.
    constexpr size_t kMaxDepth = 64;
    static_assert(kMaxBvhDepth < kMaxDepth);
    std::array<Entry, 2 * 3 * kMaxDepth> stack;
    size_t top = 0;
    stack[top++] = {units_of_tree, start[2].x, from};
    while (top > 0) {
        const auto [units, unit, enter] = stack[--top];
        if (enter > limit())
            continue;
        if (int32_t(unit) < 0) {
            if (enter_portal(-unit))
                return true;
            continue;
        }
        const uvec4* const texel = units + size_t(unit) * OVC_UNIT_TEXELS;
        if (texel[3].w & OVC_PAIR) {
            if (visit(texel[0].w) || (texel[1].w != OVC_NO_TRIANGLE && visit(texel[1].w)))
                return true;
            continue;
        }
        const bool is_link = units == units_of_tree && !pages.empty() && texel[3].y != 0;
        const uvec4* const below = is_link ? pages[texel[3].y - 1].view().data() : units;
        const uint32_t first_child = is_link ? texel[3].z : texel[3].x;
        const size_t siblings = top; // kept with the nearest on top
        for (uint32_t child = 0; child < 4; ++child) {
            Box box;
            for (int axis = 0; axis < 3; ++axis) {
                const GridRange range = range_of(texel[axis], child);
                box.lo[axis] = grid_org[axis] + range.lo * grid_cell[axis];
                box.hi[axis] = grid_org[axis] + range.hi * grid_cell[axis];
            }
            if (box.empty())
                continue;
            const Interval inside = clip(walked.ray, box.padded(walked.margin), from, limit());
            if (inside.empty())
                continue;
            assert(top < stack.size());
            size_t at = top++;
            for (; at > siblings && stack[at - 1].enter < inside.enter; --at)
                stack[at] = stack[at - 1];
            stack[at] = {below, first_child + child, inside.enter};
        }
    }
    return false;
}

/// Walks all pages under the top-level tree, as walk_units() does. scene: its box and frame.
template <class Visit, class Limit>
bool walk_tree(const TopLevel& top, std::span<const Page> pages, const Leaf& scene,
               const PreparedRay& p, double from, Visit&& visit, Limit&& limit) {
    const std::span<const uvec4> units = top.tree.view();
    const auto enter = [&](uint32_t number) {
        assert(number < top.portals.size());
        const Portal& portal = top.portals[number];
        return walk_units(
            units, portal.tree, pages, walked_ray(portal, p), from,
            [&](uint32_t i) { return visit(portal.first_number + i); },
            [](uint32_t) { return false; }, limit);
    };
    const WalkedRay walked = top.way_in ? walked_ray(*top.way_in, p) : walked_ray(scene, p);
    return walk_units(units, 0, pages, walked, from, visit, enter, limit);
}

/// Walks one page. leaf: its box and frame.
template <class Visit, class Limit>
bool walk_page(const Page& page, const Leaf& leaf, const PreparedRay& p, double from, Visit&& visit,
               Limit&& limit) {
    return walk_units(
        page.view(), 0, {}, walked_ray(leaf, p), from, visit, [](uint32_t) { return false; },
        limit);
}

} // namespace ovc
