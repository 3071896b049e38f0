// SPDX-License-Identifier: Apache-2.0
// Grid: the 16-bit coordinates in which a page stores the boxes of nodes.
#pragma once

#include "core/box.h"
#include "gpu/page/node_boxes.h"

#include <algorithm>
#include <cmath>

namespace ovc {

/// The grid over a box, in the frame that boxes are in.
class Grid {
public:
    explicit Grid(const Box& box) {
        for (int axis = 0; axis < 3; ++axis) {
            // Two cells of margin on each side leave room for the padding below.
            const double cell = std::max(box.extent()[axis], 1e-30) / (kLast - 4);
            cell_[axis] = std::nextafter(float(cell), INFINITY);
            middle_[axis] = float((box.lo[axis] + box.hi[axis]) / 2);
        }
    }

    GridHeader header() const { return {middle_, cell_}; }

    /// Returns the range of `box` along an axis, rounded outwards by at least a tenth of a cell.
    /// That is 1/655,350 of the leaf or 50 float roundings, while the kernel makes at most 26
    /// (docs/design/numerics.md).
    GridRange range(const Boxf& box, int axis) const {
        const double lo = std::floor(position(box.lo[axis], axis) - kPadding);
        const double hi = std::ceil(position(box.hi[axis], axis) + kPadding);
        return {uint32_t(std::clamp(lo, 1.0, kLast)), uint32_t(std::clamp(hi, 1.0, kLast))};
    }

private:
    static constexpr double kLast = kGridLast;
    static constexpr double kPadding = 0.1;

    double position(float x, int axis) const {
        return (double(x) - double(middle_[axis])) / double(cell_[axis]) + kGridMiddle;
    }

    vec3 middle_;
    vec3 cell_;
};

} // namespace ovc
