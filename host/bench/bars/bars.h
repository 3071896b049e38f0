// SPDX-License-Identifier: Apache-2.0
// Bars: how fast and how lean Overcast is promised to be, each line measured and held to it.
#pragma once

#include "host/bench/bench.h"
#include "host/bench/programs/import_cost.h"
#include "host/bench/programs/programs.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

enum class Better { More, Less };

/// A line of the table.
struct Bar {
    std::string what;
    Better better = Better::More;
    double at_least = 0; // at most, where less is better
    double aim = 0;
    std::optional<double> measured;
    std::string note; // where nothing was measured, why; else what the figure is of

    bool passed() const;
};

/// "passed", "failed", or "skipped" where nothing was measured.
std::string_view verdict(const Bar& bar);

/// Kernel seconds of Embree's robust mode and of the CPU KDT in float over ours, the frame in
/// certified precision over that in fast; of the contenders certified, fast, embree-robust,
/// cpu-float-kdtree.
std::vector<Bar> kernel_bars(const BenchResult& mesh);
/// Kernel seconds of Embree's high quality over ours, a line for each set of rays.
std::vector<Bar> high_quality_bars(const BenchResult& scene, const std::string& what);
/// Call seconds over those of one leaf, all sets of rays together; entrants are sweep values of
/// certified, the first of one leaf.
std::vector<Bar> leaves_bars(const BenchResult& sweep);
/// Kernel seconds over those of one leaf, the worst of all sets of rays; entrants as above.
std::vector<Bar> leaves_of_scene_bars(const BenchResult& sweep, const std::string& what);
/// Kernel seconds of Embree's robust mode over ours, with the plugin's own choice of leaves.
std::vector<Bar> default_leaves_bars(const BenchResult& scene, const std::string& what);
/// The frame's call seconds under a budget over those with all pages resident.
Bar budget_bar(const BenchResult& sweep);
Bar bytes_bar(const BenchResult& scene, const std::string& what, double at_least, double aim);
/// The worst over all entrants on the GPU: peak less budget, bytes.
Bar peak_bar(std::span<const BenchResult> results);
std::vector<Bar> program_bars(const ProgramsResult& programs);
/// files: with what they are called. The last is the binary PLY file.
std::vector<Bar> import_bars(std::span<const std::pair<std::string, ImportCost>> files);
/// A line that was not measured, and why.
Bar skipped_bar(std::string what, std::string why);

/// Markdown, and a sentence on how many lines hold; with a line end.
std::string bars_table(std::span<const Bar> bars);
std::string bars_json(std::span<const Bar> bars, std::span<const BenchResult> results,
                      const ProgramsResult* programs);

} // namespace ovc
