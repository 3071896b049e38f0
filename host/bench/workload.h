// SPDX-License-Identifier: Apache-2.0
// Workload: something that is timed, the same for every contender: a set of rays to answer, or a
// whole frame to render.
#pragma once

#include "core/scene.h"
#include "host/bench/ray_sets.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

struct Workload {
    std::string name;
    /// What is timed; how many rays it traced.
    std::function<Result<uint64_t>(Backend&)> run;
    /// What the last run answered: a number for each ray or pixel that is equal where the answer
    /// is.
    std::function<std::vector<uint64_t>()> answers;
    /// And how far along each ray its answer is: t, infinity for a miss; occlusion: 0, or infinity.
    /// Of a frame there is none.
    std::function<std::vector<double>()> distances;
};

/// How far distances are from the right ones.
struct DistanceError {
    uint64_t missed = 0; // answered as a miss, and the right answer is a hit
    double largest = 0;  // |t - right t| / |right t| where both hit, whatever triangle
    double rms = 0;      // its root mean square
};

/// As many of each. A right t of 0 is met or counts as an error of 1.
DistanceError distance_error(std::span<const double> distances, std::span<const double> right);

/// True asks a running workload to end early; what it was doing is then lost.
using StopRequest = std::function<bool()>;

/// Its answers are the triangles' names, mesh in the upper half, or 1 and 0 for occlusion.
Workload ray_workload(RaySet set);

/// render_batched with shadows; its answers are pixels. The scene outlives it.
Workload frame_workload(const Scene& scene, const Camera& camera, uint32_t width, uint32_t height,
                        StopRequest stop);

/// FNV-1a of 64 bits over the answers' bytes, least significant first.
uint64_t checksum(std::span<const uint64_t> answers);

} // namespace ovc
