// SPDX-License-Identifier: Apache-2.0
// Reads ovc_query, of this header or of an earlier one, and the rays in the format that it names.
#pragma once

#include "core/ray_span.h"
#include "core/text/format_text.h"
#include "plugin/abi/scene_call.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace ovc {

static_assert(sizeof(ovc_ray_float) == sizeof(FloatRay) &&
              offsetof(ovc_ray_float, t_min) == offsetof(FloatRay, t_min) &&
              offsetof(ovc_ray_float, dir) == offsetof(FloatRay, dir) &&
              offsetof(ovc_ray_float, t_max) == offsetof(FloatRay, t_max));

/// Returns the caller's query with defaults for the fields that it lacks, or for all where it is
/// NULL. Throws a Failure for a query that is wrong.
inline ovc_query complete(const ovc_query* query) {
    ovc_query all{};
    all.struct_size = sizeof(all);
    if (!query)
        return all;
    constexpr size_t sizes[] = {offsetof(ovc_query, leaf), offsetof(ovc_query, flagged),
                                offsetof(ovc_query, ray_format), sizeof(ovc_query)};
    if (std::find(std::begin(sizes), std::end(sizes), query->struct_size) == std::end(sizes))
        invalid(format_text("ovc_query.struct_size is {}, expected sizeof(ovc_query) = {}",
                            query->struct_size, sizeof(ovc_query)));
    std::memcpy(&all, query, query->struct_size);
    if (all.ray_format > OVC_RAY_FLOAT)
        invalid(format_text("ovc_query.ray_format is {}, expected 0 or 1", all.ray_format));
    if (all.reserved)
        invalid(format_text("ovc_query.reserved is {}, expected 0", all.reserved));
    return all;
}

inline RaySpan rays_of(const ovc_query& query, const ovc_ray* rays, size_t ray_count) {
    if (query.ray_format == OVC_RAY_FLOAT)
        return RaySpan(std::span(reinterpret_cast<const FloatRay*>(rays), ray_count));
    return RaySpan(std::span(reinterpret_cast<const Ray*>(rays), ray_count));
}

/// Returns the triangle that each ray does not see; empty where there are none.
inline std::span<const TriangleId> skip_of(const ovc_query& query, size_t ray_count) {
    if (!query.skip)
        return {};
    return {reinterpret_cast<const TriangleId*>(query.skip), ray_count};
}

/// Returns the caller's buffers for notes on rays; each of the spans may be empty.
inline RayNotes notes_of(const ovc_query& query, size_t ray_count) {
    const auto span = [&](uint32_t* notes) {
        return notes ? std::span(notes, ray_count) : std::span<uint32_t>();
    };
    return {span(query.leaf), span(query.passes), span(query.flagged)};
}

inline void refuse_notes(const char* call, const ovc_query& query) {
    if (query.leaf || query.passes || query.flagged)
        invalid(format_text("{}: ovc_query.leaf, passes and flagged are for intersect", call));
}

inline void refuse_progress(const char* call, const ovc_query& query) {
    if (query.progress)
        invalid(format_text(
            "{}: ovc_query.progress is for intersect and occluded and their submitted forms",
            call));
}

} // namespace ovc
