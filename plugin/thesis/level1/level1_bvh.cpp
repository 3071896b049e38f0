// SPDX-License-Identifier: Apache-2.0
// The BVH is cut off by count, flattened and walked.
#include "plugin/thesis/level1/level1_bvh.h"

#include "plugin/thesis/system.h"

#include <algorithm>
#include <cassert>

namespace ovc::thesis {
namespace {

/// One suffices: the best order of ten changes the tree far below level 1, which is cut off.
constexpr int kLevel1Shuffles = 1;

/// A node of the hierarchy that is cut off: a leaf has items, and an inner node has children.
struct Branch {
    std::vector<uint32_t> items;
    std::vector<Branch> children;
};

/// Returns the subtree at `node`, whose n leaves take 2 n - 1 nodes in a row (gpu/bvh/bvh.h).
Branch cut_off(std::span<const BvhNode> nodes, uint32_t node, size_t leaves,
               uint32_t max_triangles) {
    assert(leaves > 0 && max_triangles > 0 && node + 2 * leaves - 1 <= nodes.size());
    Branch branch;
    if (leaves <= max_triangles) {
        for (const BvhNode& n : nodes.subspan(node, 2 * leaves - 1))
            if (n.is_leaf())
                branch.items.push_back(n.item);
        return branch;
    }
    const size_t left = (nodes[node].right - node) / 2;
    branch.children.push_back(cut_off(nodes, node + 1, left, max_triangles));
    branch.children.push_back(cut_off(nodes, nodes[node].right, leaves - left, max_triangles));
    return branch;
}

void collect(const InsertionTree& tree, uint32_t node, std::vector<uint32_t>& items) {
    std::vector<uint32_t> open = {node};
    while (!open.empty()) {
        const InsertionNode& n = tree.nodes[open.back()];
        open.pop_back();
        if (n.item != kNone)
            items.push_back(n.item);
        for (uint32_t child = n.first_child; child != kNone; child = tree.nodes[child].next_sibling)
            open.push_back(child);
    }
}

Branch merge(const InsertionTree& tree, uint32_t node, uint32_t max_triangles) {
    Branch branch;
    if (tree.nodes[node].items <= max_triangles) {
        collect(tree, node, branch.items);
        return branch;
    }
    std::vector<uint32_t> together; // the items of siblings that make one leaf
    for (uint32_t child = tree.nodes[node].first_child; child != kNone;
         child = tree.nodes[child].next_sibling) {
        if (tree.nodes[child].items > max_triangles) {
            branch.children.push_back(merge(tree, child, max_triangles));
            continue;
        }
        if (together.size() + tree.nodes[child].items > max_triangles)
            branch.children.push_back({std::exchange(together, {}), {}});
        collect(tree, child, together);
    }
    if (!together.empty())
        branch.children.push_back({std::move(together), {}});
    return branch;
}

/// Appends branches to the array, and their leaves to level 1.
class Flattener {
public:
    Flattener(const Soup& soup, std::span<const TriangleId> triangles, Level1& level1,
              std::vector<BvhEntry>& entries)
        : soup_(soup), triangles_(triangles), level1_(level1), entries_(entries) {}

    void append(const Branch& branch) {
        const size_t at = entries_.size();
        entries_.push_back({{}, 0, kNone});
        if (branch.children.empty()) {
            entries_[at].leaf = uint32_t(level1_.leaves.size());
            level1_.leaves.push_back(leaf_of(branch.items));
            entries_[at].box = level1_.leaves.back().box;
        }
        Box box = entries_[at].box;
        for (const Branch& child : branch.children) {
            const size_t first = entries_.size();
            append(child);
            box.add(entries_[first].box);
        }
        entries_[at].box = box;
        entries_[at].behind = uint32_t(entries_.size());
    }

private:
    Leaf leaf_of(std::span<const uint32_t> items) const {
        std::vector<TriangleId> triangles;
        Box bounds;
        for (const uint32_t item : items) {
            triangles.push_back(triangles_[item]);
            bounds.add(bounds_of(soup_.triangle(triangles.back())));
        }
        std::sort(triangles.begin(), triangles.end());
        return make_leaf(soup_, bounds.padded(level1_.padding), level1_.padding,
                         std::move(triangles));
    }

    const Soup& soup_;
    std::span<const TriangleId> triangles_;
    Level1& level1_;
    std::vector<BvhEntry>& entries_;
};

/// Returns boxes in the scene's frame, in float: they only decide which triangles go together.
std::vector<Boxf> rough_boxes(const Soup& soup, const Leaf& whole) {
    std::vector<Boxf> boxes(whole.triangles.size());
    const std::vector<LocalTriangle> triangles = local_triangles(soup, whole);
    for (size_t i = 0; i < triangles.size(); ++i)
        for (const vec3& corner : triangles[i])
            boxes[i].add(corner);
    return boxes;
}

} // namespace

CompleteBvh::CompleteBvh(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                         ovc_level1_build build, BuildProgress* progress)
    : soup_(soup), triangles_(triangles.begin(), triangles.end()), bounds_(bounds) {
    if (triangles.empty())
        return;
    const std::vector<Boxf> boxes = rough_boxes(soup, whole_leaf(soup, triangles, bounds));
    if (build == OVC_LEVEL1_BUILD_TOP_DOWN)
        nodes_ = build_bvh(boxes, progress);
    else
        insertion_ = best_insertion_tree(boxes, kLevel1Shuffles, progress);
}

Level1 CompleteBvh::cut(uint32_t max_leaf_triangles, std::vector<BvhEntry>& entries) const {
    assert(max_leaf_triangles > 0);
    entries.clear();
    Level1 level1;
    level1.bounds = bounds_;
    if (triangles_.empty())
        return level1;
    level1.padding = padding_of(bounds_);
    const Branch root = nodes_.empty() ? merge(insertion_, 0, max_leaf_triangles)
                                       : cut_off(nodes_, 0, triangles_.size(), max_leaf_triangles);
    Flattener(soup_, triangles_, level1, entries).append(root);
    level1.nodes = {KdNode::leaf(0, uint32_t(level1.leaves.size()))};
    return level1;
}

Visit next_in_bvh(std::span<const BvhEntry> entries, const PreparedRay& p, uint32_t& index) {
    while (index < entries.size()) {
        const BvhEntry& entry = entries[index];
        const Interval inside = clip(p, entry.box, p.ray.t_min, p.ray.t_max);
        index = inside.empty() ? entry.behind : index + 1;
        if (!inside.empty() && entry.leaf != kNone)
            return {entry.leaf, inside};
    }
    return {};
}

} // namespace ovc::thesis
