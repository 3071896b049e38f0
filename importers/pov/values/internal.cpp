// SPDX-License-Identifier: Apache-2.0
// The formulas follow from the parameters that functions.inc describes. pov_test.cpp checks them
// against values that povray 3.7.0 prints.
#include "importers/pov/values/internal.h"

#include "core/texture/noise.h"

#include <algorithm>
#include <cmath>

namespace ovc::pov {

namespace {

using Arguments = std::span<const double>;

double radius(Arguments a) {
    return std::hypot(a[0], a[1], a[2]);
}

double rounded_box(Arguments a) {
    double square = 0;
    for (size_t i = 0; i < 3; ++i) {
        const double out = std::max(std::abs(a[i]) - (a[4 + i] - a[3]), 0.0);
        square += out * out;
    }
    return std::sqrt(square) - a[3];
}

double superellipsoid(Arguments a) {
    const double east = a[3], north = a[4];
    const double wide = std::pow(std::abs(a[0]), 2 / east) + std::pow(std::abs(a[1]), 2 / east);
    const double all = std::pow(wide, east / north) + std::pow(std::abs(a[2]), 2 / north);
    return 1 - std::pow(all, north / 2);
}

} // namespace

Internal find_internal(int number) {
    switch (number) {
    case 17: // f_ellipsoid
        return {[](Arguments a) { return std::hypot(a[0] * a[3], a[1] * a[4], a[2] * a[5]); }, 6};
    case 47: // f_ph, the angle from y
        return {[](Arguments a) { return std::atan2(std::hypot(a[0], a[2]), a[1]); }, 3};
    case 57: // f_r
        return {radius, 3};
    case 60: // f_rounded_box
        return {rounded_box, 7};
    case 61: // f_sphere
        return {[](Arguments a) { return radius(a) - a[3]; }, 4};
    case 68: // f_superellipsoid
        return {superellipsoid, 5};
    case 69: // f_th, the angle around y
        return {[](Arguments a) { return std::atan2(a[0], a[2]); }, 3};
    case 70: // f_torus
        return {[](Arguments a) { return std::hypot(std::hypot(a[0], a[2]) - a[3], a[1]) - a[4]; },
                5};
    case 76: // f_noise3d
        return {[](Arguments a) { return noise({a[0], a[1], a[2]}); }, 3};
    case 78: // f_noise_generator
        return {[](Arguments a) {
                    return noise({a[0], a[1], a[2]},
                                 a[3] < 1.5 ? NoiseKind::Original : NoiseKind::Corrected);
                },
                4};
    default:
        return {};
    }
}

} // namespace ovc::pov
