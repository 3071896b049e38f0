// SPDX-License-Identifier: Apache-2.0
// Two-level as the thesis has it gives bit for bit the answers of testing every triangle in double,
// whatever its level 1, the size of leaves and the budget, in batches and in streams.
#include "gpu/gl/test_gl.h"
#include "plugin/structure/failure.h"
#include "plugin/structure/test_structures.h"
#include "plugin/thesis/queued/queues.h"
#include "plugin/thesis/queued/test_kinds.h"

#include <gmock/gmock.h>

namespace ovc::thesis {
namespace {

using test::ok;
using test::rays_from_outside;
using test::Spawner;
using testing::HasSubstr;

struct Limits {
    uint64_t leaf_triangles = 0;
    uint64_t budget = 0;
};

ovc_scene_config config_of(const Kind& kind, const Limits& limits = {}) {
    ovc_scene_config config{sizeof(ovc_scene_config)};
    config.structure = OVC_STRUCTURE_THESIS_TWO_LEVEL;
    config.level1 = kind.level1;
    config.level1_build = kind.build;
    config.leaf_triangles = limits.leaf_triangles;
    config.gpu_memory_bytes = limits.budget;
    return config;
}

class Queued : public test::OnGl {
protected:
    std::unique_ptr<Structure> build(const Soup& soup, const ovc_scene_config& config) {
        Result<std::unique_ptr<Structure>> made = make_structure(soup, {*gl, config, {}});
        EXPECT_TRUE(made) << made.error().message;
        return made ? std::move(*made) : nullptr;
    }
    std::unique_ptr<Structure> build(const Soup& soup, const Kind& kind,
                                     const Limits& limits = {}) {
        return build(soup, config_of(kind, limits));
    }
};

TEST_F(Queued, EqualsBruteForceBitForBit) {
    for (const auto& [soup_name, soup] : test::unpleasant_soups()) {
        const auto rays = test::unpleasant_rays(soup, 43, 1200);
        const std::vector<Hit> expected = test::brute_force(soup, rays);
        for (const Kind& kind : kinds())
            for (const Limits& limits :
                 {Limits{}, Limits{1u << 30}, Limits{40}, Limits{100, 32u << 10}}) {
                SCOPED_TRACE(soup_name + ", " + kind.name + ", leaves of " +
                             std::to_string(limits.leaf_triangles));
                const auto structure = build(soup, kind, limits);
                ASSERT_TRUE(structure);
                test::expect_answers(*structure, rays, expected);
                test::expect_counts(structure->report(), rays);
            }
    }
}

TEST_F(Queued, AStreamAnswersEveryRayOnceAsABatchDoes) {
    const Soup soup = test::closed_grid(100);
    const auto rays = rays_from_outside(11, 5000);
    for (const Kind& kind : kinds())
        for (const size_t at_once : {size_t(700), size_t(100000)}) {
            SCOPED_TRACE(kind.name);
            const auto structure = build(soup, kind, {500, 300u << 10});
            ASSERT_TRUE(structure);
            Spawner host(rays, at_once);
            ASSERT_TRUE(ok(structure->stream(host)));
            EXPECT_EQ(host.answers, rays.size());
            std::vector<Hit> hits(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            std::vector<Ray> spawned;
            std::vector<TriangleId> skip;
            for (size_t i = 0; i < rays.size(); ++i) {
                ASSERT_TRUE(test::same(hits[i], host.hits_of[i])) << "ray " << i;
                spawned.push_back(hits[i].is_hit() ? Spawner::from_hit(rays[i], hits[i]) : Ray{});
                skip.push_back(hits[i].id);
            }
            std::vector<uint8_t> blocked(rays.size());
            ASSERT_TRUE(ok(structure->occluded(spawned, skip, blocked)));
            for (size_t i = 0; i < rays.size(); ++i)
                ASSERT_EQ(host.blocked[i], hits[i].is_hit() ? blocked[i] : 2) << "ray " << i;
        }
}

/// Traces rays that are reflected from hit to hit, and a shadow ray from each: generation after
/// generation by batches, or all together by a stream.
class Reflections final : public StreamHost {
public:
    static constexpr size_t kGenerations = 5;

    explicit Reflections(std::vector<Ray> rays) : rays_(std::move(rays)) {}

    Result<Done> run(Structure& structure) {
        std::vector<Ray> rays = rays_;
        std::vector<TriangleId> skip(rays.size());
        for (size_t generation = 0; generation < kGenerations; ++generation) {
            std::vector<Hit> hits(rays.size());
            if (Result<Done> done = structure.intersect(rays, skip, hits); !done)
                return done;
            std::vector<Ray> shadows, reflected;
            skip.clear();
            for (size_t i = 0; i < rays.size(); ++i)
                if (hits[i].is_hit()) {
                    shadows.push_back(Spawner::from_hit(rays[i], hits[i]));
                    reflected.push_back(reflect(rays[i], hits[i]));
                    skip.push_back(hits[i].id);
                }
            std::vector<uint8_t> blocked(shadows.size());
            if (Result<Done> done = structure.occluded(shadows, skip, blocked); !done)
                return done;
            rays = std::move(reflected);
        }
        return Done{};
    }

    bool more(RayStream& stream, size_t) override {
        std::vector<uint64_t> tokens(paths_.empty() ? rays_.size() : 0);
        for (uint64_t& token : tokens)
            token = remember(rays_[size_t(&token - tokens.data())], 0);
        stream.push({false, std::span(rays_).first(tokens.size()), {}, tokens});
        return true;
    }
    bool hits(RayStream& stream, std::span<const uint64_t> tokens,
              std::span<const Hit> hits) override {
        for (size_t i = 0; i < tokens.size(); ++i) {
            if (!hits[i].is_hit())
                continue;
            const auto [ray, generation] = paths_[tokens[i]];
            const Ray shadow = Spawner::from_hit(ray, hits[i]);
            stream.push({true, {&shadow, 1}, {&hits[i].id, 1}, {&tokens[i], 1}});
            if (generation + 1 == kGenerations)
                continue;
            const Ray reflected = reflect(ray, hits[i]);
            const uint64_t token = remember(reflected, generation + 1);
            stream.push({false, {&reflected, 1}, {&hits[i].id, 1}, {&token, 1}});
        }
        return true;
    }
    bool occlusions(RayStream&, std::span<const uint64_t>, std::span<const uint8_t>) override {
        return true;
    }

private:
    /// Returns a ray into another direction, which depends on the hit alone.
    static Ray reflect(const Ray& ray, const Hit& hit) {
        return {ray.at(hit.t), 0, dvec3(ray.dir.y, -ray.dir.z, ray.dir.x)};
    }
    uint64_t remember(const Ray& ray, size_t generation) {
        paths_.emplace_back(ray, generation);
        return paths_.size() - 1;
    }

    std::vector<Ray> rays_;
    std::vector<std::pair<Ray, size_t>> paths_; // by token
};

/// The scene is one leaf, so that a pass takes all rays that there are. Batches take a pass for
/// each kind of ray and generation. A stream, whose queue holds shadow rays and the next generation
/// together, takes one for each generation and one for the last shadows.
TEST_F(Queued, AStreamTracesShadowsAndReflectionsTogether) {
    const Soup soup = test::closed_grid(100);
    for (const Kind& kind : kinds()) {
        const auto mixed = build(soup, kind, {1u << 30});
        const auto batched = build(soup, kind, {1u << 30});
        Reflections reflections(rays_from_outside(11, 20000));
        ASSERT_TRUE(ok(reflections.run(*batched)));
        ASSERT_TRUE(ok(mixed->stream(reflections)));
        const ovc_statistics m = mixed->report(), b = batched->report();
        EXPECT_EQ(m.nearest_rays, b.nearest_rays);
        EXPECT_EQ(m.occlusion_rays, b.occlusion_rays);
        EXPECT_EQ(b.passes, 2 * Reflections::kGenerations) << kind.name;
        EXPECT_EQ(m.passes, Reflections::kGenerations + 1) << kind.name;
    }
}

TEST_F(Queued, AHostMayStopAStream) {
    const Soup soup = test::closed_grid(100);
    const auto rays = rays_from_outside(11, 5000);
    const auto structure = build(soup, kinds()[0]);
    Spawner host(rays, 1000);
    host.stop_after = 1500;
    const Result<Done> stopped = structure->stream(host);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().kind, ErrorKind::Cancelled);
    EXPECT_LT(host.answers, rays.size());
    std::vector<Hit> hits(rays.size());
    EXPECT_TRUE(ok(structure->intersect(rays, {}, hits))) << "and works afterwards";
}

TEST_F(Queued, DecidesNearlyAllOrdinaryRaysOnTheGpu) {
    const Soup soup = test::closed_grid(200);
    const auto rays = rays_from_outside(5, 50000);
    for (const Kind& kind : kinds()) {
        const auto structure = build(soup, kind);
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        const ovc_statistics s = structure->report();
        EXPECT_LE(s.flagged, rays.size() / 100) << kind.name;
        EXPECT_LE(s.retraced, rays.size() / 1000) << kind.name;
    }
}

TEST_F(Queued, DoesNotSeeTheTriangleThatARayStartsOn) {
    const Soup soup = test::closed_grid(60);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    const auto [rays, skip] = test::RaysOnTriangles(soup, 5);
    std::vector<Hit> expected;
    for (size_t i = 0; i < rays.size(); ++i)
        expected.push_back(test::brute_force(soup, ids, rays[i], skip[i]));
    for (const Kind& kind : kinds()) {
        const auto structure = build(soup, kind);
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
        EXPECT_LE(structure->report().flagged, rays.size() / 50) << kind.name;
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_TRUE(test::same(hits[i], expected[i])) << kind.name << ", ray " << i;
    }
}

TEST_F(Queued, FastPrecisionIsCloseAndFlagsNothing) {
    const Soup soup = test::closed_grid(100);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    const auto rays = rays_from_outside(15, 3000);
    std::vector<Hit> exact;
    for (const Ray& ray : rays)
        exact.push_back(test::brute_force(soup, ids, ray));
    for (const Kind& kind : kinds()) {
        ovc_scene_config config = config_of(kind);
        config.precision = OVC_PRECISION_FAST;
        const auto structure = build(soup, config);
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        std::vector<uint8_t> shadows(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        ASSERT_TRUE(ok(structure->occluded(rays, {}, shadows)));
        size_t other = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const Hit& expected = exact[i];
            other += hits[i].id != expected.id || (shadows[i] != 0) != expected.is_hit();
            if (hits[i].id == expected.id && expected.is_hit()) {
                EXPECT_NEAR(hits[i].t, expected.t, 1e-5) << kind.name;
                EXPECT_NEAR(hits[i].u, expected.u, 1e-2) << kind.name;
                EXPECT_NEAR(hits[i].v, expected.v, 1e-2) << kind.name;
            }
        }
        EXPECT_LT(other, rays.size() / 500) << kind.name;
        EXPECT_EQ(structure->report().flagged, 0u) << kind.name;
    }
}

TEST_F(Queued, MovesPagesOnlyWhereTheyDoNotAllFit) {
    const Soup soup = test::closed_grid(150);
    const auto rays = rays_from_outside(5, 10000);
    for (const Kind& kind : kinds()) {
        const auto whole = build(soup, kind, {2000});
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(whole->intersect(rays, {}, hits)));
        const ovc_statistics all = whole->report();
        EXPECT_LE(all.pages_in, all.leaves) << kind.name;
        EXPECT_LE(all.bytes_in, all.level2_bytes) << kind.name;
        const auto tight = build(soup, kind, {2000, all.level2_bytes / 3});
        ASSERT_TRUE(ok(tight->intersect(rays, {}, hits)));
        const ovc_statistics part = tight->report();
        EXPECT_GT(part.pages_in, all.leaves) << kind.name;
        EXPECT_LE(part.gpu_peak_bytes, part.gpu_budget_bytes) << kind.name;
    }
}

/// Returns sheets, each a leaf: a ray that passes all of them is in one queue after another.
TEST_F(Queued, ARayIsInOneQueueAfterAnother) {
    std::vector<vec3> corners;
    for (int sheet = 0; sheet < 8; ++sheet)
        for (const vec3& v : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)})
            corners.push_back(v + vec3(0, 0, float(sheet)));
    const Soup soup = test::one_chunk(std::move(corners));
    const std::vector<Ray> rays(100, Ray{dvec3(0.7, 0.7, -1), 0, dvec3(0, 0, 1)}); // beside them
    const auto structure = build(soup, kinds()[3], {1}); // a BVH cuts no triangle
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    const ovc_statistics s = structure->report();
    EXPECT_EQ(s.leaves, 8u);
    EXPECT_EQ(s.passes, 8u);
    EXPECT_EQ(s.ray_visits, 8 * rays.size());
}

TEST(Queues, PreferTheFullestOfThoseThatAreThere) {
    Queues queues(4);
    std::vector<Page> pages(4);
    for (size_t i = 0; i < pages.size(); ++i)
        pages[i].texels.resize(100 * (i + 1));
    for (const auto& [leaf, rays] : {std::pair(0u, 5), {1u, 20}, {2u, 24}, {3u, 3}})
        for (int i = 0; i < rays; ++i)
            queues.push(leaf, uint32_t(i));
    const auto choose = [&](std::vector<uint32_t> resident) {
        return queues.choose(
            [&](uint32_t l) { return std::ranges::find(resident, l) != resident.end(); }, pages);
    };
    EXPECT_EQ(choose({0, 1, 2, 3}), 2u);
    EXPECT_EQ(choose({0, 3}), 0u);
    EXPECT_EQ(choose({}), 1u) << "most rays a byte";
    EXPECT_EQ(queues.take(1).size(), 20u);
    EXPECT_EQ(choose({}), 2u);
    for (const uint32_t leaf : {0u, 2u, 3u})
        queues.take(leaf);
    EXPECT_TRUE(queues.empty());
}

std::string refusal(const ovc_scene_config& config) {
    DeviceInfo device;
    device.max_texture_size = 16384;
    device.max_buffer_texels = 1 << 27;
    try {
        check_config(config, device);
    } catch (const Failure& failure) {
        return failure.message;
    }
    return "";
}

TEST(QueuedConfig, RefusesWhatMeansNothing) {
    for (const Kind& kind : kinds())
        EXPECT_EQ(refusal(config_of(kind, {100})), "");
    EXPECT_EQ(refusal(config_of({"", OVC_LEVEL1_GRID, OVC_LEVEL1_BUILD_BOTTOM_UP})),
              "thesis-two-level: a grid is built top-down; it has no leaves to merge");
    EXPECT_THAT(refusal(config_of(kinds()[0], {0, 28675})),
                HasSubstr("the smallest that works is 28676 bytes"));
    EXPECT_EQ(refusal(config_of(kinds()[0], {0, 28676})), "");
    ovc_scene_config config = config_of(kinds()[0]);
    config.kernel = OVC_KERNEL_COMPUTE;
    EXPECT_EQ(refusal(config), "thesis-two-level has no compute kernel");
    config = config_of(kinds()[2]);
    config.structure = OVC_STRUCTURE_GPU_GRID;
    EXPECT_EQ(refusal(config),
              "gpu-grid has no level 1: level1 is 1 and level1_build 0, expected 0");
}

} // namespace
} // namespace ovc::thesis
