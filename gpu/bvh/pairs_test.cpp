// SPDX-License-Identifier: Apache-2.0
// Pairing loses no triangle and moves no corner.
#include "gpu/bvh/pairs.h"

#include "core/ray.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ovc {
namespace {

std::vector<LocalTriangle> triangles_of(const Soup& soup) {
    std::vector<LocalTriangle> triangles;
    for (const Chunk& chunk : soup.chunks)
        for (uint32_t i = 0; i < chunk.size(); ++i) {
            const Triangle t = chunk.triangle(i);
            triangles.push_back({vec3(t[0]), vec3(t[1]), vec3(t[2])});
        }
    return triangles;
}

/// Returns the corners in an order that does not depend on which comes first.
LocalTriangle sorted(LocalTriangle t) {
    std::sort(t.begin(), t.end(), [](const vec3& a, const vec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    });
    return t;
}

TEST(Pairs, HoldEveryTriangleOnceWithItsOwnCorners) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        SCOPED_TRACE(name);
        std::vector<LocalTriangle> triangles = triangles_of(soup);
        std::erase_if(triangles, [](const LocalTriangle& t) { return !is_finite(t[0]); });
        std::vector<int> seen(triangles.size(), 0);
        for (const TrianglePair& pair : pair_triangles(triangles)) {
            const auto& c = pair.corners;
            ++seen[pair.a];
            EXPECT_EQ(sorted({c[0], c[1], c[2]}), sorted(triangles[pair.a]));
            if (pair.b == kNone)
                continue;
            ++seen[pair.b];
            EXPECT_EQ(sorted({c[0], c[3], c[2]}), sorted(triangles[pair.b]));
        }
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), ptrdiff_t(seen.size()));
    }
}

TEST(Pairs, JoinMostOfAClosedMesh) {
    const auto triangles = triangles_of(test::closed_grid(64));
    EXPECT_LT(pair_triangles(triangles).size(), triangles.size() * 0.53);
}

} // namespace
} // namespace ovc
