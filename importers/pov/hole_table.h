// SPDX-License-Identifier: Apache-2.0
// HoleTable holds the holes of textures as they stand in the world, while shapes become meshes.
#pragma once

#include "core/scene.h"
#include "importers/pov/values/value.h"

#include <array>
#include <unordered_map>

namespace ovc::pov {

/// The cover of a shape: a material, and a number in the HoleTable, or kNone.
struct Cover {
    uint32_t material = 0;
    uint32_t holes = kNone;
    bool curved = false; // the triangles stand for a curved surface
    bool uv = false;     // the mesh keeps its texture coordinates; it has no holes then
};

class HoleTable {
public:
    /// Adds cutouts to the scene, once each.
    explicit HoleTable(Scene& scene) : scene_(scene) {}

    /// Returns the number of the pigment's holes, which are there. placed: brings the pigment, or
    /// with `on_uv` its texture coordinates, to where they are asked for.
    uint32_t number(const Pigment& pigment, const dmat4& placed, bool on_uv);

    /// Returns an index into Scene::cutouts; kNone for kNone.
    uint32_t cutout(uint32_t holes) const { return holes == kNone ? kNone : placed_[holes].cutout; }

    /// Appends where a triangle lies on the picture; does nothing for kNone. uv: of its corners.
    void add_uv(uint32_t holes, const std::array<dvec3, 3>& in_world, const vec2* uv,
                std::vector<vec2>& to) const;

private:
    struct PlacedHoles {
        uint32_t cutout;
        bool on_uv;
        dmat4 to_picture;
    };

    Scene& scene_;
    std::unordered_map<const Holes*, uint32_t> cutouts_;
    std::vector<PlacedHoles> placed_;
};

} // namespace ovc::pov
