// SPDX-License-Identifier: Apache-2.0
#include "host/shade/surface/media.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace ovc {
namespace {

/// A ray of length 2 by t = 1.
const Ray kRay{dvec3(1, 2, 3), 0, dvec3(0, 0, 2), 1e30};

TEST(Media, TakeAndGiveLightAlongTheWay) {
    Medium medium;
    medium.absorption = vec3(0, 0.5f, 1);
    medium.emission = vec3(0.25f);
    medium.samples = 64;
    const ThroughMedia through = through_media({}, {&medium, 1}, kRay, 1.5);
    for (int i = 0; i < 3; ++i) {
        const double a = double(medium.absorption[i]), left = std::exp(-3 * a);
        EXPECT_NEAR(through.share[i], left, 1e-6);
        EXPECT_NEAR(through.added[i], a > 0 ? 0.25 * (1 - left) / a : 0.75, 1e-4);
    }
    EXPECT_TRUE(through.scattering.empty());
}

TEST(Media, ScatterLightThatIsMissingBehind) {
    Medium medium;
    medium.scattering = vec3(0.2f);
    medium.extinction = 0.5f;
    const ThroughMedia through = through_media({}, {&medium, 1}, kRay, 1);
    EXPECT_NEAR(through.share.x, std::exp(-2 * 0.2 * 0.5), 1e-6);
    ASSERT_EQ(through.scattering.size(), medium.samples);
    float sum = 0;
    for (const ScatteringPlace& place : through.scattering)
        sum += place.share.x;
    EXPECT_NEAR(sum, (1 - double(through.share.x)) / 0.5, 1e-4);
    EXPECT_EQ(through.scattering[0].at, dvec3(1, 2, 3 + 1.0 / medium.samples));
}

TEST(Media, AreAsDenseAsTheirTextures) {
    Texture half;
    half.stops = {{0, {vec3(0.5f, 0, 0)}}};
    const PlacedTexture placed{0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)}};
    Medium medium;
    medium.emission = vec3(1);
    medium.densities = {placed, placed};
    EXPECT_NEAR(through_media({&half, 1}, {&medium, 1}, kRay, 1).added.x, 0.5, 1e-6);
    EXPECT_EQ(through_media({&half, 1}, {&medium, 1}, kRay, 1).added.y, 0);
}

TEST(Media, ThatAreEvenAreLookedAtWhereTheyCanBeSeen) {
    Medium medium;
    medium.scattering = vec3(0.2f);
    const ThroughMedia through = through_media({}, {&medium, 1}, kRay, 1e7);
    EXPECT_LT(through.share.x, 1e-6);
    float sum = 0;
    for (const ScatteringPlace& place : through.scattering)
        sum += place.share.x;
    EXPECT_NEAR(sum, 1, 0.05) << "all light has been scattered";
}

TEST(Media, KeepAShareOfLightInAFewPlacesToo) {
    Texture rising; // from 0 to 1 along the ray
    rising.pattern.kind = Pattern::Kind::Function;
    rising.pattern.wave = Pattern::Wave::None;
    rising.pattern.formula = {{{FormulaStep::Kind::Argument, 2}}, {1}};
    rising.stops = {{0, {vec3(0)}}, {1, {vec3(1)}}};
    Medium medium;
    medium.absorption = vec3(0, 1, 2);
    EXPECT_NEAR(share_through_media({}, {&medium, 1}, kRay, 1).y, std::exp(-2), 1e-6);
    medium.densities = {{0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 0.5, -1.5)}}};
    const vec3 share = share_through_media({&rising, 1}, {&medium, 1}, kRay, 1);
    EXPECT_EQ(share.x, 1);
    EXPECT_NEAR(share.y, std::exp(-1), 1e-5);
    EXPECT_NEAR(share.z, std::exp(-2), 1e-5);
}

/// Each phase scatters as much light in all as an even one.
TEST(Media, PhasesKeepTheLight) {
    for (const Medium::Phase phase :
         {Medium::Phase::Even, Medium::Phase::MieHazy, Medium::Phase::MieMurky,
          Medium::Phase::Rayleigh, Medium::Phase::HenyeyGreenstein}) {
        Medium medium;
        medium.phase = phase;
        medium.eccentricity = -0.6f;
        double mean = 0;
        constexpr int kSteps = 20000;
        for (int i = 0; i < kSteps; ++i)
            mean += phase_of(medium, 2 * (i + 0.5) / kSteps - 1) / kSteps;
        EXPECT_NEAR(mean, 1, 1e-4) << int(phase);
    }
}

} // namespace
} // namespace ovc
