// SPDX-License-Identifier: Apache-2.0
// Texture: a color that varies in space, as a value that a scene holds and its file keeps.
// docs/decisions/0033-textures-are-trees-in-the-scene.md says why it has this form.
#pragma once

#include "core/texture/formula.h"
#include "core/texture/noise.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ovc {

inline constexpr uint32_t kNoTexture = UINT32_MAX;

/// The color of a place of a surface, and the light that it lets through: light x rgb x filter +
/// light x transmit.
struct TransparentColor {
    vec3 rgb{0};
    float filter = 0;
    float transmit = 0;

    float opacity() const { return 1 - filter - transmit; }
    /// Returns the share of light that goes through, for each color.
    vec3 through() const { return filter * rgb + vec3(transmit); }
    bool operator==(const TransparentColor&) const = default;
};

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

/// A number that varies in space: POV-Ray's patterns, with their names. Those from Brick on have
/// whole numbers as values, which choose a stop; those before have values from 0 to 1.
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
        Planar,
        Quilted, // parameters: the control values
        Radial,
        Ripples,
        Slope, // parameters: direction (or a point), the slopes of the values 0 and 1, 1 for a
               // point, a height's gradient and its value at the origin, which is added
        Spherical,
        Spiral1, // parameters: the number of arms
        Spiral2, // likewise
        Waves,
        Wood,
        Wrinkles,
        Average, // of all stops, weighted by their `at`
        Brick,   // parameters: size, mortar
        Checker,
        Cubic,
        Hexagon,
        Square,
        Triangular,
    };
    enum class Wave : uint64_t { Ramp, Triangular, Sine, Scallop, Cubic, Power };

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

    bool operator==(const Pattern&) const = default;
};

/// A color at a value of the pattern, or a texture in its place.
struct TextureStop {
    double at = 0;
    TransparentColor color;
    uint32_t texture = kNoTexture; // index into Scene::textures, below that of its own texture

    bool operator==(const TextureStop&) const = default;
};

/// Colors between stops are mixed in proportion. `stops`: at least one, in ascending order of `at`
/// except for Kind::Average.
struct Texture {
    Pattern pattern;
    std::vector<TextureStop> stops;

    bool operator==(const Texture&) const = default;
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
    bool operator==(const PlacedTexture&) const = default;
};

} // namespace ovc
