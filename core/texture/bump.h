// SPDX-License-Identifier: Apache-2.0
// Bump: a pattern that tilts the normals of a surface, as POV-Ray's `normal` does.
#pragma once

#include "core/texture/texture.h"

#include <span>

namespace ovc {

struct Bump {
    /// Height tilts against the slope of the pattern's value. The others add noise to the normal:
    /// three noises, those times the cube of the noise, or the sum of their magnitudes in octaves.
    enum class Kind : uint64_t { Height, Noise, Dents, Wrinkles };

    Kind kind = Kind::Height;
    double amount = 0.5;
    double accuracy = 0.02; // how far apart Height looks at the pattern, in its space; above 0
    PlacedTexture pattern;  // only the pattern of the texture matters, not its colors

    bool operator==(const Bump&) const = default;
};

/// Returns the tilted normal at a point of the world, of length 1. normal: of length 1, on the side
/// that is seen.
dvec3 bumped(std::span<const Texture> textures, const Bump& bump, const dvec3& at,
             const dvec3& normal);

} // namespace ovc
