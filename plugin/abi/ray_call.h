// SPDX-License-Identifier: Apache-2.0
// RayCall: a call of intersect or occluded, whether it is waited for or submitted, whose arguments
// have been checked.
#pragma once

#include "core/text/format_text.h"
#include "plugin/abi/query_call.h"

#include <cassert>
#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

struct RayCall {
    const char* name = ""; // as in messages
    bool any_hit = false;
    ovc_query query{};
    RaySpan rays;
    std::span<Hit> hits;            // one per ray, or max_hits, unless any_hit
    std::span<uint8_t> occluded;    // one per ray, if any_hit
    std::optional<size_t> max_hits; // of a ray, of which all hits are asked for
    std::span<uint64_t> counts;     // empty, or one per ray, if so

    bool has_buffers() const {
        return any_hit ? occluded.size() == rays.size()
                       : hits.size() == rays.size() * max_hits.value_or(1);
    }
};

inline void check_buffers(const char* name, const void* rays, const void* answers, size_t count) {
    if (count && (!rays || !answers))
        invalid(format_text("{}: rays or the answers' buffer is NULL", name));
}

/// One of the caller's buffers.
struct BufferRange {
    const char* name;
    const void* begin; // NULL: there is none
    size_t bytes;
    bool is_written;

    bool overlaps(const BufferRange& other) const {
        const auto mine = reinterpret_cast<uintptr_t>(begin);
        const auto theirs = reinterpret_cast<uintptr_t>(other.begin);
        return begin && other.begin && mine < theirs + other.bytes && theirs < mine + bytes;
    }
};

/// Throws a Failure where an answer would be written over rays that are still to be read, or over
/// another answer.
inline void check_apart(const char* name, const void* rays, const void* answers,
                        size_t answer_bytes, size_t count, const ovc_query& query) {
    const size_t ray_bytes =
        query.ray_format == OVC_RAY_FLOAT ? sizeof(ovc_ray_float) : sizeof(ovc_ray);
    const size_t notes_bytes = count * sizeof(uint32_t);
    const BufferRange buffers[] = {
        {"rays", rays, count * ray_bytes, false},
        {"ovc_query.skip", query.skip, count * sizeof(ovc_triangle), false},
        {"ovc_query.after", query.after == answers ? nullptr : query.after, count * sizeof(ovc_hit),
         false},
        {"ovc_query.masks", query.masks, count * sizeof(uint32_t), false},
        {"the answers' buffer", answers, count * answer_bytes, true},
        {"ovc_query.leaf", query.leaf, notes_bytes, true},
        {"ovc_query.passes", query.passes, notes_bytes, true},
        {"ovc_query.flagged", query.flagged, notes_bytes, true},
    };
    for (const BufferRange& a : buffers)
        for (const BufferRange& b : buffers)
            if (&a < &b && b.is_written && a.overlaps(b))
                invalid(format_text("{}: {} and {} overlap, expected buffers apart", name, a.name,
                                    b.name));
}

/// Returns a call for the nearest hits. Throws a Failure for arguments that make no sense.
inline RayCall nearest_call(const char* name, const ovc_ray* rays, size_t count, ovc_hit* hits,
                            const ovc_query* query) {
    check_buffers(name, rays, hits, count);
    const ovc_query asked = complete(query);
    check_apart(name, rays, hits, sizeof(ovc_hit), count, asked);
    return {.name = name,
            .query = asked,
            .rays = rays_of(asked, rays, count),
            .hits = {reinterpret_cast<Hit*>(hits), count}};
}

/// Returns a call for all hits of the rays.
inline RayCall all_hits_call(const ovc_ray* rays, size_t count, size_t max_hits, ovc_hit* hits,
                             uint64_t* counts, const ovc_query* query) {
    constexpr const char* kName = "all_hits";
    constexpr size_t kMaxHits = ~size_t(0) / sizeof(ovc_hit);
    if (count && max_hits > kMaxHits / count)
        invalid(format_text("{}: {} rays times max_hits = {} are more than memory can hold", kName,
                            count, max_hits));
    check_buffers(kName, rays, max_hits ? static_cast<const void*>(hits) : counts, count);
    const ovc_query asked = complete(query);
    refuse_notes(kName, asked);
    check_apart(kName, rays, max_hits ? hits : nullptr, max_hits * sizeof(ovc_hit), count, asked);
    check_apart(kName, rays, counts, sizeof(uint64_t), count, asked);
    const BufferRange first{"hits", hits, count * max_hits * sizeof(ovc_hit), true};
    const BufferRange second{"counts", counts, count * sizeof(uint64_t), true};
    if (max_hits && first.overlaps(second))
        invalid(format_text("{}: hits and counts overlap, expected buffers apart", kName));
    return {.name = kName,
            .query = asked,
            .rays = rays_of(asked, rays, count),
            .hits = {reinterpret_cast<Hit*>(hits), max_hits ? count * max_hits : 0},
            .max_hits = max_hits,
            .counts = {counts, counts ? count : 0}};
}

inline RayCall occlusion_call(const char* name, const ovc_ray* rays, size_t count,
                              uint8_t* occluded, const ovc_query* query) {
    check_buffers(name, rays, occluded, count);
    const ovc_query asked = complete(query);
    refuse_notes(name, asked);
    check_apart(name, rays, occluded, 1, count, asked);
    return {.name = name,
            .any_hit = true,
            .query = asked,
            .rays = rays_of(asked, rays, count),
            .occluded = {occluded, count}};
}

inline void check_notes(const RayCall& call, const Structure& structure) {
    if (notes_of(call.query, call.rays.size()).any() && !structure.takes_notes())
        invalid(format_text("{}: this structure cannot tell ovc_query.leaf, passes or flagged",
                            call.name));
}

/// Returns what the call excludes, without its filter. after: keeps the places that the hits lie
/// behind where the answers are written over the caller's.
inline Exclusions exclusions_of(const RayCall& call, std::vector<Hit>& after) {
    Exclusions without = exclusions_of(call.query, call.rays.size());
    if (call.query.after && without.after.data() == call.hits.data()) {
        after.assign(without.after.begin(), without.after.end());
        without.after = after;
    }
    return without;
}

/// Answers the call, for a thread that has the scene's turn. watch: nullptr, or asked as the rays
/// go on. Throws a Failure.
inline void trace(const RayCall& call, Structure& structure, TraceWatch* watch) {
    assert(call.has_buffers());
    check_notes(call, structure);
    check_structure(call.name, call.query, structure);
    std::vector<Hit> after;
    Exclusions without = exclusions_of(call, after);
    const FilterOf filter(call.query);
    without.sieves.filters = filter.get();
    const CallWatch::Scope watched(structure.call_watch(), watch);
    if (watch && !watch->goes_on(0))
        cancelled(call.name);
    const Result<Done> done =
        call.any_hit ? structure.occluded(call.rays, without, call.occluded)
        : call.max_hits
            ? structure.all_hits(call.rays, without, {*call.max_hits, call.hits, call.counts})
            : structure.intersect_noted(call.rays, without, call.hits,
                                        notes_of(call.query, call.rays.size()));
    filter.check(call.name);
    if (!done && done.error().kind == ErrorKind::Cancelled)
        cancelled(call.name);
    check(done);
}

} // namespace ovc
