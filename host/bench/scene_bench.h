// SPDX-License-Identifier: Apache-2.0
// Benches one scene: reads it, gives it a camera and lights where it has none, builds contenders
// over it and times them in turn.
#pragma once

#include "core/system/log.h"
#include "host/bench/bench.h"

#include <functional>
#include <string>
#include <vector>

namespace ovc {

class TerminalLine;

/// The workloads of a bench.
struct Asked {
    /// The names of workloads to keep of those asked for below; empty: all of them. Rays at edges
    /// and corners ("edges") and small calls ("primary-small" and so on) are asked for here alone.
    std::vector<std::string> only;
    ImageSize size;
    bool ray_sets = true; // primary, shadow, diffuse
    bool frame = true;
    bool float_rays = false;             // rays in numbers that floats have
    std::vector<uint32_t> primary_sides; // also camera rays of squares of so many pixels a side
};

struct SceneBench {
    std::string scene; // a file, or a test scene's name
    std::string model; // a file, for test scenes that show a model; or empty
    Asked asked;
    uint32_t repeats = 5;
    std::vector<Contender> contenders;
    std::string device;
    ovc_ranks_own ranks_own = OVC_RANKS_OWN_AUTO; // where there are several ranks
    /// The first contender is the reference, instead of the CPU KDT, which takes minutes to build
    /// over tens of millions of triangles.
    bool first_is_reference = false;
    /// What all contenders may take of host memory together, with the scene, which is in .ovc; then
    /// the first is the reference as well. 0: no limit.
    uint64_t host_bytes = 0;
};

/// The ways in which a run of the bench talks to its user.
struct BenchSurroundings {
    const StopRequest& stop;
    const LogSink& log;
    TerminalLine& progress;
};

/// Returns the result; `complete` is false where the run was stopped. Error: a scene that cannot be
/// read, a contender that fails.
Result<BenchResult> bench_scene(const SceneBench& job, const BenchSurroundings& around);

} // namespace ovc
