// SPDX-License-Identifier: Apache-2.0
// Evaluates patterns with their warps, turbulence and waves, and mixes the colors of their stops.
#include "core/texture/pattern.h"

#include "core/smooth_step.h"
#include "core/texture/pattern_value.h"
#include "core/texture/warp.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc {

namespace {

using Kind = Pattern::Kind;

/// Patterns are 0 beyond this, where doubles tell no two cells apart.
constexpr double kFarthestPattern = 1e12;

bool is_in_reach(const dvec3& at) {
    return is_finite(at) && max_component(glm::abs(at)) <= kFarthestPattern;
}

/// Returns the value, which lies between 0 and 1 unless the frequency is 0: then POV-Ray takes it
/// without phase, as it is. Else POV-Ray wraps just above 1, so that a value of 1 stays.
double wave_of(const Pattern& pattern, double value) {
    if (pattern.wave == Pattern::Wave::None)
        return value;
    constexpr double kWrap = 1.00001;
    double x = value;
    if (pattern.frequency != 0) {
        x = std::fmod(value * pattern.frequency + pattern.phase, kWrap);
        x = x < 0 ? std::max(0.0, x + 1) : x;
    }
    switch (pattern.wave) {
    case Pattern::Wave::Ramp:
    case Pattern::Wave::None:
        break;
    case Pattern::Wave::Triangular:
        return triangle_of(x);
    case Pattern::Wave::Sine:
        return 0.5 + 0.5 * std::sin(2 * std::numbers::pi * x);
    case Pattern::Wave::Scallop:
        return std::abs(std::sin(std::numbers::pi * x));
    case Pattern::Wave::Cubic:
        return smooth_step(x);
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

/// Moves a point and what lies around it.
void move(const TextureStep& step, TexturePoint& point) {
    point.at = warped(step, point.at);
    if (step.kind != TextureStep::Kind::Affine)
        return;
    for (dvec3& side : point.sides)
        side = {glm::dot(dvec3(step.rows[0]), side), glm::dot(dvec3(step.rows[1]), side),
                glm::dot(dvec3(step.rows[2]), side)};
}

} // namespace

dvec3 moved(const Pattern& pattern, dvec3 at) {
    for (const TextureStep& step : pattern.steps)
        at = warped(step, at);
    if (pattern.turbulence != dvec3(0) && !adds_turbulence(pattern.kind))
        at += pattern.turbulence * turbulence(at, pattern.octaves);
    return at;
}

std::vector<TextureStep> steps_of(const Pattern& pattern) {
    std::vector<TextureStep> steps = pattern.steps;
    if (pattern.turbulence != dvec3(0) && !adds_turbulence(pattern.kind)) {
        const Octaves& octaves = pattern.octaves;
        steps.push_back({TextureStep::Kind::Turbulence,
                         {dvec4(pattern.turbulence, octaves.lambda),
                          dvec4(octaves.omega, double(octaves.count), 0, 0), dvec4(0)}});
    }
    return steps;
}

double value_of_moved(std::span<const Texture> textures, const Pattern& pattern,
                      const TexturePoint& point) {
    if (!is_in_reach(point.at))
        return 0;
    if (is_discrete(pattern))
        return discrete_value(pattern, point.at);
    const double value =
        wave_of(pattern, has_cells(pattern.kind) ? discrete_value(pattern, point.at)
                                                 : continuous_value(textures, pattern, point));
    return std::isfinite(value) ? value : 0;
}

PatternPlace evaluate(std::span<const Texture> textures, const Pattern& pattern,
                      const TexturePoint& point) {
    PatternPlace place{0, point};
    if (pattern.kind == Kind::Perlin) // which takes means over the sides
        for (const TextureStep& step : pattern.steps)
            move(step, place.at);
    else
        place.at.at = moved(pattern, point.at);
    place.value = value_of_moved(textures, pattern, place.at);
    if (!is_in_reach(place.at.at))
        place.at.at = dvec3(0);
    return place;
}

namespace {

float mean_of(const TransparentColor& color) {
    return (color.rgb.x + color.rgb.y + color.rgb.z) / 3;
}

TransparentColor color_of_pattern(std::span<const Texture> textures, const Texture& texture,
                                  const TexturePoint& unmoved) {
    const PatternPlace place = evaluate(textures, texture.pattern, unmoved);
    const TexturePoint& point = place.at;
    TransparentColor sum;
    if (texture.pattern.kind == Kind::Average) {
        for_each_averaged(texture.stops, [&](const TextureStop& stop, double share) {
            add(sum, color_of_stop(textures, stop, point), float(share));
        });
        return sum;
    }
    const Between where = stops_at(texture, place.value);
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
    for (const TextureStep& step : texture.pattern.steps)
        move(step, point);
    return color_at(*texture.image, point.at, point.sides);
}

} // namespace

TexturePoint moved_to_uv(const TexturePoint& point) {
    TexturePoint there = point;
    there.at = dvec3(point.uv, 0);
    there.sides = {dvec3(point.uv_sides[0], 0), dvec3(point.uv_sides[1], 0)};
    return there;
}

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
    return texture.on_uv ? color_of_pattern(textures, texture, moved_to_uv(point))
                         : color_of_pattern(textures, texture, point);
}

TransparentColor color_at(std::span<const Texture> textures, const PlacedTexture& placed,
                          const TexturePoint& world) {
    const Texture& texture = textures[placed.texture];
    // The rest of a place does not count for the plain colors that most discrete patterns have.
    if (texture.kind == TextureKind::Pattern && is_discrete(texture.pattern) && !texture.on_uv) {
        const dvec3 at = moved(texture.pattern, placed.at(world.at));
        const double value = value_of_moved(textures, texture.pattern, at);
        const TextureStop& stop = texture.stops[stops_at(texture, value).first];
        if (stop.texture == kNoTexture)
            return stop.color;
    }
    return color_at(textures, placed.texture, placed.at(world));
}

double height_at(std::span<const Texture> textures, uint32_t number, const TexturePoint& point) {
    const Texture& texture = textures[number];
    if (texture.kind == TextureKind::Product) {
        double all = 1;
        for (const TextureStop& stop : texture.stops)
            all *= stop.texture == kNoTexture ? double(mean_of(stop.color))
                                              : height_at(textures, stop.texture, point);
        return all;
    }
    if (texture.kind == TextureKind::Pattern && texture.pattern.wave == Pattern::Wave::None)
        return evaluate(textures, texture.pattern, point).value;
    return double(mean_of(color_at(textures, number, point)));
}

double value_at(std::span<const Texture> textures, uint32_t number, const TexturePoint& point) {
    const Texture& texture = textures[number];
    if (texture.kind == TextureKind::Pattern && !texture.on_uv)
        return evaluate(textures, texture.pattern, point).value;
    return double(mean_of(color_at(textures, number, point)));
}

} // namespace ovc
