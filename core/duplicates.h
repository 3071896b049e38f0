// SPDX-License-Identifier: Apache-2.0
// Duplicates: triangles with the same three corners, whatever their order. No ray tells them apart,
// so the smallest id of each such set stands for all in every structure over the soup.
#pragma once

#include "core/soup.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Returns whether both have the same three corners, in any order and either winding. 0 equals -0.
bool same_corners(const Triangle& a, const Triangle& b);

/// Returns the hit as one of triangle `id`, which has the same corners as the triangle that was
/// hit: u and v then count from the corners of `id`.
Hit as_hit_of(TriangleId id, const Soup& soup, const Hit& hit);

/// The sets of duplicates of a soup. At equal t the smaller id wins, so the smallest id of a set
/// answers for all of it. Only a ray that skips the smallest is answered with another one, the
/// second smallest.
class Duplicates {
public:
    /// Takes all ids but the smallest of each set out of `triangles`, and returns the sets. The ids
    /// are of finite triangles, sorted and unique, and stay so. A triangle is a unit of progress.
    static Duplicates take_out(const Soup& soup, std::vector<TriangleId>& triangles,
                               BuildProgress* progress = nullptr);

    /// Returns the second smallest id of the set whose smallest is `id`; `id` where there is none.
    TriangleId second(TriangleId id) const;

    /// Returns how many triangles were taken out.
    uint64_t count() const { return count_; }

    /// The two ids of a set that can be answers.
    struct Pair {
        TriangleId smallest;
        TriangleId second;
    };

    /// Returns all sets, sorted by smallest.
    std::span<const Pair> pairs() const { return pairs_; }
    /// Returns the duplicates that once had these pairs(), sorted by smallest, and this count().
    static Duplicates restored(std::span<const Pair> pairs, uint64_t count) {
        assert(std::is_sorted(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
            return a.smallest < b.smallest;
        }));
        Duplicates duplicates;
        duplicates.pairs_.assign(pairs.begin(), pairs.end());
        duplicates.count_ = count;
        return duplicates;
    }

private:
    std::vector<Pair> pairs_; // sorted by smallest
    uint64_t count_ = 0;
};

} // namespace ovc
