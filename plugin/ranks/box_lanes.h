// SPDX-License-Identifier: Apache-2.0
// BoxLanes: boxes side by side, several of which are tested at once with a ray, or with a packet of
// rays. Based on: Boulos and others 2006, "Geometric and Arithmetic Culling Methods for Entire Ray
// Packets", section 3 (interval arithmetic).
#pragma once

#include "core/box.h"
#include "core/ray.h"
#include "plugin/ranks/box_entry.h"

#include <cstddef>
#include <span>
#include <vector>

namespace ovc {

/// Bounds of the rays of a packet.
class RayPacket {
public:
    /// rays: not empty.
    explicit RayPacket(std::span<const Ray> rays);

    /// Whether all rays are valid, and their bounds tell anything.
    bool is_bounded() const { return is_bounded_; }

    /// An axis along which all rays go the same way. t lies between (in - a) inv and (out - b) inv,
    /// where in and out are the sides of a box, with the sign of the axis.
    struct Axis {
        int sign = 0; // 0: not all go the same way
        double a = 0, b = 0;
        double min_inv = 0, max_inv = 0;
    };
    Axis axes[3];
    double min_t = 0, max_t = 0;

private:
    bool is_bounded_ = false;
};

class BoxLanes {
public:
    static constexpr size_t kLanes = 8;
    struct Eight {
        double sides[6][kLanes]; // lo.x, lo.y, lo.z, hi.x, hi.y, hi.z
    };
    using Entries = double[kLanes];

    BoxLanes() = default;
    explicit BoxLanes(std::span<const Box> boxes);

    bool empty() const { return boxes_ == 0; }
    /// Returns the smallest entry of the ray into any of the boxes.
    double enter(const EnteringRay& ray) const;
    /// Returns a lower bound of the entries of all rays of a bounded packet; kNoEntry only where
    /// none of them enters a box. some: gets the boxes that any of them may enter, for rays.
    double enter(const RayPacket& packet, BoxLanes& some) const;

private:
    void clear() { boxes_ = 0, lanes_.clear(); }
    void add(const Eight& from, size_t lane);

    size_t boxes_ = 0;
    std::vector<Eight> lanes_;  // filled up with boxes that no ray enters
    std::vector<Eight> around_; // a box for each of these, where packets are to be tested
};

} // namespace ovc
