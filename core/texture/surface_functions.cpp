// SPDX-License-Identifier: Apache-2.0
// The algebraic surfaces among the functions that POV-Ray's functions.inc takes from POV-Ray. Which
// polynomial each is was found by fitting the values that povray 3.7.0.10 prints.
#include "core/texture/surface_functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

using Arguments = std::span<const double>;

/// Returns the value as far as POV-Ray counts it. a[3]: the strength of the field.
double field(Arguments a, double value) {
    return std::clamp(a[3] * value, -10.0, 10.0);
}

double squared(double x) {
    return x * x;
}

double cushion(Arguments a) {
    const double x = a[0] * a[0], y = a[1] * a[1], z = a[2];
    return field(a, x + y - squared(x + y) + z * (2 * y + z * (x - y - 2 + z * (2 - z))));
}

double heart(Arguments a) {
    const double x = a[0] * a[0], y = a[1] * a[1], z = a[2];
    const double ball = 2 * x + y + z * z - 1;
    return field(a, z * z * z * (0.1 * x + y) - ball * ball * ball);
}

double klein_bottle(Arguments a) {
    const double x = a[0], y = a[1], z = a[2];
    const double square = x * x + y * y + z * z - 1, less = square - 2 * y;
    return field(a, -(square + 2 * y) * (less * less - 8 * z * z) - 16 * x * z * less);
}

double torus_gumdrop(Arguments a) {
    const double x = a[0] * a[0], y = a[1] * a[1], z = a[2] * a[2];
    return field(a, -4 * (x * x + y * y + z * z) - 17 * x * (y + z) - 8 * y * z + 20 * (x + y + z) -
                        17);
}

double torus_of_inversion(Arguments a) {
    const double major = a[4] * a[4], minor = a[5] * a[5], round = a[0] * a[0] + a[2] * a[2];
    return field(a, 4 * major * round - squared(round + a[1] * a[1] + major - minor));
}

double hyperbolic_torus(Arguments a) {
    const double major = a[4] * a[4], minor = a[5] * a[5];
    const double x = a[0] * a[0], z = a[2] * a[2];
    return field(a, 4 * major * (x - z) - squared(x + a[1] * a[1] - z + major - minor));
}

double parabolic_torus(Arguments a) {
    const double major = a[4] * a[4], minor = a[5] * a[5];
    const double x = a[0] * a[0], y = a[1] * a[1];
    return field(a, (major + minor) * (x - a[2]) - (major - minor) * y - squared(x + y - a[2]) -
                        squared(major - minor));
}

double ovals_of_cassini(Arguments a) {
    const double major = a[4] * a[4], round = a[0] * a[0] + a[2] * a[2];
    return field(a, a[5] * a[5] + a[6] * major * round - squared(round + a[1] * a[1] + major));
}

double folium(Arguments a) {
    const double round = a[1] * a[1] + a[2] * a[2];
    return field(a, round * (1 + (a[5] - 4 * a[4]) * a[0]) + (a[5] + 1) * a[0] * a[0]);
}

double kummer(Arguments a) {
    const double x = a[0] * a[0], y = a[1] * a[1], z = a[2] * a[2];
    return field(a, 1 - x * x - y * y - z * z - a[4] * (x + y + z) -
                        a[5] * (x * y + y * z + z * x) - a[6] * a[0] * a[1] * a[2]);
}

/// Returns how far off a tube's middle the point (x, y) of its cross-section lies. shape: 0 for a
/// square, 1 for a circle, 2 for a square on its corner, and what is between them.
double off_middle(double x, double y, double shape) {
    x = std::abs(x), y = std::abs(y);
    if (!(shape > 0))
        return std::max(x, y);
    return std::pow(std::pow(x, 2 / shape) + std::pow(y, 2 / shape), shape / 2);
}

/// Arguments: the point, how many helices, radians of a turn per unit of y, the radius of the tube,
/// that of the turns, the height of the tube in widths, its cross-section's shape and angle. The
/// cross-section lies in a plane through the y axis. Far from all turns the axis counts instead.
double helix_of_tubes(Arguments a) {
    const double step = 2 * std::numbers::pi / a[3];
    const double turn = (a[1] * a[4] + std::atan2(a[2], a[0])) / step;
    const double from_axis = std::hypot(a[0], a[2]), far = from_axis + a[6];
    const double up = (turn - std::floor(turn) - 0.5) * step / (a[4] * a[7]);
    if (!std::isfinite(up))
        return far - a[5];
    const double angle = a[9] * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
    const double out = from_axis - a[6];
    return std::min(far, off_middle(out * c - up * s, out * s + up * c, a[8])) - a[5];
}

/// The arguments are those of the other helix. There is one of them, whose cross-section is level
/// and turns with it; height and angle do not count.
double level_helix(Arguments a) {
    const double c = std::cos(a[4] * a[1]), s = std::sin(a[4] * a[1]);
    return off_middle(a[0] * c + a[2] * s - a[6], a[2] * c - a[0] * s, a[8]) - a[5];
}

struct SurfaceFunction {
    uint32_t number;
    int count; // of arguments
    double (*call)(Arguments);
};

constexpr auto kSurfaces = std::to_array<SurfaceFunction>({
    {11, 4, [](Arguments a) { return field(a, squared(a[0] * a[2]) - a[1]); }}, // crossed_trough
    {12, 4,                                                                     // cubic_saddle
     [](Arguments a) { return field(a, std::pow(a[1], 3) - std::pow(a[0], 3) + a[2]); }},
    {13, 4, cushion},
    {14, 4, // devils_curve
     [](Arguments a) {
         const double x = a[0] * a[0], y = a[1] * a[1], z = a[2] * a[2];
         return field(a, 0.36 * x - 0.25 * y + y * y - squared(x + z));
     }},
    {20, 6, folium},
    {22, 4, // glob
     [](Arguments a) {
         return field(a, 0.5 * std::pow(a[0], 4) * (1 + a[0]) - a[1] * a[1] - a[2] * a[2]);
     }},
    {23, 4, heart},
    {25, 10, helix_of_tubes}, // helix1
    {26, 10, level_helix},    // helix2
    {31, 6, hyperbolic_torus},
    {33, 6, // kampyle_of_eudoxus
     [](Arguments a) {
         const double x = a[0] * a[0];
         return field(a, squared(a[5]) * x * (x - a[4] * a[4]) - a[1] * a[1] - a[2] * a[2]);
     }},
    {35, 4, klein_bottle},
    {36, 4, // kummer_surface_v1
     [](Arguments a) {
         const double x = a[0] * a[0], y = a[1] * a[1], z = a[2] * a[2];
         return field(a, x + y + z + x * y + y * z + z * x - x * x - y * y - z * z - 1);
     }},
    {37, 7, kummer},
    {38, 4, // lemniscate_of_gerono
     [](Arguments a) {
         const double x = a[0] * a[0];
         return field(a, x - x * x - a[1] * a[1] - a[2] * a[2]);
     }},
    {41, 4, // mitre
     [](Arguments a) {
         const double x = a[0] * a[0], y = a[1] * a[1], z = a[2] * a[2];
         return field(a, y * (1 - y - z) - 4 * x * (x + y + z));
     }},
    {42, 4, // nodal_cubic
     [](Arguments a) { return field(a, 6 * a[1] * a[2] - std::pow(a[1], 3) - std::pow(a[2], 3)); }},
    {43, 4, cushion}, // odd, which has the same values
    {44, 7, ovals_of_cassini},
    {45, 4, // paraboloid
     [](Arguments a) { return field(a, a[1] - a[0] * a[0] - a[2] * a[2]); }},
    {46, 6, parabolic_torus},
    {48, 4, // pillow
     [](Arguments a) {
         double sum = 0;
         for (size_t i = 0; i < 3; ++i)
             sum += squared(a[i] * a[i]) - a[i] * a[i];
         return field(a, sum);
     }},
    {49, 4, // piriform
     [](Arguments a) {
         return field(a, std::pow(a[0], 3) * (a[0] - 1) + a[1] * a[1] + a[2] * a[2]);
     }},
    {51, 8, // poly4
     [](Arguments a) {
         const double y = a[1];
         return std::hypot(a[0], a[2]) - (a[3] + y * (a[4] + y * (a[5] + y * (a[6] + y * a[7]))));
     }},
    {54, 4, // quartic_paraboloid
     [](Arguments a) { return field(a, a[1] - std::pow(a[0], 4) - std::pow(a[2], 4)); }},
    {55, 4, // quartic_saddle
     [](Arguments a) { return field(a, a[1] - std::pow(a[0], 4) + std::pow(a[2], 4)); }},
    {56, 6, // quartic_cylinder
     [](Arguments a) {
         const double width = a[5] * a[5], round = a[0] * a[0] + a[2] * a[2];
         return field(a, a[4] * a[4] * width - round * (a[1] * a[1] + width));
     }},
    {65, 4, // steiners_roman
     [](Arguments a) {
         return field(a, -a[0] * a[1] * a[2] - squared(a[0] * a[1]) - squared(a[1] * a[2]) -
                             squared(a[2] * a[0]));
     }},
    {66, 7, // strophoid
     [](Arguments a) {
         const double round = a[1] * a[1] + a[2] * a[2];
         return field(a, (a[0] - a[5]) * round + squared(a[6] * a[0]) * (a[0] + a[4]));
     }},
    {71, 6, torus_of_inversion}, // torus2
    {72, 4, torus_gumdrop},
    {73, 4, // umbrella
     [](Arguments a) { return field(a, a[1] * a[2] * a[2] - a[0] * a[0]); }},
    {74, 5, // witch_of_agnesi
     [](Arguments a) { return field(a, a[4] * (1 - a[1]) - a[1] * (a[0] * a[0] + a[2] * a[2])); }},
});

} // namespace

InternalFunction surface_function(uint32_t number) {
    const auto found = std::ranges::find(kSurfaces, number, &SurfaceFunction::number);
    return found == kSurfaces.end() ? InternalFunction{}
                                    : InternalFunction{found->count, found->call};
}

} // namespace ovc
