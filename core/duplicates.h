// SPDX-License-Identifier: Apache-2.0
// Duplicates: triangles with the same three corners, whatever their order. No ray tells them apart,
// so the smallest id of each such set stands for all in every structure over the soup.
#pragma once

#include "core/soup.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Do both have the same three corners, in any order and either winding? 0 equals -0.
bool same_corners(const Triangle& a, const Triangle& b);

/// The hit as one of `id`, whose corners are those of the triangle that was hit: u and v then count
/// from its own.
Hit as_hit_of(TriangleId id, const Soup& soup, const Hit& hit);

/// The sets of duplicates of a soup. Equal t goes to the smaller id, so the smallest of a set is
/// the answer wherever one of them is; only a ray that does not see the smallest, or whose hits lie
/// behind it, is answered with another one.
class Duplicates {
public:
    /// Takes all but the smallest id of each set out of `triangles`: finite ones, sorted, without
    /// repetition, and so they stay. A triangle is a unit of progress.
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
