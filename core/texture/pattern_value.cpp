// SPDX-License-Identifier: Apache-2.0
// The values of POV-Ray's patterns before frequency, phase and wave. Its documentation (section
// 3.4.7.1, "General Patterns") says what they look like; constants that it does not give were found
// by asking povray for values, and pattern_test.cpp compares with such values.
#include "core/texture/pattern_value.h"
#include "core/texture/fractal.h"
#include "core/texture/noise/perlin.h"
#include "core/texture/noise/random_cells.h"
#include "core/texture/tiles/tiling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

using Kind = Pattern::Kind;

double fraction(double x) {
    return x - std::floor(x);
}

double cycle(double x) {
    return std::sin(2 * std::numbers::pi * x);
}

double granite(const Pattern& pattern, const dvec3& at) {
    const bool corrected = pattern.noise != NoiseKind::Original;
    double sum = 0, frequency = 1;
    for (int i = 0; i < 6; ++i, frequency *= 2) {
        const double off = std::abs(0.5 - noise(4 * frequency * at, pattern.noise));
        sum += (corrected ? std::min(0.5, 2 * off) : off) / frequency;
    }
    return std::min(sum, 1.0);
}

double wrinkles(const Pattern& pattern, const dvec3& at) {
    const bool corrected = pattern.noise != NoiseKind::Original;
    double sum = 0, frequency = 1;
    for (int i = 0; i < 10; ++i, frequency *= 2) {
        const double value = noise(frequency * at, pattern.noise);
        sum += (corrected ? std::clamp(2 * value - 0.5, 0.0, 1.0) : value) / frequency;
    }
    return std::min(0.5 * sum, 1.0);
}

/// parameters: the amount of turbulence.
double agate(const Pattern& pattern, const dvec3& at) {
    const double noise = scalar_turbulence(at, pattern.octaves, pattern.noise);
    const double wave = cycle(1.3 * pattern.parameters[0] * noise + 1.1 * at.z);
    return std::pow(std::clamp(0.5 * (wave + 1), 0.0, 1.0), 0.77);
}

double marble(const Pattern& pattern, const dvec3& at) {
    const double amount = pattern.turbulence.x;
    return amount == 0 ? at.x
                       : at.x + amount * scalar_turbulence(at, pattern.octaves, pattern.noise);
}

double wood(const Pattern& pattern, const dvec3& at) {
    dvec3 p = at;
    if (pattern.turbulence != dvec3(0)) {
        const dvec3 shaken = (at + turbulence(at, pattern.octaves)) * pattern.turbulence;
        p += dvec3(cycle(shaken.x), cycle(shaken.y), 0);
    }
    return std::hypot(p.x, p.y);
}

double leopard(const dvec3& at) {
    const double sum = std::sin(at.x) + std::sin(at.y) + std::sin(at.z);
    return sum * sum / 9;
}

double radial(const dvec3& at) {
    return at.x == 0 && at.z == 0 ? 0 : std::atan2(at.x, at.z) / (2 * std::numbers::pi) + 0.75;
}

/// Turbulence, which has moved the place already, is added once more.
double spiral(const Pattern& pattern, const dvec3& at) {
    const double turn = std::atan2(at.y, at.x) / (2 * std::numbers::pi) + 0.25;
    const double amount = pattern.turbulence.x;
    const double shaken =
        amount == 0 ? 0 : amount * scalar_turbulence(at, pattern.octaves, pattern.noise);
    return std::hypot(at.x, at.y) + at.z + pattern.parameters[0] * turn + shaken;
}

/// parameters: see Pattern::Kind. Values beyond 1 are 1.
double crackle(const Pattern& pattern, const dvec3& at) {
    const std::array<double, 10>& p = pattern.parameters;
    const NearestPoints found = nearest_points(at, {p[3], p[4]});
    if (p[5] != 0)
        return noise(found.nearest, pattern.noise);
    const std::array<double, 3>& d = found.distance;
    return std::clamp(p[0] * d[0] + p[1] * d[1] + p[2] * d[2], 0.0, 1.0);
}

/// Returns the value of the grid at whole coordinates, which are cut off at its ends.
double density_at(const DensityGrid& grid, const glm::ivec3& cell) {
    size_t index = 0;
    for (int axis = 2; axis >= 0; --axis) {
        const int size = int(grid.size[size_t(axis)]);
        index = index * size_t(size) + size_t(std::clamp(cell[axis], 0, size - 1));
    }
    return double(grid.values[index]);
}

/// Returns 0 outside of the unit cube. Between the values it takes the nearest below, or those
/// around in proportion.
double density(const Pattern& pattern, const dvec3& at) {
    const DensityGrid& grid = pattern.grid;
    if (grid.values.empty() || -max_component(-at) < 0 || max_component(at) >= 1)
        return 0;
    const dvec3 place = at * dvec3(grid.size[0], grid.size[1], grid.size[2]);
    if (pattern.parameters[0] == 0)
        return density_at(grid, glm::ivec3(glm::floor(place)));
    const dvec3 low = glm::floor(place), share = place - low;
    double sum = 0;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
        const dvec3 weight = glm::mix(1.0 - share, share, dvec3(corner));
        sum += weight.x * weight.y * weight.z * density_at(grid, glm::ivec3(low) + corner);
    }
    return sum;
}

/// parameters: how soft the seam is at its bottom and at its top.
double quilted(const Pattern& pattern, const dvec3& at) {
    const dvec3 off = glm::abs(at - glm::floor(at) - 0.5);
    return (off.x + off.y + off.z) / 3 * quilted_curve(pattern, glm::length(off)) / std::sqrt(0.75);
}

/// The crests of the waves that run out from all sources.
double ripples(const Pattern& pattern, const dvec3& at) {
    double sum = 0;
    const std::span<const WaveSource> sources = wave_sources(pattern.parameters[0]);
    for (const WaveSource& source : sources)
        sum += cycle(glm::distance(at, source.at) * pattern.frequency + pattern.phase);
    return 0.5 + 0.5 * sum / double(sources.size());
}

double waves(const Pattern& pattern, const dvec3& at) {
    double sum = 0;
    const std::span<const WaveSource> sources = wave_sources(pattern.parameters[0]);
    for (const WaveSource& source : sources)
        sum += cycle(glm::distance(at, source.at) * pattern.frequency * source.frequency +
                     pattern.phase) /
               source.frequency;
    return 0.5 + 0.2 * sum / double(sources.size());
}

/// Returns the share of half a turn from pointing away from `direction` to pointing along it.
double slope(const Pattern& pattern, const TexturePoint& point) {
    const std::array<double, 10>& p = pattern.parameters;
    const dvec3 given(p[0], p[1], p[2]);
    const dvec3 direction = p[5] != 0 ? given - point.at : given;
    const double length = glm::length(direction);
    if (!(length > 0) || point.normal == dvec3(0))
        return 0;
    const double cosine = std::clamp(glm::dot(direction, point.normal) / length, -1.0, 1.0);
    const double slope = (std::asin(cosine) / std::numbers::pi) + 0.5;
    const double height = glm::dot(point.at, dvec3(p[6], p[7], p[8])) + p[9];
    return height + (p[4] != p[3] ? (slope - p[3]) / (p[4] - p[3]) : slope);
}

/// Returns 1 where the ray meets the surface at a right angle, and 0.5 where it runs along it.
double angle_of_incidence(const TexturePoint& point) {
    const double cosine = std::clamp(-glm::dot(point.view, point.normal), -1.0, 1.0);
    return std::asin(cosine) / std::numbers::pi + 0.5;
}

/// A gradient begins anew this far below whole numbers, so that a plane through them keeps to one
/// color though its corners are floats. POV-Ray, whose planes are exact, takes the whole numbers
/// themselves.
constexpr double kGradientOffset = 1e-6;

double gradient(const Pattern& pattern, const dvec3& at) {
    const auto& p = pattern.parameters;
    const double x = glm::dot(at, dvec3(p[0], p[1], p[2])), whole = std::round(x);
    const double value = std::abs(x - whole) < kGradientOffset ? whole : x;
    // Behind 1 itself the value is the fraction.
    return value > 1 ? fraction(value) : value;
}

/// pbrt's textures of noise. Based on: Pharr, Jakob and Humphreys 2016, "Physically Based
/// Rendering", section 10.6.
double perlin(const Pattern& pattern, const TexturePoint& point) {
    using P = PerlinParameter;
    const std::array<double, 10>& p = pattern.parameters;
    const NoiseSum sum{p[P::kOctaves], p[P::kRoughness], point.sides};
    switch (int(p[P::kForm])) {
    case P::Turbulence:
        return turbulence_sum(point.at, sum);
    case P::Windy:
        return windy_sum(point.at, point.sides);
    case P::Marble:
        return 0.5 + 0.5 * std::sin(point.at.y + p[P::kVariation] * noise_sum(point.at, sum));
    default:
        return noise_sum(point.at, sum);
    }
}

/// Two spirals that run against each other. The value goes from 0 to 2.
double double_spiral(const Pattern& pattern, const dvec3& at) {
    return triangle_of(spiral(pattern, at)) + triangle_of(std::hypot(at.x, at.y));
}

/// Returns the value of a pattern that follows from the place alone.
double value_of_place(Kind kind, const dvec3& at) {
    switch (kind) {
    case Kind::Boxed:
        return std::max(0.0, 1 - max_component(glm::abs(at)));
    case Kind::Cylindrical:
        return std::max(0.0, 1 - std::hypot(at.x, at.z));
    case Kind::Leopard:
        return leopard(at);
    case Kind::Onion:
        return fraction(glm::length(at));
    case Kind::Planar:
        return std::max(0.0, 1 - std::abs(at.y));
    case Kind::Radial:
        return radial(at);
    case Kind::Spherical:
        return std::max(0.0, 1 - glm::length(at));
    default:
        return 0;
    }
}

} // namespace

double triangle_of(double x) {
    const double part = fraction(x);
    return part < 0.5 ? 2 * part : 2 * (1 - part);
}

double quilted_curve(const Pattern& pattern, double t) {
    const double s = 1 - t;
    return t * (t * t + 3 * s * (pattern.parameters[0] * s + pattern.parameters[1] * t));
}

double continuous_value(std::span<const Texture> textures, const Pattern& pattern,
                        const TexturePoint& point) {
    const dvec3& at = point.at;
    switch (pattern.kind) {
    case Kind::Agate:
        return agate(pattern, at);
    case Kind::AngleOfIncidence:
        return angle_of_incidence(point);
    case Kind::Bozo:
        return noise(at, pattern.noise);
    case Kind::Cells:
        return cell_value(at);
    case Kind::Crackle:
        return crackle(pattern, at);
    case Kind::Dents:
        return std::pow(noise(at, pattern.noise), 3);
    case Kind::Density:
        return density(pattern, at);
    case Kind::Fractal:
        return fractal(pattern.parameters, at);
    case Kind::Function:
        return evaluate(textures, pattern.formula, std::array{at.x, at.y, at.z});
    case Kind::Gradient:
        return gradient(pattern, at);
    case Kind::Granite:
        return granite(pattern, at);
    case Kind::Marble:
        return marble(pattern, at);
    case Kind::Perlin:
        return perlin(pattern, point);
    case Kind::Quilted:
        return quilted(pattern, at);
    case Kind::Ripples:
        return ripples(pattern, at);
    case Kind::Slope:
        return slope(pattern, point);
    case Kind::Spiral1:
        return spiral(pattern, at);
    case Kind::Spiral2:
        return double_spiral(pattern, at);
    case Kind::Tiling:
        return tiling(size_t(pattern.parameters[0]), at);
    case Kind::Waves:
        return waves(pattern, at);
    case Kind::Wood:
        return wood(pattern, at);
    case Kind::Wrinkles:
        return wrinkles(pattern, at);
    default:
        return value_of_place(pattern.kind, at);
    }
}

} // namespace ovc
