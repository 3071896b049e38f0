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
/// answers for all of it. Only a ray that skips the smallest, or whose hits must lie behind it, is
/// answered with another one.
class Duplicates {
public:
    /// Takes all ids but the smallest of each set out of `triangles`, and returns the sets. The ids
    /// are of finite triangles, sorted and unique, and stay so. A triangle is a unit of progress.
    static Duplicates take_out(const Soup& soup, std::vector<TriangleId>& triangles,
                               BuildProgress* progress = nullptr);

    /// A triangle that was taken out, and the smallest of its set.
    struct Pair {
        TriangleId smallest;
        TriangleId other;

        auto operator<=>(const Pair&) const = default;
    };

    /// Returns all triangles that were taken out, sorted.
    std::span<const Pair> pairs() const { return pairs_; }
    uint64_t count() const { return pairs_.size(); }
    /// Returns the set whose smallest is `id`, without that one; empty where there is no such set.
    std::span<const Pair> of(TriangleId id) const;

    /// pairs: as pairs() returned them.
    static Duplicates restored(std::span<const Pair> pairs) {
        Duplicates duplicates;
        duplicates.pairs_.assign(pairs.begin(), pairs.end());
        return duplicates;
    }

private:
    std::vector<Pair> pairs_;
};

} // namespace ovc
