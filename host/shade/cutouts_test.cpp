// SPDX-License-Identifier: Apache-2.0
// Cutouts: where a picture is asked for a hit, and which hits count.
#include "host/shade/cutouts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ovc {
namespace {

/// Four opacities: 0 and 85 above 170 and 255.
Cutout four() {
    return {.width = 2, .height = 2, .opacity = {0, 85, 170, 255}};
}

TEST(Cutout, IsAskedByTheTexelAtAPlace) {
    const Cutout cutout = four();
    EXPECT_EQ(opacity_at(cutout, {0.2, 0.9}), 0);
    EXPECT_NEAR(opacity_at(cutout, {0.7, 0.6}), 1 / 3.0, 1e-6);
    EXPECT_NEAR(opacity_at(cutout, {0.2, 0.2}), 2 / 3.0, 1e-6);
    EXPECT_EQ(opacity_at(cutout, {0.5, 0.2}), 1) << "the border is of the next texel";
}

TEST(Cutout, IsInterpolatedBetweenTheMiddlesOfTexels) {
    Cutout cutout = four();
    cutout.smooth = true;
    EXPECT_EQ(opacity_at(cutout, {0.25, 0.75}), 0);
    EXPECT_NEAR(opacity_at(cutout, {0.5, 0.75}), 1 / 6.0, 1e-6);
    EXPECT_NEAR(opacity_at(cutout, {0.5, 0.5}), 0.5, 1e-6);
    EXPECT_NEAR(opacity_at(cutout, {0, 0.25}), 5 / 6.0, 1e-6) << "the other side is beyond";
    cutout.beyond = Cutout::Beyond::Clamp;
    EXPECT_NEAR(opacity_at(cutout, {0, 0.25}), 2 / 3.0, 1e-6);
    cutout.beyond = Cutout::Beyond::Hole;
    EXPECT_NEAR(opacity_at(cutout, {0, 0.25}), 1 / 3.0, 1e-6);
}

TEST(Cutout, HasARuleBeyondItsSquare) {
    Cutout cutout = four();
    for (const double far : {1.0, -3.0, 1e6}) {
        EXPECT_NEAR(opacity_at(cutout, {0.7 + far, 0.6 - far}), 1 / 3.0, 1e-6);
        cutout.beyond = Cutout::Beyond::Hole;
        EXPECT_EQ(opacity_at(cutout, {0.7 + far, 0.6}), 0);
        EXPECT_EQ(opacity_at(cutout, {0.7, 0.2 + far}), 0);
        cutout.beyond = Cutout::Beyond::Clamp;
        EXPECT_NEAR(opacity_at(cutout, {0.7, 0.6 + std::abs(far)}), 1 / 3.0, 1e-6);
        EXPECT_NEAR(opacity_at(cutout, {-far * 1e300, -1.0}), far > 0 ? 2 / 3.0 : 1, 1e-6);
        cutout.beyond = Cutout::Beyond::Repeat;
    }
    for (const double wild : {std::numeric_limits<double>::infinity(), std::nan(""), 1e308})
        for (const bool smooth : {false, true}) {
            cutout.smooth = smooth;
            const float opacity = opacity_at(cutout, {wild, -wild});
            EXPECT_TRUE(opacity >= 0 && opacity <= 1) << wild;
        }
}

TEST(Cutout, IsScaledAndPlaced) {
    Cutout cutout = four();
    cutout.scale = 0.5f;
    cutout.uv_scale = {2, 1};
    cutout.uv_offset = {0.5, 0};
    EXPECT_NEAR(opacity_at(cutout, {0.1, 0.2}), 0.5, 1e-6);
    cutout.scale = 4;
    EXPECT_EQ(opacity_at(cutout, {0.4, 0.2}), 1) << "no more than all";
}

/// Two meshes of one triangle each, of which the first has a cutout.
Scene scene_with(Cutout cutout) {
    Scene scene;
    scene.materials.emplace_back();
    for (int m = 0; m < 2; ++m)
        scene.add_mesh("", 0, Chunk::owning(dvec3(0), {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}));
    scene.cutouts.push_back(std::move(cutout));
    scene.meshes[0].cutout = 0;
    scene.meshes[0].uv = {vec2(0), vec2(1, 0), vec2(0, 1)};
    return scene;
}

bool counts(Cutouts& cutouts, const Hit& hit) {
    const uint64_t ray = 7;
    uint8_t keep = 1;
    EXPECT_TRUE(cutouts.keep({&ray, 1}, {&hit, 1}, {&keep, 1}));
    return keep != 0;
}

TEST(Cutouts, KeepHitsOffTheHoles) {
    const Scene scene = scene_with({.width = 2, .height = 1, .opacity = {0, 255}});
    Cutouts cutouts(scene, Cutouts::Asked::ByPaths);
    EXPECT_TRUE(cutouts.any());
    EXPECT_FALSE(counts(cutouts, {1, 0.3, 0.5, {0, 0}}));
    EXPECT_TRUE(counts(cutouts, {1, 0.6, 0.1, {0, 0}}));
    EXPECT_TRUE(counts(cutouts, {1, 0.3, 0.5, {1, 0}})) << "a mesh without holes";
}

TEST(Cutouts, OfShadowsAreForShadowRays) {
    Scene scene = scene_with({.width = 1, .height = 1, .opacity = {0}});
    std::swap(scene.meshes[0].cutout, scene.meshes[0].shadow_cutout);
    EXPECT_FALSE(Cutouts(scene, Cutouts::Asked::ByPaths).any());
    Cutouts by_shadow_rays(scene, Cutouts::Asked::ByShadowRays);
    EXPECT_FALSE(counts(by_shadow_rays, {1, 0.3, 0.5, {0, 0}}));
}

TEST(Cutouts, KeepPartOfTheHitsWhereOpacityIsPart) {
    Scene scene = scene_with({.width = 1, .height = 1, .opacity = {255}, .scale = 0.3f});
    constexpr int kHits = 100'000;
    const auto kept = [&](double step) {
        Cutouts cutouts(scene, Cutouts::Asked::ByPaths);
        int count = 0;
        for (int i = 0; i < kHits; ++i)
            count += counts(cutouts, {1 + i * step, 0.25 + i * 1e-6, 0.25, {0, 0}});
        return count / double(kHits);
    };
    EXPECT_NEAR(kept(0), 0.3, 0.008);
    EXPECT_EQ(kept(0), kept(0)) << "the same hits, the same answer";
    EXPECT_NEAR(kept(1e-9), 0.3, 0.008);
    scene.cutouts[0].partial = false;
    EXPECT_EQ(kept(0), 1);
}

} // namespace
} // namespace ovc
