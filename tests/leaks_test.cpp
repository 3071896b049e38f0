// SPDX-License-Identifier: Apache-2.0
// Tests `overcast report --only leaks` in its short form, and its targets in meshes with holes.
#include "host/suites/stability/leak_cases.h"

#include "host/suites/stability/sound_targets.h"
#include "host/suites/stability/stability.h"
#include "host/suites/stability/stability_meshes.h"
#include "kdtree/build.h"
#include "kdtree/traverse.h"
#include "tests/real_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace ovc {
namespace {

Soup soup_of(Corners corners, dvec3 place) {
    Soup soup;
    soup.chunks.push_back(Chunk::owning(place, std::move(corners)));
    return soup;
}

/// Returns the icosphere without its first `count` triangles.
Corners with_hole(size_t count) {
    Corners corners = icosphere();
    corners.erase(corners.begin(), corners.begin() + std::ptrdiff_t(3 * count));
    return corners;
}

TEST(Leaks, NoneAtEdgesAndVerticesOfClosedMeshes) {
    auto cases = leak_cases(/* dragon= */ nullptr);
    share_rays(cases, 100'000);
    StabilityOptions options;
    options.peers = false;
    const auto results = run_stability(cases, options, {}, [](const StabilityResult&) {});
    if (!results)
        GTEST_SKIP() << results.error().message;
    ASSERT_EQ(results->size(), cases.size());
    uint64_t rays = 0, flagged = 0;
    for (const StabilityResult& r : *results) {
        EXPECT_EQ(r.hits, r.rays) << r.name;
        EXPECT_EQ(r.certified.leaks, 0u) << r.name;
        EXPECT_EQ(r.certified.wrong, 0u) << r.name;
        EXPECT_EQ(r.wrong_occlusions, 0u) << r.name;
        rays += r.rays;
        flagged += r.flagged;
    }
    EXPECT_GE(rays, 100'000u);
    EXPECT_GT(flagged, rays / 4) << "these rays are beyond float32";
}

TEST(Leaks, ARunEndsAfterABatchWhenTold) {
    auto cases = leak_cases(/* dragon= */ nullptr);
    share_rays(cases, 33'000'000);
    StabilityOptions options;
    options.peers = false;
    options.go_on = [](const StabilityResult&) { return false; };
    const auto results = run_stability(cases, options, {}, [](const StabilityResult&) {});
    if (!results)
        GTEST_SKIP() << results.error().message;
    ASSERT_EQ(results->size(), 1u);
    EXPECT_GT(results->front().rays, 0u);
    EXPECT_LT(results->front().rays, 1'000'000u);
}

TEST(SoundTargets, AreAllOfAClosedMesh) {
    const SoundTargets targets(soup_of(icosphere(), dvec3(1e7)));
    EXPECT_EQ(targets.vertices(), 2562u); // By Euler's formula, this is 5120 / 2 + 2.
    EXPECT_EQ(targets.sound_vertices(), 2562u);
    EXPECT_EQ(targets.edges(), 7680u);
    EXPECT_EQ(targets.sound_edges(), 7680u);
}

TEST(SoundTargets, AreNotAtARim) {
    // One triangle is missing, so its three edges and three vertices are at a rim.
    const SoundTargets targets(soup_of(with_hole(1), dvec3(0)));
    EXPECT_EQ(targets.sound_edges(), targets.edges() - 3);
    EXPECT_EQ(targets.sound_vertices(), targets.vertices() - 3);
}

TEST(SoundTargets, AreNotWhereThreeTrianglesMeetOrOneIsTurned) {
    Corners third = icosphere();
    third.insert(third.end(), {third[0], third[1], vec3(9)});
    const SoundTargets with_third(soup_of(third, dvec3(0)));
    EXPECT_EQ(with_third.sound_edges(), with_third.edges() - 3);
    Corners turned = icosphere();
    std::swap(turned[0], turned[1]);
    const SoundTargets with_turned(soup_of(turned, dvec3(0)));
    EXPECT_EQ(with_turned.sound_edges(), with_turned.edges() - 3);
}

TEST(SoundTargets, AreHitThoughTheMeshHasHoles) {
    for (const dvec3& place : {dvec3(0), dvec3(4.5e6, 6e6, 6), dvec3(1e9)}) {
        const Soup soup = soup_of(with_hole(2000), place);
        Random random(1);
        const AimedRays set = SoundTargets(soup).rays(random, 5000);
        ASSERT_EQ(set.rays.size(), 5000u);
        std::vector<Hit> hits(set.rays.size());
        intersect(build_kd_tree(soup), soup, set.rays, {}, hits);
        EXPECT_TRUE(std::ranges::all_of(hits, [](const Hit& hit) { return hit.is_hit(); }));
    }
}

TEST(SoundTargets, AreNearlyAllOfTheDragon) {
    const auto data = real_data();
    if (!data)
        GTEST_SKIP() << kNoRealData;
    const auto dragon = load_dragon(data->string());
    ASSERT_TRUE(dragon) << dragon.error().message;
    const SoundTargets targets((*dragon)->soup);
    std::printf("%llu of %llu edges, %llu of %llu vertices\n",
                static_cast<unsigned long long>(targets.sound_edges()),
                static_cast<unsigned long long>(targets.edges()),
                static_cast<unsigned long long>(targets.sound_vertices()),
                static_cast<unsigned long long>(targets.vertices()));
    EXPECT_GT(double(targets.sound_edges()), 0.99 * double(targets.edges()));
    EXPECT_GT(double(targets.sound_vertices()), 0.99 * double(targets.vertices()));
    EXPECT_LT(targets.sound_edges(), targets.edges()) << "the scan has holes";
}

TEST(SoundTargets, OfASingleTriangleAreNone) {
    Random random(1);
    const SoundTargets targets(soup_of(coincident(1), dvec3(0)));
    EXPECT_TRUE(targets.rays(random, 10).rays.empty());
}

} // namespace
} // namespace ovc
