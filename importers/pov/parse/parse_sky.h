// SPDX-License-Identifier: Apache-2.0
// Reads sky_sphere { }, which rays see that hit nothing, and fog { } and rainbow { } before it.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads a sky_sphere from its { on.
SkySphere parse_sky_sphere(Reader& reader);

/// Reads the { … } of a fog.
Fog parse_fog(Reader& reader);

/// Reads the { … } of a rainbow, which has no colors where the scene gives none.
Rainbow parse_rainbow(Reader& reader);

} // namespace ovc::pov
