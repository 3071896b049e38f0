// SPDX-License-Identifier: Apache-2.0
// Streams over two-level answer what batches answer.
#include "plugin/two_level/test_two_level.h"

namespace ovc {
namespace {

using test::ok;
using test::Spawner;

TEST_F(TwoLevelGl, AStreamAnswersWhatBatchesAnswer) {
    for (const auto& [soup_name, soup] : test::unpleasant_soups()) {
        const auto rays = test::unpleasant_rays(soup, 71, 1500);
        for (const auto& [name, options] : variants()) {
            SCOPED_TRACE(soup_name + ", " + name);
            const auto structure = build(soup, options);
            std::vector<Hit> expected(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, {}, expected)));
            std::vector<Ray> second;
            std::vector<TriangleId> skip;
            std::vector<size_t> parents;
            for (size_t i = 0; i < rays.size(); ++i)
                if (expected[i].is_hit()) {
                    second.push_back(Spawner::from_hit(rays[i], expected[i]));
                    skip.push_back(expected[i].id);
                    parents.push_back(i);
                }
            std::vector<uint8_t> occluded(second.size());
            ASSERT_TRUE(ok(structure->occluded(second, skip, occluded)));

            Spawner host(rays, 400);
            ASSERT_TRUE(ok(structure->stream(host)));
            EXPECT_EQ(host.answers, rays.size());
            size_t differing = 0;
            for (size_t i = 0; i < rays.size(); ++i)
                differing += !test::same(host.hits_of[i], expected[i]);
            EXPECT_EQ(differing, 0u);
            differing = 0;
            for (size_t j = 0; j < parents.size(); ++j)
                differing += host.blocked[parents[j]] != occluded[j];
            EXPECT_EQ(differing, 0u);
        }
    }
}

TEST_F(TwoLevelGl, AStreamThatIsStoppedSaysSoAndTheStructureGoesOn) {
    const Soup soup = test::closed_grid(24);
    const auto rays = test::unpleasant_rays(soup, 5, 1000);
    const auto structure = build(soup, {.leaf_triangles = 100});
    Spawner host(rays, 100);
    host.stop_after = 150;
    const Result<Done> stopped = structure->stream(host);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::Cancelled);
    Spawner again(rays, 1000);
    EXPECT_TRUE(ok(structure->stream(again)));
    EXPECT_EQ(again.answers, rays.size());
}

} // namespace
} // namespace ovc
