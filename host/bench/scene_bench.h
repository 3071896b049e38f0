// SPDX-License-Identifier: Apache-2.0
// A bench of one scene: it is read, dressed with a camera and lights, contenders are built over it
// and asked in turn.
#pragma once

#include "core/system/log.h"
#include "host/bench/bench.h"

#include <functional>
#include <string>
#include <vector>

namespace ovc {

class TerminalLine;

/// Which rays contenders are asked.
struct Asked {
    /// Keeps those workloads alone that have these names; empty: all that is asked for below.
    std::vector<std::string> only;
    ImageSize size;
    bool ray_sets = true; // primary, shadow, diffuse
    bool frame = true;
    bool edges = false;                  // rays at edges and corners
    std::vector<uint32_t> primary_sides; // besides: camera rays of squares of so many pixels a side
};

struct SceneBench {
    std::string scene;
    std::string model; // of scenes that show one; or empty
    Asked asked;
    uint32_t repeats = 5;
    std::vector<Contender> contenders;
    std::string device;
    /// The first contender says what is right, instead of the CPU KDT, which takes minutes to build
    /// over tens of millions of triangles.
    bool first_is_reference = false;
};

/// What a run of the bench has to do with its surroundings.
struct BenchSurroundings {
    const StopRequest& stop;
    const LogSink& log;
    TerminalLine& progress;
};

/// complete is false where it was stopped. Error: a scene that cannot be read, a contender that
/// fails.
Result<BenchResult> bench_scene(const SceneBench& job, const BenchSurroundings& around);

} // namespace ovc
