// SPDX-License-Identifier: Apache-2.0
// Camera rays of pictures that are not flat: fisheye, panoramas and the like.
#pragma once

#include "core/ray.h"
#include "core/scene.h"

namespace ovc {

/// Returns the ray through a place in the picture; its dir is 0 where nothing is shown. at: from
/// (-0.5, -0.5), the lower left corner, to (0.5, 0.5), the upper right one.
Ray bent_ray(const ImageWindow& window, const dvec3& eye, const dvec2& at);

} // namespace ovc
