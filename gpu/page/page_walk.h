// SPDX-License-Identifier: Apache-2.0
// The kernel's traversal on the CPU, in double. It finds the triangles of a page, or of all pages
// under the top-level tree, that a ray may meet. The exact fallback uses it; it follows
// shaders/traverse.glsl.
#pragma once

#include "core/exact/triangle.h"
#include "gpu/bvh/bvh.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/node_lanes.h"
#include "gpu/page/page.h"
#include "gpu/page/top_level.h"
#include "shaders/layout.h"

#include <array>
#include <cassert>
#include <type_traits>
#include <vector>

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

/// Returns the ray for the boxes on a grid, from t = `from` on.
inline NodeRay node_ray(const GridHeader& grid, const WalkedRay& walked, double from) {
    NodeRay ray;
    for (int axis = 0; axis < 3; ++axis) {
        ray.cell[axis] = double(grid.cell[axis]);
        const double origin = double(grid.middle[axis]) - double(kGridMiddle) * ray.cell[axis];
        ray.lo[axis] = origin - walked.margin;
        ray.hi[axis] = origin + walked.margin;
        ray.org[axis] = walked.ray.ray.org[axis];
        ray.inv_dir[axis] = walked.ray.inv_dir[axis];
    }
    ray.from = from;
    return ray;
}

/// A unit that a ray goes to.
struct UnitOnWay {
    const uvec4* units; // the array in which the unit and its children are counted
    uint32_t unit;      // negative: a portal
    double enter;       // t

    bool is_portal() const { return int32_t(unit) < 0; }
    const uvec4* texels() const { return units + size_t(unit) * OVC_UNIT_TEXELS; }
    bool is_pair() const { return !is_portal() && (texels()[3].w & OVC_PAIR); }
};

/// The units that a ray has still to go to, the next one on top.
class UnitStack {
public:
    bool empty() const { return top_ == 0; }
    void push(const UnitOnWay& unit) {
        assert(top_ < units_.size());
        units_[top_++] = unit;
    }
    UnitOnWay pop() { return units_[--top_]; }

private:
    // Each level leaves up to three siblings, and the last one its next node.
    static constexpr size_t kMaxDepth = 64;
    static_assert(kMaxBvhDepth < kMaxDepth);

    std::array<UnitOnWay, 2 * 3 * kMaxDepth> units_;
    size_t top_ = 0;
};

/// In place of the pages of a tree that has none: its links lead to its own units.
struct NoPages {};

/// Calls visit(i) for the triangles of a pair until a call returns true.
template <class Visit>
bool visit_pair(const uvec4* texels, Visit&& visit) {
    return visit(texels[0].w) || (texels[1].w != OVC_NO_TRIANGLE && visit(texels[1].w));
}

/// Calls visit(i) -> bool (true: stop) for the number i of each triangle whose packed box, widened
/// by the ray's rounding margin, the ray meets within [from, limit()], and enter_portal(number) ->
/// bool for each portal that it meets so. Goes to the nearest children first, as the kernel does,
/// but to pairs before nodes; t is that of the ray itself. Returns true when one of the calls
/// stopped it. tree: the units of a page or of a top-level tree; header: the number of the header's
/// unit in them; units_of(page): the units that the tree's links lead to, null where a page is
/// missing. Those of a page are not used any more when the next page is asked for.
template <class UnitsOf, class Visit, class Enter, class Limit>
bool walk_units(std::span<const uvec4> tree, uint32_t header, UnitsOf&& units_of,
                const WalkedRay& walked, double from, Visit&& visit, Enter&& enter_portal,
                Limit&& limit) {
    constexpr bool kHasLinks = !std::is_same_v<std::remove_cvref_t<UnitsOf>, NoPages>;
    const auto start = tree.subspan(size_t(header) * OVC_UNIT_TEXELS);
    const NodeRay ray = node_ray(header_of(start), walked, from);
    const MeetChildren meet = meet_children();
    UnitStack stack;
    stack.push({tree.data(), start[2].x, from});
    while (!stack.empty()) {
        const UnitOnWay here = stack.pop();
        if (here.enter > limit())
            continue;
        if (here.is_portal()) {
            if (enter_portal(-here.unit))
                return true;
            continue;
        }
        const uvec4* const texels = here.texels();
        if (here.is_pair()) {
            if (visit_pair(texels, visit))
                return true;
            continue;
        }
        const uvec4* below = here.units;
        uint32_t first_child = texels[3].x;
        if constexpr (kHasLinks)
            if (here.units == tree.data() && texels[3].y != 0) {
                below = units_of(texels[3].y - 1);
                first_child = texels[3].z;
                if (!below)
                    continue;
            }
        NodeMeeting meeting;
        meet(ray, &texels[0].x, limit(), meeting);
        uint32_t by_place[4], nodes[4]; // the farthest first; the nearest first
        for (uint32_t child = 0; child < 4; ++child)
            by_place[meeting.place[child]] = child;
        size_t node_count = 0;
        for (size_t i = meeting.count; i-- > 0;) {
            const UnitOnWay child{below, first_child + by_place[i], meeting.enter[by_place[i]]};
            if (!child.is_pair())
                nodes[node_count++] = by_place[i];
            else if (child.enter <= limit() && visit_pair(child.texels(), visit))
                return true;
        }
        while (node_count > 0) {
            const uint32_t child = nodes[--node_count];
            stack.push({below, first_child + child, meeting.enter[child]});
        }
    }
    return false;
}

/// Walks all pages under the top-level tree, as walk_units() does. scene: its box and frame.
template <class UnitsOf, class Visit, class Limit>
bool walk_tree(const TopLevel& top, UnitsOf&& units_of, const Leaf& scene, const PreparedRay& p,
               double from, Visit&& visit, Limit&& limit) {
    const std::span<const uvec4> units = top.tree.view();
    const auto enter = [&](uint32_t number) {
        assert(number < top.portals.size());
        const Portal& portal = top.portals[number];
        return walk_units(
            units, portal.tree, units_of, walked_ray(portal, p), from,
            [&](uint32_t i) { return visit(portal.first_number + i); },
            [](uint32_t) { return false; }, limit);
    };
    const WalkedRay walked = top.way_in ? walked_ray(*top.way_in, p) : walked_ray(scene, p);
    return walk_units(units, 0, units_of, walked, from, visit, enter, limit);
}

/// The same where all pages are in memory.
template <class Visit, class Limit>
bool walk_tree(const TopLevel& top, const std::vector<Page>& pages, const Leaf& scene,
               const PreparedRay& p, double from, Visit&& visit, Limit&& limit) {
    return walk_tree(
        top, [&](uint32_t page) { return pages[page].view().data(); }, scene, p, from, visit,
        limit);
}

/// Walks one page. leaf: its box and frame.
template <class Visit, class Limit>
bool walk_page(const Page& page, const Leaf& leaf, const PreparedRay& p, double from, Visit&& visit,
               Limit&& limit) {
    return walk_units(
        page.view(), 0, NoPages(), walked_ray(leaf, p), from, visit, [](uint32_t) { return false; },
        limit);
}

} // namespace ovc
