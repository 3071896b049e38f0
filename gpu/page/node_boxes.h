// SPDX-License-Identifier: Apache-2.0
// The boxes of a node's children, as its first three texels hold them (shaders/layout.h).
#pragma once

#include "gpu/page/page.h"

#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ovc {

/// The grid of a page's boxes, as the page's header gives it: coordinate c lies at
/// middle + (c - kGridMiddle) cell.
struct GridHeader {
    vec3 middle;
    vec3 cell;
};

/// Returns the grid of the page whose texels these are.
inline GridHeader header_of(std::span<const uvec4> texels) {
    const auto vector = [](const uvec4& t) {
        return vec3(std::bit_cast<float>(t.x), std::bit_cast<float>(t.y),
                    std::bit_cast<float>(t.z));
    };
    return {vector(texels[0]), vector(texels[1])};
}

constexpr uint32_t kGridLast = 0xffff;
constexpr uint32_t kGridMiddle = 0x8000;

/// A range of grid coordinates, 0 to kGridLast. The empty range stands for a missing child.
struct GridRange {
    uint32_t lo = kGridLast;
    uint32_t hi = 0;

    bool empty() const { return lo > hi; }
    bool operator==(const GridRange&) const = default;
};

namespace node_boxes {

/// The cells to take off a lower bound. The kernel reads the upper half of a word with the lower
/// half as its fraction, which adds less than a cell. That only widens an upper bound, but would
/// narrow a lower one.
inline uint32_t less(size_t child) {
    return child & 1;
}
inline uint32_t shift(size_t child) {
    return child & 1 ? 16 : 0;
}
inline void put(uint32_t& word, size_t child, uint32_t coordinate) {
    word = (word & ~(kGridLast << shift(child))) | (coordinate ^ kGridMiddle) << shift(child);
}
inline uint32_t get(uint32_t word, size_t child) {
    return (word >> shift(child) & kGridLast) ^ kGridMiddle;
}

} // namespace node_boxes

/// Stores a child's range along the axis whose texel `words` is. For an odd child lo is not 0.
inline void put_range(uvec4& words, size_t child, GridRange range) {
    assert(child < 4); // lo may be 0 in a damaged file, and is then a box that is too small
    node_boxes::put(words[int(child / 2)], child, range.lo - node_boxes::less(child));
    node_boxes::put(words[int(2 + child / 2)], child, range.hi);
}

inline GridRange range_of(const uvec4& words, size_t child) {
    return {node_boxes::get(words[int(child / 2)], child) + node_boxes::less(child),
            node_boxes::get(words[int(2 + child / 2)], child)};
}

} // namespace ovc
