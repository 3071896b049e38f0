// SPDX-License-Identifier: Apache-2.0
// Box: an axis-aligned bounding box, closed on all sides. Empty until something is added.
#pragma once

#include "core/vec.h"

#include <limits>

namespace ovc {

template <class T>
struct BoxT {
    using Vec = glm::vec<3, T, glm::defaultp>;

    Vec lo{std::numeric_limits<T>::infinity()};
    Vec hi{-std::numeric_limits<T>::infinity()};

    void add(const Vec& p) {
        lo = glm::min(lo, p);
        hi = glm::max(hi, p);
    }
    void add(const BoxT& b) {
        lo = glm::min(lo, b.lo);
        hi = glm::max(hi, b.hi);
    }

    bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
    Vec extent() const { return hi - lo; }
    Vec center() const { return lo + (hi - lo) * T(0.5); }

    /// Returns half the surface area, for the surface-area heuristic; 0 when the box is empty.
    T half_area() const {
        if (empty())
            return T(0);
        const Vec d = extent();
        return d.x * d.y + d.y * d.z + d.z * d.x;
    }

    /// Returns an upper bound of the rounding error when something small is added to the box's
    /// coordinates. Far from the origin it may exceed the size of the box.
    T rounding() const {
        return std::numeric_limits<T>::epsilon() *
               max_component(glm::max(glm::abs(lo), glm::abs(hi)));
    }

    /// Returns the box larger by `margin` on each side (smaller where that is negative), rounded.
    BoxT padded(T margin) const { return {lo - Vec(margin), hi + Vec(margin)}; }

    /// Returns the common part, which is empty when the boxes are apart.
    BoxT intersection(const BoxT& b) const { return {glm::max(lo, b.lo), glm::min(hi, b.hi)}; }

    /// True when the closed boxes share at least a point.
    bool touches(const BoxT& b) const { return !intersection(b).empty(); }

    bool contains(const Vec& p) const {
        return glm::all(glm::lessThanEqual(lo, p)) && glm::all(glm::lessThanEqual(p, hi));
    }
};

using Box = BoxT<double>;
using Boxf = BoxT<float>;

} // namespace ovc
