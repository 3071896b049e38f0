// SPDX-License-Identifier: Apache-2.0
// MaterialTable turns textures into the materials of a scene.
#pragma once

#include "importers/pov/flatten.h"
#include "importers/pov/texture_table.h"

#include <unordered_map>

namespace ovc::pov {

void tell_all(const Notes& notes, const Look& look);

/// An interior, the transformation that brings its media into the world, whether the object is
/// hollow, without which it has no media, whether it has no inside at all, and whether light lights
/// both of its sides.
struct PlacedInterior {
    const Interior* interior = nullptr; // null: none
    dmat4 placed{1};
    bool hollow = false;
    bool is_sheet = false;
    bool double_illuminate = false;
};

/// Adds materials to a scene. Equal ones are added once.
class MaterialTable {
public:
    MaterialTable(const Look& look, Scene& scene) : look_(look), scene_(scene), textures_(scene) {}

    /// Returns an index into Scene::materials. color: of the texture's pigment, perhaps without its
    /// holes. placed: brings the texture into the world. inside: the texture of the inner side, or
    /// null where it is the same.
    uint32_t number(const Texture& texture, const Color& color, const dmat4& placed,
                    const PlacedInterior& interior, const Texture* inside = nullptr);

    /// As TextureTable::set_has_uv.
    void set_has_uv(bool has_uv) { textures_.set_has_uv(has_uv); }

    /// As TextureTable::set_to_uv.
    void set_to_uv(std::vector<TextureStep> to_uv) { textures_.set_to_uv(std::move(to_uv)); }
    /// As TextureTable::maps_uv.
    bool maps_uv() const { return textures_.maps_uv(); }

    /// Returns whether a part of the material lies on texture coordinates.
    bool is_on_uv(uint32_t material) const { return on_uv_[material]; }

    /// Returns the medium as it lies in the world.
    Medium medium(const Media& media, const dmat4& placed);

    /// Returns the bump of a normal that has a pattern.
    Bump bump(const Normal& normal, const dmat4& placed);

private:
    ovc::Material made(const Texture& texture, const Color& color, const dmat4& placed,
                       const PlacedInterior& interior);
    void mix(const Texture& texture, const dmat4& placed, const PlacedInterior& interior,
             ovc::Material& material);
    void fill(const PlacedInterior& interior, ovc::Material& material);

    bool has_part_on_uv(const ovc::Material& material) const;
    const std::vector<MapStop>& moved_stops(const Pigment& mix);

    const Look& look_;
    Scene& scene_;
    TextureTable textures_;
    std::vector<bool> on_uv_;                            // of each material
    std::unordered_multimap<size_t, uint32_t> by_color_; // numbers of materials
    /// What moved_stops returns, of each map; it has those maps that it made.
    std::unordered_map<PatternPtr, std::vector<MapStop>> moved_stops_;
};

} // namespace ovc::pov
