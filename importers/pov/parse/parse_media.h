// SPDX-License-Identifier: Apache-2.0
// Reads media { } and density { }.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads a media from its { on.
Media parse_media(Reader& reader);

/// Reads a density, which is a pigment, from its { on.
Pigment parse_density(Reader& reader);

} // namespace ovc::pov
