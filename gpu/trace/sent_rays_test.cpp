// SPDX-License-Identifier: Apache-2.0
// Rays by lanes are those that the functions for one ray make, bit for bit, by vectors of every
// width.
#include "gpu/trace/sent_rays.h"

#include "core/ray_span.h"
#include "gpu/frame/portal.h"
#include "kdtree/restart.h"
#include "kdtree/test_soups.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <numeric>

namespace ovc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns rays around a box of size 2 at the origin, every third of which has a number from
/// `odd` in one of its fields.
std::vector<Ray> rays_with(std::span<const double> odd, size_t count) {
    test::Random random(3);
    std::vector<Ray> rays;
    for (size_t i = 0; i < count; ++i) {
        Ray ray{random.point(-3, 3), random(0, 0.5), random.point(-1, 1),
                i % 2 == 0 ? kInfinity : random(0, 4)};
        double* const fields[] = {&ray.org.x, &ray.org.y, &ray.org.z, &ray.t_min,
                                  &ray.dir.x, &ray.dir.y, &ray.dir.z, &ray.t_max};
        if (i % 3 == 0)
            *fields[random.below(8)] = odd[random.below(odd.size())];
        rays.push_back(ray);
    }
    return rays;
}

const double kOdd[] = {0,     -0.0,  1,         -1,         2.5,  1e-300, 1e-310, -1e-320,
                       1e300, 1e308, kInfinity, -kInfinity, kNan, 1e13,   -1e18,  1e-30};

RayStates eight(std::span<const Ray> rays) {
    RayStates states{};
    states.set(RayLanes::kCount, 0, [&](size_t lane) { return &rays[lane]; });
    std::iota(states.skip.begin(), states.skip.end(), 0u);
    return states;
}

TEST(RayLanes, LookAheadAsTheFunctionsForOneRay) {
    Level1 level1;
    level1.bounds = {dvec3(-1), dvec3(1)};
    level1.padding = padding_of(level1.bounds);
    const Box padded = level1.bounds.padded(level1.padding);
    const LanesScene scene{false, level1.padding, LanesBox(level1.bounds), LanesBox(padded)};
    const std::vector<Ray> rays = rays_with(kOdd, 80000);
    size_t lost = 0, met = 0, invalid = 0;
    for (size_t i = 0; i < rays.size(); i += RayLanes::kCount)
        for (const LookAhead way : ways_to_look_ahead()) {
            const LanesAhead ahead = way(scene, eight(std::span(rays).subspan(i)).rays);
            for (size_t lane = 0; lane < RayLanes::kCount; ++lane) {
                const PreparedRay p(rays[i + lane]);
                const bool valid = p.ray.valid();
                ASSERT_EQ(ahead.valid >> lane & 1, valid) << i + lane;
                invalid += !valid;
                if (!valid)
                    continue;
                const bool walks = can_walk(level1, p);
                ASSERT_EQ(ahead.walks >> lane & 1, walks) << i + lane;
                lost += !walks;
                const bool meets = !clip(p, padded, p.ray.t_min, p.ray.t_max).empty();
                ASSERT_EQ(ahead.meets >> lane & 1, meets) << i + lane;
                met += meets;
            }
        }
    EXPECT_GT(lost, 100u);
    EXPECT_GT(invalid, 1000u);
    EXPECT_GT(met, 10000u);
}

TEST(RayLanes, AreInTheFrameAsTheFunctionForOneRayHasThem) {
    const Leaf scene = scene_leaf({dvec3(-1), dvec3(1)});
    const std::vector<double> odd = {0, -0.0, 1, -1, 2.5, 1e-300, 1e13, -1e18, 1e-30, 1e200};
    std::vector<Ray> rays = rays_with(odd, 40000);
    for (size_t i = 0; i < rays.size(); i += 20) // from too far away to tell where in the box
        rays[i] = {1e9 * rays[i + 1].dir, 0, -rays[i + 1].dir};
    std::vector<RayState> states;
    for (const Ray& ray : rays)
        if (ray.valid())
            states.push_back({.ray = ray,
                              .skip = uint32_t(states.size() % 7),
                              .asks = states.size() % 2 == 0 ? OVC_RAY_ANY_HIT : 9u});
    const SentRays sent = send({RayForm::Kind::Resumed, &scene, nullptr}, states);
    const auto* const resumed = reinterpret_cast<const ResumedRay*>(sent.bytes().data());
    size_t undecidable = 0;
    for (size_t i = 0; i < states.size(); ++i) {
        LocalTime time;
        const LocalRay ray =
            local_ray(scene, states[i].ray, states[i].skip, states[i].any_hit(), time);
        ASSERT_EQ(resumed[i].waited_for, states[i].key());
        ASSERT_EQ(resumed[i].ray.t_end, ray.t_end) << i;
        undecidable += ray.t_end == OVC_UNDECIDABLE;
        if (ray.t_end < 0)
            continue; // the rest does not matter
        ASSERT_EQ(std::memcmp(&resumed[i].ray, &ray, sizeof(ray)), 0) << i;
    }
    EXPECT_GT(undecidable, 100u);
}

TEST(RayLanes, AreTheSameByEveryWidthOfVectors) {
    std::vector<Ray> rays = rays_with(kOdd, 8000);
    std::erase_if(rays, [](const Ray& ray) { return !ray.valid(); });
    rays.resize(rays.size() / RayLanes::kCount * RayLanes::kCount);
    const LanesFrame frame{LanesBox({dvec3(-1), dvec3(1)}), {0.1, 0.2, 0.3}, 0.7, 1e6, -1, -2};
    for (size_t i = 0; i < rays.size(); i += RayLanes::kCount) {
        const RayStates states = eight(std::span(rays).subspan(i));
        LocalRows first;
        ways_to_frame()[0](frame, states.rays, states.skip.data(), first);
        for (const ToFrame way : ways_to_frame()) {
            LocalRows local;
            way(frame, states.rays, states.skip.data(), local);
            for (int lane = 0; lane < RayLanes::kCount; ++lane) {
                ASSERT_EQ(local.rows[lane][LocalRows::kEnd], first.rows[lane][LocalRows::kEnd]);
                if (local.rows[lane][LocalRows::kEnd] >= 0) {
                    ASSERT_EQ(std::memcmp(local.rows[lane], first.rows[lane], 32), 0);
                }
            }
        }
    }
}

TEST(RayLanes, AreGatheredAsTheyAreByEveryWidthOfVectors) {
    const std::vector<Ray> rays = rays_with(kOdd, 800);
    const RaySpan read(rays); // with 0 for -0
    for (size_t i = 0; i < rays.size(); i += RayLanes::kCount)
        for (const Gather way : ways_to_gather()) {
            std::array<const Ray*, RayLanes::kCount> some;
            for (size_t lane = 0; lane < some.size(); ++lane)
                some[lane] = &rays[i + lane];
            RayStates states;
            way(some.data(), states.rays);
            for (size_t lane = 0; lane < some.size(); ++lane) {
                const Ray ray = states.state(int(lane)).ray, expected = read[i + lane];
                ASSERT_EQ(std::memcmp(&ray, &expected, sizeof(ray)), 0) << i + lane;
                ASSERT_EQ(std::memcmp(&states.rays.t_min[lane], &expected.t_min, 8), 0);
            }
        }
}

TEST(SentRays, AreThoseOfABlockWithoutHoles) {
    const Leaf scene = scene_leaf({dvec3(-1), dvec3(1)});
    const RayForm form{RayForm::Kind::Local, &scene, nullptr};
    const double none[] = {0.25};
    const std::vector<Ray> rays = rays_with(none, 16);
    SentRays sent;
    sent.reset(form, 16);
    const size_t counts[] = {sent.put(0, eight(std::span(rays).first(8)), 0b1001),
                             sent.put(8, eight(std::span(rays).subspan(8)), 0b0110)};
    EXPECT_THAT(counts, testing::Each(2u));
    sent.close_holes(8, counts);
    const RayState states[] = {{.ray = rays[0], .skip = 0},
                               {.ray = rays[3], .skip = 3},
                               {.ray = rays[9], .skip = 1},
                               {.ray = rays[10], .skip = 2}};
    const SentRays expected = send(form, states);
    ASSERT_EQ(sent.bytes().size(), expected.bytes().size());
    EXPECT_EQ(std::memcmp(sent.bytes().data(), expected.bytes().data(), sent.bytes().size()), 0);
    EXPECT_EQ(sent.bytes().size(), whole_blocks(4) * sizeof(LocalRay));
}

TEST(SentRays, ComeBackAfterPacketsWereParted) {
    const Leaf scene = scene_leaf({dvec3(-1), dvec3(1)});
    std::vector<RayState> states(1000);
    for (size_t i = 0; i < states.size(); ++i)
        states[i].ray = {dvec3(0), 0, i % 50 == 7 ? dvec3(0, 0, -1) : dvec3(0, 0, 1)};
    SentRays sent = send({RayForm::Kind::Local, &scene, nullptr}, states);
    const std::vector<std::byte> before(sent.bytes().begin(), sent.bytes().end());
    EXPECT_TRUE(sent.are_coherent());
    ASSERT_TRUE(sent.part(4096));
    EXPECT_EQ(sent.parted().size(), 20u);
    EXPECT_GT(sent.slots(), sent.size());
    EXPECT_NE(std::memcmp(sent.bytes().data(), before.data(), before.size()), 0);
    sent.unpart();
    ASSERT_EQ(sent.bytes().size(), before.size());
    EXPECT_EQ(std::memcmp(sent.bytes().data(), before.data(), before.size()), 0);
    const SentRays some = sent.first(10);
    EXPECT_EQ(some.size(), 10u);
    EXPECT_EQ(std::memcmp(some.bytes().data(), before.data(), 10 * sizeof(LocalRay)), 0);
}

} // namespace
} // namespace ovc
