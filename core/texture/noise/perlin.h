// SPDX-License-Identifier: Apache-2.0
// Perlin's improved noise as pbrt has it, and sums of it that leave out what a ray's footprint is
// too wide for.
// Based on: Perlin 2002, "Improving Noise"; the values of pbrt-v4.
#pragma once

#include "core/vec.h"

#include <array>

namespace ovc {

/// Returns the noise at a point, from about -1 to 1. It is 0 at whole coordinates.
double improved_noise(const dvec3& at);

/// What the octaves of a sum are: each has 1.99 times the frequency of the one before, and
/// `roughness` times its share.
struct NoiseSum {
    double octaves = 8; // at most 32
    double roughness = 0.5;
    /// The sides of the parallelogram around the point over which the sum is wanted; both 0: a
    /// point. Octaves with waves shorter than twice these are left out, the last one softly.
    std::array<dvec3, 2> sides{};
};
inline constexpr double kMaxNoiseOctaves = 32;

/// Returns the sum of octaves of noise, as pbrt's fbm.
/// Based on: Pharr, Jakob and Humphreys 2016, "Physically Based Rendering", section 10.6.
double noise_sum(const dvec3& at, const NoiseSum& sum);

/// Returns the sum of the magnitudes of octaves of noise, as pbrt's wrinkled. Octaves that are left
/// out count by their mean.
double turbulence_sum(const dvec3& at, const NoiseSum& sum);

/// Returns the height of waves in gusts of wind, as pbrt's windy.
double windy_sum(const dvec3& at, const std::array<dvec3, 2>& sides);

} // namespace ovc
