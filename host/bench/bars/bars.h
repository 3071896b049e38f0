// SPDX-License-Identifier: Apache-2.0
// Bars state how fast and how lean Overcast is promised to be; each is measured and judged.
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
    double at_least = 0; // the maximum where less is better
    double aim = 0;
    std::optional<double> measured;
    std::string note; // the reason where nothing was measured, else what the figure means

    bool passed() const;
};

/// Returns "passed", "failed", or "skipped" where nothing was measured.
std::string_view verdict(const Bar& bar);

/// Returns the kernel seconds of Embree's robust mode and of the CPU KDT in float divided by ours,
/// and the time of a frame in certified precision divided by that in fast. Contenders: certified,
/// fast, embree-robust, cpu-float-kdtree.
std::vector<Bar> kernel_bars(const BenchResult& mesh);
/// Returns a line for each set of rays: kernel seconds of Embree's high quality divided by ours.
std::vector<Bar> high_quality_bars(const BenchResult& scene, const std::string& what);
/// Returns call seconds, summed over all sets of rays, divided by those of one leaf. Entrants are
/// certified with several numbers of leaves, the first with one leaf.
std::vector<Bar> leaves_bars(const BenchResult& sweep);
/// Returns kernel seconds divided by those of one leaf, for the worst set of rays. Entrants are as
/// above.
std::vector<Bar> leaves_of_scene_bars(const BenchResult& sweep, const std::string& what);
/// Returns kernel seconds of Embree's robust mode divided by ours, with the plugin's own choice of
/// leaves.
std::vector<Bar> default_leaves_bars(const BenchResult& scene, const std::string& what);
/// Returns the frame's call seconds under a budget divided by those with all pages resident.
/// Entrants: certified with all pages resident, then with the budget.
Bar budget_bar(const BenchResult& sweep);
Bar bytes_bar(const BenchResult& scene, const std::string& what, double at_least, double aim);
/// Returns by how many bytes the peak exceeds the budget: the worst entrant on the GPU.
Bar peak_bar(std::span<const BenchResult> results);
std::vector<Bar> program_bars(const ProgramsResult& programs);
/// files: names and costs; the last is the binary PLY file.
std::vector<Bar> import_bars(std::span<const std::pair<std::string, ImportCost>> files);
/// Returns a line that was not measured, with the reason.
Bar skipped_bar(std::string what, std::string why);

/// Returns Markdown and a sentence on how many lines hold, with a line end.
std::string bars_table(std::span<const Bar> bars);
std::string bars_json(std::span<const Bar> bars, std::span<const BenchResult> results,
                      const ProgramsResult* programs);

} // namespace ovc
