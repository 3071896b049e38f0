// SPDX-License-Identifier: Apache-2.0
// Area lights: an emitting surface as a few lights on it.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/objects.h"

namespace ovc::pbrt {

/// A flat part of the shape becomes spots that shine as Lambert's law says, up to kAreaPoints of
/// them; a closed one a point in its middle that shines everywhere, with the light that it sends
/// out on average. Between the two: both, by how much the normals agree.
std::vector<Light> lights_on(const Shape& shape, const vec3& radiance, bool two_sided);

inline constexpr size_t kAreaPoints = 4;

/// Light that falls with the square of the distance: `intensity` over distance squared arrives.
void set_falloff(Light& light, const vec3& intensity);

} // namespace ovc::pbrt
