// SPDX-License-Identifier: Apache-2.0
// The formulas were found by asking povray for the light on bumpy planes under several lights,
// which tells their normals; bump_test.cpp compares with such normals.
#include "core/texture/bump.h"

#include "core/texture/pattern.h"

#include <cmath>

namespace ovc {

namespace {

/// Returns -0.1 times four thirds of the pattern's gradient, about. The corners of a tetrahedron of
/// size `accuracy` are where the pattern is looked at.
dvec3 against_slope(std::span<const Texture> textures, const Bump& bump, const dvec3& at) {
    static const dvec3 kCorners[] = {{2 * std::sqrt(2.0) / 3, -1 / 3.0, 0},
                                     {-std::sqrt(2.0) / 3, -1 / 3.0, std::sqrt(2 / 3.0)},
                                     {-std::sqrt(2.0) / 3, -1 / 3.0, -std::sqrt(2 / 3.0)},
                                     {0, 1, 0}};
    dvec3 sum(0);
    for (const dvec3& corner : kCorners)
        sum -= value_at(textures, bump.pattern.texture, {at + bump.accuracy * corner}) * corner;
    return 0.1 / bump.accuracy * sum;
}

dvec3 wrinkled(const dvec3& at) {
    dvec3 sum(0);
    double frequency = 1;
    for (int i = 0; i < 10; ++i, frequency *= 2)
        sum += glm::abs(vector_noise(frequency * at)) / frequency;
    return sum;
}

dvec3 tilt(std::span<const Texture> textures, const Bump& bump, const dvec3& at) {
    if (bump.kind == Bump::Kind::Height)
        return against_slope(textures, bump, at);
    const Pattern& pattern = textures[bump.pattern.texture].pattern;
    const dvec3 where = evaluate(pattern, at).at;
    switch (bump.kind) {
    case Bump::Kind::Dents:
        return std::pow(noise(where, pattern.noise), 3) * vector_noise(where);
    case Bump::Kind::Wrinkles:
        return wrinkled(where);
    default:
        return vector_noise(where);
    }
}

} // namespace

dvec3 bumped(std::span<const Texture> textures, const Bump& bump, const dvec3& at,
             const dvec3& normal) {
    const PlacedTexture& placed = bump.pattern;
    // Rows of the map from the world: normals go to the pattern by the inverse of its transpose.
    const dmat3 rows(dvec3(placed.to_texture[0]), dvec3(placed.to_texture[1]),
                     dvec3(placed.to_texture[2]));
    const dvec3 there = glm::inverse(rows) * normal;
    const double length = glm::length(there);
    if (!(length > 0) || !std::isfinite(length))
        return normal;
    const dvec3 tilted = there / length + bump.amount * tilt(textures, bump, placed.at(at));
    const dvec3 back = rows * tilted;
    const double size = glm::length(back);
    return size > 0 && std::isfinite(size) ? back / size : normal;
}

} // namespace ovc
