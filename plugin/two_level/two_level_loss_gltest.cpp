// SPDX-License-Identifier: Apache-2.0
// Two-level goes on or refuses where the driver has no room, and where it loses the context.
#include "plugin/two_level/test_two_level.h"

namespace ovc {
namespace {

using test::ok;

TEST_F(TwoLevelGl, GoesOnWithASmallerPoolWhereTheDriverHasNoRoom) {
    const Soup soup = test::random_soup(2, 3000, 0.05);
    const auto rays = test::unpleasant_rays(soup, 5, 1000);
    const auto whole = build(soup, {.budget_bytes = 2u << 20, .leaf_triangles = 200});
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    ASSERT_TRUE(ok(whole->intersect(rays, {}, expected)));

    std::vector<std::string> warnings;
    const LogSink log = [&](LogLevel, std::string_view line) { warnings.emplace_back(line); };
    TwoLevelOptions options{.budget_bytes = 2u << 20, .leaf_triangles = 200};
    const uint64_t level2_bytes = whole->scene().level2_bytes();
    options.driver_bytes = whole->plan().ray_bytes() + level2_bytes / 2;
    auto built = TwoLevel::build(soup, *gl, options, log);
    ASSERT_TRUE(built) << built.error().message;
    EXPECT_LT((*built)->plan().pool_bytes, level2_bytes);
    ASSERT_FALSE(warnings.empty());
    EXPECT_NE(warnings[0].find("no room for a pool of"), std::string::npos) << warnings[0];
    ASSERT_TRUE(ok((*built)->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(test::same(expected[i], hits[i])) << "ray " << i;

    options.driver_bytes = 1000;
    const auto refused = TwoLevel::build(soup, *gl, options, log);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::OutOfGpuMemory);
}

/// Rays come to a far leaf by the top-level tree alone, so the pool is never without it.
TEST_F(TwoLevelGl, KeepsTheTreeThatLeadsToTheFloorWhereTheDriverHasNoRoom) {
    const Soup soup = test::grid_on_floor(24);
    const auto rays = test::rays_from_outside(36, 2000);
    TwoLevelOptions options{.budget_bytes = 2u << 20, .leaf_triangles = 60};
    const auto whole = build(soup, options);
    ASSERT_EQ(whole->scene().level1.far_leaves, 1u);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    ASSERT_TRUE(ok(whole->intersect(rays, {}, expected)));
    size_t refused = 0, answered = 0;
    const uint64_t enough = whole->plan().ray_bytes() + (64 << 10);
    for (uint64_t driver_bytes = enough / 2; driver_bytes < enough; driver_bytes += 1 << 10) {
        options.driver_bytes = driver_bytes;
        const auto built = TwoLevel::build(soup, *gl, options, LogSink());
        if (!built) {
            ASSERT_EQ(built.error().kind, ErrorKind::OutOfGpuMemory) << built.error().message;
            ++refused;
            continue;
        }
        ++answered;
        ASSERT_TRUE(ok((*built)->intersect(rays, {}, hits)));
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_TRUE(test::same(expected[i], hits[i]))
                << "ray " << i << ", driver " << driver_bytes;
    }
    EXPECT_GT(refused, 0u);
    EXPECT_GT(answered, 0u);
}

TEST_F(TwoLevelGl, CutsASceneThatIsOneLeafWhereTheDriverHasNoRoom) {
    const Soup soup = test::random_soup(2, 3000, 0.05);
    const auto rays = test::unpleasant_rays(soup, 5, 1000);
    TwoLevelOptions options{.budget_bytes = 2u << 20};
    const auto whole = build(soup, options);
    ASSERT_EQ(whole->scene().level1.leaves.size(), 1u);
    options.driver_bytes = whole->plan().ray_bytes() + whole->scene().level2_bytes() / 2;
    const auto cut = build(soup, options);
    EXPECT_GT(cut->scene().level1.leaves.size(), 5u);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    ASSERT_TRUE(ok(whole->intersect(rays, {}, expected)));
    ASSERT_TRUE(ok(cut->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(test::same(expected[i], hits[i])) << "ray " << i;
}

TEST_F(TwoLevelGl, ALostContextIsAnErrorOnceForEveryStructureAndThenAllWork) {
    const Soup soup = test::random_soup(2, 3000, 0.05);
    const auto rays = test::unpleasant_rays(soup, 5, 1000);
    const auto one = build(soup, {.leaf_triangles = 200});
    const auto other = build(soup, {.budget_bytes = 96u << 10, .leaf_triangles = 200});
    const auto idle = build(soup, {});
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    ASSERT_TRUE(ok(one->intersect(rays, {}, expected)));

    gl->run([](GlState& state) { state.context.lose(); });
    const Result<Done> lost = one->intersect(rays, {}, hits);
    ASSERT_FALSE(lost);
    EXPECT_EQ(lost.error().kind, ErrorKind::DeviceLost);
    for (const auto* structure : {&one, &other}) {
        ASSERT_TRUE(ok((*structure)->intersect(rays, {}, hits)));
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_TRUE(test::same(expected[i], hits[i])) << "ray " << i;
    }
}

/// Kills the context in the middle of a stream, whose rays wait for leaves.
class Killer final : public StreamHost {
public:
    Killer(GlThread& gl, std::span<const Ray> rays) : gl_(gl), rays_(rays) {}
    bool more(RayStream& stream, size_t) override {
        if (!asked_) {
            std::vector<uint64_t> tokens(rays_.size());
            stream.push({false, rays_, {}, tokens});
        }
        asked_ = true;
        return true;
    }
    bool hits(RayStream&, std::span<const uint64_t>, std::span<const Hit>) override {
        gl_.run([](GlState& state) { state.context.lose(); });
        return true;
    }
    bool occlusions(RayStream&, std::span<const uint64_t>, std::span<const uint8_t>) override {
        return true;
    }

private:
    GlThread& gl_;
    std::span<const Ray> rays_;
    bool asked_ = false;
};

TEST_F(TwoLevelGl, AContextLostAmongPassesIsAnErrorAndTheSceneWorksAgain) {
    const Soup soup = test::random_soup(2, 3000, 0.05);
    const auto rays = test::unpleasant_rays(soup, 5, 4000);
    const auto structure = build(soup, {.budget_bytes = 96u << 10, .leaf_triangles = 100});
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, expected)));
    Killer killer(*gl, rays);
    const Result<Done> lost = structure->stream(killer);
    ASSERT_FALSE(lost);
    EXPECT_EQ(lost.error().kind, ErrorKind::DeviceLost);
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(test::same(expected[i], hits[i])) << "ray " << i;
}

} // namespace
} // namespace ovc
