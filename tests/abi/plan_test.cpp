// SPDX-License-Identifier: Apache-2.0
// Compares the forecast of plan() with the result of commit. They agree within 10 %, or one leaf or
// page.
#include "importers/importer.h"
#include "kdtree/test_soups.h"
#include "tests/abi/abi_scene.h"
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

    uint64_t saved_bytes_of(ovc_scene scene) const {
        uint64_t all = 0;
        const auto count = [](void* user, const void*, size_t size) {
            *static_cast<uint64_t*>(user) += size;
            return 0;
        };
        EXPECT_EQ(api().save(scene, count, &all), OVC_OK) << error();
        return all;
    }

    /// Plans, commits and compares. Returns the statistics of the commit.
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
        // The plan gives an upper bound of the largest page.
        EXPECT_GE(double(plan.largest_page_bytes), 0.9 * double(made.largest_page_bytes));
        EXPECT_LE(double(plan.largest_page_bytes), 1.3 * double(made.largest_page_bytes));
        near("pages resident", plan.resident_pages, made.pages_in, 1);
        near("host bytes", plan.host_bytes, made.host_bytes);
        EXPECT_EQ(plan.gpu_budget_bytes, made.gpu_budget_bytes);
        // The plan's parts add up to what commit allocates.
        near("saved bytes", plan.saved_bytes, saved_bytes_of(scene.get()), 4096);
        near("GPU bytes", plan.ray_bytes + plan.level1_bytes + plan.pool_bytes,
             made.gpu_peak_bytes);
        return made;
    }

    /// Compares at several numbers of leaves and several budgets.
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

    /// Expects a difference of at most a tenth, or of `slack`.
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
    compare_all("powerplant-200000");
}

TEST_F(Plan, OfPlants) {
    compare_all("plants-5");
}

TEST_F(Plan, OfDragons) {
    const Scene sphere = std::move(*make_test_scene("sphere-5"));
    const Result<Scene> scene = make_test_scene("dragons-3", &sphere.soup);
    ASSERT_TRUE(scene) << scene.error().message;
    compare_all("dragons-3", scene->soup);
}

/// plan() looks at each mesh once, not at each of its instances, which are 36 million triangles
/// here.
TEST_F(Plan, OfAThousandInstances) {
    Scene scene = std::move(*make_test_scene("sphere-5"));
    Scene trees = std::move(*make_test_scene("terrain-130"));
    scene.soup.chunks.push_back(std::move(trees.soup.chunks[0]));
    test::Random random(5);
    for (int i = 0; i < 1000; ++i) {
        Chunk chunk = scene.soup.chunks[size_t(i % 2)].unplaced();
        Transform transform{};
        for (size_t row = 0; row < 3; ++row) {
            const dvec3 r = random.point(-1, 1);
            transform.rows[row] = {r.x, r.y, r.z, 300 * random.point(-1, 1).x};
        }
        chunk.place(transform);
        scene.soup.chunks.push_back(std::move(chunk));
    }
    auto config = sized<ovc_scene_config>();
    const ovc_statistics made = compare(scene.soup, config);
    EXPECT_EQ(made.unique_triangles, 20480u + 33800u);
    EXPECT_EQ(made.instances, 1002u);
    config.gpu_memory_bytes = 4 << 20;
    compare(scene.soup, config);
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
    Soup kitchen; // The scene has 174 files.
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(*data / "meshes/kitchen-fathirmutfak"))
        if (entry.path().extension() == ".obj")
            if (Result<Scene> part = load(entry.path()))
                for (Chunk& chunk : part->soup.chunks)
                    kitchen.chunks.push_back(std::move(chunk));
    ASSERT_GT(kitchen.triangle_count(), 200'000u);
    compare_all("kitchen", kitchen);
}

/// Returns the number that the message of a refused commit names.
uint64_t named_by(const std::string& message) {
    const std::string before = "the smallest that works is ";
    const size_t at = message.find(before);
    return at == std::string::npos ? 0 : std::stoull(message.substr(at + before.size()));
}

TEST_F(Plan, TellsTheSmallestBudgetThatWorksAndAllLargerOnesWork) {
    for (const char* name : {"soup-5", "sphere-5", "soup-20"}) {
        const Result<Scene> scene = make_test_scene(name);
        ASSERT_TRUE(scene) << scene.error().message;
        for (const uint64_t leaf_triangles : {0, 50}) {
            SCOPED_TRACE(name + (" in leaves of " + std::to_string(leaf_triangles)));
            auto config = sized<ovc_scene_config>();
            config.leaf_triangles = leaf_triangles;
            const auto with = [&](uint64_t budget) {
                config.gpu_memory_bytes = budget;
                return test::add_soup(device, scene->soup, config);
            };
            const uint64_t smallest = plan_of(with(0).get()).smallest_budget_bytes;
            for (const uint64_t missing : {uint64_t(1), smallest / 20, smallest / 4}) {
                const auto short_of = with(smallest - missing);
                if (!short_of)
                    continue; // The scene is refused before anything is added.
                const ovc_plan plan = plan_of(short_of.get());
                EXPECT_FALSE(plan.fits);
                EXPECT_EQ(plan.smallest_budget_bytes, smallest);
                EXPECT_EQ(api().commit(short_of.get()), OVC_ERROR_OUT_OF_BUDGET);
                EXPECT_EQ(named_by(error()), smallest) << error();
            }
            for (const double times : {1.0, 1.001, 1.04, 1.2, 1.7, 3.0}) {
                const auto enough = with(uint64_t(double(smallest) * times));
                EXPECT_TRUE(plan_of(enough.get()).fits) << times;
                EXPECT_EQ(api().commit(enough.get()), OVC_OK) << times << ": " << error();
                const ovc_statistics made = test::statistics(enough);
                EXPECT_LE(made.gpu_peak_bytes, made.gpu_budget_bytes) << times;
            }
        }
    }
}

TEST_F(Plan, OfManyCopiesOfFewTriangles) {
    std::vector<vec3> corners;
    for (int i = 0; i < 300'000; ++i)
        for (int k = 0; k < 3; ++k)
            corners.push_back(vec3(float(i % 7 + k), float(i % 7 * k), float(k == 2)));
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), std::move(corners)));
    compare(soup, sized<ovc_scene_config>());
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
