// SPDX-License-Identifier: Apache-2.0
// Groups the boxes of a part's nodes by a BVH over them, and brings them into the world.
#include "gpu/page/portal_boxes.h"

#include "gpu/bvh/bvh.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/open_nodes.h"

#include <algorithm>

namespace ovc {
namespace {

/// Boxes of an outline. Each takes some nanoseconds a portal.
constexpr size_t kBoxes = 64;
/// The boxes are so much wider on each side, in the frame, where the pages lie within [-1, 1]: a
/// thousand times what roundings move between there and the world (is_well_moved()).
constexpr double kMargin = 0x1p-20;

/// Returns the roots of up to `max` subtrees that hold all of the tree, the largest nodes opened.
std::vector<uint32_t> largest_subtrees(std::span<const BvhNode> nodes, size_t max) {
    std::vector<uint32_t> roots{0};
    const auto size = [&](uint32_t root) {
        return nodes[root].is_leaf() ? -1 : nodes[root].box.half_area();
    };
    while (roots.size() < max) {
        const auto largest = std::ranges::max_element(roots, {}, size);
        const uint32_t root = *largest;
        if (nodes[root].is_leaf())
            break;
        *largest = root + 1;
        roots.push_back(nodes[root].right);
    }
    return roots;
}

} // namespace

PartOutline::PartOutline(std::span<const Page> pages) {
    const bool in_memory =
        std::ranges::none_of(pages, [](const Page& page) { return page.stored_bytes != 0; });
    const std::vector<Entry> entries =
        opened(pages, in_memory ? std::max(kBoxes, pages.size()) : pages.size());
    std::vector<Boxf> boxes;
    for (const Entry& entry : entries)
        boxes.push_back(entry.box);
    const GridHeader grid = header_of(pages[0].view());
    const dvec3 first = dvec3(grid.middle) - double(kGridMiddle) * dvec3(grid.cell);
    const std::vector<BvhNode> nodes = build_bvh(boxes);
    const std::vector<uint32_t> roots = largest_subtrees(nodes, kGroups);
    for (size_t i = 0; i < roots.size(); ++i) {
        uint32_t to_come = 1; // nodes of the subtree
        for (uint32_t node = roots[i]; to_come > 0; ++node, --to_come) {
            if (!nodes[node].is_leaf()) {
                to_come += 2;
                continue;
            }
            const dvec3 lo(nodes[node].box.lo), hi(nodes[node].box.hi);
            groups_[i].push_back({first + (lo + hi) / 2.0, (hi - lo) / 2.0 + kMargin});
        }
    }
}

PartOutline::Groups PartOutline::placed(const Frame& frame, const Transform* transform) const {
    const Transform way = or_identity(transform);
    Groups groups;
    for (size_t i = 0; i < kGroups; ++i) {
        for (const Block& block : groups_[i]) {
            const dvec3 center = way(frame.origin + block.center / frame.scale);
            const dvec3 half = block.half_extent / frame.scale;
            dvec3 reach;
            for (int axis = 0; axis < 3; ++axis) {
                const auto& row = way.rows[size_t(axis)];
                reach[axis] = std::abs(row[0]) * half.x + std::abs(row[1]) * half.y +
                              std::abs(row[2]) * half.z;
            }
            groups[i].add(Box{center - reach, center + reach});
        }
        if (!groups[i].empty())
            groups[i] = groups[i].padded(groups[i].rounding());
    }
    return groups;
}

} // namespace ovc
