// SPDX-License-Identifier: Apache-2.0
// Walks a KD-tree front to back along a ray. Split planes are as thick as the ray's rounding
// margin, so the walk may visit a leaf too many, but passes by none that the exact ray touches.
#pragma once

#include "core/exact/triangle.h"
#include "kdtree/tree.h"

#include <array>
#include <cassert>
#include <limits>

namespace ovc {

/// Calls visit(node, enter, exit) -> bool (true: stop) for each leaf along the ray, in order of
/// entry. limit() returns the largest t that is still of interest; it may shrink from call to call.
template <class Visit, class Limit>
void walk(std::span<const KdNode> nodes, const Box& bounds, const PreparedRay& p, Visit&& visit,
          Limit&& limit) {
    if (nodes.empty())
        return;
    const double margin = p.margin(bounds);
    struct Entry {
        uint32_t node;
        double enter, exit;
    };
    std::array<Entry, 128> stack; // deeper than any tree of build.cpp
    int top = 0;
    const Interval whole =
        clip(p, bounds.padded(margin + bounds.rounding()), p.ray.t_min, p.ray.t_max);
    if (!whole.empty())
        stack[top++] = {0, whole.enter, whole.exit};
    while (top > 0) {
        auto [node, enter, exit] = stack[--top];
        if (enter > limit())
            continue;
        while (!nodes[node].is_leaf()) {
            const int axis = nodes[node].axis();
            const double distance = nodes[node].split() - p.ray.org[axis];
            const uint32_t below = node + 1;
            const uint32_t above = nodes[node].above();
            double near_exit = exit, far_enter = enter;
            bool below_first = p.ray.dir[axis] > 0;
            if (p.ray.dir[axis] == 0) {
                below_first = distance >= 0;
                if (std::abs(distance) > margin)
                    far_enter = std::numeric_limits<double>::infinity(); // never reached
            } else {
                const double a = (distance - margin) * p.inv_dir[axis];
                const double b = (distance + margin) * p.inv_dir[axis];
                // Comparisons with NaN are false, so that both sides are then visited over the
                // whole interval.
                near_exit = std::max(a, b) < exit ? std::max(a, b) : exit;
                far_enter = std::min(a, b) > enter ? std::min(a, b) : enter;
            }
            const uint32_t near = below_first ? below : above;
            const uint32_t far = below_first ? above : below;
            if (near_exit < enter) {
                node = far;
                enter = far_enter;
                continue;
            }
            if (far_enter <= exit) {
                assert(top < int(stack.size()));
                stack[top++] = {far, far_enter, exit};
            }
            node = near;
            exit = near_exit;
        }
        if (visit(nodes[node], enter, exit))
            return;
    }
}

} // namespace ovc
