// SPDX-License-Identifier: Apache-2.0
// Tracing: what waves, resolving and passes are handed.
#pragma once

#include "plugin/built_scene.h"
#include "plugin/call_watch.h"
#include "plugin/two_level_options.h"

#include <cstdint>

namespace ovc {

/// Sums over the life of a structure. Fields as in ovc_statistics.
struct TraceStatistics {
    uint64_t passes = 0;
    uint64_t pages_in = 0;
    uint64_t bytes_in = 0;
    uint64_t nearest_rays = 0;
    uint64_t occlusion_rays = 0;
    uint64_t invalid_rays = 0;
    uint64_t ray_visits = 0;
    uint64_t flagged = 0;
    uint64_t retraced = 0;
    uint64_t capped = 0;
    uint64_t queues = 0; // of rays waiting for a leaf that was moved in
    uint64_t queued_rays = 0;
    uint64_t longest_queue = 0;
    uint64_t stragglers = 0; // answered in double, because too few waited to move a page for
    uint64_t peak_bytes = 0;
    double seconds_trace = 0;
    double seconds_kernel = 0;
    double seconds_pass = 0;
};

/// All of it outlives what it is handed to.
struct Tracing {
    const BuiltScene& scene;
    const TwoLevelOptions& options;
    TraceStatistics& statistics;
    CallWatch& watch;
};

} // namespace ovc
