// SPDX-License-Identifier: Apache-2.0
// Approach: a ray from far away, begun anew beside the scene, so that doubles suffice to walk a
// tree along it. Without that the rounding of a position along it may be larger than the scene, and
// every triangle would have to be asked.
#pragma once

#include "core/exact/triangle.h"

#include <optional>

namespace ovc {

class Approach {
public:
    /// p, which outlives this, on its way to a scene in `bounds`.
    Approach(const PreparedRay& p, const Box& bounds);

    /// The ray to walk along: p where it is near. Else the same line to within the margin of the
    /// ray, with a t of its own; and what the walk finds is tested against p itself.
    const PreparedRay& ray() const { return moved_ ? *moved_ : p_; }

    /// p hits the triangle.
    void note_hit(const Triangle& triangle);

    /// Nothing beyond this t of ray() can win any more.
    double limit(const Nearest& nearest) const { return moved_ ? limit_ : nearest.limit(); }

private:
    const PreparedRay& p_;
    std::optional<PreparedRay> moved_;
    double limit_ = 0;
};

} // namespace ovc
