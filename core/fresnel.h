// SPDX-License-Identifier: Apache-2.0
// Fresnel's equations for a boundary of two clear media, the mean of both polarisations, in double.
#pragma once

#include "core/vec.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc {

/// Returns the share of light that the boundary reflects; 1 where it reflects all. cosine: between
/// the normal and the direction that the light comes from, in [0, 1]. ior: the index of refraction
/// of the medium behind the boundary, divided by that of the medium before it.
inline double fresnel(double cosine, double ior) {
    const double square = ior * ior + cosine * cosine - 1; // (ior x the refracted cosine)^2
    if (!(square > 0))
        return 1;
    const double g = std::sqrt(square);
    const double s = (cosine - g) / (cosine + g);
    const double p = (ior * ior * cosine - g) / (ior * ior * cosine + g);
    return 0.5 * (s * s + p * p);
}

/// Returns the share of light that the boundary reflects when as much comes from each direction.
/// ior: above 0. Based on: Walsh 1926, in the form of Dunkle 1963.
inline double fresnel_mean(double ior) {
    assert(ior > 0);
    if (ior < 1) // n^2 (1 - F) of the other side passes, total reflection included
        return 1 - (1 - fresnel_mean(1 / ior)) * ior * ior;
    if (ior < 1 + 1e-4) // the formula's terms cancel
        return 0;
    const double n = ior, n2 = n * n, n4 = n2 * n2;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / ((n2 + 1) * (n2 + 1) * (n2 + 1)) *
               std::log((n - 1) / (n + 1)) -
           2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
           8 * n4 * (n4 + 1) / ((n2 + 1) * (n4 - 1) * (n4 - 1)) * std::log(n);
}

/// Returns the factor of a ground's color if a boundary above it throws part of the scattered light
/// back down. ior: of the boundary, above the ground or below; at most 1 counts as none.
inline vec3 share_from_below(const vec3& color, double ior) {
    const float back = float(fresnel_mean(1 / std::max(ior, 1.0)));
    return (1 - back) / (vec3(1) - back * color);
}

} // namespace ovc
