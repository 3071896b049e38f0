// SPDX-License-Identifier: Apache-2.0
// A call of intersect or occluded, whether it is waited for or submitted: its arguments checked,
// then traced.
#pragma once

#include "plugin/query_call.h"

namespace ovc {

struct RayCall {
    const char* name = ""; // as in messages
    bool any_hit = false;
    ovc_query query{};
    RaySpan rays;
    std::span<Hit> hits;         // where not any_hit
    std::span<uint8_t> occluded; // where any_hit
};

inline void check_buffers(const char* name, const void* rays, const void* answers, size_t count) {
    if (count && (!rays || !answers))
        invalid(fmt::format("{}: rays or the answers' buffer is NULL", name));
}

/// Throws a Failure for arguments that make no sense.
inline RayCall nearest_call(const char* name, const ovc_ray* rays, size_t count, ovc_hit* hits,
                            const ovc_query* query) {
    check_buffers(name, rays, hits, count);
    const ovc_query asked = complete(query);
    return {.name = name,
            .query = asked,
            .rays = rays_of(asked, rays, count),
            .hits = {reinterpret_cast<Hit*>(hits), count}};
}

inline RayCall occlusion_call(const char* name, const ovc_ray* rays, size_t count,
                              uint8_t* occluded, const ovc_query* query) {
    check_buffers(name, rays, occluded, count);
    const ovc_query asked = complete(query);
    refuse_notes(name, asked);
    return {.name = name,
            .any_hit = true,
            .query = asked,
            .rays = rays_of(asked, rays, count),
            .occluded = {occluded, count}};
}

inline void check_notes(const RayCall& call, const Structure& structure) {
    if (notes_of(call.query, call.rays.size()).any() && !structure.takes_notes())
        invalid(fmt::format("{}: this structure cannot tell ovc_query.leaf, passes or flagged",
                            call.name));
}

[[noreturn]] inline void cancelled(const char* name) {
    throw Failure{OVC_ERROR_CANCELLED, fmt::format("{}: cancelled", name)};
}

/// With the scene's turn. watch: nullptr, or asked between passes. Throws a Failure.
inline void trace(const RayCall& call, Structure& structure, TraceWatch* watch) {
    check_notes(call, structure);
    const auto skip = skip_of(call.query, call.rays.size());
    const Structure::Watched watched(structure, watch);
    if (watch && !watch->goes_on(0))
        cancelled(call.name);
    const Result<Done> done =
        call.any_hit ? structure.occluded(call.rays, skip, call.occluded)
                     : structure.intersect_noted(call.rays, skip, call.hits,
                                                 notes_of(call.query, call.rays.size()));
    if (!done && done.error().kind == ErrorKind::Cancelled)
        cancelled(call.name);
    check(done);
}

} // namespace ovc
