// SPDX-License-Identifier: Apache-2.0
// Takes medians and divides them.
#include "host/bench/ratios/ratios.h"

#include <algorithm>
#include <cassert>
#include <functional>

namespace ovc {

Spread spread_of(std::span<const double> values) {
    assert(!values.empty());
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    const size_t half = sorted.size() / 2;
    const double median = sorted.size() % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
    return {sorted.front(), median, sorted.back()};
}

std::optional<double> mrays(const Measurement& m, double seconds) {
    if (!(seconds > 0))
        return {};
    return double(m.rays) / seconds * 1e-6;
}

static std::optional<double> quotient(double over, double under) {
    if (!(over > 0 && under > 0))
        return {};
    return over / under;
}

double call_seconds(const Measurement& m) {
    return spread_of(m.seconds).median;
}

static double cpu_seconds(const Measurement& m) {
    return spread_of(m.cpu_seconds).median;
}

double kernel_seconds(const Measurement& m) {
    return spread_of(kernel_turns(m)).median;
}

std::span<const double> kernel_turns(const Measurement& m) {
    return spread_of(m.kernel_seconds).median > 0 ? m.kernel_seconds : m.seconds;
}

/// Returns the first measurement of a matching contender at the workload of m, or null.
static const Measurement* find(const BenchResult& result, const Measurement& m,
                               const std::function<bool(const Contender&)>& matches) {
    for (const Measurement& other : result.measurements)
        if (other.workload == m.workload && matches(result.entrants[other.entrant].contender))
            return &other;
    return nullptr;
}

std::optional<double> kernel_speed_to(const BenchResult& result, const Measurement& m,
                                      std::string_view peer) {
    const Measurement* other = find(result, m, [&](const Contender& c) { return c.name == peer; });
    if (!other)
        return {};
    return quotient(kernel_seconds(*other), kernel_seconds(m));
}

Ratios ratios_of(const BenchResult& result, const Measurement& m) {
    const Contender& self = result.entrants[m.entrant].contender;
    Ratios ratios;
    if (const Measurement* robust =
            find(result, m, [](const Contender& c) { return c.name == "embree-robust"; })) {
        ratios.call_speed_to_robust = quotient(call_seconds(*robust), call_seconds(m));
        ratios.kernel_speed_to_robust = kernel_speed_to(result, m, "embree-robust");
        ratios.cpu_speed_to_robust = quotient(cpu_seconds(*robust), cpu_seconds(m));
    }
    if (self.kind != ContenderKind::TwoLevel)
        return ratios;
    const Measurement* fast = find(result, m, [&](const Contender& c) {
        return c.kind == self.kind && c.precision == OVC_PRECISION_FAST &&
               c.kernel == self.kernel && c.leaves.words == self.leaves.words &&
               c.budget.words == self.budget.words && c.instances.words == self.instances.words;
    });
    if (fast) {
        ratios.call_time_to_fast = quotient(call_seconds(m), call_seconds(*fast));
        ratios.kernel_time_to_fast = quotient(kernel_seconds(m), kernel_seconds(*fast));
        ratios.cpu_time_to_fast = quotient(cpu_seconds(m), cpu_seconds(*fast));
    }
    if (const Measurement* first =
            find(result, m, [&](const Contender& c) { return c.name == self.name; })) {
        ratios.call_time_to_first = quotient(call_seconds(m), call_seconds(*first));
        ratios.kernel_time_to_first = quotient(kernel_seconds(m), kernel_seconds(*first));
    }
    return ratios;
}

std::optional<double> build_time_to_embree(const BenchResult& result, const BenchEntrant& entrant) {
    for (const BenchEntrant& other : result.entrants)
        if (other.contender.name == "embree-medium")
            return quotient(entrant.build_seconds(), other.build_seconds());
    return {};
}

std::optional<double> bytes_a_triangle(const BenchResult& result, const BenchEntrant& entrant) {
    return quotient(double(entrant.built.level2_bytes), double(result.triangles));
}

} // namespace ovc
