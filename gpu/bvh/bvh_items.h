// SPDX-License-Identifier: Apache-2.0
// The items that the builder of a BVH sorts: boxes of four floats a corner, with a number.
#pragma once

#include "core/box.h"

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace ovc {

/// A box of four floats a corner, so that the compiler makes one vector operation of each min and
/// max.
struct alignas(16) Bounds {
    std::array<float, 4> lo;
    std::array<float, 4> hi;

    static Bounds empty() {
        constexpr float inf = std::numeric_limits<float>::infinity();
        return {{inf, inf, inf, inf}, {-inf, -inf, -inf, -inf}};
    }
    static Bounds of(const Boxf& b) {
        return {{b.lo.x, b.lo.y, b.lo.z, 0}, {b.hi.x, b.hi.y, b.hi.z, 0}};
    }
    void add(const Bounds& b) {
        for (size_t i = 0; i < 4; ++i) {
            lo[i] = b.lo[i] < lo[i] ? b.lo[i] : lo[i];
            hi[i] = b.hi[i] > hi[i] ? b.hi[i] : hi[i];
        }
    }
    bool is_empty() const { return !(lo[0] <= hi[0] && lo[1] <= hi[1] && lo[2] <= hi[2]); }
    float half_area() const {
        const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
        return x * y + y * z + z * x;
    }
    Boxf box() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

struct Item {
    // lo[3] holds the bits of the index. min and max leave it alone, because hi[3] is not read.
    Bounds bounds;

    static Item of(const Boxf& box, uint32_t index) {
        Item item{Bounds::of(box)};
        item.bounds.lo[3] = std::bit_cast<float>(index);
        return item;
    }
    uint32_t index() const { return std::bit_cast<uint32_t>(bounds.lo[3]); }
    /// Twice the centre along an axis.
    float center(size_t axis) const { return bounds.lo[axis] + bounds.hi[axis]; }
};

} // namespace ovc
