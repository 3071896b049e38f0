// SPDX-License-Identifier: Apache-2.0
// Two-level with two passes under way gives the same answers over a driver that does everything as
// late as GL allows.
#include "plugin/two_level/test_two_level.h"

#include "gpu/gl/workarounds.h"
#include "gpu/late/late_gl.h"

#include <cstdlib>
#include <optional>
#include <string>

namespace ovc {
namespace {

class LateTwoLevelGl : public TwoLevelGl, public testing::WithParamInterface<bool> {
protected:
    void SetUp() override {
        const std::string name(entry_of(Workaround::FinishedPass).name);
        setenv("OVERCAST_NO_WORKAROUNDS", name.c_str(), /* overwrite= */ 1);
        TwoLevelGl::SetUp();
        unsetenv("OVERCAST_NO_WORKAROUNDS");
        ASSERT_EQ(gl ? gl->info().passes_in_flight : 2, 2u);
    }
    void TearDown() override {
        if (gl)
            gl->run([&](GlState&) { driver.reset(); });
    }
    void begin_late(unsigned seed) {
        gl->run([&](GlState&) { driver.emplace(seed); });
    }

    const Soup soup = test::random_soup(3, 2000, 0.1);
    const std::vector<Ray> rays = test::rays_from_outside(6, 6000);
    std::optional<LateGl> driver;
};
INSTANTIATE_TEST_SUITE_P(Kernel, LateTwoLevelGl, testing::Bool(),
                         [](const auto& p) { return p.param ? "Compute" : "Fragment"; });

TEST_P(LateTwoLevelGl, AnswersAsBruteForceDoes) {
    const std::vector<Hit> expected = test::brute_force(soup, rays);
    begin_late(1);
    for (const uint64_t budget : {uint64_t(2) << 20, uint64_t(160) << 10}) {
        SCOPED_TRACE(budget);
        const auto structure =
            build(soup, {.budget_bytes = budget, .leaf_triangles = 100, .compute = GetParam()});
        ASSERT_TRUE(structure);
        EXPECT_LT(structure->plan().batch_rays, rays.size() / 3) << "in several passes";
        test::expect_answers(*structure, rays, expected);
        EXPECT_EQ(structure->report().queues > 0, budget < 1 << 20) << "pages move";
    }
    EXPECT_GE(driver->max_shaders(), 2u);
}

struct StopsSoon final : TraceWatch {
    bool goes_on(double done) override { return done < 0.3; }
};

/// A call that ends early waits for the pass that it has begun.
TEST_P(LateTwoLevelGl, ACallAfterOneThatWasCancelledAnswersAsEver) {
    const std::vector<Hit> expected = test::brute_force(soup, rays);
    const auto structure =
        build(soup, {.budget_bytes = 2 << 20, .leaf_triangles = 100, .compute = GetParam()});
    ASSERT_TRUE(structure);
    begin_late(2);
    std::vector<Hit> hits(rays.size());
    {
        StopsSoon watch;
        const CallWatch::Scope scope(structure->call_watch(), &watch);
        EXPECT_FALSE(structure->intersect(rays, {}, hits));
    }
    test::expect_answers(*structure, rays, expected);
}

TEST_P(LateTwoLevelGl, AStreamThatIsStoppedStops) {
    const auto structure = build(soup, {.leaf_triangles = 100, .compute = GetParam()});
    ASSERT_TRUE(structure);
    begin_late(3);
    test::Spawner host(rays, 100);
    host.stop_after = 150;
    const Result<Done> stopped = structure->stream(host);
    ASSERT_FALSE(stopped) << host.answers << " answers";
    EXPECT_EQ(stopped.error().kind, ErrorKind::Cancelled);
    EXPECT_LT(host.answers, rays.size());
}

} // namespace
} // namespace ovc
