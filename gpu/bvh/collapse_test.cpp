// SPDX-License-Identifier: Apache-2.0
// Compares the choice of nodes that remain with every choice there is.
#include "gpu/bvh/collapse.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <limits>

namespace ovc {
namespace {

std::vector<Boxf> strewn(uint64_t seed, size_t count) {
    test::Random random(seed);
    std::vector<Boxf> boxes;
    for (size_t i = 0; i < count; ++i) {
        const vec3 p(random.point(0, 1));
        boxes.push_back({p, p + vec3(random.point(0, 0.3))});
    }
    return boxes;
}

/// Returns the min sum of areas over all ways to put the boxes below `node` under up to
/// `max_children` nodes.
double min_cost(const std::vector<BvhNode>& nodes, uint32_t node, int max_children) {
    const BvhNode& n = nodes[node];
    if (n.is_leaf())
        return 0;
    double best = std::numeric_limits<double>::infinity();
    for (int i = 1; i < max_children; ++i)
        best = std::min(best,
                        min_cost(nodes, node + 1, i) + min_cost(nodes, n.right, max_children - i));
    for (int i = 1; i < 4; ++i)
        best = std::min(best, double(n.box.half_area()) + min_cost(nodes, node + 1, i) +
                                  min_cost(nodes, n.right, 4 - i));
    return best;
}

double cost(const std::vector<BvhNode>& nodes, const Collapse& collapse, Subtree of,
            std::vector<int>& seen) {
    const BvhNode& n = nodes[of.node];
    if (n.is_leaf()) {
        ++seen[n.item];
        return 0;
    }
    const Children children = collapse.children(of);
    EXPECT_GE(children.count, 2);
    double sum = n.box.half_area();
    for (int i = 0; i < children.count; ++i)
        sum += cost(nodes, collapse, children.subtree[size_t(i)], seen);
    return sum;
}

TEST(Collapse, IsTheCheapestOfAllAndLosesNoBox) {
    for (uint64_t seed = 0; seed < 40; ++seed) {
        SCOPED_TRACE(seed);
        const std::vector<Boxf> boxes = strewn(seed, 2 + seed % 7);
        const std::vector<BvhNode> nodes = build_bvh(boxes);
        const Collapse collapse(nodes, nullptr);
        std::vector<int> seen(boxes.size(), 0);
        const double expected = min_cost(nodes, 0, 1);
        EXPECT_NEAR(cost(nodes, collapse, collapse.root(), seen), expected, 1e-5 * expected);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), ptrdiff_t(boxes.size()));
    }
}

} // namespace
} // namespace ovc
