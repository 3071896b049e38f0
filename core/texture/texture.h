// SPDX-License-Identifier: Apache-2.0
// Texture: a color that varies in space, as a value that a scene holds and its file keeps.
// docs/decisions/0033-textures-are-trees-in-the-scene.md says why it has this form.
#pragma once

#include "core/region/region.h"
#include "core/texture/formula.h"
#include "core/texture/image_texture.h"
#include "core/texture/noise/noise.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

inline constexpr uint32_t kNoTexture = UINT32_MAX;

/// Returns the share of its own light that a surface of this color shows. by_brightest: a filter
/// hides it in proportion to its brightest component (Finish::filter_by_brightest).
inline float opacity(const TransparentColor& color, bool by_brightest) {
    return by_brightest ? 1 - color.filter * max_component(color.rgb) - color.transmit
                        : color.opacity();
}

/// A step on the way of a point to where a pattern is evaluated.
struct TextureStep {
    enum class Kind : uint64_t {
        Affine,     // rows: of a 3 x 4 matrix, which multiplies the point
        Turbulence, // rows[0]: the amount along x, y, z, then lambda; rows[1]: omega, octaves
        Repeat,     // rows[0]: the period along x, y or z, others 0; rows[1]: the offset of each
                    // period; rows[2]: 1 or -1 a component, by which every second one is flipped
        BlackHole,  // rows[0]: center, radius; rows[1]: strength, falloff, 1 where it pushes
        // Of the next four rows[0] has the axis that they go by (0, 1 or 2), the power of the
        // distance by which lengths grow, and the major radius or the height of the plane.
        Cylindrical,
        Spherical,
        Toroidal,
        Planar,
        BoxNet, // unfolds the surface of the box from -1 to 1 into the unit square
        Cubic,  // the same of cubes of all sizes, of which z becomes the half width
    };
    Kind kind = Kind::Affine;
    std::array<dvec4, 3> rows{dvec4(1, 0, 0, 0), dvec4(0, 1, 0, 0), dvec4(0, 0, 1, 0)};

    bool operator==(const TextureStep&) const = default;
};

/// Values from 0 to 1 that fill the unit cube, as POV-Ray's density files do. The first index
/// varies fastest.
struct DensityGrid {
    std::array<uint32_t, 3> size{}; // each above 0, or all 0 without a grid
    std::vector<float> values;

    bool operator==(const DensityGrid&) const = default;
};

/// A number that varies in space: POV-Ray's patterns, with their names, and Dots and Perlin of
/// pbrt. Those from Brick on have whole numbers as values, which choose a stop; those before have
/// values from 0 to 1, except for Perlin.
struct Pattern {
    enum class Kind : uint64_t {
        Agate,
        AngleOfIncidence,
        Boxed,
        Bozo,
        Cells,
        Crackle, // parameters: factors of the three nearest distances, metric, offset, 1 for solid
        Cylindrical,
        Dents,
        Density,  // of the pattern's grid; parameters: its interpolation, 0 to 2
        Fractal,  // parameters: see fractal.h
        Function, // the pattern's formula
        Gradient, // parameters: a direction of length 1
        Granite,
        Leopard,
        Marble,
        Onion,
        Perlin, // parameters: see PerlinParameter
        Planar,
        Quilted, // parameters: the control values
        Radial,
        Ripples, // parameters: the number of sources; 0: 10
        Slope,   // parameters: direction (or a point), the slopes of the values 0 and 1, 1 for a
                 // point, a height's gradient and its value at the origin, which is added
        Spherical,
        Spiral1, // parameters: the number of arms
        Spiral2, // likewise
        Tiling,  // parameters: its number (tiling.h)
        Waves,   // parameters: as Ripples
        Wood,
        Wrinkles,
        Average, // of all stops, weighted by their `at`
        Brick,   // parameters: size, mortar
        Checker,
        Cubic,
        Dots, // 1 in a dot of the plane of x and y, else 0
        Hexagon,
        Object, // 1 inside of the pattern's region, else 0
        Square,
        Triangular,
    };
    /// None leaves values as they are, whatever frequency and phase.
    enum class Wave : uint64_t { Ramp, Triangular, Sine, Scallop, Cubic, Power, None };

    Kind kind = Kind::Bozo;
    std::array<double, 10> parameters{};
    Wave wave = Wave::Ramp;
    double frequency = 1;
    double phase = 0;
    double exponent = 1; // of Wave::Power
    NoiseKind noise = NoiseKind::Corrected;
    /// Moves the point by turbulence before the pattern is evaluated. Marble, wood and agate add it
    /// to their values instead.
    dvec3 turbulence{0};
    Octaves octaves;
    std::vector<TextureStep> steps; // in their order, before the turbulence
    Formula formula;                // of Kind::Function: of x, y and z
    DensityGrid grid;               // of Kind::Density
    Region region;                  // of Kind::Object

    bool operator==(const Pattern&) const = default;
};

/// The places of what makes a pattern of Perlin's improved noise among its parameters.
struct PerlinParameter {
    enum Place : size_t {
        kForm,      // one of Form
        kOctaves,   // at most kMaxNoiseOctaves (perlin.h)
        kRoughness, // the share of each octave in the one before
        kVariation, // of Marble: how far it is out of shape
    };
    /// The sum of octaves, that of their magnitudes, waves in gusts of wind, or a wave along y.
    enum Form { Sum, Turbulence, Windy, Marble };
};

/// A color at a value of the pattern, or a texture in its place.
struct TextureStop {
    double at = 0;
    TransparentColor color;
    uint32_t texture = kNoTexture; // index into Scene::textures, below that of its own texture

    bool operator==(const TextureStop&) const = default;
};

/// The way in which a texture combines its parts.
enum class TextureKind : uint64_t {
    Pattern, // colors between stops are mixed in proportion, by the value of the pattern
    Image,   // the color of `image`, at the point that the pattern's affine steps lead to
    Product, // of all stops
    Mix,     // of the first two stops; the mean color of the third is the share of the second
};

/// `stops`: at least one except for an image, for patterns in ascending order of `at` except for
/// Kind::Average; three for a mix.
struct Texture {
    Pattern pattern;
    std::vector<TextureStop> stops;
    TextureKind kind = TextureKind::Pattern;
    bool on_uv = false; // evaluated at (u, v, 0) of the surface instead of a point in space
    std::optional<ImageTexture> image = {};

    bool operator==(const Texture&) const = default;
};

/// A point where textures are evaluated, and the surface that lies there, if any.
struct TexturePoint {
    TexturePoint(const dvec3& place) : at(place) {}
    TexturePoint(const dvec3& place, const dvec3& up, const dvec3& seen_along)
        : at(place), normal(up), view(seen_along) {}

    dvec3 at;        // in the texture's space
    dvec3 normal{0}; // in the world, of length 1; 0: there is no surface
    dvec3 view{0};   // of the ray that sees the point, of length 1; 0: none does
    /// The sides of the parallelogram around the point of which a texture is to take the mean.
    std::array<dvec3, 2> sides{};
    bool has_uv = false; // without, textures on uv have the color that they have without a picture
    dvec2 uv{0};
    std::array<dvec2, 2> uv_sides{};
    std::array<dvec3, 2> by_uv{}; // how the point of the world moves by u and by v
};

/// A texture as it lies in the world.
struct PlacedTexture {
    uint32_t texture = 0;              // index into Scene::textures
    std::array<dvec4, 3> to_texture{}; // rows of a 3 x 4 affine matrix from the world

    /// Returns the point of the texture's space at a point of the world.
    dvec3 at(const dvec3& world) const {
        const dvec4 p(world, 1);
        return {glm::dot(to_texture[0], p), glm::dot(to_texture[1], p), glm::dot(to_texture[2], p)};
    }
    /// Returns a point of the world as one of the texture's space.
    TexturePoint at(const TexturePoint& world) const {
        TexturePoint there = world;
        for (dvec3& side : there.sides)
            side = {glm::dot(dvec3(to_texture[0]), side), glm::dot(dvec3(to_texture[1]), side),
                    glm::dot(dvec3(to_texture[2]), side)};
        there.at = at(world.at);
        return there;
    }
    bool operator==(const PlacedTexture&) const = default;
};

} // namespace ovc
