// SPDX-License-Identifier: Apache-2.0
// NearestQuery, OcclusionQuery: how the two kinds of queries differ in the kernel and in the use of
// an answer.
#pragma once

#include "core/exact/triangle.h"
#include "core/exclusions.h"
#include "core/ray_span.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace ovc {

struct NearestQuery {
    static constexpr bool kAnyHit = false;
    RaySpan rays;
    Exclusions without;
    std::span<Hit> results;
    std::span<uint32_t> passes;  // empty, or counts those of each ray
    std::span<uint32_t> flagged; // empty, or becomes 1 for flagged rays
    std::span<Hit> places;       // what without.after refers to, where rays have sieves
    bool has_own_places = false; // all of these are hits that this query has found

    NearestQuery part(size_t first, size_t count) const {
        return {rays.subspan(first, count),
                without.subspan(first, count),
                results.subspan(first, count),
                passes.empty() ? passes : passes.subspan(first, count),
                flagged.empty() ? flagged : flagged.subspan(first, count),
                places.empty() ? places : places.subspan(first, count),
                has_own_places};
    }
    bool counts_passes() const { return !passes.empty(); }
    void count_pass(size_t i) const { ++passes[i]; }
    void flag(size_t i) const {
        if (!flagged.empty())
            flagged[i] = 1;
    }
    void set_miss(size_t i) const { results[i] = Hit{}; }
    void set(size_t i, const Hit& hit) const { results[i] = hit; }
    void set(size_t i, const Nearest& nearest) const { results[i] = nearest.hit(); }
    bool was_hit(size_t i) const { return results[i].is_hit(); }
    const Hit& hit(size_t i) const { return results[i]; }
    bool has_sieves() const { return !without.sieves.pass_all(); }
    void may_pass_by(std::span<Hit> places_of_rays) { places = places_of_rays; }
    /// From now on only hits behind the one that was found count.
    void pass_by(size_t i) const { places[i] = results[i]; }
};

struct OcclusionQuery {
    static constexpr bool kAnyHit = true;
    static constexpr bool has_own_places = false;
    RaySpan rays;
    Exclusions without;
    std::span<uint8_t> results;

    OcclusionQuery part(size_t first, size_t count) const {
        return {rays.subspan(first, count), without.subspan(first, count),
                results.subspan(first, count)};
    }
    bool counts_passes() const { return false; }
    void count_pass(size_t) const {}
    void flag(size_t) const {}
    void set_miss(size_t i) const { results[i] = 0; }
    void set(size_t i, const Hit& hit) const { results[i] = hit.is_hit(); }
    void set(size_t i, const Nearest& nearest) const { results[i] = nearest.is_hit(); }
    bool was_hit(size_t i) const { return results[i] != 0; }
    Hit hit(size_t) const { return {}; } // the triangle is not kept
    /// Rays that have them ask for their nearest hits instead.
    bool has_sieves() const { return false; }
    void may_pass_by(std::span<Hit>) {}
    void pass_by(size_t) const {}
};

} // namespace ovc
