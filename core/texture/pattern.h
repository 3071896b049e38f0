// SPDX-License-Identifier: Apache-2.0
// Evaluates patterns and textures at points.
#pragma once

#include "core/texture/texture.h"

#include <span>

namespace ovc {

/// A place where a pattern has been evaluated.
struct PatternPlace {
    double value;    // of the pattern
    TexturePoint at; // after its steps and its turbulence: textures of its stops go on from there
};

/// Returns the pattern's value at a point of the texture's space. It is a number for any point.
/// textures: those that the pattern's formula calls.
PatternPlace evaluate(std::span<const Texture> textures, const Pattern& pattern,
                      const TexturePoint& point);

/// Returns the point at which a texture on texture coordinates is evaluated.
TexturePoint moved_to_uv(const TexturePoint& point);

/// The two halves of evaluate(): where the pattern's steps and its turbulence lead, and the value
/// there. moved() returns a point that is not finite, or very far away, where the value is 0.
dvec3 moved(const Pattern& pattern, dvec3 at);
double value_of_moved(std::span<const Texture> textures, const Pattern& pattern,
                      const TexturePoint& point);

/// Returns the color of textures[number] at a point of its space.
TransparentColor color_at(std::span<const Texture> textures, uint32_t number,
                          const TexturePoint& point);

/// Returns the color of a texture as it lies in the world, at a point of the world.
TransparentColor color_at(std::span<const Texture> textures, const PlacedTexture& placed,
                          const TexturePoint& world);

/// Returns what varies in textures[number] as a number: the pattern's value, or the mean color.
double value_at(std::span<const Texture> textures, uint32_t number, const TexturePoint& point);

/// Returns the mean color of textures[number]. Values of patterns without a wave, and products of
/// them, are not cut off at 0 and 1 as colors are.
double height_at(std::span<const Texture> textures, uint32_t number, const TexturePoint& point);

/// Returns Bezier's cubic with the control values of a Quilted pattern, which its seams follow.
double quilted_curve(const Pattern& pattern, double t);

/// Returns how bright POV-Ray calls a color.
inline float gray(const vec3& rgb) {
    return 0.297f * rgb.x + 0.589f * rgb.y + 0.114f * rgb.z;
}

/// Calls use(stop, share) for each stop of an average. Shares go by `at`, and add up to 1; they are
/// the same where all of these are 0.
template <class Use>
void for_each_averaged(std::span<const TextureStop> stops, const Use& use) {
    double weights = 0;
    for (const TextureStop& stop : stops)
        weights += stop.at;
    for (const TextureStop& stop : stops)
        use(stop, weights > 0 ? stop.at / weights : 1.0 / double(stops.size()));
}

/// Returns the steps by which moved() moves a point; the last of them may be its turbulence.
std::vector<TextureStep> steps_of(const Pattern& pattern);

/// Two neighbouring stops, by their indices, and the share of the second.
struct Between {
    size_t first, second;
    double share;
};

/// Returns where `value` lies among `count` > 0 stops, whose values are at(0) <= at(1) <= …. At the
/// value of several stops it is the first of them, or at the end of all the last, as for POV-Ray.
/// discrete: the value is a stop's number instead.
template <class At>
Between between(size_t count, const At& at, double value, bool discrete) {
    if (discrete) {
        const size_t i = size_t(value) % count;
        return {i, i, 0};
    }
    if (value >= at(count - 1))
        return {count - 1, count - 1, 0};
    size_t next = 0;
    while (next < count && at(next) < value)
        ++next;
    if (next == 0 || next == count) // before the first, or no number
        return {0, 0, 0};
    return {next - 1, next, (value - at(next - 1)) / (at(next) - at(next - 1))};
}

/// Returns whether the pattern has whole numbers as values, before its wave.
inline bool has_cells(Pattern::Kind kind) {
    return kind >= Pattern::Kind::Brick;
}

/// Returns whether the values of the pattern are whole numbers, which choose a stop. Those that a
/// wave or a frequency changes lie between stops.
inline bool is_discrete(const Pattern& pattern) {
    const bool moves = pattern.phase != 0 || pattern.frequency != 1;
    return has_cells(pattern.kind) &&
           (pattern.wave == Pattern::Wave::None ||
            (pattern.wave == Pattern::Wave::Ramp && (pattern.frequency == 0 || !moves)));
}

/// Returns where a value of the texture's pattern lies among its stops.
inline Between stops_at(const Texture& texture, double value) {
    return between(
        texture.stops.size(), [&](size_t i) { return texture.stops[i].at; }, value,
        is_discrete(texture.pattern));
}

} // namespace ovc
