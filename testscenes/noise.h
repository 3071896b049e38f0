// SPDX-License-Identifier: Apache-2.0
// Smooth functions that are the same on every machine: sine and noise from + - * / and floor alone.
#pragma once

#include "core/vec.h"

#include <cstdint>

namespace ovc {

/// The point of the unit circle after `turns` turns: (cosine, sine), to about 1e-9.
dvec2 circle(double turns);

/// 0 up to `from`, 1 from `to` on, smooth between. from > to: the other way round.
double smooth_step(double from, double to, double x);

/// Value noise in [-1, 1], twice differentiable, one value per unit cell corner.
double noise(dvec2 p, uint64_t seed);
double noise(dvec3 p, uint64_t seed);

/// `octaves` of noise, each of half the size and half the height, in about [-1, 1].
double fractal_noise(dvec2 p, int octaves, uint64_t seed);
double fractal_noise(dvec3 p, int octaves, uint64_t seed);

} // namespace ovc
