// SPDX-License-Identifier: Apache-2.0
#include "gpu/tuning/comparison.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace ovc {

std::optional<VariantComparison> compare(const KernelVariant& base, const KernelVariant& candidate,
                                         const ComparisonLimits& limits, TimeVariant time) {
    const size_t rounds = limits.rounds;
    assert(rounds > 0);
    if (!time(base) || !time(candidate))
        return {};
    std::vector<double> ratios;
    std::vector<double> base_seconds;
    for (size_t round = 0; round < rounds; ++round) {
        // The order changes, so that neither is always the one whose pages are in the caches.
        const bool base_first = round % 2 == 0;
        const std::optional<double> a = time(base_first ? base : candidate);
        const std::optional<double> b = time(base_first ? candidate : base);
        if (!a || !b)
            return {};
        const double of_base = base_first ? *a : *b, of_candidate = base_first ? *b : *a;
        ratios.push_back(of_candidate / std::max(of_base, 1e-12));
        base_seconds.push_back(of_base);
    }
    std::ranges::sort(ratios);
    VariantComparison found;
    found.ratio = ratios[rounds / 2];
    found.base_seconds = *std::ranges::min_element(base_seconds);
    // That is 11 of 15 rounds; by chance alone as many would be faster once in 17 comparisons, and
    // whatever gains is compared twice.
    const size_t surely = rounds - std::max<size_t>(rounds, 3) / 3 + 1;
    found.is_faster = found.ratio < 1 - limits.worthwhile && ratios[surely - 1] < 1;
    return found;
}

} // namespace ovc
