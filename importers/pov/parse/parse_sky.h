// SPDX-License-Identifier: Apache-2.0
// sky_sphere { }: what is behind everything.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// From the { on.
SkySphere parse_sky_sphere(Reader& reader);

/// What is seen of the sky in front of a background of that color; warns where it is not as POV-Ray
/// draws it. at: of the warning.
Background background_of(Reader& reader, const SkySphere& sky, const vec3& behind, const Place& at);

} // namespace ovc::pov
