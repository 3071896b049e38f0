// SPDX-License-Identifier: Apache-2.0
// Reads sky_sphere { }, which rays see that hit nothing.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads a sky_sphere from its { on.
SkySphere parse_sky_sphere(Reader& reader);

/// Returns the sky as seen in front of a background of the color `behind`. Warns, with the place
/// `at`, where POV-Ray draws the sky differently.
Background background_of(Reader& reader, const SkySphere& sky, const vec3& behind, const Place& at);

} // namespace ovc::pov
