// SPDX-License-Identifier: Apache-2.0
// Bump: a pattern that tilts the normals of a surface, as POV-Ray's `normal` does.
#pragma once

#include "core/texture/texture.h"

#include <span>

namespace ovc {

/// The height of a surface and its slope at a value of a pattern, as in POV-Ray's `slope_map`.
struct SlopeStop {
    double at = 0;
    double height = 0;
    double slope = 0;

    bool operator==(const SlopeStop&) const = default;
};

/// The places of what Bump::Kind::Facets needs among its pattern's parameters.
struct FacetParameter {
    enum Place : size_t {
        kCoords,    // not 0: noise is added in cells of space, so many times
        kSize,      // the size of cells, of space or of normals; below 1e-6 it is that
        kMetric = 3 // as for crackle
    };
};

struct Bump {
    /// Height tilts against the slope of the pattern's value. The next three add noise to the
    /// normal: three noises, those times the cube of the noise, or the sum of their magnitudes in
    /// octaves. Ripples and Waves tilt it along the waves that run over the surface. Quilted tilts
    /// it away from the middle of a cell. Facets has one normal in each cell of space, or of all
    /// normals, whatever its amount: see FacetParameter. Picture tilts it against the slope of the
    /// brightness of three texels of a planar image. Mix adds up
    /// the normals of `parts`, one for each stop of the texture, in proportion.
    enum class Kind : uint64_t {
        Height,
        Noise,
        Dents,
        Wrinkles,
        Ripples,
        Waves,
        Quilted,
        Facets,
        Picture,
        Mix
    };

    Kind kind = Kind::Height;
    double amount = 0.5;
    double accuracy = 0.02;   // how far apart Height looks at the pattern, in its space; above 0
    bool keeps_depth = false; // the tilt is over the size of the pattern, which is scaled
                              // (POV-Ray's no_bump_scale)
    PlacedTexture pattern;    // only the pattern of the texture and the values of its stops matter
    std::vector<SlopeStop> profile; // of Height: turns values into heights; none: they are heights
    std::vector<uint32_t> parts;    // of Mix: indices into Scene::bumps, below that of this one

    bool operator==(const Bump&) const = default;
};

/// Returns the tilted normal at a point of the world, of length 1. bumps: those of the scene.
/// normal: of length 1, on the side that is seen. view: along the ray that sees it.
dvec3 bumped(std::span<const Texture> textures, std::span<const Bump> bumps, const Bump& bump,
             const dvec3& at, const dvec3& normal, const dvec3& view);

} // namespace ovc
