// SPDX-License-Identifier: Apache-2.0
// The algebraic surfaces among the functions that POV-Ray's functions.inc takes from POV-Ray.
#pragma once

#include "core/texture/formula.h"

namespace ovc {

/// Returns the function of this number, or one without a call where it is no such surface.
InternalFunction surface_function(uint32_t number);

} // namespace ovc
