// SPDX-License-Identifier: Apache-2.0
// Compares each choice with each.
#include "host/report/page/frontier.h"

#include <cassert>

namespace ovc {

static bool dominates(const Choice& a, const Choice& b) {
    assert(a.errors.size() == b.errors.size());
    bool smaller = false;
    for (size_t k = 0; k < a.errors.size(); ++k) {
        if (a.errors[k] > b.errors[k])
            return false;
        smaller = smaller || a.errors[k] < b.errors[k];
    }
    return a.seconds < (1 - kSameTime) * b.seconds || (smaller && a.seconds <= b.seconds);
}

std::optional<size_t> dominating(std::span<const Choice> choices, size_t i) {
    assert(i < choices.size());
    std::optional<size_t> best;
    for (size_t k = 0; k < choices.size(); ++k)
        if (k != i && dominates(choices[k], choices[i]) &&
            (!best || choices[k].seconds < choices[*best].seconds))
            best = k;
    return best;
}

} // namespace ovc
