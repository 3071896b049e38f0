// SPDX-License-Identifier: Apache-2.0
#include "host/shade/surface/media.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace ovc {
namespace {

/// A ray of length 2 by t = 1.
const Ray kRay{dvec3(1, 2, 3), 0, dvec3(0, 0, 2), 1e30};

ThroughMedia through(const Medium& medium, double end, std::span<const Texture> textures = {}) {
    const Medium* const all[] = {&medium};
    const double ends[] = {0, end};
    return through_media(textures, all, kRay, ends);
}

TEST(Media, TakeAndGiveLightAlongTheWay) {
    Medium medium;
    medium.absorption = vec3(0, 0.5f, 1);
    medium.emission = vec3(0.25f);
    medium.samples = 64;
    for (const uint32_t levels : {0u, 3u}) {
        medium.levels = levels;
        const ThroughMedia all = through(medium, 1.5);
        for (int i = 0; i < 3; ++i) {
            const double a = double(medium.absorption[i]), left = std::exp(-3 * a);
            EXPECT_NEAR(all.share[i], left, 1e-6);
            EXPECT_NEAR(all.added[i], a > 0 ? 0.25 * (1 - left) / a : 0.75,
                        levels == 0 ? 1e-4 : 0.02); // parts do not dim themselves
        }
        EXPECT_TRUE(all.scattering.empty());
    }
}

/// The pictures of povray 3.7 have these shares of what the medium emits.
TEST(Media, AreSampledAsPovrayDoes) {
    struct Asked {
        uint32_t samples, levels;
        double left;
    };
    for (const Asked& asked :
         {Asked{6, 3, 0.6863}, {2, 3, 0.8033}, {3, 3, 0.7433}, {11, 3, 0.6613}, {5, 0, 0.6311}}) {
        Medium medium;
        medium.emission = vec3(0.5f);
        medium.absorption = vec3(0.5f);
        medium.samples = asked.samples;
        medium.levels = asked.levels;
        EXPECT_NEAR(through(medium, 1).added.x, asked.left, 2e-4) << asked.samples;
    }
}

/// As in povray, six parts take up 6 / 7 of the way, and are halved at most twice where the light
/// changes.
TEST(Media, ArePartsThatAreHalvedWhereTheyDiffer) {
    Texture step; // 1 behind the given z, before it 0
    step.pattern.kind = Pattern::Kind::Function;
    step.pattern.wave = Pattern::Wave::None;
    step.pattern.formula = {{{FormulaStep::Kind::Argument, 2}}, {1}};
    step.stops = {{0, {vec3(0)}}, {1e-6, {vec3(1)}}};
    const auto behind = [&](double z, float emission) {
        Medium medium;
        medium.emission = vec3(emission);
        medium.densities = {
            {0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, -(3 + 2 * z))}}};
        return double(through(medium, 1, {&step, 1}).added.x) / (2 * double(emission));
    };
    EXPECT_NEAR(behind(0.87, 0.5f), 0, 1e-6) << "beyond the last place";
    EXPECT_NEAR(behind(0.85, 0.5f), 1 / 72.0, 1e-4) << "the last of 48 + 1, whose end counts less";
    EXPECT_NEAR(behind(0.85, 0.01f), 1 / 18.0, 1e-4) << "too faint to be halved";
}

TEST(Media, ScatterLightThatIsMissingBehind) {
    Medium medium;
    medium.scattering = vec3(0.2f);
    medium.extinction = 0.5f;
    medium.samples = 64;
    medium.levels = 0;
    const ThroughMedia all = through(medium, 1);
    EXPECT_NEAR(all.share.x, std::exp(-2 * 0.2 * 0.5), 1e-6);
    ASSERT_EQ(all.scattering.size(), medium.samples);
    float sum = 0;
    for (const ScatteringPlace& place : all.scattering)
        sum += place.share.x;
    EXPECT_NEAR(sum, (1 - double(all.share.x)) / 0.5, 1e-4);
    EXPECT_EQ(all.scattering[0].at, dvec3(1, 2, 3 + 1.0 / medium.samples));
    medium.intervals = 1 << 16;
    EXPECT_LE(through(medium, 1).scattering.size(), kMaxScatteringPlaces);
}

TEST(Media, AreAsDenseAsTheirTextures) {
    Texture half;
    half.stops = {{0, {vec3(0.5f, 0, 0)}}};
    const PlacedTexture placed{0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)}};
    Medium medium;
    medium.emission = vec3(1);
    medium.densities = {placed, placed};
    EXPECT_NEAR(through(medium, 1, {&half, 1}).added.x, 0.5, 1e-6);
    EXPECT_EQ(through(medium, 1, {&half, 1}).added.y, 0);
}

TEST(Media, KeepAShareOfLightInAFewPlacesToo) {
    Texture rising; // from 0 to 1 along the ray
    rising.pattern.kind = Pattern::Kind::Function;
    rising.pattern.wave = Pattern::Wave::None;
    rising.pattern.formula = {{{FormulaStep::Kind::Argument, 2}}, {1}};
    rising.stops = {{0, {vec3(0)}}, {1, {vec3(1)}}};
    Medium medium;
    medium.absorption = vec3(0, 1, 2);
    const Medium* const all[] = {&medium};
    EXPECT_NEAR(share_through_media({}, all, kRay, 1).y, std::exp(-2), 1e-6);
    medium.densities = {{0, {dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 0.5, -1.5)}}};
    const vec3 share = share_through_media({&rising, 1}, all, kRay, 1);
    EXPECT_EQ(share.x, 1);
    EXPECT_NEAR(share.y, std::exp(-1), 1e-5);
    EXPECT_NEAR(share.z, std::exp(-2), 1e-5);
}

/// As much brighter than an even phase as pixels of povray 3.7.0.10 are, at angles of 0, 30, 60, 90
/// and 180 degrees. Only even phases and those of Henyey and Greenstein keep the light.
TEST(Media, PhasesAreThoseOfPovRay) {
    const struct {
        Medium::Phase phase;
        std::array<double, 5> measured;
    } cases[] = {{Medium::Phase::Even, {1, 1, 1, 1, 1}},
                 {Medium::Phase::MieHazy, {5.7662, 3.5566, 1.0961, 0.5969, 0.5767}},
                 {Medium::Phase::MieMurky, {25.2947, 3.1924, 0.4980, 0.4956, 0.4956}},
                 {Medium::Phase::Rayleigh, {1.5987, 1.3988, 0.9991, 0.7992, 1.5987}},
                 {Medium::Phase::HenyeyGreenstein, {6.0031, 3.1542, 1.1547, 0.5374, 0.2229}}};
    const double cosines[] = {1, std::sqrt(0.75), 0.5, 0, -1};
    for (const auto& c : cases) {
        Medium medium;
        medium.phase = c.phase;
        medium.eccentricity = 0.5f;
        for (size_t i = 0; i < 5; ++i)
            EXPECT_NEAR(phase_of(medium, cosines[i]), c.measured[i], 0.004 * c.measured[i])
                << int(c.phase) << " " << i;
    }
}

} // namespace
} // namespace ovc
