// SPDX-License-Identifier: Apache-2.0
// HitLanes: computes t, u and v of several hits at once, rounded once, by the widest vectors that
// the processor has.
#pragma once

#include <vector>

namespace ovc {

/// Eight rays and the triangle that each of them hits. Arrays are [axis][lane].
struct HitLanes {
    static constexpr int kCount = 8;
    using Vec = double[3][kCount];

    alignas(64) Vec a, b, c, org, dir;
    alignas(64) double t[kCount], u[kCount], v[kCount];
    /// Not 0: t, u and v are the exact values, rounded to nearest. 0: doubled precision cannot tell
    /// how they round, and they may be anything.
    alignas(64) long long known[kCount];
};

/// Fills in t, u, v and known of all lanes; unused lanes may hold anything. The bits are the same
/// on every processor.
void round_hits(HitLanes& lanes);

/// Returns a round_hits() per width of vectors that the processor has, the widest last: for tests.
using RoundHits = void (*)(HitLanes&);
std::vector<RoundHits> ways_to_round_hits();

} // namespace ovc
