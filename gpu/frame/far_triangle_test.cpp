// SPDX-License-Identifier: Apache-2.0
// The numbers of a far triangle tell where its corners lie, within the bounds that they come with.
#include "gpu/frame/far_triangle.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {
namespace {

struct Found {
    Leaf leaf;
    std::vector<FarTriangle> far;
};

/// Returns the far triangles of a leaf around the soup, in a scene `times` as large.
Found far_triangles(const Soup& soup, double times = 1) {
    Box bounds;
    const std::vector<TriangleId> triangles = hittable_triangles(soup, nullptr, &bounds);
    Found found{whole_leaf(soup, triangles, bounds), {}};
    const Box scene = bounds.padded((times - 1) / 2 * max_component(bounds.extent()));
    const Numbering numbers(soup);
    found.far = far_triangles_of({soup, numbers}, found.leaf, scene);
    return found;
}

TEST(FarTriangle, TellsTheWeightsOfPointsWithinItsBounds) {
    test::Random random(1);
    size_t triangles = 0;
    for (uint64_t seed = 0; seed < 300; ++seed) {
        const double size = std::pow(10.0, random(-6, 8));
        const Soup soup =
            test::random_soup(seed, 1 + random.below(16), size, random.point(-9, 9) * size);
        const auto [leaf, far] = far_triangles(soup);
        for (const FarTriangle& f : far) {
            ++triangles;
            const Triangle t = soup.triangle(leaf.triangles[f.number]);
            const double b = random(-1, 2), c = random(-1, 2);
            const dvec3 world = t[0] + b * (t[1] - t[0]) + c * (t[2] - t[0]);
            const dvec3 p = leaf.frame.to_local(world);
            const dvec3 p_error = 0x1p-49 * (glm::abs(world) * leaf.frame.scale + dvec3(1));
            const std::array weights{1 - b - c, b, c};
            for (size_t i = 0; i < 3; ++i) {
                // Beyond the corners the error grows with the weights, and the point has its own.
                const FarTriangle::Corner& corner_i = f.corners[i];
                const double error = 8 * f.error + glm::dot(glm::abs(corner_i.to_weight), p_error);
                EXPECT_NEAR(corner_i.weight_at(p), weights[i], error);
                EXPECT_LE(f.error, 1e-6);
                const dvec3 corner = leaf.frame.to_local(t[i]);
                EXPECT_LE(f.lo, glm::dot(f.normal, corner));
                EXPECT_GE(f.hi, glm::dot(f.normal, corner));
            }
            EXPECT_LE(f.hi - f.lo, 1e-7) << "thick for its width";
        }
    }
    EXPECT_GT(triangles, 1000u);
}

TEST(FarTriangle, IsOneOfFewInALeafThatIsLargeInTheScene) {
    const Soup few = test::random_soup(3, 16, 0.5);
    EXPECT_EQ(far_triangles(few).far.size(), 16u);
    EXPECT_EQ(far_triangles(few, 3).far.size(), 16u);
    EXPECT_EQ(far_triangles(few, 8).far.size(), 0u);
    EXPECT_EQ(far_triangles(test::random_soup(3, 17, 0.5)).far.size(), 0u);
}

TEST(FarTriangle, IsNotTooThin) {
    Soup sliver;
    const dvec3 along(1, 1 / 3.0, 1 / 7.0);
    sliver.chunks.push_back(
        Chunk::owning_doubles(dvec3(0), {dvec3(0), along, 0.7 * along + dvec3(0, 1e-12, 0)}));
    EXPECT_TRUE(far_triangles(sliver).far.empty());
}

} // namespace
} // namespace ovc
