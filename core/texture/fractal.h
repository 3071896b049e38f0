// SPDX-License-Identifier: Apache-2.0
// POV-Ray's fractal patterns: Mandelbrot, Julia and magnet sets in the plane of x and y.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstddef>

namespace ovc {

/// Indices into Pattern::parameters of Kind::Fractal.
struct FractalParameter {
    static constexpr size_t kIterations = 0; // 1 to kMaxFractalIterations
    static constexpr size_t kExponent = 1;   // 2 to 33; -1 and -2: the magnet sets
    static constexpr size_t kIsJulia = 2;    // 1: `c` is kX, kY and the orbit begins at the point
    static constexpr size_t kX = 3, kY = 4;
    static constexpr size_t kExterior = 5,
                            kExteriorFactor = 6; // how its points are colored: 0 to 8
    static constexpr size_t kInterior = 7, kInteriorFactor = 8; // 0 to 6
};

inline constexpr double kMaxFractalIterations = 1e5;

/// Returns the value of a pattern with these parameters, before frequency and wave.
double fractal(const std::array<double, 10>& parameters, const dvec3& at);

} // namespace ovc
