// SPDX-License-Identifier: Apache-2.0
// Reads ovc_query, of this header or of an earlier one, and the rays in the format that it names.
#pragma once

#include "core/exclusions.h"
#include "core/ray_span.h"
#include "core/text/format_text.h"
#include "plugin/abi/asked_filter.h"
#include "plugin/abi/scene_call.h"
#include "plugin/abi/struct_size.h"

#include <cstddef>

namespace ovc {

static_assert(sizeof(ovc_ray_float) == sizeof(FloatRay) &&
              offsetof(ovc_ray_float, t_min) == offsetof(FloatRay, t_min) &&
              offsetof(ovc_ray_float, dir) == offsetof(FloatRay, dir) &&
              offsetof(ovc_ray_float, t_max) == offsetof(FloatRay, t_max));

/// Returns the caller's query with defaults for the fields that it lacks, or for all where it is
/// NULL. Throws a Failure for a query that is wrong.
inline ovc_query complete(const ovc_query* query) {
    if (!query)
        return {.struct_size = sizeof(ovc_query)};
    const ovc_query all = whole("ovc_query", query, offsetof(ovc_query, leaf));
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

/// Returns the hits that the query excludes, without its filter.
inline Exclusions exclusions_of(const ovc_query& query, size_t ray_count) {
    const size_t skipped = query.skip ? ray_count : 0, behind = query.after ? ray_count : 0;
    Exclusions without(std::span(reinterpret_cast<const TriangleId*>(query.skip), skipped),
                       std::span(reinterpret_cast<const Hit*>(query.after), behind));
    without.sieves.masks = {query.masks, query.masks ? ray_count : 0};
    return without;
}

/// The filter of a query, for the time of a call.
class FilterOf {
public:
    explicit FilterOf(const ovc_query& query) : asked_(query.filter, query.filter_user) {}
    FilterOf(const FilterOf&) = delete;

    /// Returns it, or nothing where the query has none.
    std::span<HitFilter* const> get() const {
        return {&filter_, asked_.is_there() ? size_t(1) : 0};
    }
    /// Throws a Failure where the filter has stopped the call.
    void check(const char* call) const {
        if (asked_.stopped())
            cancelled(call);
    }

private:
    AskedFilter asked_;
    HitFilter* const filter_ = &asked_;
};

/// Returns the caller's buffers for notes on rays; each of the spans may be empty.
inline RayNotes notes_of(const ovc_query& query, size_t ray_count) {
    const auto span = [&](uint32_t* notes) {
        return notes ? std::span(notes, ray_count) : std::span<uint32_t>();
    };
    return {span(query.leaf), span(query.passes), span(query.flagged)};
}

inline void check_structure(const char* call, const ovc_query& query, const Structure& structure) {
    if ((query.after || query.masks || query.filter) && !structure.takes_after())
        invalid(format_text("{}: this structure cannot do ovc_query.after, masks or filter", call));
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
