// SPDX-License-Identifier: Apache-2.0
// The functions of floats of POV-Ray's language, and those that functions.inc takes from POV-Ray.
// The formulas of the latter follow from the parameters that functions.inc describes;
// importers/pov/values/expression_test.cpp checks them against values that povray 3.7.0 prints.
#include "core/texture/formula.h"
#include "core/texture/noise/noise.h"
#include "core/texture/surface_functions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

uint64_t bits(double x) {
    return uint64_t(int64_t(std::clamp(x, -9e15, 9e15)));
}

using Args = const double*;
constexpr auto kFloatFunctions = std::to_array<FloatFunction>(
    {{"abs", 1, [](Args a) { return std::abs(a[0]); }},
     {"acos", 1, [](Args a) { return std::acos(std::clamp(a[0], -1.0, 1.0)); }},
     {"acosh", 1, [](Args a) { return std::acosh(a[0]); }},
     {"asin", 1, [](Args a) { return std::asin(std::clamp(a[0], -1.0, 1.0)); }},
     {"asinh", 1, [](Args a) { return std::asinh(a[0]); }},
     {"atan", 1, [](Args a) { return std::atan(a[0]); }},
     {"atan2", 2, [](Args a) { return std::atan2(a[0], a[1]); }},
     {"atanh", 1, [](Args a) { return std::atanh(a[0]); }},
     {"bitwise_and", 2, [](Args a) { return double(bits(a[0]) & bits(a[1])); }},
     {"bitwise_or", 2, [](Args a) { return double(bits(a[0]) | bits(a[1])); }},
     {"bitwise_xor", 2, [](Args a) { return double(bits(a[0]) ^ bits(a[1])); }},
     {"ceil", 1, [](Args a) { return std::ceil(a[0]); }},
     {"cos", 1, [](Args a) { return std::cos(a[0]); }},
     {"cosh", 1, [](Args a) { return std::cosh(a[0]); }},
     {"degrees", 1, [](Args a) { return a[0] / kDegree; }},
     {"div", 2, [](Args a) { return std::trunc(a[0] / a[1]); }},
     {"exp", 1, [](Args a) { return std::exp(a[0]); }},
     {"floor", 1, [](Args a) { return std::floor(a[0]); }},
     {"int", 1, [](Args a) { return std::trunc(a[0]); }},
     {"ln", 1, [](Args a) { return std::log(a[0]); }},
     {"log", 1, [](Args a) { return std::log10(a[0]); }},
     {"max", -1, [](Args a) { return std::max(a[0], a[1]); }},
     {"min", -1, [](Args a) { return std::min(a[0], a[1]); }},
     {"mod", 2, [](Args a) { return std::fmod(a[0], a[1]); }},
     {"pow", 2, [](Args a) { return std::pow(a[0], a[1]); }},
     {"pwr", 2, [](Args a) { return std::pow(a[0], a[1]); }},
     {"radians", 1, [](Args a) { return a[0] * kDegree; }},
     {"sin", 1, [](Args a) { return std::sin(a[0]); }},
     {"sinh", 1, [](Args a) { return std::sinh(a[0]); }},
     {"sqr", 1, [](Args a) { return a[0] * a[0]; }},
     {"sqrt", 1, [](Args a) { return std::sqrt(a[0]); }},
     {"tan", 1, [](Args a) { return std::tan(a[0]); }},
     {"tanh", 1, [](Args a) { return std::tanh(a[0]); }}});
static_assert(std::is_sorted(kFloatFunctions.begin(), kFloatFunctions.end(),
                             [](const FloatFunction& a, const FloatFunction& b) {
                                 return a.name < b.name;
                             }));

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

NoiseKind noise_kind(double number) {
    return number < 1.5   ? NoiseKind::Original
           : number < 2.5 ? NoiseKind::Corrected
                          : NoiseKind::Perlin;
}

/// The arguments of Musgrave's fractals: a point, H, lacunarity, octaves, offset, one more, and the
/// kind of noise.
struct Fractal {
    explicit Fractal(Arguments a)
        : point(a[0], a[1], a[2]),
          lacunarity(a[4]),
          fading(std::pow(a[4], -a[3])),
          octaves(int(std::clamp(std::ceil(a[5]), 1.0, 64.0))),
          offset(a[6]),
          extra(a[7]),
          kind(noise_kind(a[8])) {}

    /// Returns the noise of an octave, from -1 to 1.
    double octave(int i) const { return 2 * noise(std::pow(lacunarity, i) * point, kind) - 1; }

    dvec3 point;
    double lacunarity;
    double fading; // the share of an octave in the one before
    int octaves;
    double offset;
    double extra;
    NoiseKind kind;
};

/// Musgrave's ridged multifractal, whose gain is `extra`.
/// Based on: Ebert and others, "Texturing and Modeling", chapter "Procedural Fractal Terrains".
double ridged_multifractal(Arguments a) {
    const Fractal f(a);
    double sum = 0, signal = 0, share = 1;
    for (int i = 0; i < f.octaves; ++i, share *= f.fading) {
        const double weight = i == 0 ? 1 : std::clamp(signal * f.extra, 0.0, 1.0);
        const double ridge = f.offset - std::abs(f.octave(i));
        signal = ridge * ridge * weight;
        sum += signal * share;
    }
    return sum;
}

/// Musgrave's hetero terrain. POV-Ray multiplies octaves by the sum before them to the power of
/// the whole part of T, where Musgrave's power is 1.
double hetero_terrain(Arguments a) {
    const Fractal f(a);
    double sum = 0, share = 1;
    for (int i = 0; i < f.octaves; ++i, share *= f.fading) {
        const double step = share * (f.octave(i) + f.offset);
        sum += i == 0 ? step : step * std::pow(sum, std::floor(f.extra));
    }
    return sum;
}

} // namespace

std::span<const FloatFunction> float_functions() {
    return kFloatFunctions;
}

InternalFunction internal_function(uint32_t number) {
    switch (number) {
    case 17: // f_ellipsoid
        return {6, [](Arguments a) { return std::hypot(a[0] * a[3], a[1] * a[4], a[2] * a[5]); }};
    case 29: // f_hetero_mf
        return {9, hetero_terrain};
    case 47: // f_ph, the angle from y
        return {3, [](Arguments a) { return std::atan2(std::hypot(a[0], a[2]), a[1]); }};
    case 57: // f_r
        return {3, radius};
    case 59: // f_ridged_mf
        return {9, ridged_multifractal};
    case 60: // f_rounded_box
        return {7, rounded_box};
    case 61: // f_sphere
        return {4, [](Arguments a) { return radius(a) - a[3]; }};
    case 68: // f_superellipsoid
        return {5, superellipsoid};
    case 69: // f_th, the angle around y
        return {3, [](Arguments a) { return std::atan2(a[0], a[2]); }};
    case 70: // f_torus
        return {5,
                [](Arguments a) { return std::hypot(std::hypot(a[0], a[2]) - a[3], a[1]) - a[4]; }};
    case 76: // f_noise3d
        return {3, [](Arguments a) { return noise({a[0], a[1], a[2]}); }};
    case 78: // f_noise_generator
        return {4, [](Arguments a) { return noise({a[0], a[1], a[2]}, noise_kind(a[3])); }};
    default:
        return surface_function(number);
    }
}

} // namespace ovc
