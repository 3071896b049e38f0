// SPDX-License-Identifier: Apache-2.0
// Bars state how fast and how lean Overcast is promised to be; each is measured and judged.
#pragma once

#include "host/bench/bench.h"
#include "host/bench/programs/import_cost.h"
#include "host/bench/programs/programs.h"
#include "host/bench/ratios/paired_ratio.h"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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
    std::optional<PairedRatio> turns = {}; // where `measured` is its median

    /// Sets the figure to the median of turns, where there are any.
    void take(const std::optional<PairedRatio>& ratio) {
        turns = ratio;
        if (ratio)
            measured = ratio->median;
    }
    /// Whether the figure would hold.
    bool passed() const { return measured && holds(*measured); }
    /// Whether turns of the measurement differ by more than the figure lies off the bar.
    bool is_too_noisy() const { return turns && holds(turns->low) != holds(turns->high); }

private:
    bool holds(double figure) const {
        return better == Better::More ? figure >= at_least : figure <= at_least;
    }
};

/// Returns "passed" or "failed"; "too noisy" where the turns do not tell; "skipped" where nothing
/// was measured.
std::string_view verdict(const Bar& bar);

/// The promise of a ratio.
struct Promise {
    double at_least, aim;
};
/// One promise each for primary, shadow and diffuse rays.
using PromiseOfSets = std::array<Promise, 3>;

/// Returns a line for each set of rays: the peer's kernel seconds divided by ours, certified.
std::vector<Bar> kernel_bars(const BenchResult& scene, const std::string& what,
                             std::string_view peer, const PromiseOfSets& promises);
/// Returns the same of the seconds from call to return.
std::vector<Bar> call_bars(const BenchResult& scene, const std::string& what, std::string_view peer,
                           const PromiseOfSets& promises);
/// Returns the time of a frame in certified precision divided by that in fast.
Bar certify_bar(const BenchResult& mesh);
/// Returns the call seconds of a ray at a side or corner divided by those of a primary ray.
Bar edges_bar(const BenchResult& mesh);
/// Returns a line for each set of rays: the call seconds of kSmallCallRays rays a call divided by
/// those of all rays in one call.
std::vector<Bar> small_calls_bars(const BenchResult& mesh);
/// Returns call seconds, summed over all sets of rays, divided by those of one leaf. Entrants are
/// certified with several numbers of leaves, the first with one leaf.
std::vector<Bar> leaves_bars(const BenchResult& sweep);
/// Returns kernel seconds divided by those of one leaf, for the worst set of rays. Entrants are as
/// above.
std::vector<Bar> leaves_of_scene_bars(const BenchResult& sweep, const std::string& what);
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
/// Returns a sentence that names the lines which failed; "" where none did.
std::string failed_bars(std::span<const Bar> bars);
std::string bars_json(std::span<const Bar> bars, std::span<const BenchResult> results,
                      const ProgramsResult* programs);

} // namespace ovc
