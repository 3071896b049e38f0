// SPDX-License-Identifier: Apache-2.0
// NearestQuery, OcclusionQuery: how the two kinds of queries differ in the kernel and in the use of
// an answer.
#pragma once

#include "core/exact/triangle.h"
#include "core/ray_span.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace ovc {

struct NearestQuery {
    static constexpr bool kAnyHit = false;
    RaySpan rays;
    std::span<const TriangleId> skip; // empty, or one per ray
    std::span<Hit> results;
    std::span<uint32_t> passes;  // empty, or counts those of each ray
    std::span<uint32_t> flagged; // empty, or becomes 1 for flagged rays

    TriangleId skipped(size_t i) const { return skip.empty() ? TriangleId{} : skip[i]; }
    NearestQuery part(size_t first, size_t count) const {
        return {rays.subspan(first, count), skip.empty() ? skip : skip.subspan(first, count),
                results.subspan(first, count),
                passes.empty() ? passes : passes.subspan(first, count),
                flagged.empty() ? flagged : flagged.subspan(first, count)};
    }
    void count_pass(size_t i) const {
        if (!passes.empty())
            ++passes[i];
    }
    void flag(size_t i) const {
        if (!flagged.empty())
            flagged[i] = 1;
    }
    void set_miss(size_t i) const { results[i] = Hit{}; }
    void set(size_t i, const Hit& hit) const { results[i] = hit; }
    void set(size_t i, const Nearest& nearest) const { results[i] = nearest.hit(); }
    bool was_hit(size_t i) const { return results[i].is_hit(); }
    const Hit& hit(size_t i) const { return results[i]; }
};

struct OcclusionQuery {
    static constexpr bool kAnyHit = true;
    RaySpan rays;
    std::span<const TriangleId> skip;
    std::span<uint8_t> results;

    TriangleId skipped(size_t i) const { return skip.empty() ? TriangleId{} : skip[i]; }
    OcclusionQuery part(size_t first, size_t count) const {
        return {rays.subspan(first, count), skip.empty() ? skip : skip.subspan(first, count),
                results.subspan(first, count)};
    }
    void count_pass(size_t) const {}
    void flag(size_t) const {}
    void set_miss(size_t i) const { results[i] = 0; }
    void set(size_t i, const Hit& hit) const { results[i] = hit.is_hit(); }
    void set(size_t i, const Nearest& nearest) const { results[i] = nearest.is_hit(); }
    bool was_hit(size_t i) const { return results[i] != 0; }
    Hit hit(size_t) const { return {}; } // the triangle is not kept
};

/// Returns ray i as the host gave it.
template <class Query>
PreparedRay prepare(const Query& query, size_t i) {
    return PreparedRay(query.rays[i], query.skipped(i));
}

} // namespace ovc
