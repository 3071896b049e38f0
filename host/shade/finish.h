// SPDX-License-Identifier: Apache-2.0
// Finish: how a surface with POV-Ray's finish answers light. Each formula is that of POV-Ray 3.7,
// whose documentation names the terms (section 3.4.7.3, "Finish").
#pragma once

#include "host/shade/shade.h"

namespace ovc {

/// What the surface reflects of light that arrives from `towards` (unit length, above the surface);
/// surface.material has a finish. arriving: POV-Ray's color of the light, where it stands.
vec3 finish_light(const SurfacePoint& surface, const dvec3& towards, const vec3& arriving,
                  bool highlights);

/// As branches(); surface.material has a finish.
Branches finish_branches(const SurfacePoint& surface, bool total);

/// Returns the share of diffuse light that arrives at an angle of that cosine, above 0.
float brilliant(const Finish& finish, double cosine);

/// Returns a number from 0 to 1 that depends on the place alone.
float random_share(const dvec3& at);

} // namespace ovc
