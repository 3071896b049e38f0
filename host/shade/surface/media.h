// SPDX-License-Identifier: Apache-2.0
// The media that light goes through on its way to a ray's origin.
#pragma once

#include "core/medium.h"
#include "core/ray.h"
#include "core/scene.h"

#include <span>
#include <vector>

namespace ovc {

/// The max places along a ray in which media scatter light. Each may spawn a shadow ray for each
/// light.
inline constexpr uint32_t kMaxScatteringPlaces = 256;

/// The media that fill the way of a ray, all of them together.
using MediaAlong = std::span<const Medium* const>;

/// A place along a ray that scatters light towards its origin.
struct ScatteringPlace {
    dvec3 at;
    vec3 share;           // of light from everywhere that is even, which it sends along the ray
    const Medium* medium; // whose phase says how it depends on the light's direction
};

/// The shares of light, for each color, that come through the media, and what they add.
struct ThroughMedia {
    vec3 share{1};
    vec3 added{0};
    std::vector<ScatteringPlace> scattering;
};

/// Returns what the media do on the ray's way between the first and the last of `ends`, values of t
/// that rise. They cut it where the light changes. textures: of the media's densities.
ThroughMedia through_media(std::span<const Texture> textures, MediaAlong media, const Ray& ray,
                           std::span<const double> ends);

/// Returns the share of light that comes through the media, which are looked at in a few places.
vec3 share_through_media(std::span<const Texture> textures, MediaAlong media, const Ray& ray,
                         double t);

/// Returns whether the scene has media anywhere.
bool has_media(const Scene& scene);

/// Returns how many shadow rays an answer of Whitted's integrator may spawn.
size_t max_shadow_rays(const Scene& scene);

/// Returns how much more than evenly a medium scatters into a direction. cosine: of the angle
/// between the light's way and that of the light that leaves.
double phase_of(const Medium& medium, double cosine);

} // namespace ovc
