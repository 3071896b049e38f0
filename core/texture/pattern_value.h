// SPDX-License-Identifier: Apache-2.0
// The values of single patterns, for pattern.cpp.
#pragma once

#include "core/texture/pattern.h"

namespace ovc {

/// Returns the value of a pattern that is not discrete, before frequency, phase and wave.
double continuous_value(std::span<const Texture> textures, const Pattern& pattern,
                        const TexturePoint& point);

/// Returns the wave that goes from 0 at whole numbers to 1 in between.
double triangle_of(double x);

/// Returns the number of the stop that a discrete pattern chooses.
double discrete_value(const Pattern& pattern, const dvec3& at);

} // namespace ovc
