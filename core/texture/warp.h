// SPDX-License-Identifier: Apache-2.0
// The steps that move a point before a pattern is evaluated: POV-Ray's transformations and warps.
#pragma once

#include "core/texture/texture.h"

namespace ovc {

/// Returns the point where the step brings one.
dvec3 warped(const TextureStep& step, const dvec3& at);

} // namespace ovc
