// SPDX-License-Identifier: Apache-2.0
// What nearest-hit and occlusion queries differ in: the kernel, and what becomes of an answer.
#pragma once

#include "core/triangle.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace ovc {

struct NearestQuery {
    static constexpr bool kAnyHit = false;
    std::span<const Ray> rays;
    std::span<const TriangleId> skip; // empty, or one per ray
    std::span<Hit> results;

    void set_miss(size_t i) const { results[i] = Hit{}; }
    void set(size_t i, const Hit& hit) const { results[i] = hit; }
    bool was_hit(size_t i) const { return results[i].is_hit(); }
    const Hit& hit(size_t i) const { return results[i]; }
    /// The end of ray i as far as it is still of interest.
    double t_max(size_t i) const { return std::min(rays[i].t_max, results[i].t); }
};

struct OcclusionQuery {
    static constexpr bool kAnyHit = true;
    std::span<const Ray> rays;
    std::span<const TriangleId> skip;
    std::span<uint8_t> results;

    void set_miss(size_t i) const { results[i] = 0; }
    void set(size_t i, const Hit& hit) const { results[i] = hit.is_hit(); }
    bool was_hit(size_t i) const { return results[i] != 0; }
    Hit hit(size_t) const { return {}; } // which one is not kept
    double t_max(size_t i) const { return rays[i].t_max; }
};

/// Ray i as the host gave it.
template <class Query>
PreparedRay prepare(const Query& query, size_t i) {
    return PreparedRay(query.rays[i], query.skip.empty() ? TriangleId{} : query.skip[i]);
}

/// Ray i up to the best hit so far.
template <class Query>
PreparedRay prepare_rest(const Query& query, size_t i) {
    PreparedRay p = prepare(query, i);
    p.ray.t_max = query.t_max(i);
    return p;
}

} // namespace ovc
