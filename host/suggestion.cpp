// SPDX-License-Identifier: Apache-2.0
// Edit distance with swaps of neighbours, over short words.
#include "host/suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace ovc {

/// Insertions, deletions, replacements and swaps of two neighbours that lead from a to b.
static size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<size_t> before_last, last(b.size() + 1), row(b.size() + 1);
    for (size_t j = 0; j <= b.size(); ++j)
        last[j] = j;
    for (size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before_last[j - 2] + 1);
        }
        before_last = last;
        std::swap(last, row);
    }
    return last[b.size()];
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
    std::string_view best;
    // A third of the letters may be wrong; beyond that it is another word.
    size_t least = std::max<size_t>(1, word.size() / 3) + 1;
    for (const std::string_view candidate : candidates)
        if (const size_t distance = edit_distance(word, candidate); distance < least) {
            least = distance;
            best = candidate;
        }
    return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
    const std::string_view meant = nearest(word, candidates);
    return meant.empty() ? "" : fmt::format("; did you mean '{}'?", meant);
}

} // namespace ovc
