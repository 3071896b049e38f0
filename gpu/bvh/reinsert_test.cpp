// SPDX-License-Identifier: Apache-2.0
// Compares reinsertion with trying every move, and checks what it must keep: the leaves, boxes that
// fit, the height, the cost, and the bits.
#include "gpu/bvh/reinsert.h"

#include "core/system/parallel.h"
#include "gpu/bvh/best_move.h"
#include "gpu/bvh/pairs.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <tuple>

namespace ovc {
namespace {

using Tree = std::vector<BvhNode>;

std::vector<Boxf> strewn(uint64_t seed, size_t count, double size) {
    test::Random random(seed);
    std::vector<Boxf> boxes;
    for (size_t i = 0; i < count; ++i) {
        const vec3 p(random.point(0, 1));
        boxes.push_back({p, p + vec3(random.point(0, size))});
    }
    return boxes;
}

/// Returns small boxes, and floors through all of them.
std::vector<Boxf> storeys() {
    std::vector<Boxf> boxes = strewn(3, 5000, 0.02);
    for (int i = 0; i < 8; ++i) {
        const float z = float(i) / 8;
        boxes.push_back({{0, 0, z}, {1, 0.5f, z}});
        boxes.push_back({{0, 0.5f, z}, {1, 1, z}});
    }
    return boxes;
}

std::vector<std::pair<std::string, Tree>> trees() {
    std::vector<Boxf> rods = strewn(4, 20000, 0.02), series;
    for (size_t i = 0; i < rods.size(); ++i)
        rods[i].hi[int(i % 3)] += 0.3f;
    for (int i = 0; i < 300; ++i) {
        const float x = std::pow(0.75f, float(i)); // each split by the heuristic cuts off one
        series.push_back({vec3(x), vec3(x * 1.1f)});
    }
    return {{"none", {}},
            {"one", build_bvh(strewn(1, 1, 1))},
            {"two", build_bvh(strewn(1, 2, 1))},
            {"strewn", build_bvh(strewn(2, 20000, 0.02))},
            {"rods", build_bvh(rods)},
            {"storeys", build_bvh(storeys())},
            {"coincident", build_bvh(std::vector<Boxf>(1000, Boxf{vec3(0), vec3(1)}))},
            {"geometric series", build_bvh(series)}};
}

/// Every leaf's item and box, sorted. walk() also checks that every box is the union of its
/// children's.
using LeafList = std::vector<std::tuple<uint32_t, float, float, float, float, float, float>>;

int walk(const Tree& nodes, uint32_t node, LeafList& leaves) {
    const auto& [box, right, item] = nodes[node];
    if (nodes[node].is_leaf()) {
        leaves.emplace_back(item, box.lo.x, box.lo.y, box.lo.z, box.hi.x, box.hi.y, box.hi.z);
        return 0;
    }
    Boxf both = nodes[node + 1].box;
    both.add(nodes[right].box);
    EXPECT_TRUE(both.lo == box.lo && both.hi == box.hi) << node;
    return 1 + std::max(walk(nodes, node + 1, leaves), walk(nodes, right, leaves));
}

struct Facts {
    LeafList leaves;
    int height = 0;
    double cost = 0;

    explicit Facts(const Tree& nodes) {
        if (nodes.empty())
            return;
        height = walk(nodes, 0, leaves);
        std::sort(leaves.begin(), leaves.end());
        cost = SiblingTree(nodes).cost();
    }
};

bool same(const Tree& a, const Tree& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const BvhNode& x, const BvhNode& y) {
                          return x.box.lo == y.box.lo && x.box.hi == y.box.hi &&
                                 x.right == y.right && x.item == y.item;
                      });
}

TEST(Reinsert, KeepsTheLeavesAndGrowsNeitherCostNorHeight) {
    for (auto& [name, nodes] : trees()) {
        SCOPED_TRACE(name);
        const Facts before(nodes);
        reinsert(nodes);
        const Facts after(nodes);
        EXPECT_EQ(nodes.size(), before.leaves.empty() ? 0 : 2 * before.leaves.size() - 1);
        EXPECT_EQ(after.leaves, before.leaves);
        EXPECT_LE(after.height, before.height);
        EXPECT_LE(after.cost, before.cost * (1 + 1e-6));
    }
}

TEST(Reinsert, KeepsEveryPartOfWhatPlanesCut) {
    test::Random random(6);
    std::vector<LocalTriangle> triangles;
    for (int i = 0; i < 3000; ++i) {
        const vec3 from(random.point(-1, 1));
        const vec3 along = (i % 20 ? 0.02f : 1.0f) * vec3(random.point(-1, 1)); // some are long
        triangles.push_back({from, from + along, from + vec3(random.point(-0.005, 0.005))});
    }
    const std::vector<TrianglePair> pairs = pair_triangles(triangles);
    std::vector<Boxf> boxes(pairs.size());
    for (size_t i = 0; i < pairs.size(); ++i)
        for (const vec3& corner : pairs[i].corners)
            boxes[i].add(corner);
    Tree nodes = build_split_bvh(boxes, pairs, pairs.size() / 5);
    const Facts before(nodes);
    ASSERT_GT(before.leaves.size(), pairs.size());
    reinsert(nodes);
    const Facts after(nodes);
    EXPECT_EQ(after.leaves, before.leaves);
    EXPECT_LT(after.cost, before.cost);
    EXPECT_EQ(nodes.size(), 2 * before.leaves.size() - 1) << "no node is unused";
}

TEST(Reinsert, GainsMuchWhereFloorsGoThroughSmallThings) {
    Tree nodes = build_bvh(storeys());
    const double before = Facts(nodes).cost;
    reinsert(nodes);
    EXPECT_LT(Facts(nodes).cost, 0.9 * before);
}

TEST(Reinsert, GivesTheSameBitsOnAnyNumberOfThreads) {
    for (const auto& [name, nodes] : trees()) {
        SCOPED_TRACE(name);
        Tree one = nodes, four = nodes;
        {
            const ThreadLimit limit(1);
            reinsert(one);
        }
        const ThreadLimit limit(4);
        reinsert(four);
        EXPECT_TRUE(same(one, four));
    }
}

TEST(Reinsert, CanBeStopped) {
    Tree nodes = build_bvh(strewn(5, 1000, 0.1));
    bool goes_on = true;
    BuildProgress progress([&](double, const char*) { return goes_on; });
    progress.begin("work", 1, 1);
    goes_on = false;
    std::this_thread::sleep_for(
        std::chrono::milliseconds(50)); // progress reports only now and then
    EXPECT_THROW(reinsert(nodes, &progress), Cancelled);
}

TEST(MoveSearch, FindsTheBestOfAllMovesThereAre) {
    int moves = 0;
    for (uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        const Tree nodes = build_bvh(strewn(seed, 2 + seed % 15, 0.5));
        SiblingTree tree(nodes);
        for (uint32_t from = SiblingTree::kFirst; from < tree.end(); ++from) {
            float least = 0;
            for (uint32_t to = 0; to < tree.end(); ++to) {
                if (to == 1 || !tree.can_move(from, to))
                    continue;
                const double before = tree.cost();
                const uint32_t parent = tree.parent(from);
                const float change = tree.move(from, to);
                EXPECT_NEAR(change, tree.cost() - before, 1e-5 * before);
                Facts(tree.nodes()); // checks that boxes fit
                least = std::min(least, change);
                tree.move(from, parent);
                ASSERT_TRUE(same(tree.nodes(), nodes)) << "undone";
            }
            const Move best = MoveSearch(tree, from).best();
            EXPECT_NEAR(best.gain, -least, 1e-5 * tree.cost());
            EXPECT_EQ(best.to == kNone, best.gain == 0);
            moves += best.gain > 0;
        }
    }
    EXPECT_GT(moves, 20) << "some trees could be better";
}

} // namespace
} // namespace ovc
