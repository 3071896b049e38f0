// SPDX-License-Identifier: Apache-2.0
// Everything that the table of bars needs, measured in one run.
#pragma once

#include "host/bench/bars/bars.h"
#include "host/bench/scene_bench.h"

#include <string>
#include <vector>

namespace ovc {

struct BarsJob {
    std::string mesh; // the file of the Stanford dragon, to compare with docs/benchmarks.md
    std::string device;
    uint32_t size = 1024; // of pictures, pixels a side; slivers, architecture and programs: half
    uint32_t repeats = 5;
};

struct BarsResult {
    std::vector<Bar> bars;
    std::vector<BenchResult> scenes;
    std::optional<ProgramsResult> programs;
    bool complete = true; // false: it was stopped
};

/// A few minutes on two cores. The calling process has run no parallel loop yet. mesh: a file, or a
/// test scene, of which a file is made first. Error: the mesh cannot be read, a contender or a
/// program fails.
Result<BarsResult> run_bars(const BarsJob& job, const BenchSurroundings& around);

/// Whole programs alone: `runs` timed runs of each over the mesh, as above, of size x size pixels.
Result<ProgramsResult> run_programs(const std::string& mesh, uint32_t size, uint32_t runs,
                                    const BenchSurroundings& around);

} // namespace ovc
