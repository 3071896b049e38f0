// SPDX-License-Identifier: Apache-2.0
// Sweeps measure how the cost of the plugin's work grows, with the exponent that fits.
#pragma once

#include "host/bench/bench_arguments.h"
#include "host/bench/scene_bench.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

struct SweepRow {
    double x = 0;
    std::vector<std::optional<double>> values; // one for each column
};

struct Sweep {
    std::string scene;
    std::string over;                 // "rays"
    std::vector<std::string> columns; // "certified: call s"
    std::vector<SweepRow> rows;       // by growing x
    bool complete = false;            // false: the run was stopped
};

/// Returns the sweep that the job asks for, with certified answers. rays: 1e3 to 1e7 camera rays of
/// the scene; triangles: spheres of 5e3 to 2e7; instances: 1 to 7e4 places of one mesh; leaves: 1
/// to 1000; budget: 5 % to 100 % of the bytes of all pages. Error: as bench_scene(), or --most is
/// below the first row.
Result<Sweep> run_sweep(const BenchJob& job, const BenchSurroundings& around);

/// Returns k of the power law c x^k nearest to a column, by least squares of logarithms. Returns
/// nothing where fewer than two rows have a value above 0, or all have the same x. column: an index
/// of every row's values (asserted).
std::optional<double> fitted_exponent(const Sweep& sweep, size_t column);

/// Returns Markdown, one line for each row and the exponents last, with a line end.
std::string sweep_table(const Sweep& sweep);
std::string sweep_json(const Sweep& sweep);

} // namespace ovc
