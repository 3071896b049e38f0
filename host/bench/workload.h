// SPDX-License-Identifier: Apache-2.0
// A Workload is a task that every contender is timed at: answering a set of rays, or rendering a
// whole frame.
#pragma once

#include "core/file/image.h"
#include "core/scene.h"
#include "host/bench/ray_sets.h"
#include "host/suites/judge.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace ovc {

/// Returns true to ask a running workload to end early, which then loses its work.
using StopRequest = std::function<bool()>;

struct NearestTask {
    std::vector<Ray> rays;
    std::vector<Hit> hits; // one a ray
    size_t call_rays;      // of each call, except for the last
};

struct OcclusionTask {
    std::vector<Ray> rays;
    std::vector<uint8_t> occluded; // one a ray
    size_t call_rays;              // as above
};

struct FrameTask {
    const Scene* scene;
    Camera camera;
    ImageSize size;
    StopRequest stop;
    Image image;
};

/// A task with the answers of its last run.
struct Workload {
    std::string name;
    std::variant<NearestTask, OcclusionTask, FrameTask> task;

    /// Does the work, which is timed, and returns how many rays were traced.
    Result<uint64_t> run(Backend& backend);
    /// Returns a number for each ray or pixel of the last run. Equal answers have equal numbers.
    std::vector<uint64_t> answers() const;
    /// Judges the answers of the last run; `right` are answers() and distances() of the same run by
    /// another backend. Zeros for a frame, whose pixels are not judged.
    Verdicts judged(const Soup& soup, std::span<const uint64_t> right,
                    std::span<const double> right_distances) const;
    /// Returns how far along each ray of the last run its answer is: t, or infinity for a miss;
    /// 0 or infinity for occlusion. Empty for a frame.
    std::vector<double> distances() const;
};

/// The differences of distances from the right ones.
struct DistanceError {
    double largest = 0;      // |t - right t| / |right t| where both hit, even different triangles
    double rms = 0;          // the root mean square of the same
    double largest_ulps = 0; // |t - right t| in units of the last place of a float at right t
};

/// Returns the errors of `distances`, which has the size of `right` (asserted). Where the right t
/// is 0, any other t is an error of 1.
DistanceError distance_error(std::span<const double> distances, std::span<const double> right);

/// Returns a workload that answers the rays. Its answers are the triangles' ids, mesh in the upper
/// half, or 1 and 0 for occlusion.
Workload ray_workload(RaySet set);

inline constexpr size_t kSmallCallRays = 1024;
inline constexpr const char* kSmall = "-small"; // behind the name of such a workload
/// Returns the workload with kSmallCallRays rays in a call instead of all. Not for a frame.
Workload in_small_calls(Workload workload);

/// Rounds the workload's rays to floats, so that contenders that take floats answer the same rays.
void round_rays(Workload& workload);

/// Returns a workload that renders a frame with shadows; its answers are pixels. `scene` must
/// outlive it.
Workload frame_workload(const Scene& scene, const Camera& camera, uint32_t width, uint32_t height,
                        StopRequest stop);

/// Returns the 64-bit FNV-1a hash of the answers' bytes, least significant first.
uint64_t checksum(std::span<const uint64_t> answers);

} // namespace ovc
