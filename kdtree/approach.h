// SPDX-License-Identifier: Apache-2.0
// Approach: begins a ray from far away anew beside the scene, so that doubles suffice to walk a
// tree along it. Without that, the rounding of a position along the ray may be larger than the
// scene, and the ray would have to be tested against every triangle. A direction that is very short
// or long gets a length near 1.
#pragma once

#include "core/exact/triangle.h"

#include <optional>

namespace ovc {

class Approach {
public:
    /// Begins the approach of ray p, which must outlive this, to a scene in `bounds`.
    Approach(const PreparedRay& p, const Box& bounds);

    /// Returns the ray to walk along: p where that is near, else the same line to within the ray's
    /// margin, with a t of its own. Triangles found on the way must be tested against p itself.
    const PreparedRay& ray() const { return moved_ ? *moved_ : p_; }
    bool is_moved() const { return moved_.has_value(); }

    /// Notes that p hits the triangle, which may lower the limit.
    void note_hit(const Triangle& triangle);

    /// Returns the t of ray() beyond which nothing can win any more.
    double limit(const Nearest& nearest) const { return moved_ ? limit_ : nearest.limit(); }

private:
    const PreparedRay& p_;
    std::optional<PreparedRay> moved_;
    double limit_ = 0;
};

} // namespace ovc
