// SPDX-License-Identifier: Apache-2.0
// The kernel's traversal on the CPU, in double: which triangles of a page a ray may meet. The twin
// of shaders/traverse.glsl, and the inner half of the arbiter.
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
template <class Visit, class Limit>
bool walk_page(const Page& page, const Leaf& leaf, const PreparedRay& p, double from, Visit&& visit,
               Limit&& limit) {
    const std::span<const uvec4> texels = page.view();
    const auto texel = [&](uint32_t unit, int i) -> const uvec4& {
        return texels[size_t(unit) * OVC_UNIT_TEXELS + size_t(i)];
    };
    const auto vector = [&](int i) {
        const uvec4& t = texel(0, i);
        return dvec3(std::bit_cast<float>(t.x), std::bit_cast<float>(t.y),
                     std::bit_cast<float>(t.z));
    };
    const dvec3 grid_cell = vector(1);
    const dvec3 grid_org = vector(0) - double(kGridMiddle) * grid_cell;
    PreparedRay local = p; // the same t: origin and direction are mapped alike
    local.ray.org = leaf.frame.to_local(p.ray.org);
    local.ray.dir = p.ray.dir * leaf.frame.scale;
    local.inv_dir = p.inv_dir / leaf.frame.scale;
    const double margin = p.margin(leaf.box) * leaf.frame.scale;

    struct Entry {
        uint32_t unit;
        double enter;
    };
    // Three siblings a level, and the one that is next.
    static_assert(3 * kMaxBvhDepth + 1 <= 3 * 64);
    std::array<Entry, 3 * 64> stack;
    size_t top = 0;
    stack[top++] = {OVC_ROOT_UNIT, from};
    while (top > 0) {
        const Entry entry = stack[--top];
        if (entry.enter > limit())
            continue;
        if (texel(entry.unit, 3).w & OVC_PAIR) {
            const uint32_t a = texel(entry.unit, 0).w;
            const uint32_t b = texel(entry.unit, 1).w;
            if (visit(a) || (b != OVC_NO_TRIANGLE && visit(b)))
                return true;
            continue;
        }
        const size_t siblings = top; // kept with the nearest on top
        for (uint32_t child = 0; child < 4; ++child) {
            Box box;
            for (int axis = 0; axis < 3; ++axis) {
                const GridRange range = range_of(texel(entry.unit, axis), child);
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
            stack[at] = {texel(entry.unit, 3).x + child, inside.enter};
        }
    }
    return false;
}

} // namespace ovc
