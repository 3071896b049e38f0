// SPDX-License-Identifier: Apache-2.0
// What plan() tells against what commit then makes: within 10 %, or one leaf or page.
#include "importers/importer.h"
#include "tests/abi_scene.h"
#include "tests/real_data.h"
#include "testscenes/catalog.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

namespace ovc {
namespace {

using test::api;
using test::sized;

class Plan : public test::DeviceTest {
protected:
    ovc_plan plan_of(ovc_scene scene) const {
        auto plan = sized<ovc_plan>();
        EXPECT_EQ(api().plan(scene, &plan), OVC_OK) << error();
        return plan;
    }

    ovc_statistics statistics_of(ovc_scene scene) const {
        auto statistics = sized<ovc_statistics>();
        EXPECT_EQ(api().statistics(scene, &statistics), OVC_OK) << error();
        return statistics;
    }

    /// Plans, commits and compares; returns what was committed.
    ovc_statistics compare(const Soup& soup, const ovc_scene_config& config) const {
        const auto scene = test::add_soup(device, soup, config);
        EXPECT_TRUE(scene) << error();
        const ovc_plan plan = plan_of(scene.get());
        EXPECT_EQ(api().commit(scene.get()), OVC_OK) << error();
        const ovc_statistics made = statistics_of(scene.get());
        EXPECT_EQ(plan.triangles, made.triangles);
        EXPECT_EQ(plan.hittable,
                  made.triangles - made.dropped_not_finite - made.dropped_degenerate);
        EXPECT_TRUE(plan.fits);
        near("leaves", plan.leaves, made.leaves, 1);
        near("references", plan.leaf_references, made.leaf_references);
        near("bytes of level 2", plan.level2_bytes, made.level2_bytes);
        // The most of many is told from above: what the worst leaf may be.
        EXPECT_GE(double(plan.largest_page_bytes), 0.9 * double(made.largest_page_bytes));
        EXPECT_LE(double(plan.largest_page_bytes), 1.3 * double(made.largest_page_bytes));
        near("pages resident", plan.resident_pages, made.pages_in, 1);
        near("host bytes", plan.host_bytes, made.host_bytes);
        EXPECT_EQ(plan.gpu_budget_bytes, made.gpu_budget_bytes);
        // What commit allocates is what the plan shares out, and nothing else.
        near("GPU bytes", plan.ray_bytes + plan.level1_bytes + plan.pool_bytes,
             made.gpu_peak_bytes);
        return made;
    }

    /// At several counts of leaves and several budgets.
    void compare_all(const std::string& name, const Soup& soup) const {
        uint64_t level2_bytes = 0;
        for (const uint32_t leaves : {0u, 4u, 40u, 200u}) {
            SCOPED_TRACE(name + ", leaves " + std::to_string(leaves));
            auto config = sized<ovc_scene_config>();
            config.leaves = leaves;
            config.gpu_memory_bytes = 2ull << 30;
            const ovc_statistics made = compare(soup, config);
            if (leaves == 0)
                level2_bytes = made.level2_bytes;
        }
        for (const uint64_t share : {2, 4, 8, 24}) {
            SCOPED_TRACE(name + ", budget 1/" + std::to_string(share));
            auto config = sized<ovc_scene_config>();
            config.gpu_memory_bytes = level2_bytes / share + (64 << 10);
            compare(soup, config);
        }
    }

    void compare_all(const std::string& name) const {
        const Result<Scene> scene = make_test_scene(name);
        ASSERT_TRUE(scene) << scene.error().message;
        compare_all(name, scene->soup);
    }

    /// Off by a tenth at most, or by so many.
    static void near(const char* what, uint64_t planned, uint64_t made, uint64_t slack = 0) {
        const double most = std::max(0.1 * double(made), double(slack));
        EXPECT_LE(std::abs(double(planned) - double(made)), most)
            << what << ": planned " << planned << ", made " << made;
    }
};

TEST_F(Plan, OfMeshes) {
    compare_all("sphere-6");
    compare_all("terrain-300");
    compare_all("knot");
}

TEST_F(Plan, OfSoupAndSlivers) {
    compare_all("soup-5");
    compare_all("soup-100");
}

TEST_F(Plan, OfAPartOfTheMillimetreGround) {
    compare_all("far-terrain");
}

TEST_F(Plan, OfArchitecture) {
    compare_all("city");
    compare_all("powerplant-300000");
}

TEST_F(Plan, OfPlants) {
    compare_all("plants-5");
}

TEST_F(Plan, OfDragons) {
    compare_all("dragons-2");
}

TEST_F(Plan, OfTheRealDragonAndKitchen) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    for (const auto& file :
         {"meshes/stanford-dragon/dragon_vrip.ply.gz", "meshes/stanford-bunny/bun_zipper.ply"}) {
        const Result<Scene> scene = load(*data / file);
        ASSERT_TRUE(scene) << scene.error().message;
        compare_all(file, scene->soup);
    }
    Soup kitchen; // 174 files, one scene
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(*data / "meshes/kitchen-fathirmutfak"))
        if (entry.path().extension() == ".obj")
            if (Result<Scene> part = load(entry.path()))
                for (Chunk& chunk : part->soup.chunks)
                    kitchen.chunks.push_back(std::move(chunk));
    ASSERT_GT(kitchen.triangle_count(), 200'000u);
    compare_all("kitchen", kitchen);
}

TEST_F(Plan, TellsTheSmallestBudgetThatWorksToATenth) {
    for (const char* name : {"soup-100", "knot", "plants-5"}) {
        SCOPED_TRACE(name);
        const Result<Scene> scene = make_test_scene(name);
        ASSERT_TRUE(scene) << scene.error().message;
        auto config = sized<ovc_scene_config>();
        const uint64_t smallest =
            plan_of(test::add_soup(device, scene->soup, config).get()).smallest_budget_bytes;
        config.gpu_memory_bytes = smallest + smallest / 10;
        const auto enough = test::add_soup(device, scene->soup, config);
        EXPECT_TRUE(plan_of(enough.get()).fits);
        EXPECT_EQ(api().commit(enough.get()), OVC_OK) << error();
        config.gpu_memory_bytes = smallest - smallest / 10;
        const auto short_of = test::add_soup(device, scene->soup, config);
        EXPECT_FALSE(plan_of(short_of.get()).fits);
        EXPECT_EQ(api().commit(short_of.get()), OVC_ERROR_OUT_OF_BUDGET);
    }
}

TEST_F(Plan, IsTheSameBeforeAndAfterCommit) {
    const Result<Scene> scene = make_test_scene("knot");
    ASSERT_TRUE(scene);
    const auto config = sized<ovc_scene_config>();
    const auto committed = test::add_soup(device, scene->soup, config);
    ovc_plan before = plan_of(committed.get());
    ASSERT_EQ(api().commit(committed.get()), OVC_OK);
    ovc_plan after = plan_of(committed.get());
    EXPECT_GT(before.seconds, 0);
    before.seconds = after.seconds = 0;
    EXPECT_EQ(std::memcmp(&before, &after, sizeof(before)), 0);
}

TEST_F(Plan, OfAnEmptyScene) {
    const auto config = sized<ovc_scene_config>();
    const auto scene = test::add_soup(device, {}, config);
    const ovc_plan plan = plan_of(scene.get());
    EXPECT_EQ(plan.leaves, 0u);
    EXPECT_EQ(plan.level2_bytes, 0u);
    EXPECT_TRUE(plan.fits);
}

TEST_F(Plan, ChecksItsArguments) {
    const auto scene = test::add_soup(device, {}, sized<ovc_scene_config>());
    EXPECT_EQ(api().plan(nullptr, nullptr), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(api().plan(scene.get(), nullptr), OVC_ERROR_INVALID_ARGUMENT);
    ovc_plan plan{};
    EXPECT_EQ(api().plan(scene.get(), &plan), OVC_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(error(), testing::HasSubstr("ovc_plan.struct_size is 0"));
}

} // namespace
} // namespace ovc
