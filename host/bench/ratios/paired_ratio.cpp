// SPDX-License-Identifier: Apache-2.0
// Divides times turn by turn.
#include "host/bench/ratios/paired_ratio.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ovc {

/// Returns how many of `count` sorted values are left out at each end: as many as there may be,
/// where the median is as likely to lie above a value as below it.
static size_t left_out(size_t count) {
    double share = std::pow(0.5, double(count)); // of cases in which `out` values lie below
    double below = share;                        // in which so many or fewer do
    size_t out = 0;
    while (true) {
        share *= double(count - out) / double(out + 1);
        if (below + share > 0.05)
            return out;
        below += share;
        ++out;
    }
}

std::optional<PairedRatio> paired_ratio(std::span<const double> over,
                                        std::span<const double> under) {
    if (over.empty() || over.size() != under.size())
        return {};
    std::vector<double> ratios;
    for (size_t i = 0; i < over.size(); ++i) {
        if (!(over[i] > 0 && under[i] > 0))
            return {};
        ratios.push_back(over[i] / under[i]);
    }
    std::ranges::sort(ratios);
    const size_t count = ratios.size(), half = count / 2, out = left_out(count);
    const double median = count % 2 ? ratios[half] : (ratios[half - 1] + ratios[half]) / 2;
    return PairedRatio{median, ratios[out], ratios[count - 1 - out]};
}

} // namespace ovc
