// SPDX-License-Identifier: Apache-2.0
// Sweeps: what the plugin's work costs as it grows, with the exponent that fits.
#pragma once

#include "host/bench/bench_arguments.h"
#include "host/bench/scene_bench.h"

#include <optional>
#include <string>
#include <vector>

namespace ovc {

struct SweepRow {
    double x = 0;
    std::vector<std::optional<double>> values; // as the columns
};

struct Sweep {
    std::string scene;
    std::string over;                 // "rays"
    std::vector<std::string> columns; // "certified: call s"
    std::vector<SweepRow> rows;       // by growing x
    bool complete = false;            // false: it was stopped
};

/// rays: 1e3 to 1e7 camera rays of the scene; triangles: spheres of 5e3 to 2e7; leaves: 1 to 1000;
/// budget: 5 % to 100 % of the bytes of all pages. Certified answers; errors as of bench_scene().
Result<Sweep> run_sweep(const BenchJob& job, const BenchSurroundings& around);

/// k of the power law c x^k nearest to a column, by least squares of logarithms. Nothing where
/// fewer than two rows have a value above 0.
std::optional<double> fitted_exponent(const Sweep& sweep, size_t column);

/// Markdown: a line a row, exponents last; with a line end.
std::string sweep_table(const Sweep& sweep);
std::string sweep_json(const Sweep& sweep);

} // namespace ovc
