// SPDX-License-Identifier: Apache-2.0
// The rule of equal answers for the systems of the thesis: each gives bit for bit the answers of
// testing every triangle in double.
#include "gpu/gl/test_gl.h"
#include "plugin/structure/failure.h"
#include "plugin/structure/test_structures.h"
#include "plugin/thesis/runner.h"

#include <gmock/gmock.h>

namespace ovc::thesis {
namespace {

using test::ok;
using test::rays_from_outside;
using testing::HasSubstr;

struct Variant {
    std::string name;
    ovc_structure structure;
    uint32_t textures = 0;
};

const std::vector<Variant>& variants() {
    static const std::vector<Variant> all = {{"single texture", OVC_STRUCTURE_SINGLE_TEXTURE},
                                             {"several textures", OVC_STRUCTURE_MULTI_TEXTURE, 4},
                                             {"grid", OVC_STRUCTURE_GPU_GRID},
                                             {"kd-tree", OVC_STRUCTURE_GPU_KD_TREE},
                                             {"skip-pointer BVH", OVC_STRUCTURE_SKIP_BVH}};
    return all;
}

class Comparisons : public test::OnGl {
protected:
    Result<std::unique_ptr<Structure>> make(const Soup& soup, const Variant& variant,
                                            uint64_t budget = 0, bool certify = true) {
        ovc_scene_config config{sizeof(ovc_scene_config)};
        config.structure = variant.structure;
        config.leaves = variant.textures;
        config.gpu_memory_bytes = budget;
        config.precision = certify ? OVC_PRECISION_CERTIFIED : OVC_PRECISION_FAST;
        return make_structure(soup, {*gl, config, {}});
    }

    std::unique_ptr<Structure> build(const Soup& soup, const Variant& variant, uint64_t budget = 0,
                                     bool certify = true) {
        Result<std::unique_ptr<Structure>> made = make(soup, variant, budget, certify);
        EXPECT_TRUE(made) << made.error().message;
        return made ? std::move(*made) : nullptr;
    }
};

TEST_F(Comparisons, EqualBruteForceBitForBit) {
    for (const auto& [soup_name, soup] : test::unpleasant_soups()) {
        const auto rays = test::unpleasant_rays(soup, 41, 1500);
        const std::vector<Hit> expected = test::brute_force(soup, rays);
        for (const Variant& variant : variants()) {
            SCOPED_TRACE(soup_name + ", " + variant.name);
            const auto structure = build(soup, variant);
            ASSERT_TRUE(structure);
            test::expect_answers(*structure, rays, expected);
            test::expect_counts(structure->report(), rays);
        }
    }
}

TEST_F(Comparisons, DecideNearlyAllOrdinaryRaysOnTheGpu) {
    const Soup soup = test::closed_grid(200);
    const auto rays = rays_from_outside(5, 50000);
    for (const Variant& variant : variants()) {
        const auto structure = build(soup, variant);
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        const ovc_statistics s = structure->report();
        EXPECT_LE(s.flagged, rays.size() / 100) << variant.name;
        EXPECT_LE(s.retraced, rays.size() / 1000) << variant.name;
        EXPECT_EQ(s.ray_visits, rays.size()) << variant.name;
        EXPECT_GT(s.passes, 0u) << variant.name;
    }
}

TEST_F(Comparisons, DoNotSeeTheTriangleThatARayStartsOn) {
    const Soup soup = test::closed_grid(60);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    const auto [rays, skip] = test::RaysOnTriangles(soup, 5);
    for (const Variant& variant : variants()) {
        const auto structure = build(soup, variant);
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
        EXPECT_LE(structure->report().flagged, rays.size() / 50) << variant.name;
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_TRUE(test::same(hits[i], test::brute_force(soup, ids, rays[i], skip[i])))
                << variant.name << ", ray " << i;
    }
}

TEST_F(Comparisons, FastPrecisionIsCloseAndFlagsNothing) {
    const Soup soup = test::closed_grid(100);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    const auto rays = rays_from_outside(15, 3000);
    for (const Variant& variant : variants()) {
        const auto structure = build(soup, variant, 0, /* certify= */ false);
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        size_t other = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = test::brute_force(soup, ids, rays[i]);
            if (hits[i].id != expected.id) {
                ++other;
            } else if (expected.is_hit()) {
                EXPECT_NEAR(hits[i].t, expected.t, 1e-5) << variant.name;
                EXPECT_NEAR(hits[i].u, expected.u, 1e-2) << variant.name;
                EXPECT_NEAR(hits[i].v, expected.v, 1e-2) << variant.name;
            }
        }
        EXPECT_LT(other, rays.size() / 500) << variant.name;
        EXPECT_EQ(structure->report().flagged, 0u) << variant.name;
    }
}

TEST_F(Comparisons, WorkWithinTheSmallestBudgetTheyName) {
    const Soup soup = test::random_soup(8, 5000, 0.02);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    const auto rays = test::unpleasant_rays(soup, 3, 3000);
    for (const Variant& variant : variants()) {
        const auto refused = make(soup, variant, 100000);
        ASSERT_FALSE(refused) << variant.name;
        EXPECT_THAT(refused.error().message,
                    HasSubstr("a GPU budget of 100000 bytes is too small"));
        const ovc_statistics whole = build(soup, variant)->report();
        const auto tight =
            make(soup, variant, whole.bytes_in + 48 * 1024 - 1); // too small by a byte
        ASSERT_FALSE(tight) << variant.name;
        const std::string& message = tight.error().message;
        const std::string before = "the smallest that works is ";
        const uint64_t smallest = std::stoull(message.substr(message.find(before) + before.size()));
        EXPECT_FALSE(make(soup, variant, smallest - 1)) << variant.name;
        const auto structure = build(soup, variant, smallest);
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        for (size_t i = 0; i < rays.size(); i += 7)
            ASSERT_TRUE(test::same(hits[i], test::brute_force(soup, ids, rays[i])))
                << variant.name << ", ray " << i;
        EXPECT_LE(structure->report().gpu_peak_bytes, smallest);
        EXPECT_GE(structure->report().passes, 3u) << "a row of rays a pass";
    }
}

TEST_F(Comparisons, MultiTextureUsesTheTexturesItWasAskedFor) {
    const Soup soup = test::random_soup(8, 5000, 0.02);
    for (const uint32_t textures : {1u, 2u, 3u, 4u}) {
        const auto structure = build(soup, {"", OVC_STRUCTURE_MULTI_TEXTURE, textures});
        ASSERT_TRUE(structure);
        const ovc_statistics s = structure->report();
        EXPECT_GE(s.leaves, textures);
        EXPECT_LE(s.leaves, 2 * textures);
        EXPECT_LE(s.largest_page_bytes, s.bytes_in);
    }
}

TEST_F(Comparisons, TheSkipPointerBvhTakesMorePassesForLongerWays) {
    uint64_t passes = 0;
    for (const size_t triangles : {10, 1000, 10000}) {
        const Soup soup = test::random_soup(8, triangles, 0.2);
        const auto rays = test::unpleasant_rays(soup, 5, 1000);
        const auto structure = build(soup, {"", OVC_STRUCTURE_SKIP_BVH});
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        EXPECT_GT(structure->report().passes, passes);
        passes = structure->report().passes;
        // A pass makes 128 steps, and no ray takes more steps than there are nodes and triangles.
        EXPECT_LE(passes, 1 + 2 * triangles / 128);
    }
}

/// Returns sheets over each other, small beside the scene, so in one place of any structure.
Soup sheets(size_t count) {
    std::vector<vec3> corners = {vec3(500), vec3(501, 500, 500), vec3(500, 501, 500)};
    for (size_t i = 0; i < count; ++i) {
        const float z = float(i) * 1e-7f;
        corners.insert(corners.end(), {vec3(0, 0, z), vec3(1, 0, z), vec3(0, 1, z)});
    }
    return test::one_chunk(std::move(corners));
}

TEST_F(Comparisons, ARayWhoseLoopTheDriverWouldEndIsDecidedInDouble) {
    if (!gl->info().is_software)
        GTEST_SKIP() << "no driver of a GPU ends a loop";
    const Soup soup = sheets(8000);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    test::Random random(3);
    std::vector<Ray> rays(40);
    for (Ray& ray : rays) {
        const double x = random(0, 1);
        ray = {dvec3(x, 1.001 - x, 5), 0, dvec3(0, 0, -1)}; // just past all of them
    }
    for (const ovc_structure structure : {OVC_STRUCTURE_GPU_GRID, OVC_STRUCTURE_GPU_KD_TREE}) {
        const auto system = build(soup, {"", structure});
        ASSERT_TRUE(system);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(system->intersect(rays, {}, hits)));
        for (size_t i = 0; i < rays.size(); ++i)
            EXPECT_TRUE(test::same(hits[i], test::brute_force(soup, ids, rays[i]))) << "ray " << i;
        EXPECT_GT(system->report().capped, 0u) << name_of(structure);
    }
}

std::string refusal(ovc_structure structure, uint32_t leaves, uint64_t leaf_triangles,
                    uint32_t kernel) {
    ovc_scene_config config{sizeof(ovc_scene_config)};
    config.structure = structure;
    config.leaves = leaves;
    config.leaf_triangles = leaf_triangles;
    config.kernel = kernel;
    try {
        check_config(config, {});
    } catch (const Failure& failure) {
        return failure.message;
    }
    return "";
}

TEST(ComparisonConfig, RefusesFieldsOfRanks) {
    ovc_scene_config config{};
    config.structure = OVC_STRUCTURE_GPU_GRID;
    config.ranks_own = OVC_RANKS_OWN_SHARE;
    try {
        check_config(config, {});
        ADD_FAILURE() << "nothing is refused";
    } catch (const Failure& failure) {
        EXPECT_EQ(failure.message,
                  "gpu-grid is one process's: communicator, ranks_own, rank_timeout and sample are "
                  "for libovercast-mpi.so, expected 0");
    }
}

TEST(ComparisonConfig, RefusesWhatMeansNothing) {
    EXPECT_THAT(refusal(OVC_STRUCTURE_TWO_LEVEL, 0, 0, 0), HasSubstr("libovercast.so"));
    EXPECT_EQ(refusal(OVC_STRUCTURE_GPU_GRID, 0, 0, OVC_KERNEL_COMPUTE),
              "gpu-grid has no compute kernel");
    EXPECT_EQ(refusal(OVC_STRUCTURE_SKIP_BVH, 3, 0, 0),
              "skip-bvh has no leaves: leaves is 3, expected 0");
    EXPECT_EQ(refusal(OVC_STRUCTURE_SINGLE_TEXTURE, 0, 9, 0),
              "single-texture has no leaves: leaf_triangles is 9, expected 0");
    EXPECT_EQ(refusal(OVC_STRUCTURE_MULTI_TEXTURE, 9, 0, 0),
              "multi-texture: leaves is 9, expected at most 8 textures");
    EXPECT_EQ(refusal(OVC_STRUCTURE_MULTI_TEXTURE, 4, 0, 0), "");
}

} // namespace
} // namespace ovc::thesis
