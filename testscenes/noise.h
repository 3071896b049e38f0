// SPDX-License-Identifier: Apache-2.0
// Smooth functions that are the same on every machine: sine and noise from + - * / and floor alone.
#pragma once

#include "core/smooth_step.h"
#include "core/vec.h"

#include <cstdint>

namespace ovc {

/// Returns the point of the unit circle after `turns` turns, (cosine, sine), to about 1e-9.
dvec2 circle(double turns);

/// Returns value noise in [-1, 1], which is twice differentiable and has a value at each corner of
/// the unit cells.
double noise(dvec2 p, uint64_t seed);
double noise(dvec3 p, uint64_t seed);

/// Adds up `octaves` of noise, each of half the size and half the height, in about [-1, 1].
double fractal_noise(dvec2 p, int octaves, uint64_t seed);
double fractal_noise(dvec3 p, int octaves, uint64_t seed);

} // namespace ovc
