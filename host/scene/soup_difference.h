// SPDX-License-Identifier: Apache-2.0
// SoupDifference: what changes from the soup of one frame to that of the next.
#pragma once

#include "core/changes.h"
#include "core/soup.h"

#include <vector>

namespace ovc {

/// The chunks before `kept` stay, with the same triangles, some of which have other corners. Those
/// from there on make room for the next frame's: their order decides ties between triangles that
/// lie on each other, so that no chunk can be replaced between two that stay.
struct SoupDifference {
    uint32_t kept = 0;
    uint32_t removed = 0, added = 0; // chunks behind those
    std::vector<PrimRange> moved;    // of kept chunks, each that borrows the corners included
    std::vector<uint32_t> placed;    // kept chunks with another transform

    bool any() const { return removed > 0 || added > 0 || !moved.empty() || !placed.empty(); }
};

SoupDifference difference(const Soup& now, const Soup& next);

/// Makes `now` the same as `next`. Chunks that stay keep their corners where they are in memory.
/// Returns the chunks that are removed: a structure over `now` may use their corners until it is
/// brought up to date.
std::vector<Chunk> take_over(Soup& now, Soup next, const SoupDifference& difference);

} // namespace ovc
