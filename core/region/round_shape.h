// SPDX-License-Identifier: Apache-2.0
// RoundShape: a ball, cylinder or cone as formulas, which trace() of a scene asks instead of
// triangles, as patterns of objects do: scenes build on what it says.
#pragma once

#include "core/vec.h"

#include <cmath>
#include <initializer_list>

namespace ovc {

/// A ball around `base`, or the cone between two circles that stand across their axis.
struct RoundShape {
    dvec3 base{0};
    double radius = 0; // of the ball, or at the base
    dvec3 cap{0};      // of a cone: not the base
    double cap_radius = 0;
    bool is_ball = true;
    bool open = false; // a cone without the disks at its ends

    bool operator==(const RoundShape&) const = default;
};

/// The point where a ray meets a surface.
struct RoundMeeting {
    double t;
    dvec3 normal; // outwards, of any length
};

/// Calls use(t) with the real roots of a t^2 + 2 b t + c.
template <class Use>
void for_each_root(double a, double b, double c, const Use& use) {
    if (a == 0) {
        if (b != 0)
            use(-0.5 * c / b);
        return;
    }
    const double square = b * b - a * c;
    if (!(square >= 0))
        return;
    // Each root by the form in which nothing cancels.
    const double q = -(b + std::copysign(std::sqrt(square), b));
    use(q / a);
    if (q != 0)
        use(c / q);
}

/// Calls use(RoundMeeting) with each meeting of the line `from` + t `way`, in no order. A ray along
/// the surface may have none.
template <class Use>
void for_each_meeting(const RoundShape& shape, const dvec3& from, const dvec3& way,
                      const Use& use) {
    const dvec3 off = from - shape.base;
    if (shape.is_ball) {
        for_each_root(glm::dot(way, way), glm::dot(off, way),
                      glm::dot(off, off) - shape.radius * shape.radius, [&](double t) {
                          use(RoundMeeting{t, off + t * way});
                      });
        return;
    }
    const dvec3 whole = shape.cap - shape.base;
    const double length = glm::length(whole);
    const dvec3 axis = whole / length;
    const double slope = (shape.cap_radius - shape.radius) / length;
    const double up = glm::dot(off, axis), rise = glm::dot(way, axis);
    const dvec3 across = off - up * axis, drift = way - rise * axis;
    const double radius = shape.radius + slope * up, growth = slope * rise;
    for_each_root(glm::dot(drift, drift) - growth * growth,
                  glm::dot(across, drift) - radius * growth,
                  glm::dot(across, across) - radius * radius, [&](double t) {
                      const double height = up + t * rise, wide = radius + t * growth;
                      if (height >= 0 && height <= length && wide >= 0)
                          use(RoundMeeting{t, across + t * drift - slope * wide * axis});
                  });
    if (shape.open || rise == 0)
        return;
    for (const bool at_cap : {false, true}) {
        const double t = ((at_cap ? length : 0) - up) / rise;
        const double wide = at_cap ? shape.cap_radius : shape.radius;
        const dvec3 there = across + t * drift;
        if (glm::dot(there, there) <= wide * wide)
            use(RoundMeeting{t, at_cap ? axis : -axis});
    }
}

/// Returns whether the point is inside of the shape, or of an open one if its ends were closed.
inline bool is_within(const RoundShape& shape, const dvec3& point) {
    const dvec3 off = point - shape.base;
    if (shape.is_ball)
        return glm::dot(off, off) < shape.radius * shape.radius;
    const dvec3 whole = shape.cap - shape.base;
    const double share = glm::dot(off, whole) / glm::dot(whole, whole);
    const double wide = shape.radius + share * (shape.cap_radius - shape.radius);
    const dvec3 across = off - share * whole;
    return share > 0 && share < 1 && glm::dot(across, across) < wide * wide;
}

} // namespace ovc
