// SPDX-License-Identifier: Apache-2.0
// LeafLimits: how large leaves and their pages may be.
#pragma once

#include "core/ray.h"

#include <algorithm>
#include <cstdint>

namespace ovc {

/// About how many copies of a triangle leaves have together (as in LoosePairs) where its pages are
/// to fit into little: what is too large for that is cut again.
inline constexpr double kCopiesOfLeaves = 1.4;

/// What leaves may be: so many triangles at most (> 0), and so many bytes of a page. But where all
/// triangles fit into one page of `whole_bytes`, there is one leaf if rays gain by it.
struct LeafLimits {
    static constexpr uint64_t kAny = ~uint64_t(0);

    uint64_t triangles;
    uint64_t page_bytes;
    uint64_t whole_bytes = 0; // 0: never one leaf for that; kAny: it fits, whatever it takes

    /// How many triangles a leaf may have, of so many. rate(n, copies): about what a page of n
    /// takes, in bytes a triangle (copies: as in LoosePairs); asked only where that matters.
    /// one_leaf(): whether rays gain by one leaf (one_leaf.h), asked only where there may be one.
    template <class Rate, class OneLeaf>
    uint32_t most_of(uint64_t all, Rate&& rate, OneLeaf&& one_leaf) const {
        if (whole_bytes > 0 && one_leaf() && (whole_bytes == kAny || fits(all, rate(all, 1))))
            return kNone - 1;
        return pages_matter() ? triangles_at(rate(triangles, kCopiesOfLeaves))
                              : uint32_t(std::min<uint64_t>(triangles, kNone - 1));
    }
    /// The most bytes of a page where there are so many leaves.
    uint64_t page_bytes_of(uint64_t leaves) const {
        return leaves == 1 ? std::max(page_bytes, whole_bytes) : page_bytes;
    }
    /// Whether a page could be too large at all: else triangles alone decide.
    bool pages_matter() const;
    /// How many triangles a leaf may have for its page to fit where one takes so many bytes. At
    /// least 1.
    uint32_t triangles_at(double bytes_per_triangle) const;
    /// The same for the parts of a leaf whose page was too large; less than it had.
    uint32_t triangles_again(uint64_t triangles_before, uint64_t bytes_before) const;

private:
    bool fits(uint64_t all, double bytes_per_triangle) const;
};

} // namespace ovc
