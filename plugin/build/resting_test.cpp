// SPDX-License-Identifier: Apache-2.0
// Meshes that moved and then stay come to rest: no portal leads to them, whatever else changes, and
// the exact fallback finds what brute force does, after each update and after saving.
#include "plugin/build/build_scene.h"
#include "plugin/build/restored_levels.h"
#include "plugin/build/saved_levels.h"
#include "plugin/build/update_scene.h"
#include "plugin/fallback/exact_fallback.h"

#include "core/file/test_archive.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ovc {
namespace {

const TwoLevelOptions kOptions;
const MemoryPlan kPlan{.budget_bytes = 1 << 26, .batch_rays = 1024, .pool_bytes = 1 << 25};

Transform shift(const dvec3& by) {
    return {{{{1, 0, 0, by.x}, {0, 1, 0, by.y}, {0, 0, 1, by.z}}}};
}

Transform turned(double angle, const dvec3& by) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {{{{c, -s, 0, by.x}, {s, c, 0, by.y}, {0, 0, 1, by.z}}}};
}

/// A scene of meshes of 200 triangles side by side, whose triangles share sides.
class Moving {
public:
    /// moving: so many of the meshes have moved before the first commit.
    Moving(uint32_t meshes, uint32_t moving) {
        for (uint32_t mesh = 0; mesh < meshes; ++mesh) {
            const Soup grid = test::closed_grid(8);
            const std::span<const vec3> corners = grid.chunks[0].corners();
            soup.chunks.push_back(
                Chunk::owning(dvec3(3 * mesh, 0, 0), {corners.begin(), corners.end()}));
            if (mesh < moving)
                soup.chunks.back().set_moves();
        }
        Result<BuiltScene> built = build_scene(soup, kOptions, kPlan, {}, nullptr);
        EXPECT_TRUE(built) << built.error().message;
        scene.emplace(std::move(*built));
    }

    void place(uint32_t mesh, const Transform& transform) {
        soup.chunks[mesh].place_anew(transform);
        changes.placed.push_back(mesh);
    }

    /// Moves the corners of some triangles of a mesh by up to a hundredth.
    void jiggle(uint32_t mesh, uint32_t first, uint32_t count) {
        const std::span<const vec3> all = soup.chunks[mesh].corners();
        std::vector<vec3> corners(all.begin() + 3 * first, all.begin() + 3 * (first + count));
        ++waves_;
        for (vec3& corner : corners)
            corner.z += 0.01f * std::sin(20 * corner.x + float(waves_));
        soup.chunks[mesh].set_corners(first, corners);
        changes.moved.push_back({mesh, first, first + count});
    }

    /// Returns whether the scene could be updated.
    bool update() {
        const auto pages =
            update_scene(*scene, std::exchange(changes, {}), kOptions, kPlan, nullptr);
        if (pages) {
            EXPECT_EQ(pages->was.size(), scene->pages.size());
            expect_brute_force(*scene);
        }
        return pages.has_value();
    }

    /// Returns the number of frames that rays change to: 0 where all pages share one.
    size_t portals() const { return scene->top.portals.size() - !scene->top.portals.empty(); }

    void expect_brute_force(const BuiltScene& built) const {
        const auto ids = hittable_triangles(soup, nullptr, nullptr);
        for (const Ray& ray : test::unpleasant_rays(soup, 3, 300)) {
            if (!ray.valid())
                continue;
            const Hit expected = test::brute_force(soup, ids, ray);
            const Hit found = trace_exactly</* kAnyHit= */ false>(built, PreparedRay(ray));
            ASSERT_TRUE(test::same(expected, found))
                << test::describe(expected) << " but found " << test::describe(found);
        }
    }

    Soup soup;
    std::optional<BuiltScene> scene;
    Changes changes;

private:
    int waves_ = 0;
};

/// Commits small changes until all meshes have come to rest, a third of the scene in each.
void rest(Moving& moving, uint32_t jiggled) {
    for (int commit = 0; commit < 3; ++commit) {
        moving.jiggle(jiggled, 10, 3);
        ASSERT_TRUE(moving.update());
    }
}

class Rest : public testing::TestWithParam<uint32_t> {};
/// The parameter is the number of meshes, of five, that move.
INSTANTIATE_TEST_SUITE_P(MovingOfFive, Rest, testing::Values(2, 5));

TEST_P(Rest, NeedsNoPortals) {
    const uint32_t count = GetParam();
    Moving moving(5, count);
    EXPECT_EQ(moving.portals(), count < 5 ? count + 1 : 5);
    for (uint32_t mesh = 0; mesh < count; ++mesh)
        moving.place(mesh, turned(0.3 * mesh, {3.0 * mesh, 0.1, 0}));
    ASSERT_TRUE(moving.update());
    EXPECT_EQ(moving.portals(), count < 5 ? count + 1 : 5);
    rest(moving, 4);
    EXPECT_EQ(moving.portals(), 0u);
    // One moves on. Nothing is built for it, and a portal leads to where it is.
    moving.place(1, turned(2, {3, 0.4, 0}));
    ASSERT_TRUE(moving.update());
    EXPECT_EQ(moving.portals(), 2u);
    moving.place(1, turned(2.5, {3, 0.4, 0.2}));
    moving.jiggle(1, 0, 20);
    ASSERT_TRUE(moving.update());
    EXPECT_EQ(moving.portals(), 2u);
    rest(moving, 4);
    EXPECT_EQ(moving.portals(), 0u);
    // So far away that the frame of the scene grows, for those as well that have not moved.
    moving.place(0, shift({-20, 5, 0}));
    ASSERT_TRUE(moving.update());
    rest(moving, 4);
    EXPECT_EQ(moving.portals(), 0u);
}

TEST_P(Rest, ComesAtOnceWithAllCorners) {
    const uint32_t count = GetParam();
    Moving moving(5, count);
    for (uint32_t mesh = 0; mesh < count; ++mesh) {
        moving.place(mesh, shift({0.01 * mesh, 0.1, 0}));
        moving.jiggle(mesh, 0, moving.soup.chunks[mesh].size());
    }
    ASSERT_TRUE(moving.update());
    EXPECT_EQ(moving.portals(), 0u);
}

TEST_P(Rest, IsSaved) {
    const uint32_t count = GetParam();
    Moving moving(5, count);
    for (uint32_t mesh = 0; mesh < count; ++mesh)
        moving.place(mesh, turned(0.2 * mesh, {3.0 * mesh, 0.1, 0}));
    ASSERT_TRUE(moving.update());
    rest(moving, 0);
    moving.place(1, turned(2, {3, 0.4, 0}));
    ASSERT_TRUE(moving.update());
    const auto limits = [&](uint64_t, uint64_t) { return moving.scene->limits; };
    test::ArchiveMemory memory;
    ASSERT_TRUE(save_levels(*moving.scene, memory.sink()));
    auto found = restore_levels(memory.bytes(), moving.soup, limits);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_TRUE(*found);
    set_limits(**found, kOptions, kPlan);
    ASSERT_TRUE(add_tree(**found, kOptions, kPlan));
    EXPECT_EQ((*found)->top.portals.size(), 3u);
    moving.expect_brute_force(**found);
    moving.scene.emplace(std::move(**found));
    rest(moving, 0);
    EXPECT_EQ(moving.portals(), 0u);
}

TEST_P(Rest, LeadsNoWalkAstrayIfTheFileIsDamaged) {
    Moving moving(5, GetParam());
    moving.place(1, shift({3, 0.4, 0}));
    ASSERT_TRUE(moving.update());
    rest(moving, 0);
    const auto limits = [&](uint64_t, uint64_t) { return moving.scene->limits; };
    test::ArchiveMemory whole;
    ASSERT_TRUE(save_levels(*moving.scene, whole.sink()));
    int taken = 0;
    for (uint32_t seed = 0; seed < 600; ++seed) {
        std::mt19937 random(seed);
        std::vector<uint8_t> orders(6 * (1 + random() % 3));
        for (uint8_t& byte : orders)
            byte = uint8_t(random());
        test::ArchiveMemory memory = whole;
        test::damage(memory, orders);
        test::reseal(memory);
        auto found = restore_levels(memory.bytes(), moving.soup, limits);
        if (!found || !*found || !add_tree(**found, kOptions, kPlan))
            continue;
        ++taken;
        for (const Ray& ray : test::unpleasant_rays(moving.soup, seed, 30)) {
            const Hit hit = trace_exactly</* kAnyHit= */ false>(**found, PreparedRay(ray));
            ASSERT_TRUE(!hit.is_hit() || moving.soup.has(hit.id));
        }
    }
    EXPECT_GT(taken, 50);
}

/// The frame of a scene that is a million times as large leaves all answers in doubt.
TEST(Rest, NeedsAFrameThatSuits) {
    Moving moving(3, 3);
    moving.place(0, {{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1}}}});
    moving.place(1, {{{{1e6, 0, 0, 0}, {0, 1e6, 0, 0}, {0, 0, 1e6, 0}}}});
    ASSERT_TRUE(moving.update());
    rest(moving, 1);
    EXPECT_EQ(moving.portals(), 3u) << "the large one is home, behind a portal as the others";
}

} // namespace
} // namespace ovc
