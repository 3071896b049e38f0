// SPDX-License-Identifier: Apache-2.0
#include "core/texture/noise/perlin.h"
#include "core/texture/normal_map.h"
#include "core/texture/pattern.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ovc {

/// The value at (3.14, 42, 7) is that which Perlin's published program prints. The others are those
/// of pbrt-v4, some of whose gradients have other numbers.
TEST(Perlin, HasTheValuesOfImprovedNoise) {
    EXPECT_NEAR(improved_noise({10.5, 2.25, 0.75}), 0.4492054, 1e-7);
    EXPECT_NEAR(improved_noise({20.5, 13.25, 5.75}), -0.0245395, 1e-7);
    EXPECT_NEAR(improved_noise({-4.25, 0.5, 9.5}), -0.1098633, 1e-7);
    EXPECT_NEAR(improved_noise({3.14, 42, 7}), 0.136919958784, 1e-12);
    EXPECT_EQ(improved_noise({-3, 5, 1000}), 0);
    EXPECT_NEAR(improved_noise({3.14 - 256, 42, 7 + 512}), 0.136919958784, 1e-9) << "a period";
    EXPECT_EQ(improved_noise({NAN, 0, 0}), 0);
}

TEST(Perlin, SumsLeaveOutWhatIsSmallerThanTheFootprint) {
    const dvec3 at(0.3, 1.7, -2.2);
    EXPECT_NEAR(noise_sum(at, {2, 0.5}), improved_noise(at) + 0.5 * improved_noise(1.99 * at),
                1e-12);
    EXPECT_NEAR(turbulence_sum(at, {2, 0.25}),
                std::abs(improved_noise(at)) + 0.25 * std::abs(improved_noise(1.99 * at)) +
                    0.0625 * 0.2,
                1e-12);
    // A side of 1/4 leaves one octave: half a wave is as long as the footprint's double.
    EXPECT_NEAR(noise_sum(at, {8, 0.5, {dvec3(0.25, 0, 0), dvec3(0)}}), improved_noise(at), 1e-12);
    EXPECT_EQ(noise_sum(at, {8, 0.5, {dvec3(4, 0, 0), dvec3(0)}}), 0);
    EXPECT_NEAR(turbulence_sum(at, {3, 0.5, {dvec3(4, 0, 0), dvec3(0)}}), 0.2 * 1.75, 1e-12);
}

/// A footprint is that of the texture's space.
TEST(Perlin, PatternsMoveFootprintsAlong) {
    Pattern pattern;
    pattern.kind = Pattern::Kind::Perlin;
    pattern.wave = Pattern::Wave::None;
    pattern.parameters = {PerlinParameter::Sum, 8, 0.5};
    TextureStep smaller;
    smaller.rows = {dvec4(0.5, 0, 0, 0), dvec4(0, 0.5, 0, 0), dvec4(0, 0, 0.5, 0)};
    pattern.steps = {smaller};
    TexturePoint point(dvec3(0.6, 3.4, -4.4));
    point.sides[0] = dvec3(0, 0.5, 0);
    const double value = evaluate({}, pattern, point).value;
    EXPECT_NEAR(value, improved_noise({0.3, 1.7, -2.2}), 1e-12);
    EXPECT_LT(value, 0) << "values are not cut off";
}

TEST(Perlin, HeightsInSpaceTiltNormalsAgainstTheirSlope) {
    std::vector<Texture> textures(2);
    textures[0].pattern.kind = Pattern::Kind::Function;
    textures[0].pattern.wave = Pattern::Wave::None;
    textures[0].pattern.formula = {{{FormulaStep::Kind::Argument, 0}}, {1}};
    textures[0].stops = {{0, {vec3(0)}}, {1, {vec3(1)}}};
    textures[1].kind = TextureKind::Product;
    textures[1].stops = {{0, {}, 0}, {0, {vec3(0.5f)}, kNoTexture}};
    const NormalMap map{NormalMap::Kind::Space, 1, 2};
    // The height is x, also where it is far above 1.
    const dvec3 normal = tilted(textures, map, dvec3(-7, 1, 2), {0, 0, 1});
    EXPECT_NEAR(normal.x, -std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(normal.y, 0, 1e-6);
    EXPECT_NEAR(normal.z, std::sqrt(0.5), 1e-6);
}

} // namespace ovc
