// SPDX-License-Identifier: Apache-2.0
// The tree by insertion holds every box once, inside its ancestors; shuffles keep the best cost.
#include "plugin/thesis/level1/goldsmith_salmon.h"

#include "core/ray.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <numeric>

namespace ovc::thesis {
namespace {

std::vector<Boxf> boxes_of(const Soup& soup) {
    std::vector<Boxf> boxes;
    for (const TriangleId id : hittable_triangles(soup, nullptr, nullptr)) {
        const Box box = bounds_of(soup.triangle(id));
        boxes.push_back({vec3(box.lo), vec3(box.hi)});
    }
    return boxes;
}

bool contains(const Boxf& outer, const Boxf& inner) {
    return outer.contains(inner.lo) && outer.contains(inner.hi);
}

/// Returns the depth of the tree below n, and counts items into `seen`.
size_t check(const InsertionTree& tree, uint32_t n, const std::vector<Boxf>& boxes,
             std::vector<int>& seen) {
    const InsertionNode& node = tree.nodes[n];
    if (node.item != kNone) {
        ++seen[node.item];
        EXPECT_EQ(node.children, 0u);
        EXPECT_TRUE(contains(node.box, boxes[node.item]));
        return 1;
    }
    size_t depth = 0;
    uint32_t children = 0;
    for (uint32_t c = node.first_child; c != kNone; c = tree.nodes[c].next_sibling, ++children) {
        EXPECT_TRUE(contains(node.box, tree.nodes[c].box));
        EXPECT_EQ(tree.nodes[c].parent, n);
        depth = std::max(depth, check(tree, c, boxes, seen));
    }
    EXPECT_EQ(children, node.children);
    return depth + 1;
}

TEST(GoldsmithSalmon, HoldsEveryBoxOnceAndStaysShallow) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const std::vector<Boxf> boxes = boxes_of(soup);
        const InsertionTree tree = best_insertion_tree(boxes, 3);
        if (boxes.empty()) {
            EXPECT_TRUE(tree.nodes.empty());
            continue;
        }
        std::vector<int> seen(boxes.size(), 0);
        EXPECT_LE(check(tree, 0, boxes, seen), 60u) << name;
        for (const int count : seen)
            EXPECT_EQ(count, 1) << name;
        EXPECT_EQ(tree.nodes[0].items, boxes.size()) << name;
    }
}

TEST(GoldsmithSalmon, MoreShufflesCostNoMoreAndAreTheSameEveryTime) {
    const std::vector<Boxf> boxes = boxes_of(test::random_soup(4, 2000, 0.02));
    const double one = best_insertion_tree(boxes, 1).cost;
    const double ten = best_insertion_tree(boxes, 10).cost;
    EXPECT_LT(ten, one);
    EXPECT_EQ(ten, best_insertion_tree(boxes, 10).cost);
}

TEST(GoldsmithSalmon, CostsLessThanOneListAndThanHalvesInTheOrderOfTheFile) {
    const std::vector<Boxf> boxes = boxes_of(test::random_soup(4, 2000, 0.02));
    std::vector<uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    // Testing all 2000 costs 2000, and halving unsorted boxes by count costs hardly less.
    EXPECT_LT(insert_in_order(boxes, order).cost, 100);
}

} // namespace
} // namespace ovc::thesis
