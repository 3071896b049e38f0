// SPDX-License-Identifier: Apache-2.0
// Lights maps pbrt's lights to points, spots and parallel light, and area lights to lights on them.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/look/textures.h"
#include "importers/pbrt/objects.h"

namespace ovc::pbrt {

/// The emission of the shapes that follow an AreaLightSource.
struct Emission {
    vec3 radiance{1};
    bool two_sided = false;
    std::optional<double> power;     // v4's, which each shape sends out that pbrt makes of a mesh
    std::optional<uint32_t> picture; // a texture on uv that multiplies the radiance
};

/// Returns the radiance that an emitting shape sends out.
vec3 radiance_of(const Emission& emission, const Shape& shape);

class Lights {
public:
    Lights(Textures& textures, Diagnostics& diagnostics)
        : textures_(textures), diagnostics_(diagnostics) {}

    /// Returns false, after a warning, for a type that is not known.
    bool add(const std::string& type, const Parameters& parameters, const dmat4& to_world,
             const Place& place);
    Emission emission(const Parameters& parameters, const Place& place) const;
    /// Adds an emitting shape, which its transform places in the world. radiance: what it sends out
    /// everywhere.
    void add_area(const Shape& shape, const vec3& radiance, bool two_sided);

    /// Moves all lights into the scene. view_up is the direction up in the picture.
    void finish(const dvec3& view_up, Scene& scene);

private:
    vec3 scaled(const Parameters& parameters, std::string_view color, const vec3& otherwise) const;
    void add_point(const Parameters& parameters, const dmat4& to_world);
    void add_goniometric(const Parameters& parameters, const dmat4& to_world, const Place& place);
    void add_projection(const Parameters& parameters, const dmat4& to_world, const Place& place);
    void add_spot(const Parameters& parameters, const dmat4& to_world, const Place& place);
    void add_distant(const Parameters& parameters, const dmat4& to_world, const Place& place);
    void tell_no_direction(const Place& place);
    void add_infinite(const Parameters& parameters, const dmat4& to_world, const Place& place);
    void add_map(const Parameters& parameters, const vec3& radiance, const dmat4& to_world,
                 const Place& place);
    ThrownPicture thrown(const Parameters& parameters, const dmat3& to_light,
                         const ImageTexture& picture, const Place& place);

    Textures& textures_;
    Diagnostics& diagnostics_;
    std::vector<Light> lights_;
    std::vector<Light> area_lights_;
    std::optional<Background> sky_; // with its maps as layers
    vec3 even_sky_{0};              // its light without them
    int skies_ = 0;
    vec3 sky_mean_{0};
    bool any_ = false; // whether the file has a light of any kind
};

} // namespace ovc::pbrt
