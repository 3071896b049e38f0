// SPDX-License-Identifier: Apache-2.0
// Kd-restart on level 1: finds the cell behind a t, and the leaves of cells.
#include "kdtree/restart.h"

#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {
namespace {

struct CellVisit {
    const KdNode* cell = nullptr;
    double exit = 0; // t at which the ray leaves the cell
};

/// Returns the cell that holds the ray just after t. The t of a plane is always computed in the
/// same way, so a restart at the exit of a cell always lands in the next: t grows with every cell,
/// and no cell comes twice.
CellVisit cell_after(const Level1& level1, const PreparedRay& p, double t) {
    double exit = p.ray.t_max;
    uint32_t node = 0;
    while (!level1.nodes[node].is_leaf()) {
        const KdNode& n = level1.nodes[node];
        const int axis = n.axis();
        const uint32_t below = node + 1;
        const uint32_t above = n.above();
        if (p.ray.dir[axis] == 0) {
            node = p.ray.org[axis] <= n.split() ? below : above;
            continue;
        }
        const double plane = (n.split() - p.ray.org[axis]) * p.inv_dir[axis];
        const bool below_first = p.ray.dir[axis] > 0;
        if (t < plane) {
            exit = std::min(exit, plane);
            node = below_first ? below : above;
        } else {
            node = below_first ? above : below;
        }
    }
    return {&level1.nodes[node], exit};
}

} // namespace

bool can_walk(const Level1& level1, const PreparedRay& p) {
    return has_walked_direction(p) &&
           (level1.bounds.empty() || p.margin(level1.bounds) <= level1.padding);
}

Visit next_leaf_in_cell(const Level1& level1, const PreparedRay& p, RayPosition& position) {
    while (position.next < position.end) {
        const uint32_t leaf = position.next++;
        assert(leaf < level1.leaves.size());
        const Interval inside = clip(p, level1.leaves[leaf].box, p.ray.t_min, p.ray.t_max);
        if (!inside.empty())
            return {leaf, inside};
    }
    return {};
}

Visit next_leaf(const Level1& level1, const PreparedRay& p, RayPosition& position) {
    constexpr double never = std::numeric_limits<double>::infinity();
    if (level1.nodes.empty())
        return {};
    if (position.t == p.ray.t_min && position.end == 0 &&
        clip(p, level1.bounds.padded(level1.padding), p.ray.t_min, p.ray.t_max).empty())
        return {};
    while (true) {
        if (const Visit visit = next_leaf_in_cell(level1, p, position); visit.leaf != kNone)
            return visit;
        if (position.t == never)
            return {};
        const CellVisit visit = cell_after(level1, p, position.t);
        position = {visit.exit < p.ray.t_max ? visit.exit : never, visit.cell->first(),
                    visit.cell->first() + visit.cell->count()};
    }
}

} // namespace ovc
