// SPDX-License-Identifier: Apache-2.0
// Samples: their size, their members, and that a level 1 cut by them keeps to its count.
#include "kdtree/sample.h"

#include "kdtree/partition.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace ovc {
namespace {

TEST(Sample, TakesAllOfAFewAndOneInManyOfMany) {
    EXPECT_EQ(sample_rate(0, 10), 1u);
    EXPECT_EQ(sample_rate(16383, 1u << 30), 1u);
    EXPECT_EQ(sample_rate(16384, 1u << 30), 2u);
    EXPECT_EQ(sample_rate(100'000'000, 1u << 30), 64u);
    EXPECT_EQ(sample_rate(100'000'000, 255), 1u) << "enough in every leaf";
    const Soup soup = test::random_soup(3, 64000, 0.1);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    EXPECT_EQ(sample_triangles(soup, ids, 1), ids);
    for (const uint32_t rate : {2u, 8u, 64u}) {
        const auto sample = sample_triangles(soup, ids, rate);
        // Chance moves the count by about its root; four times that are allowed.
        const double expected = double(ids.size()) / rate;
        EXPECT_NEAR(double(sample.size()), expected, 4 * std::sqrt(expected)) << rate;
        EXPECT_TRUE(std::is_sorted(sample.begin(), sample.end()));
    }
}

TEST(Sample, HasAllDuplicatesOrNone) {
    const Soup once = test::random_soup(4, 5000, 0.1);
    std::vector<vec3> corners(once.chunks[0].corners().begin(), once.chunks[0].corners().end());
    for (size_t i = 0; i < 15000; i += 3) // again, turned and wound the other way
        corners.insert(corners.end(), {corners[i + 2], corners[i + 1], corners[i]});
    const Soup twice = test::one_chunk(std::move(corners));
    const auto sample = sample_triangles(twice, hittable_triangles(twice, nullptr, nullptr), 8);
    std::set<uint32_t> prims;
    for (const TriangleId id : sample)
        prims.insert(id.prim);
    ASSERT_GT(prims.size(), 500u);
    for (const uint32_t prim : prims)
        EXPECT_EQ(prims.count((prim + 5000) % 10000), 1u);
}

/// Returns many small triangles, and some that reach across all of them.
Soup large_soup() {
    const Soup small = test::closed_grid(250), large = test::random_soup(5, 40, 2);
    std::vector<vec3> corners(small.chunks[0].corners().begin(), small.chunks[0].corners().end());
    corners.insert(corners.end(), large.chunks[0].corners().begin(),
                   large.chunks[0].corners().end());
    return test::one_chunk(std::move(corners));
}

TEST(Sample, LeavesKeepToTheCountAndHoldEveryTriangleThatTouchesThem) {
    const Soup soup = large_soup();
    Box bounds;
    const auto ids = hittable_triangles(soup, nullptr, &bounds);
    for (const uint32_t max_triangles : {100'000u, 20'000u, 2'000u, 300u}) {
        const Level1 level1 = partition(soup, ids, bounds, max_triangles);
        uint64_t references = 0;
        for (const Leaf& leaf : level1.leaves) {
            EXPECT_LE(leaf.triangles.size(), max_triangles);
            references += leaf.triangles.size();
        }
        EXPECT_LT(double(references), 1.5 * double(ids.size())) << max_triangles;
        // At each of its corners, a triangle is in the leaf around that corner.
        std::vector<std::set<TriangleId>> inside;
        for (const Leaf& leaf : level1.leaves)
            inside.emplace_back(leaf.triangles.begin(), leaf.triangles.end());
        for (size_t i = 0; i < ids.size(); i += 61)
            for (const dvec3& corner : soup.triangle(ids[i])) {
                bool found = false;
                for (size_t l = 0; l < inside.size() && !found; ++l)
                    found = level1.leaves[l].cell.contains(corner) && inside[l].count(ids[i]);
                EXPECT_TRUE(found) << "triangle " << i << ", leaves of " << max_triangles;
            }
    }
}

TEST(Sample, IsNotDrawnAgainWhereItIsTheOneToCutBy) {
    const Soup soup = large_soup();
    Box bounds;
    const auto ids = hittable_triangles(soup, nullptr, &bounds);
    constexpr uint32_t kMax = 20'000;
    const uint32_t rate = sample_rate(ids.size(), kMax);
    ASSERT_GT(rate, 1u);
    const auto leaves_by = [&](std::span<const TriangleId> drawn, uint32_t at) {
        std::vector<std::vector<TriangleId>> leaves;
        for (Leaf& leaf : partition(soup, ids, bounds, kMax, nullptr, {drawn, at}).leaves)
            leaves.push_back(std::move(leaf.triangles));
        return leaves;
    };
    const auto sample = sample_triangles(soup, ids, rate);
    const auto half = std::span(sample).first(sample.size() / 2);
    const auto expected = leaves_by({}, 0);
    EXPECT_EQ(leaves_by(sample, rate), expected);
    EXPECT_NE(leaves_by(half, rate), expected) << "it is taken as it is";
    EXPECT_EQ(leaves_by(half, 2 * rate), expected) << "another one is to be drawn";
}

TEST(Sample, CutsAgainOnlyTheLeavesItIsTold) {
    const Soup soup = large_soup();
    Box bounds;
    const auto ids = hittable_triangles(soup, nullptr, &bounds);
    const Level1 before = partition(soup, ids, bounds, 20'000);
    ASSERT_GE(before.leaves.size(), 4u);
    std::vector<uint32_t> max_triangles(before.leaves.size(), kNone), was;
    max_triangles[1] = 1000;
    max_triangles[3] = 5000;
    const Level1 after = cut_again(soup, before, max_triangles, was);
    ASSERT_EQ(was.size(), after.leaves.size());
    EXPECT_EQ(std::count(was.begin(), was.end(), kNone) + ptrdiff_t(before.leaves.size()) - 2,
              ptrdiff_t(was.size()));
    EXPECT_GT(after.leaves.size(), before.leaves.size() + 2);
    std::set<TriangleId> all;
    for (size_t i = 0; i < was.size(); ++i) {
        const Leaf& leaf = after.leaves[i];
        all.insert(leaf.triangles.begin(), leaf.triangles.end());
        if (was[i] == kNone) {
            EXPECT_LE(leaf.triangles.size(), 5000u);
            continue;
        }
        EXPECT_EQ(leaf.triangles, before.leaves[was[i]].triangles);
        EXPECT_EQ(leaf.box.lo, before.leaves[was[i]].box.lo);
        EXPECT_EQ(leaf.frame.origin, before.leaves[was[i]].frame.origin);
    }
    EXPECT_EQ(all.size(), ids.size());
    // Leaf nodes name all leaves, each once and in order.
    uint32_t next = 0;
    for (const KdNode& node : after.nodes)
        if (node.is_leaf()) {
            EXPECT_EQ(node.first(), next);
            next += node.count();
        }
    EXPECT_EQ(next, after.leaves.size());
}

} // namespace
} // namespace ovc
