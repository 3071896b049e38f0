// SPDX-License-Identifier: Apache-2.0
// Rays just beside a ray that runs along the side of a triangle.
#pragma once

#include "plugin/hosts/tachyon/tachyon_triangle.h"
#include "plugin/overcast.h"

#include <array>
#include <cstddef>

namespace ovc::tachyon {

struct RaysBeside {
    std::array<ovc_ray, 3> rays;
    size_t count = 0;

    const ovc_ray* begin() const { return rays.data(); }
    const ovc_ray* end() const { return rays.data() + count; }
};

/// Rays parallel to `ray`, each a ten millionth of the triangle across a side that its hit lies on
/// within rounding errors, or across the corner of two such sides; none for a hit clear of all
/// sides. They begin a little before the hit.
RaysBeside rays_beside(const ovc_ray& ray, const ovc_hit& hit, const Triangle& triangle);

} // namespace ovc::tachyon
