// SPDX-License-Identifier: Apache-2.0
// The hierarchy holds every box once, inside all boxes above it, and never grows too deep.
#include "gpu/bvh/bvh.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

int check(const std::vector<BvhNode>& nodes, const std::vector<Boxf>& boxes, uint32_t node,
          std::vector<int>& seen) {
    const BvhNode& n = nodes[node];
    if (n.is_leaf()) {
        ++seen[n.item];
        EXPECT_EQ(n.box.lo, boxes[n.item].lo);
        EXPECT_EQ(n.box.hi, boxes[n.item].hi);
        return 0;
    }
    for (const uint32_t child : {node + 1, n.right}) {
        EXPECT_TRUE(n.box.contains(nodes[child].box.lo) && n.box.contains(nodes[child].box.hi));
    }
    return 1 + std::max(check(nodes, boxes, node + 1, seen), check(nodes, boxes, n.right, seen));
}

std::vector<std::pair<std::string, std::vector<Boxf>>> cases() {
    test::Random random(2);
    std::vector<Boxf> strewn, same, series;
    for (int i = 0; i < 20000; ++i) {
        const vec3 p(random.point(0, 1));
        strewn.push_back({p, p + vec3(random.point(0, 0.02))});
        same.push_back({vec3(0), vec3(1)});
    }
    for (int i = 0; i < 300; ++i) {
        const float x = std::pow(0.75f, float(i)); // each split by the heuristic cuts off one
        series.push_back({vec3(x), vec3(x * 1.1f)});
    }
    return {{"none", {}},
            {"one", {same[0]}},
            {"strewn", strewn},
            {"coincident", same},
            {"geometric series", series}};
}

TEST(Bvh, HoldsEveryBoxOnceInsideItsAncestors) {
    for (const auto& [name, boxes] : cases()) {
        SCOPED_TRACE(name);
        const std::vector<BvhNode> nodes = build_bvh(boxes);
        ASSERT_EQ(nodes.size(), boxes.empty() ? 0 : 2 * boxes.size() - 1);
        if (boxes.empty())
            continue;
        std::vector<int> seen(boxes.size(), 0);
        EXPECT_LE(check(nodes, boxes, 0, seen), kMaxBvhDepth);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), ptrdiff_t(boxes.size()));
    }
}

} // namespace
} // namespace ovc
