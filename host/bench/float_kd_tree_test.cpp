// SPDX-License-Identifier: Apache-2.0
// Tests that the float tree answers as the tree in double does, except for a few hits.
#include "host/bench/float_kd_tree.h"

#include "kdtree/build.h"
#include "testscenes/catalog.h"
#include "testscenes/random.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(FloatKdTree, AnswersNearlyAsTheTreeInDouble) {
    const Result<Scene> scene = make_test_scene("sphere-4");
    ASSERT_TRUE(bool(scene));
    const KdTree tree = build_kd_tree(scene->soup);
    const auto exact = make_cpu_backend(scene->soup, tree, 0);
    const auto rounded = make_float_kd_backend(scene->soup, tree);
    std::vector<Ray> rays(20000);
    Random random(1, 0);
    for (Ray& ray : rays) {
        ray.org = 3.0 * random.direction();
        ray.dir = 0.5 * random.direction() - ray.org;
    }
    std::vector<Hit> expected(rays.size()), found(rays.size());
    std::vector<uint8_t> hidden(rays.size());
    std::vector<TriangleId> skip(rays.size());
    for (int round = 0; round < 2; ++round) {
        ASSERT_TRUE(exact->intersect(rays, skip, expected));
        ASSERT_TRUE(rounded->intersect(rays, skip, found));
        ASSERT_TRUE(rounded->occluded(rays, skip, hidden));
        size_t hits = 0, other = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            hits += expected[i].is_hit();
            other += expected[i].id != found[i].id || hidden[i] != expected[i].is_hit();
            if (expected[i].id == found[i].id && found[i].is_hit()) {
                EXPECT_NEAR(expected[i].t, found[i].t, 1e-4) << "ray " << i;
            }
            skip[i] = expected[i].id; // rays of the second round go on behind their first hit
        }
        EXPECT_GT(hits, rays.size() / 4) << "round " << round;
        EXPECT_LT(other, rays.size() / 500) << "round " << round;
    }
}

} // namespace
} // namespace ovc
