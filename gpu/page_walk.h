// SPDX-License-Identifier: Apache-2.0
// The kernel's traversal on the CPU, in double: which triangles of a page, or of all pages under
// the top-level tree, a ray may meet. It follows shaders/traverse.glsl, for the exact fallback.
#pragma once

#include "core/triangle.h"
#include "gpu/bvh.h"
#include "gpu/node_boxes.h"
#include "gpu/page.h"
#include "shaders/layout.h"

#include <array>
#include <bit>

namespace ovc {

/// Calls visit(i) -> bool (true: stop) for the number i of each triangle whose packed box,
/// widened by the ray's rounding margin, the ray meets within [from, limit()]. Nearest children
/// first, as in the kernel; t is that of the ray itself. Returns true when visit stopped it.
/// tree: a page or a top-level tree; pages: those that the latter's links lead to. leaf: its box
/// and its frame.
template <class Visit, class Limit>
bool walk_tree(const Page& tree, std::span<const Page> pages, const Leaf& leaf,
               const PreparedRay& p, double from, Visit&& visit, Limit&& limit) {
    const uvec4* const header = tree.view().data();
    const auto vector = [&](int i) {
        return dvec3(std::bit_cast<float>(header[i].x), std::bit_cast<float>(header[i].y),
                     std::bit_cast<float>(header[i].z));
    };
    const dvec3 grid_cell = vector(1);
    const dvec3 grid_org = vector(0) - double(kGridMiddle) * grid_cell;
    PreparedRay local = p; // the same t: origin and direction are mapped alike
    local.ray.org = leaf.frame.to_local(p.ray.org);
    local.ray.dir = p.ray.dir * leaf.frame.scale;
    local.inv_dir = p.inv_dir / leaf.frame.scale;
    const double margin = p.margin(leaf.box) * leaf.frame.scale;

    struct Entry {
        const uvec4* units; // where those that it names are counted from
        uint32_t unit;
        double enter;
    };
    // Three siblings a level, and the one that is next.
    constexpr size_t kMaxDepth = 64;
    static_assert(kMaxBvhDepth < kMaxDepth);
    std::array<Entry, 2 * 3 * kMaxDepth> stack;
    size_t top = 0;
    stack[top++] = {header, OVC_ROOT_UNIT, from};
    while (top > 0) {
        const auto [units, unit, enter] = stack[--top];
        if (enter > limit())
            continue;
        const uvec4* const texel = units + size_t(unit) * OVC_UNIT_TEXELS;
        if (texel[3].w & OVC_PAIR) {
            if (visit(texel[0].w) || (texel[1].w != OVC_NO_TRIANGLE && visit(texel[1].w)))
                return true;
            continue;
        }
        const bool is_link = units == header && !pages.empty() && texel[3].y != 0;
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
            const Interval inside = clip(local, box.padded(margin), from, limit());
            if (inside.empty())
                continue;
            size_t at = top++;
            for (; at > siblings && stack[at - 1].enter < inside.enter; --at)
                stack[at] = stack[at - 1];
            stack[at] = {below, first_child + child, inside.enter};
        }
    }
    return false;
}

/// The same over one page.
template <class Visit, class Limit>
bool walk_page(const Page& page, const Leaf& leaf, const PreparedRay& p, double from, Visit&& visit,
               Limit&& limit) {
    return walk_tree(page, {}, leaf, p, from, visit, limit);
}

} // namespace ovc
