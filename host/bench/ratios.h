// SPDX-License-Identifier: Apache-2.0
// What a bench's seconds mean: medians, rates, and how contenders compare.
#pragma once

#include "host/bench/bench.h"

#include <optional>
#include <span>

namespace ovc {

struct Spread {
    double min = 0;
    double median = 0; // of an even count the mean of the two in the middle
    double max = 0;
};

/// values: at least one (asserted).
Spread spread_of(std::span<const double> values);

/// Million rays a second; nothing where no time was taken.
std::optional<double> mrays(const Measurement& m, double seconds);

/// What a contender takes to answer rays that are where it wants them: a median. Of the plugin the
/// kernel alone, of Embree what its own functions take; of the others the whole call. Of those that
/// run on the CPU, software renderers included, CPU seconds of a thread.
double kernel_seconds(const Measurement& m);
/// Median of its calls.
double call_seconds(const Measurement& m);

/// The peer's kernel seconds over these, at the same workload. Nothing where the peer did not take
/// part.
std::optional<double> kernel_speed_to(const BenchResult& result, const Measurement& m,
                                      std::string_view peer);

/// Of medians, at the same workload. Nothing where the other did not take part.
struct Ratios {
    std::optional<double> call_speed_to_robust; // embree-robust's time over this one's
    std::optional<double> kernel_speed_to_robust;
    std::optional<double> cpu_speed_to_robust;
    std::optional<double> call_time_to_fast; // this one's time over fast's: same kernel, same sweep
    std::optional<double> kernel_time_to_fast;
    std::optional<double> cpu_time_to_fast;
    std::optional<double> call_time_to_first; // over that of the first values of its sweep
    std::optional<double> kernel_time_to_first;
};

Ratios ratios_of(const BenchResult& result, const Measurement& m);

/// Its build time over that of embree-medium.
std::optional<double> build_time_to_embree(const BenchResult& result, const BenchEntrant& entrant);

/// Bytes of all pages a triangle; nothing for who has no pages.
std::optional<double> bytes_a_triangle(const BenchResult& result, const BenchEntrant& entrant);

} // namespace ovc
