// SPDX-License-Identifier: Apache-2.0
// Duplicates: the smallest of each set stays, and the set names the others.
#include "core/duplicates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace ovc {
namespace {

/// Returns triangles with corners of few values, so that most come several times, in three meshes.
/// One of these has an origin that puts its triangles where others are.
Soup crowded_soup(uint64_t seed, size_t count) {
    std::mt19937_64 draw(seed);
    Soup soup;
    for (int mesh = 0; mesh < 3; ++mesh) {
        const dvec3 origin(mesh == 2 ? 1 : 0);
        std::vector<vec3> corners;
        for (size_t i = 0; i < count * 3; ++i)
            corners.push_back(
                vec3(float(draw() % 3), draw() % 2 ? 1.0f : -0.0f, float(draw() % 2)) -
                vec3(origin));
        soup.chunks.push_back(Chunk::owning(origin, std::move(corners)));
    }
    return soup;
}

std::vector<TriangleId> all_of(const Soup& soup) {
    return hittable_triangles(soup, nullptr, nullptr);
}

using Key = std::array<std::array<double, 3>, 3>;

/// Returns the corners in a canonical order, with -0 as 0.
Key key_of(const Triangle& triangle) {
    Key key;
    for (int i = 0; i < 3; ++i)
        key[i] = {triangle[i].x + 0.0, triangle[i].y + 0.0, triangle[i].z + 0.0};
    std::sort(key.begin(), key.end());
    return key;
}

TEST(Duplicates, KeepTheSmallestOfEachSetAndNameTheOthers) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
        const Soup soup = crowded_soup(seed, 50 << (seed % 5));
        const std::vector<TriangleId> before = all_of(soup);
        std::map<Key, std::vector<TriangleId>> sets;
        for (const TriangleId id : before)
            sets[key_of(soup.triangle(id))].push_back(id);

        std::vector<TriangleId> kept = before;
        const Duplicates duplicates = Duplicates::take_out(soup, kept);
        std::vector<TriangleId> smallest;
        for (const auto& [key, set] : sets) {
            smallest.push_back(set[0]);
            std::vector<TriangleId> found{set[0]};
            for (const Duplicates::Pair& pair : duplicates.of(set[0]))
                found.push_back(pair.other);
            EXPECT_EQ(found, set);
        }
        std::sort(smallest.begin(), smallest.end());
        EXPECT_EQ(kept, smallest) << "seed " << seed;
        EXPECT_EQ(duplicates.count(), before.size() - kept.size());
        EXPECT_GT(duplicates.count(), 0u);
    }
}

TEST(Duplicates, LeaveASoupWithoutThemAlone) {
    std::mt19937_64 draw(3);
    std::vector<vec3> corners(30000);
    for (vec3& corner : corners)
        corner = vec3(float(draw() >> 40), float(draw() >> 40), float(draw() >> 40));
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), std::move(corners)));
    std::vector<TriangleId> kept = all_of(soup);
    const std::vector<TriangleId> before = kept;
    const Duplicates duplicates = Duplicates::take_out(soup, kept);
    EXPECT_EQ(kept, before);
    EXPECT_EQ(duplicates.count(), 0u);
    EXPECT_TRUE(duplicates.of(before[0]).empty());
}

TEST(Duplicates, CountUAndVFromTheirOwnCorners) {
    const dvec3 corner[3] = {dvec3(0), dvec3(4, 0, 0), dvec3(0, 4, 0)};
    int order[3] = {0, 1, 2};
    do {
        Soup soup;
        soup.chunks.push_back(Chunk::owning(
            dvec3(0), {vec3(corner[0]), vec3(corner[1]), vec3(corner[2]), vec3(corner[order[0]]),
                       vec3(corner[order[1]]), vec3(corner[order[2]])}));
        std::vector<TriangleId> kept = all_of(soup);
        const Duplicates duplicates = Duplicates::take_out(soup, kept);
        const Hit hit = as_hit_of(duplicates.of({0, 0})[0].other, soup, {1, 0.25, 0.125, {0, 0}});
        ASSERT_EQ(hit.id, (TriangleId{0, 1}));
        const Triangle t = soup.triangle(hit.id);
        EXPECT_EQ((1 - hit.u - hit.v) * t[0] + hit.u * t[1] + hit.v * t[2], dvec3(1, 0.5, 0));
    } while (std::next_permutation(order, order + 3));
}

TEST(Duplicates, HaveAllThreeCornersInCommon) {
    const dvec3 a(0), b(1, 0, 0), c(0, 1, 0), d(0, 0, 1);
    EXPECT_TRUE(same_corners({a, b, c}, {c, a, b}));
    EXPECT_TRUE(same_corners({a, b, c}, {b, a, c})) << "wound the other way";
    EXPECT_TRUE(same_corners({a, b, c}, {-a, b, c})) << "-0 is 0";
    EXPECT_FALSE(same_corners({a, b, c}, {a, b, d}));
    EXPECT_FALSE(same_corners({a, b, c}, {a, b, b}));
    EXPECT_FALSE(same_corners({a, b, b}, {a, a, b}));
}

} // namespace
} // namespace ovc
