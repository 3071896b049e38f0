// SPDX-License-Identifier: Apache-2.0
// TextureTable turns patterns into the textures of a scene.
#pragma once

#include "core/scene.h"
#include "importers/pov/values/value.h"

#include <span>
#include <unordered_map>
#include <vector>

namespace ovc::pov {

struct Look;

/// Puts the transformation of a stop's pigment in front of its pattern: a texture's stops have no
/// transformations of their own.
void put_in_front(const dmat4& placed, Pattern& pattern);

/// Adds textures to a scene. Equal ones are added once. Patterns must outlive it.
class TextureTable {
public:
    /// Who evaluates the textures: whoever renders opens their pictures, but the functions of the
    /// scene look at them while the scene is read, as long as their patterns live.
    enum class For { Renderers, Functions };

    explicit TextureTable(Scene& scene, For whom = For::Renderers) : scene_(scene), for_(whom) {}

    /// Returns the pattern's colors as they lie in the world. placed: brings the pattern there.
    PlacedTexture of_pigments(const PatternMap& map, const dmat4& placed);
    /// Does the same for a pigment that has a pattern, which may lie on texture coordinates.
    PlacedTexture of_pigment(const Pigment& pigment, const dmat4& placed);
    /// Says whether the surfaces of the pigments that follow have texture coordinates. Without,
    /// which is the beginning, uv_mapping is left out.
    void set_has_uv(bool has_uv) { has_uv_ = has_uv; }
    /// Says how texture coordinates, as x and y, follow from the points of the surfaces that come;
    /// empty, which is the beginning: they do not.
    void set_to_uv(std::vector<TextureStep> to_uv) { to_uv_ = std::move(to_uv); }
    /// Returns whether uv_mapping of a pigment has a meaning on the surfaces that come.
    bool maps_uv() const { return has_uv_ || !to_uv_.empty(); }
    /// Returns whether a part of a texture that was added lies on texture coordinates.
    bool is_on_uv(uint32_t texture) const { return on_uv_[texture]; }
    /// Does the same for the color of a density.
    PlacedTexture of_density(const Pigment& density, const dmat4& placed);

    /// Does the same for the pattern of a mix of materials, one for each stop.
    PlacedTexture of_materials(const Pigment& mix, std::span<const uint32_t> materials,
                               const dmat4& placed);

    /// Returns the index of a texture of the pigment in its parent's space.
    uint32_t number(const Pigment& pigment);

private:
    uint32_t number(const PatternMap& map);
    Pattern pattern_of(const PatternMap& map);
    uint32_t add(ovc::Texture texture, bool is_mix);

    Scene& scene_;
    For for_;
    bool has_uv_ = false;
    std::vector<TextureStep> to_uv_;
    std::vector<bool> on_uv_;                                  // of each texture
    std::unordered_map<const PatternMap*, uint32_t> known_[2]; // without, with texture coordinates
    std::unordered_multimap<size_t, uint32_t> by_key_[2];      // of colors, of materials
};

/// Returns the textures of a pigment, which is the last of them, in its parent's space. There is no
/// formula.
ProgramPtr color_program(const Pigment& pigment);

/// Returns whether a color of the pigment lets light through.
bool lets_light_through(const Pigment& pigment);

/// Adds the sky's pigments, the lowest first, to the scene's background, and tells their notes.
void add_sky(const SkySphere& sky, const Look& look, Scene& scene);

} // namespace ovc::pov
