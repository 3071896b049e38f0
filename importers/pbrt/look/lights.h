// SPDX-License-Identifier: Apache-2.0
// Lights: pbrt's, mapped to points, spots and parallel light; area lights as points on them.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/look/textures.h"
#include "importers/pbrt/objects.h"

namespace ovc::pbrt {

/// What AreaLightSource says of the shapes that follow it.
struct Emission {
    vec3 radiance{1};
    bool two_sided = false;
};

class Lights {
public:
    Lights(const Textures& textures, Diagnostics& diagnostics)
        : textures_(textures), diagnostics_(diagnostics) {}

    void add(const std::string& type, const Parameters& parameters, const dmat4& to_world,
             const Place& place);
    std::optional<Emission> emission(const Parameters& parameters) const;
    /// A shape that emits, in world coordinates.
    void add_area(const Shape& shape, const Emission& emission);

    /// Moves all into the scene. view_up: up in the picture.
    void finish(const dvec3& view_up, Scene& scene);

private:
    vec3 scaled(const Parameters& parameters, std::string_view color, const vec3& otherwise) const;
    void add_point(const Parameters& parameters, const dmat4& to_world);
    void add_spot(const Parameters& parameters, const dmat4& to_world);
    void add_distant(const Parameters& parameters, const dmat4& to_world);
    void add_infinite(const Parameters& parameters, const Place& place);

    const Textures& textures_;
    Diagnostics& diagnostics_;
    std::vector<Light> lights_;
    std::vector<Light> area_lights_;
    std::optional<Background> sky_;
    vec3 sky_mean_{0};
    bool any_ = false; // the file has a light of some kind
};

} // namespace ovc::pbrt
