// SPDX-License-Identifier: Apache-2.0
// The kernel's traversal on the CPU, in double. It finds the triangles of a page, or of all pages
// under the top-level tree, that a ray may meet, or several rays together: then what the tree says
// is read and decoded once for them all. The exact fallback uses it; it follows
// shaders/traverse.glsl.
#pragma once

#include "core/exact/triangle.h"
#include "gpu/bvh/bvh.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/node_lanes.h"
#include "gpu/page/page.h"
#include "gpu/page/top_level.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <limits>
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

/// Returns the ray for the boxes on a grid.
inline NodeRay node_ray(const GridHeader& grid, const WalkedRay& walked) {
    NodeRay ray;
    for (int axis = 0; axis < 3; ++axis) {
        const double origin =
            double(grid.middle[axis]) - double(kGridMiddle) * double(grid.cell[axis]);
        ray.lo[axis] = origin - walked.margin;
        ray.hi[axis] = origin + walked.margin;
        ray.org[axis] = walked.ray.ray.org[axis];
        ray.inv_dir[axis] = walked.ray.inv_dir[axis];
    }
    ray.from = walked.ray.ray.t_min;
    ray.to = walked.ray.ray.t_max;
    return ray;
}

/// Calls visit(i) for each ray of the set.
template <class Visit>
void for_each_ray(RaySet set, Visit&& visit) {
    for (; set != 0; set &= set - 1)
        visit(uint32_t(std::countr_zero(set)));
}

/// A unit that rays go to.
struct UnitOnWay {
    const uvec4* units; // the array in which the unit and its children are counted
    uint32_t unit;      // negative: a portal
    RaySet rays;
    double enter; // the least t at which one of them does

    bool is_portal() const { return int32_t(unit) < 0; }
    const uvec4* texels() const { return units + size_t(unit) * OVC_UNIT_TEXELS; }
    bool is_pair() const { return !is_portal() && (texels()[3].w & OVC_PAIR); }
};

/// The units that rays have still to go to, the next one on top.
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

/// Calls visit(i, rays) for the triangles of a pair until a call returns true.
template <class Visit>
bool visit_pair(const uvec4* texels, RaySet rays, Visit&& visit) {
    return visit(texels[0].w, rays) || (texels[1].w != OVC_NO_TRIANGLE && visit(texels[1].w, rays));
}

/// Walks a tree. units_of, visit, enter_portal and limit are as for walk_units().
template <class UnitsOf, class Visit, class Enter, class Limit>
class UnitWalk {
public:
    UnitWalk(std::span<const uvec4> tree, UnitsOf& units_of, Visit& visit, Enter& enter_portal,
             Limit& limit)
        : tree_(tree),
          units_of_(units_of),
          visit_(visit),
          enter_portal_(enter_portal),
          limit_(limit) {}

    /// Returns true when a call of visit or enter_portal stopped it.
    template <class Walked>
    bool walk(uint32_t header, RaySet rays, Walked&& walked) {
        const auto start = tree_.subspan(size_t(header) * OVC_UNIT_TEXELS);
        const GridHeader grid = header_of(start);
        for (int axis = 0; axis < 3; ++axis)
            rays_.cell[axis] = double(grid.cell[axis]);
        for_each_ray(rays, [&](uint32_t i) { rays_.rays[i] = node_ray(grid, walked(i)); });
        stack_.push({tree_.data(), start[2].x, rays, -std::numeric_limits<double>::infinity()});
        while (!stack_.empty()) {
            UnitOnWay here = stack_.pop();
            here.rays = still_on_way(here);
            if (here.rays != 0 && go_to(here))
                return true;
        }
        return false;
    }

private:
    static constexpr bool kHasLinks = !std::is_same_v<std::remove_const_t<UnitsOf>, NoPages>;

    /// Returns the rays to the unit whose limits are not before it by now, and notes the limits.
    RaySet still_on_way(const UnitOnWay& unit) {
        RaySet still = 0;
        for_each_ray(unit.rays, [&](uint32_t i) {
            const double to = rays_.rays[i].to = limit_(i, unit.enter);
            still |= RaySet(unit.enter <= to) << i;
        });
        return still;
    }

    bool go_to(const UnitOnWay& here) {
        if (here.is_portal())
            return enter_portal_(-here.unit, here.rays);
        return here.is_pair() ? visit_pair(here.texels(), here.rays, visit_) : go_below(here);
    }

    /// Visits the pairs that are children of the node, the nearest first, and puts the others on
    /// the stack.
    bool go_below(const UnitOnWay& here) {
        const uvec4* const texels = here.texels();
        const uvec4* below = here.units;
        uint32_t first_child = texels[3].x;
        if constexpr (kHasLinks)
            if (here.units == tree_.data() && texels[3].y != 0) {
                below = units_of_(texels[3].y - 1);
                first_child = texels[3].z;
                if (!below)
                    return false;
            }
        // The rays ask about the children next, which may be far away in memory.
        for (uint32_t child = 0; child < 4; ++child)
            __builtin_prefetch(below + size_t(first_child + child) * OVC_UNIT_TEXELS);
        NodeMeeting meeting;
        meet_(rays_, here.rays, &texels[0].x, meeting);
        if (int32_t(first_child) < 0) { // all boxes are around what lies behind one portal
            UnitOnWay portal{below, first_child, 0, std::numeric_limits<double>::infinity()};
            for (uint32_t child = 0; child < 4; ++child)
                if (meeting.rays[child] != 0) {
                    portal.rays |= RaySet(meeting.rays[child]);
                    portal.enter = std::min(portal.enter, meeting.enter[child]);
                }
            if (portal.rays != 0)
                stack_.push(portal);
            return false;
        }
        uint32_t by_place[4]; // the farthest first
        for (uint32_t child = 0; child < 4; ++child)
            by_place[meeting.place[child]] = child;
        UnitOnWay nodes[4]; // the nearest first
        size_t node_count = 0;
        for (size_t i = meeting.count; i-- > 0;) {
            const uint32_t c = by_place[i];
            const UnitOnWay child{below, first_child + c, RaySet(meeting.rays[c]),
                                  meeting.enter[c]};
            if (!child.is_pair())
                nodes[node_count++] = child;
            else if (const RaySet rays = still_on_way(child);
                     rays != 0 && visit_pair(child.texels(), rays, visit_))
                return true;
        }
        while (node_count > 0)
            stack_.push(nodes[--node_count]);
        return false;
    }

    const std::span<const uvec4> tree_;
    UnitsOf& units_of_;
    Visit& visit_;
    Enter& enter_portal_;
    Limit& limit_;
    const MeetChildren meet_ = meet_children();
    NodeRays rays_;
    UnitStack stack_;
};

/// Calls visit(i, rays) -> bool (true: stop) for the number i of each triangle whose packed box,
/// widened by the rays' rounding margins, some of the rays meet, and enter_portal(number, rays) ->
/// bool for each portal that they meet so: ray r between its t_min and limit(r, enter), where t is
/// that of the ray itself, and `enter` the t at which the first ray comes to what is next. Goes to
/// the nearest children first, as the kernel does, but to pairs before nodes. Returns true when one
/// of the calls stopped it. tree: the units of a page or of a top-level tree; header: the number of
/// the header's unit in them; units_of(page): the units that the tree's links lead to, null where a
/// page is missing. Those of a page are not used any more when the next page is asked for.
/// walked(r): ray r in the frame of the tree.
template <class UnitsOf, class Walked, class Visit, class Enter, class Limit>
bool walk_units(std::span<const uvec4> tree, uint32_t header, UnitsOf&& units_of, RaySet rays,
                Walked&& walked, Visit&& visit, Enter&& enter_portal, Limit&& limit) {
    return UnitWalk(tree, units_of, visit, enter_portal, limit).walk(header, rays, walked);
}

/// Walks all pages under the top-level tree, as walk_units() does. scene: its box and frame;
/// prepared(r): ray r.
template <class UnitsOf, class Prepared, class Visit, class Limit>
bool walk_tree_together(const TopLevel& top, UnitsOf&& units_of, const Leaf& scene, RaySet all,
                        Prepared&& prepared, Visit&& visit, Limit&& limit) {
    const std::span<const uvec4> units = top.tree.view();
    const auto nowhere = [](uint32_t, RaySet) { return false; };
    const auto enter = [&](uint32_t number, RaySet rays) {
        assert(number < top.portals.size());
        const Portal& portal = top.portals[number];
        return walk_units(
            units, portal.tree, units_of, rays,
            [&](uint32_t r) { return walked_ray(portal, prepared(r)); },
            [&](uint32_t i, RaySet some) { return visit(portal.first_number + i, some); }, nowhere,
            limit);
    };
    const auto walked = [&](uint32_t r) {
        return top.way_in ? walked_ray(*top.way_in, prepared(r)) : walked_ray(scene, prepared(r));
    };
    return walk_units(units, 0, units_of, all, walked, visit, enter, limit);
}

} // namespace ovc
