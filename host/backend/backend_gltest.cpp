// SPDX-License-Identifier: Apache-2.0
// The backends through one interface: the plugin answers what the CPU KD-tree answers, and loading
// it fails clearly.
#include "host/backend/backend.h"
#include "host/backend/plugin_loader.h"
#include "kdtree/test_soups.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

namespace ovc {

static Soup random_soup(uint32_t seed, size_t triangle_count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> place(-1, 1), size(-0.1f, 0.1f);
    std::vector<vec3> corners;
    for (size_t i = 0; i < triangle_count; ++i) {
        const vec3 at(place(random), place(random), place(random));
        for (int corner = 0; corner < 3; ++corner)
            corners.push_back(at + vec3(size(random), size(random), size(random)));
    }
    Soup soup;
    soup.chunks.push_back(Chunk::owning({100, 0, 0}, corners));
    soup.chunks.push_back(Chunk::owning({100, 0.5, 0}, std::move(corners)));
    return soup;
}

static std::vector<Ray> random_rays(uint32_t seed, size_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-2, 2);
    std::vector<Ray> rays(count);
    for (Ray& ray : rays) {
        ray.org = dvec3(100, 0, 0) + dvec3(place(random), place(random), place(random));
        ray.dir = {place(random), place(random), place(random)};
    }
    return rays;
}

TEST(CpuBackend, SaysWhatItLeavesOut) {
    Soup soup = random_soup(3, 10);
    std::vector<vec3> corners(6, vec3(1));
    corners[4].y = std::nanf("");
    soup.chunks.push_back(Chunk::owning(dvec3(0), corners));
    BackendOptions options;
    options.kind = BackendKind::CpuKdTree;
    std::vector<std::string> warnings;
    const auto cpu = make_backend(soup, options, [&](LogLevel, const std::string& sentence) {
        warnings.push_back(sentence);
    });
    ASSERT_TRUE(cpu);
    EXPECT_THAT(warnings, testing::ElementsAre("left out 1 triangles with a NaN or infinite corner",
                                               "left out 1 triangles without area"));
    EXPECT_EQ((*cpu)->statistics().dropped_not_finite, 1u);
    EXPECT_EQ((*cpu)->statistics().dropped_degenerate, 1u);
}

TEST(TwoLevelBackend, AnswersWhatTheCpuAnswers) {
    const Soup soup = random_soup(1, 3000);
    BackendOptions options;
    options.kind = BackendKind::TwoLevel;
    options.gpu_memory.bytes = 16 << 20;
    options.leaves = 7;
    const Result<std::unique_ptr<Backend>> gpu = make_backend(soup, options, {});
    if (!gpu)
        GTEST_SKIP() << gpu.error().message;
    const std::unique_ptr<Backend> cpu = make_cpu_backend(soup);

    const std::vector<Ray> rays = random_rays(2, 20000);
    std::vector<Hit> expected(rays.size()), found(rays.size());
    std::vector<TriangleId> skip(rays.size());
    for (int round = 0; round < 2; ++round) {
        ASSERT_TRUE(cpu->intersect(rays, skip, expected));
        ASSERT_TRUE((*gpu)->intersect(rays, skip, found));
        std::vector<uint8_t> hidden(rays.size()), seen_hidden(rays.size());
        ASSERT_TRUE(cpu->occluded(rays, skip, hidden));
        ASSERT_TRUE((*gpu)->occluded(rays, skip, seen_hidden));
        EXPECT_EQ(hidden, seen_hidden);
        for (size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(expected[i].id, found[i].id) << "round " << round << ", ray " << i;
            ASSERT_EQ(expected[i].t, found[i].t) << "round " << round << ", ray " << i;
            skip[i] = expected[i].id; // the second round looks behind the first hit
        }
    }
    const ovc_statistics statistics = (*gpu)->statistics();
    EXPECT_EQ(statistics.triangles, soup.triangle_count());
    EXPECT_EQ(statistics.nearest_rays, 2 * rays.size());
    EXPECT_LE(statistics.gpu_peak_bytes, statistics.gpu_budget_bytes);
    EXPECT_GE(statistics.leaves, 4u);
}

TEST(ThesisBackends, AnswerWhatTheCpuAnswersAndCountPasses) {
    const Soup soup = random_soup(1, 3000);
    const std::unique_ptr<Backend> cpu = make_cpu_backend(soup);
    const std::vector<Ray> rays = random_rays(2, 20000);
    std::vector<Hit> expected(rays.size()), found(rays.size());
    ASSERT_TRUE(cpu->intersect(rays, {}, expected));
    for (const BackendKind kind :
         {BackendKind::SingleTexture, BackendKind::MultiTexture, BackendKind::GpuGrid,
          BackendKind::GpuKdTree, BackendKind::SkipBvh}) {
        BackendOptions options;
        options.kind = kind;
        const Result<std::unique_ptr<Backend>> gpu = make_backend(soup, options, {});
        if (!gpu)
            GTEST_SKIP() << gpu.error().message;
        ASSERT_TRUE((*gpu)->intersect(rays, {}, found));
        for (size_t i = 0; i < rays.size(); ++i) {
            ASSERT_EQ(expected[i].id, found[i].id) << "backend " << int(kind) << ", ray " << i;
            ASSERT_EQ(expected[i].t, found[i].t) << "backend " << int(kind) << ", ray " << i;
        }
        const ovc_statistics statistics = (*gpu)->statistics();
        EXPECT_GE(statistics.passes, 1u);
        EXPECT_GT(statistics.level2_bytes, soup.triangle_count() * 40);
        options.gpu_memory.bytes = 100000;
        const Result<std::unique_ptr<Backend>> refused = make_backend(soup, options, {});
        ASSERT_FALSE(refused);
        EXPECT_THAT(refused.error().message, testing::HasSubstr("100000 bytes is too small"));
    }
}

TEST(EmbreeBackend, AnswersAboutWhatTheCpuAnswers) {
    const Soup soup = random_soup(1, 3000);
    const std::unique_ptr<Backend> cpu = make_cpu_backend(soup);
    const std::vector<Ray> rays = random_rays(2, 20000);
    std::vector<Hit> expected(rays.size()), found(rays.size());
    std::vector<uint8_t> hidden(rays.size());
    std::vector<TriangleId> skip(rays.size());
    for (const EmbreeMode mode :
         {EmbreeMode::Medium, EmbreeMode::High, EmbreeMode::Robust, EmbreeMode::Packets}) {
        const Result<std::unique_ptr<Backend>> embree = make_embree_backend(soup, mode);
        if (!embree)
            GTEST_SKIP() << embree.error().message;
        for (int round = 0; round < 2; ++round) {
            ASSERT_TRUE(cpu->intersect(rays, skip, expected));
            ASSERT_TRUE((*embree)->intersect(rays, skip, found));
            ASSERT_TRUE((*embree)->occluded(rays, skip, hidden));
            size_t other = 0;
            for (size_t i = 0; i < rays.size(); ++i) {
                other += expected[i].id != found[i].id || hidden[i] != expected[i].is_hit();
                // Embree's floats move the triangles by some 1e-5 at 100.
                if (expected[i].id == found[i].id && found[i].is_hit()) {
                    EXPECT_NEAR(expected[i].t, found[i].t, 1e-2) << "ray " << i;
                }
                skip[i] = expected[i].id; // the second round looks behind the first hit
            }
            EXPECT_LT(other, rays.size() / 500) << "round " << round;
        }
        std::ranges::fill(skip, TriangleId{});
        EXPECT_EQ((*embree)->statistics().nearest_rays, 2 * rays.size());
    }
}

TEST(EmbreeBackend, SaysWhatItLeavesOut) {
    std::vector<std::string> told;
    const LogSink log = [&](LogLevel, const std::string& message) { told.push_back(message); };
    const auto make = [&](float corner) {
        std::vector<vec3> corners{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
        corners.insert(corners.end(), {vec3(0), vec3(corner, 0, 0), vec3(0, corner, 0)});
        const Soup soup = test::one_chunk(std::move(corners));
        return make_embree_backend(soup, EmbreeMode::Robust, log);
    };
    if (const auto embree = make(2); !embree)
        GTEST_SKIP() << embree.error().message;
    EXPECT_TRUE(told.empty());
    for (const float corner : {3e18f, INFINITY, NAN}) {
        told.clear();
        ASSERT_TRUE(make(corner));
        ASSERT_EQ(told.size(), 1u) << corner;
        EXPECT_EQ(told[0], "Embree leaves out 1 triangles with a corner that is not finite or lies "
                           "beyond 1.8e18");
    }
}

TEST(EmbreeBackend, AnswersRaysThatBeginBehindTheirOrigins) {
    const Soup soup = random_soup(1, 3000);
    std::vector<Ray> rays = random_rays(2, 5000);
    for (size_t i = 0; i < rays.size(); ++i)
        rays[i].t_min = i % 2 == 0 ? -2 : -1e300;
    const std::unique_ptr<Backend> cpu = make_cpu_backend(soup);
    std::vector<Hit> expected(rays.size()), found(rays.size());
    std::vector<uint8_t> hidden(rays.size());
    ASSERT_TRUE(cpu->intersect(rays, {}, expected));
    for (const EmbreeMode mode : {EmbreeMode::Robust, EmbreeMode::Packets}) {
        const Result<std::unique_ptr<Backend>> embree = make_embree_backend(soup, mode);
        if (!embree)
            GTEST_SKIP() << embree.error().message;
        ASSERT_TRUE((*embree)->intersect(rays, {}, found));
        ASSERT_TRUE((*embree)->occluded(rays, {}, hidden));
        size_t other = 0, before = 0;
        for (size_t i = 0; i < rays.size(); i += 2) {
            other += expected[i].id != found[i].id || hidden[i] != expected[i].is_hit();
            if (expected[i].id == found[i].id && found[i].is_hit()) {
                EXPECT_NEAR(expected[i].t, found[i].t, 1e-2) << "ray " << i;
                before += found[i].t < 0;
            }
        }
        EXPECT_LT(other, rays.size() / 500);
        EXPECT_GT(before, 100u);
    }
}

TEST(TwoLevelBackend, HandsOnThePluginsSentence) {
    const Soup soup = random_soup(1, 10);
    BackendOptions options;
    options.device = "no such device";
    const Result<std::unique_ptr<Backend>> backend = make_backend(soup, options, {});
    ASSERT_FALSE(backend);
    EXPECT_THAT(backend.error().message, testing::AnyOf(testing::HasSubstr("no such device"),
                                                        testing::HasSubstr("cannot load")));
}

TEST(LoadPlugin, SaysWhatIsWrongWithTheFile) {
    setenv("OVC_PLUGIN", "/no/such/plugin.so", 1);
    EXPECT_THAT(load_plugin().error().message, testing::HasSubstr("/no/such/plugin.so"));
    setenv("OVC_PLUGIN", "libm.so.6", 1);
    EXPECT_EQ(load_plugin().error().message,
              "'libm.so.6' is not an Overcast plugin: it has no ovc_get_api");
    unsetenv("OVC_PLUGIN");
}

} // namespace ovc
