// SPDX-License-Identifier: Apache-2.0
// Noise in space with the values of POV-Ray's: its patterns are made of it.
// Based on: Perlin 1985, "An Image Synthesizer": values and slopes at the points of a lattice. How
// they are mixed and chosen was measured: docs/decisions/0033-textures-are-trees-in-the-scene.md.
#pragma once

#include "core/vec.h"

#include <cstdint>

namespace ovc {

/// POV-Ray's noise_generator. Original is cut off at 0 and 1; Corrected is scaled to stay within.
/// Perlin has no values at the points of its lattice, only slopes.
enum class NoiseKind : uint64_t { Original = 1, Corrected = 2, Perlin = 3 };

inline constexpr uint64_t kMaxOctaves = 10;

/// How octaves of noise are added up: each has `lambda` times the frequency of the one before and
/// `omega` times its share.
struct Octaves {
    double lambda = 2;
    double omega = 0.5;
    uint64_t count = 6; // at most kMaxOctaves

    bool operator==(const Octaves&) const = default;
};

/// Returns the noise at a point, from 0 to 1, with a mean of about 0.5.
double noise(const dvec3& at, NoiseKind kind = NoiseKind::Corrected);

/// Returns three noises at once, each with a mean of 0 and from about -1 to 1.
dvec3 vector_noise(const dvec3& at);

/// Returns the sum of octaves of vector_noise(), as POV-Ray's vturbulence() does.
dvec3 turbulence(const dvec3& at, const Octaves& octaves);

/// Returns the sum of octaves of noise that marble and agate add.
double scalar_turbulence(const dvec3& at, const Octaves& octaves, NoiseKind kind);

/// Returns the number of the unit cell, from 0 to 4,095, by which POV-Ray chooses at random.
uint32_t cell_number(int64_t x, int64_t y, int64_t z);

} // namespace ovc
