// SPDX-License-Identifier: Apache-2.0
// An emitting surface becomes a few lights on it.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/objects.h"

namespace ovc::pbrt {

/// Returns the lights that stand for an emitting shape. A flat shape becomes up to kAreaPoints
/// spots that shine as Lambert's law says (twice as many if it is two-sided); a closed one becomes
/// a point in its middle that shines everywhere with its average light. A shape between the two
/// becomes a point and a spot, weighed by how much the normals agree.
std::vector<Light> lights_on(const Shape& shape, const vec3& radiance, bool two_sided);

/// Returns the area of a shape in the world.
double surface_area(const Shape& shape);

inline constexpr size_t kAreaPoints = 4;

/// Makes the light fall with the square of the distance: `intensity` over distance squared arrives.
void set_falloff(Light& light, const vec3& intensity);

} // namespace ovc::pbrt
