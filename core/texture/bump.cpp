// SPDX-License-Identifier: Apache-2.0
// The formulas were found by asking povray for the light on bumpy planes under several lights,
// which tells their normals; bump_test.cpp compares with such normals.
#include "core/texture/bump.h"

#include "core/texture/noise/random_cells.h"
#include "core/texture/pattern.h"

#include <array>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

/// Returns the height that a slope map gives a value: a cubic through the two stops around it that
/// has their slopes.
double height_of(const std::vector<SlopeStop>& profile, double value) {
    if (profile.empty())
        return value;
    const Between where = between(
        profile.size(), [&](size_t i) { return profile[i].at; }, value, false);
    const SlopeStop &a = profile[where.first], &b = profile[where.second];
    if (where.first == where.second)
        return a.height;
    const double t = where.share, s = 1 - t; // slopes are those over t
    return s * s * (1 + 2 * t) * a.height + t * t * (1 + 2 * s) * b.height +
           s * t * (s * a.slope - t * b.slope);
}

/// A bump depends on this besides itself.
struct Around {
    std::span<const Texture> textures;
    std::span<const Bump> bumps;
    dvec3 at, normal, view; // in the world
};

const Pattern& pattern_of(const Around& around, const Bump& bump) {
    return around.textures[bump.pattern.texture].pattern;
}

TexturePoint point_of(const Around& around, const Bump& bump) {
    return {bump.pattern.at(around.at), around.normal, around.view};
}

/// Returns -0.1 times four thirds of the height's gradient, about. The corners of a tetrahedron of
/// size `accuracy` are where the pattern is looked at.
dvec3 against_slope(const Around& around, const Bump& bump) {
    static const dvec3 kCorners[] = {{2 * std::sqrt(2.0) / 3, -1 / 3.0, 0},
                                     {-std::sqrt(2.0) / 3, -1 / 3.0, std::sqrt(2 / 3.0)},
                                     {-std::sqrt(2.0) / 3, -1 / 3.0, -std::sqrt(2 / 3.0)},
                                     {0, 1, 0}};
    // Warps and turbulence move the place, not its surroundings.
    const Texture& texture = around.textures[bump.pattern.texture];
    const bool is_pattern = texture.kind == TextureKind::Pattern && !texture.on_uv;
    TexturePoint point = point_of(around, bump);
    if (is_pattern)
        point.at = moved(texture.pattern, point.at);
    dvec3 sum(0);
    for (const dvec3& corner : kCorners) {
        TexturePoint near = point;
        near.at += bump.accuracy * corner;
        const double value = is_pattern ? value_of_moved(around.textures, texture.pattern, near)
                                        : value_at(around.textures, bump.pattern.texture, near);
        sum -= height_of(bump.profile, value) * corner;
    }
    return 0.1 / bump.accuracy * sum;
}

dvec3 wrinkled(const dvec3& at) {
    dvec3 sum(0);
    double frequency = 1;
    for (int i = 0; i < 10; ++i, frequency *= 2)
        sum += glm::abs(vector_noise(frequency * at)) / frequency;
    return sum;
}

/// Returns the mean of the slopes of the waves from all sources. kind: Ripples or Waves.
dvec3 waved(const Pattern& pattern, Bump::Kind kind, const dvec3& at) {
    dvec3 sum(0);
    const std::span<const WaveSource> sources = wave_sources(pattern.parameters[0]);
    for (const WaveSource& source : sources) {
        const double frequency = kind == Bump::Kind::Waves ? source.frequency : 1;
        const dvec3 way = at - source.at;
        const double away = glm::length(way);
        if (!(away > 0))
            continue;
        const double turn = away * pattern.frequency * frequency + pattern.phase;
        sum += std::sin(2 * std::numbers::pi * turn) / (frequency * away) * way;
    }
    return sum / double(sources.size());
}

/// Returns the slope of the triangle of the texel and two in the next row, to its left and right.
dvec3 against_brightness(const Around& around, const Bump& bump) {
    const Texture& texture = around.textures[bump.pattern.texture];
    if (!texture.image || !texture.image->lookup)
        return dvec3(0);
    const dvec2 texel = 1.0 / texture.image->lookup->size();
    const auto height = [&](double right, double down) {
        TexturePoint near = point_of(around, bump);
        near.at += dvec3(right * texel.x, -down * texel.y, 0);
        return double(gray(color_at(around.textures, bump.pattern.texture, near).rgb));
    };
    const double left = height(-1, 1), right = height(1, 1);
    return {0.5 * (left - right), 0.5 * (left + right) - height(0, 0), 0};
}

dvec3 quilted_slope(const Pattern& pattern, const dvec3& at) {
    const dvec3 off = at - glm::floor(at) - 0.5;
    return quilted_curve(pattern, glm::length(off)) / std::sqrt(0.75) * off;
}

/// Returns the normal of the facet that a normal of length 1 belongs to, at a place of the pattern.
dvec3 faceted(const Pattern& pattern, const dvec3& at, const dvec3& normal) {
    using P = FacetParameter;
    const std::array<double, 10>& p = pattern.parameters;
    const CrackleMetric metric{p[P::kMetric], 0};
    const double size = p[P::kSize] < 1e-6 ? 1e-6 : p[P::kSize];
    if (p[P::kCoords] == 0)
        return nearest_points(normal / size, metric).nearest;
    const dvec3 noise = vector_noise(nearest_points(at / size, metric).nearest);
    return normal + p[P::kCoords] * (noise - glm::dot(noise, normal) * normal);
}

dvec3 tilt(const Around& around, const Bump& bump) {
    if (bump.kind == Bump::Kind::Height)
        return against_slope(around, bump);
    if (bump.kind == Bump::Kind::Picture)
        return against_brightness(around, bump);
    const Pattern& pattern = pattern_of(around, bump);
    const dvec3 where = evaluate(around.textures, pattern, point_of(around, bump)).at.at;
    switch (bump.kind) {
    case Bump::Kind::Dents:
        return std::pow(noise(where, pattern.noise), 3) * vector_noise(where);
    case Bump::Kind::Wrinkles:
        return wrinkled(where);
    case Bump::Kind::Ripples:
    case Bump::Kind::Waves:
        return waved(pattern, bump.kind, where);
    case Bump::Kind::Quilted:
        return quilted_slope(pattern, where);
    default:
        return vector_noise(where);
    }
}

dvec3 tilted_normal(const Around& around, const Bump& bump);

/// Returns the weighted sum of the normals of the parts at the pattern's value, or around.normal
/// where they cancel out.
dvec3 mixed(const Around& around, const Bump& bump) {
    const Texture& texture = around.textures[bump.pattern.texture];
    const std::vector<TextureStop>& stops = texture.stops;
    const Pattern& pattern = texture.pattern;
    const auto part = [&](size_t i) { return tilted_normal(around, around.bumps[bump.parts[i]]); };
    dvec3 sum(0);
    if (pattern.kind == Pattern::Kind::Average) {
        for (size_t i = 0; i < stops.size(); ++i)
            sum += stops[i].at * part(i);
    } else {
        const double value = evaluate(around.textures, pattern, point_of(around, bump)).value;
        const Between where = stops_at(texture, value);
        sum = (1 - where.share) * part(where.first);
        if (where.share > 0)
            sum += where.share * part(where.second);
    }
    const double length = glm::length(sum);
    return length > 1e-9 ? sum / length : around.normal;
}

dvec3 tilted_normal(const Around& around, const Bump& bump) {
    if (bump.kind == Bump::Kind::Mix)
        return mixed(around, bump);
    if (bump.amount == 0)
        return around.normal;
    const PlacedTexture& placed = bump.pattern;
    const Pattern& pattern = pattern_of(around, bump);
    // Rows of the map from the world, with the maps between warps: normals go to the pattern by the
    // inverse of its transpose.
    const auto linear = [](const std::array<dvec4, 3>& map) {
        return dmat3(dvec3(map[0]), dvec3(map[1]), dvec3(map[2]));
    };
    dmat3 rows = linear(placed.to_texture);
    for (const TextureStep& step : pattern.steps)
        if (step.kind == TextureStep::Kind::Affine)
            rows = rows * linear(step.rows);
    const dvec3 there = glm::inverse(rows) * around.normal;
    const double length = glm::length(there);
    if (!(length > 0) || !std::isfinite(length))
        return around.normal;
    const dvec3 untilted = bump.keeps_depth ? there : there / length;
    const dvec3 tilted =
        bump.kind == Bump::Kind::Facets
            ? faceted(pattern, evaluate(around.textures, pattern, point_of(around, bump)).at.at,
                      there / length)
            : untilted + bump.amount * tilt(around, bump);
    const dvec3 back = rows * tilted;
    const double size = glm::length(back);
    return size > 0 && std::isfinite(size) ? back / size : around.normal;
}

} // namespace

dvec3 bumped(std::span<const Texture> textures, std::span<const Bump> bumps, const Bump& bump,
             const dvec3& at, const dvec3& normal, const dvec3& view) {
    return tilted_normal({textures, bumps, at, normal, view}, bump);
}

} // namespace ovc
