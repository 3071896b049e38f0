// SPDX-License-Identifier: Apache-2.0
// AllHits: where a call writes the hits of its rays, each ray's in the order of t, mesh and prim.
#pragma once

#include "core/ray.h"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ovc {

struct AllHits {
    size_t max_hits;            // of a ray, that are written
    std::span<Hit> hits;        // max_hits per ray; misses where a ray has fewer
    std::span<uint64_t> counts; // empty, or per ray all of its hits

    bool are_for(size_t rays) const {
        return hits.size() == rays * max_hits && (counts.empty() || counts.size() == rays);
    }
    /// Writes hit number n of ray i.
    void set(size_t i, size_t n, const Hit& hit) const {
        if (n < max_hits)
            hits[i * max_hits + n] = hit;
        if (!counts.empty())
            counts[i] = n + 1;
    }
    /// Whether the ray's hits from number n on are not asked for.
    bool has_enough(size_t n) const { return counts.empty() && n >= max_hits; }
    AllHits part(size_t first, size_t count) const {
        return {max_hits, hits.subspan(first * max_hits, count * max_hits),
                counts.empty() ? counts : counts.subspan(first, count)};
    }
};

} // namespace ovc
