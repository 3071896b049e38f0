// SPDX-License-Identifier: Apache-2.0
// Computes medians and rates from a bench's seconds, and ratios between contenders.
#pragma once

#include "host/bench/bench.h"

#include <optional>
#include <span>

namespace ovc {

struct Spread {
    double min = 0;
    double median = 0; // the mean of the two in the middle where the count is even
    double max = 0;
};

/// Returns min, median and max of `values`, at least one (asserted).
Spread spread_of(std::span<const double> values);

/// Returns million rays a second, or nothing where `seconds` is not above 0.
std::optional<double> mrays(const Measurement& m, double seconds);

/// Returns the median seconds that a contender takes once rays lie where it wants them: the kernel
/// alone for the plugin, its own functions for Embree, the whole call for others. For contenders on
/// the CPU, software renderers included, these are CPU seconds of a thread.
double kernel_seconds(const Measurement& m);
/// Returns the seconds of the calls that it is the median of.
std::span<const double> kernel_turns(const Measurement& m);
/// Returns the median of the calls' wall-clock seconds.
double call_seconds(const Measurement& m);

/// Returns the peer's kernel seconds divided by those of m, at the same workload, or nothing where
/// the peer did not take part.
std::optional<double> kernel_speed_to(const BenchResult& result, const Measurement& m,
                                      std::string_view peer);

/// Ratios of medians between contenders at the same workload. A ratio is empty where the other
/// contender did not take part.
struct Ratios {
    std::optional<double> call_speed_to_robust; // embree-robust's time over this one's
    std::optional<double> kernel_speed_to_robust;
    std::optional<double> cpu_speed_to_robust;
    std::optional<double> call_time_to_fast; // this one's time over fast's: same kernel, same sweep
    std::optional<double> kernel_time_to_fast;
    std::optional<double> cpu_time_to_fast;
    std::optional<double> call_time_to_first; // over the time at the first value of its sweep
    std::optional<double> kernel_time_to_first;
};

Ratios ratios_of(const BenchResult& result, const Measurement& m);

/// Returns the entrant's build time divided by that of embree-medium, or nothing where that did not
/// take part.
std::optional<double> build_time_to_embree(const BenchResult& result, const BenchEntrant& entrant);

/// Returns the bytes of all pages divided by the triangles, or nothing for a contender without
/// pages.
std::optional<double> bytes_a_triangle(const BenchResult& result, const BenchEntrant& entrant);

} // namespace ovc
