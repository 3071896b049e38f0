// SPDX-License-Identifier: Apache-2.0
// Measures in one run everything that the table of bars needs.
#pragma once

#include "host/bench/bars/bars.h"
#include "host/bench/scene_bench.h"

#include <string>
#include <vector>

namespace ovc {

struct BarsJob {
    std::string mesh; // the file of the Stanford dragon, to compare with docs/benchmarks.md
    std::string device;
    uint32_t size = 1024; // pixels a side; half of it for slivers, architecture and programs
    uint32_t repeats = 5;
    bool scene_alone = false; // leaves out the lines about test scenes
};

struct BarsResult {
    std::vector<Bar> bars;
    std::vector<BenchResult> scenes;
    std::optional<ProgramsResult> programs;
    bool complete = true; // false: the run was stopped
};

/// Returns all bars, after a few minutes on two cores. The calling process must have run no
/// parallel loop yet (measure_import()). job.mesh: a file, or a test scene, which is written to a
/// file first. Error: the mesh cannot be read, a contender or a program fails, a certified answer
/// is wrong.
Result<BarsResult> run_bars(const BarsJob& job, const BenchSurroundings& around);

/// Returns times of whole programs: `runs` timed runs of each over the mesh, as above, drawing size
/// x size pixels.
Result<ProgramsResult> run_programs(const std::string& mesh, uint32_t size, uint32_t runs,
                                    const BenchSurroundings& around);

} // namespace ovc
