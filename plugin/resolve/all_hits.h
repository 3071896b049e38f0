// SPDX-License-Identifier: Apache-2.0
// Finds all hits of rays: the first ones by passes, each of which finds one hit more of every ray,
// and the others on the CPU, where one walk finds all that a ray has left.
#pragma once

#include "core/all_hits.h"
#include "core/exclusions.h"
#include "core/ray_span.h"
#include "core/result.h"
#include "plugin/resolve/tracing.h"

#include <functional>

namespace ovc {

/// Sets hits, one per ray, to the nearest hits that are not excluded.
using TraceNearest =
    std::function<Result<Done>(RaySpan rays, const Exclusions& without, std::span<Hit> hits)>;

/// Writes the hits of the rays that are not excluded to `all`. Error: as of trace_nearest(), or of
/// the kind Cancelled.
Result<Done> trace_all_hits(const Tracing& tracing, const TraceNearest& trace_nearest,
                            const RaySpan& rays, const Exclusions& without, const AllHits& all);

} // namespace ovc
