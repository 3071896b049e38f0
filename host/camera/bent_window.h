// SPDX-License-Identifier: Apache-2.0
// Pictures that are not flat: fisheye, panoramas and the like.
#pragma once

#include "core/ray.h"
#include "core/scene.h"

namespace ovc {

/// at: where in the picture, (-0.5, -0.5) being its lower left and (0.5, 0.5) its upper right
/// corner. dir is 0 where nothing is shown.
Ray bent_ray(const ImageWindow& window, const dvec3& eye, const dvec2& at);

} // namespace ovc
