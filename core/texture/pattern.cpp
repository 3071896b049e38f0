// SPDX-License-Identifier: Apache-2.0
// POV-Ray's patterns. Its documentation (section 3.4.7.6, "Patterns") says what they look like;
// constants that it does not give were found by asking povray for values, and pattern_test.cpp
// compares with such values.
#include "core/texture/pattern.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

using Kind = Pattern::Kind;

/// A checker changes this far off whole numbers, so that a plane through them keeps to one side, as
/// by POV-Ray's 1e-10 for coordinates near 0.
constexpr double kCellOffset = 1e-9;

/// Patterns are 0 beyond this, where doubles tell no two cells apart.
constexpr double kFarthestPattern = 1e12;

double fraction(double x) {
    return x - std::floor(x);
}

double cycle(double x) {
    return std::sin(2 * std::numbers::pi * x);
}

/// Returns the remainder of the division by the integer, from 0 on.
double modulo(double x, double by) {
    return x - by * std::floor(x / by);
}

dvec3 repeated(dvec3 at, const TextureStep& step) {
    for (int axis = 0; axis < 3; ++axis) {
        const double period = step.rows[0][axis];
        if (!(std::abs(period) > 0))
            continue;
        const double times = std::floor(at[axis] / period);
        at[axis] -= times * period;
        if (modulo(times, 2) != 0)
            for (int other = 0; other < 3; ++other)
                if (step.rows[2][other] < 0)
                    at[other] = (other == axis ? period : 0) - at[other];
        at += times * dvec3(step.rows[1]);
    }
    return at;
}

dvec3 moved(const dvec3& at, const TextureStep& step) {
    switch (step.kind) {
    case TextureStep::Kind::Turbulence: {
        const dvec4 &first = step.rows[0], &second = step.rows[1];
        return at + dvec3(first) * turbulence(at, {first.w, second.x, uint64_t(second.y)});
    }
    case TextureStep::Kind::Repeat:
        return repeated(at, step);
    case TextureStep::Kind::Affine:
        break;
    }
    const dvec4 p(at, 1);
    return {glm::dot(step.rows[0], p), glm::dot(step.rows[1], p), glm::dot(step.rows[2], p)};
}

double granite(const Pattern& pattern, const dvec3& at) {
    const bool corrected = pattern.noise == NoiseKind::Corrected;
    double sum = 0, frequency = 1;
    for (int i = 0; i < 6; ++i, frequency *= 2) {
        const double off = std::abs(0.5 - noise(4 * frequency * at, pattern.noise));
        sum += (corrected ? std::min(0.5, 2 * off) : off) / frequency;
    }
    return std::min(sum, 1.0);
}

double wrinkles(const Pattern& pattern, const dvec3& at) {
    const bool corrected = pattern.noise == NoiseKind::Corrected;
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

/// Returns 1 for a brick and 0 for mortar. parameters: the size of a brick with its mortar, and the
/// mortar's thickness.
double brick(const Pattern& pattern, const dvec3& at) {
    dvec3 in_bricks;
    for (int i = 0; i < 3; ++i)
        in_bricks[i] = (at[i] + kCellOffset) / pattern.parameters[size_t(i)];
    const bool odd = modulo(std::floor(in_bricks.y), 2) != 0;
    in_bricks[odd ? 0 : 2] += 0.5;
    for (int i = 0; i < 3; ++i)
        if (fraction(in_bricks[i]) >= 1 - pattern.parameters[3] / pattern.parameters[size_t(i)])
            return 0;
    return 1;
}

/// Returns the sum of the numbers of the unit cell.
double cells(const dvec3& at) {
    const dvec3 cell = glm::floor(at + kCellOffset);
    return cell.x + cell.y + cell.z;
}

/// Hexagons of side 1 in the plane of x and z stand in columns 1.5 apart.
double hexagon(const dvec3& at) {
    const double height = std::numbers::sqrt3;
    double nearest = 1e300, color = 0;
    const double middle = std::floor(at.x / 1.5);
    for (int i = 0; i < 2; ++i) {
        const double column = middle + i;
        const double row = std::round(at.z / height - 0.5 * column);
        const double dx = at.x - 1.5 * column, dz = at.z - height * (row + 0.5 * column);
        if (const double away = dx * dx + dz * dz; away < nearest) {
            nearest = away;
            color = modulo(row - column, 3);
        }
    }
    return color;
}

/// Returns the number of the face of a cube around the origin that the point is seen through.
double cubic(const dvec3& at) {
    const int axis = major_axis(at);
    return axis + (at[axis] < 0 ? 3 : 0);
}

double leopard(const dvec3& at) {
    const double sum = std::sin(at.x) + std::sin(at.y) + std::sin(at.z);
    return sum * sum / 9;
}

double radial(const dvec3& at) {
    return at.x == 0 && at.z == 0 ? 0 : std::atan2(at.x, at.z) / (2 * std::numbers::pi) + 0.75;
}

double spiral(const Pattern& pattern, const dvec3& at) {
    const double turn = std::atan2(at.y, at.x) / (2 * std::numbers::pi) + 0.25;
    return std::hypot(at.x, at.y) + at.z + pattern.parameters[0] * turn;
}

/// Returns the value before frequency, phase and wave.
double plain_value(const Pattern& pattern, const dvec3& at) {
    const std::array<double, 4>& p = pattern.parameters;
    switch (pattern.kind) {
    case Kind::Agate:
        return agate(pattern, at);
    case Kind::Boxed:
        return std::max(0.0, 1 - max_component(glm::abs(at)));
    case Kind::Bozo:
        return noise(at, pattern.noise);
    case Kind::Cylindrical:
        return std::max(0.0, 1 - std::hypot(at.x, at.z));
    case Kind::Dents:
        return std::pow(noise(at, pattern.noise), 3);
    case Kind::Gradient:
        return glm::dot(at, dvec3(p[0], p[1], p[2]));
    case Kind::Granite:
        return granite(pattern, at);
    case Kind::Leopard:
        return leopard(at);
    case Kind::Marble:
        return marble(pattern, at);
    case Kind::Onion:
        return fraction(glm::length(at));
    case Kind::Planar:
        return std::max(0.0, 1 - std::abs(at.y));
    case Kind::Radial:
        return radial(at);
    case Kind::Spherical:
        return std::max(0.0, 1 - glm::length(at));
    case Kind::Spiral1:
        return spiral(pattern, at);
    case Kind::Wood:
        return wood(pattern, at);
    case Kind::Wrinkles:
        return wrinkles(pattern, at);
    case Kind::Average:
        return 0;
    case Kind::Brick:
        return brick(pattern, at);
    case Kind::Checker:
        return modulo(cells(at), 2);
    case Kind::Cubic:
        return cubic(at);
    case Kind::Hexagon:
        return hexagon(at);
    }
    return 0;
}

/// Returns the value from 0 to 1. POV-Ray wraps just above 1, so that a value of 1 stays.
double wave_of(const Pattern& pattern, double value) {
    constexpr double kWrap = 1.00001;
    double x = std::fmod(value * pattern.frequency + pattern.phase, kWrap);
    x = x < 0 ? x + kWrap : x;
    switch (pattern.wave) {
    case Pattern::Wave::Ramp:
        break;
    case Pattern::Wave::Triangular:
        return x < 0.5 ? 2 * x : 2 * (1 - x);
    case Pattern::Wave::Sine:
        return 0.5 + 0.5 * cycle(x);
    case Pattern::Wave::Scallop:
        return std::abs(cycle(0.5 * x));
    case Pattern::Wave::Cubic:
        return x * x * (3 - 2 * x);
    case Pattern::Wave::Power:
        return std::pow(x, pattern.exponent);
    }
    return x;
}

/// Returns whether turbulence is a part of the pattern's own formula.
bool adds_turbulence(Kind kind) {
    return kind == Kind::Marble || kind == Kind::Wood;
}

TransparentColor color_of_stop(std::span<const Texture> textures, const TextureStop& stop,
                               const TexturePoint& point) {
    return stop.texture == kNoTexture ? stop.color : color_at(textures, stop.texture, point);
}

void add(TransparentColor& sum, const TransparentColor& color, float share) {
    sum.rgb += share * color.rgb;
    sum.filter += share * color.filter;
    sum.transmit += share * color.transmit;
}

} // namespace

PatternPlace evaluate(const Pattern& pattern, const dvec3& at) {
    PatternPlace place{0, at};
    for (const TextureStep& step : pattern.steps)
        place.at = moved(place.at, step);
    if (pattern.turbulence != dvec3(0) && !adds_turbulence(pattern.kind))
        place.at += pattern.turbulence * turbulence(place.at, pattern.octaves);
    if (!is_finite(place.at) || max_component(glm::abs(place.at)) > kFarthestPattern)
        return {0, dvec3(0)};
    const double value = plain_value(pattern, place.at);
    place.value = is_discrete(pattern.kind) ? value : wave_of(pattern, value);
    return place;
}

namespace {

float mean_of(const TransparentColor& color) {
    return (color.rgb.x + color.rgb.y + color.rgb.z) / 3;
}

TransparentColor color_of_pattern(std::span<const Texture> textures, const Texture& texture,
                                  TexturePoint point) {
    const PatternPlace place = evaluate(texture.pattern, point.at);
    point.at = place.at;
    TransparentColor sum;
    if (texture.pattern.kind == Kind::Average) {
        double weights = 0;
        for (const TextureStop& stop : texture.stops)
            weights += stop.at;
        for (const TextureStop& stop : texture.stops)
            add(sum, color_of_stop(textures, stop, point),
                float(weights > 0 ? stop.at / weights : 1.0 / double(texture.stops.size())));
        return sum;
    }
    const Between where = between(
        texture.stops.size(), [&](size_t i) { return texture.stops[i].at; }, place.value,
        is_discrete(texture.pattern.kind));
    add(sum, color_of_stop(textures, texture.stops[where.first], point), float(1 - where.share));
    if (where.share > 0)
        add(sum, color_of_stop(textures, texture.stops[where.second], point), float(where.share));
    return sum;
}

TransparentColor product(std::span<const Texture> textures, const Texture& texture,
                         const TexturePoint& point) {
    TransparentColor all{vec3(1)};
    for (const TextureStop& stop : texture.stops) {
        const TransparentColor one = color_of_stop(textures, stop, point);
        all.rgb *= one.rgb;
        all.transmit = 1 - (1 - all.transmit) * (1 - one.transmit);
    }
    return all;
}

TransparentColor mix(std::span<const Texture> textures, const Texture& texture,
                     const TexturePoint& point) {
    const float share =
        std::clamp(mean_of(color_of_stop(textures, texture.stops[2], point)), 0.0f, 1.0f);
    TransparentColor sum;
    add(sum, color_of_stop(textures, texture.stops[0], point), 1 - share);
    add(sum, color_of_stop(textures, texture.stops[1], point), share);
    return sum;
}

TransparentColor color_of_image(const Texture& texture, TexturePoint point) {
    const auto turned = [](const TextureStep& step, const dvec3& v) {
        return dvec3(glm::dot(dvec3(step.rows[0]), v), glm::dot(dvec3(step.rows[1]), v),
                     glm::dot(dvec3(step.rows[2]), v));
    };
    for (const TextureStep& step : texture.pattern.steps) {
        point.at = moved(point.at, step);
        if (step.kind == TextureStep::Kind::Affine)
            point.sides = {turned(step, point.sides[0]), turned(step, point.sides[1])};
    }
    return color_at(*texture.image, point.at, point.sides);
}

/// Moves the point to where the texture is evaluated.
TexturePoint moved_to_uv(const TexturePoint& point) {
    TexturePoint there = point;
    there.at = dvec3(point.uv, 0);
    there.sides = {dvec3(point.uv_sides[0], 0), dvec3(point.uv_sides[1], 0)};
    return there;
}

} // namespace

TransparentColor color_at(std::span<const Texture> textures, uint32_t number,
                          const TexturePoint& point) {
    assert(number < textures.size());
    const Texture& texture = textures[number];
    if (texture.on_uv && !point.has_uv)
        return texture.image ? texture.image->otherwise : TransparentColor{vec3(0.5f)};
    switch (texture.kind) {
    case TextureKind::Image:
        return color_of_image(texture, texture.on_uv ? moved_to_uv(point) : point);
    case TextureKind::Product:
        return product(textures, texture, point);
    case TextureKind::Mix:
        return mix(textures, texture, point);
    case TextureKind::Pattern:
        break;
    }
    return color_of_pattern(textures, texture, texture.on_uv ? moved_to_uv(point) : point);
}

double value_at(std::span<const Texture> textures, uint32_t number, const TexturePoint& point) {
    const Texture& texture = textures[number];
    if (texture.kind == TextureKind::Pattern && !texture.on_uv)
        return evaluate(texture.pattern, point.at).value;
    return double(mean_of(color_at(textures, number, point)));
}

} // namespace ovc
