// SPDX-License-Identifier: Apache-2.0
// Triangles sorted by their sorted corners: duplicates then stand side by side.
#include "plugin/hosts/tachyon/duplicate_sets.h"

#include <algorithm>
#include <array>

namespace ovc::tachyon {

template <class Number>
using Sorted = std::array<std::array<Number, 3>, 3>;

template <class Number>
static Sorted<Number> sorted_corners(const std::vector<Number>& corners, size_t prim) {
    Sorted<Number> sorted;
    for (size_t i = 0; i < 9; ++i)
        sorted[i / 3][i % 3] = corners[9 * prim + i] + Number(0); // -0 becomes 0
    std::ranges::sort(sorted);
    return sorted;
}

/// Calls found(prim, duplicate) for each triangle that has a smaller duplicate, the smallest of its
/// set.
template <class Number, class Found>
static void find_duplicates(const std::vector<Number>& corners, Found&& found) {
    std::vector<std::pair<Sorted<Number>, uint32_t>> all(corners.size() / 9);
    for (size_t prim = 0; prim < all.size(); ++prim)
        all[prim] = {sorted_corners(corners, prim), uint32_t(prim)};
    std::ranges::sort(all, [](const auto& a, const auto& b) { return a < b; });
    for (size_t first = 0, i = 1; i < all.size(); ++i) {
        if (all[i].first == all[first].first)
            found(all[first].second, all[i].second);
        else
            first = i;
    }
}

DuplicateSets::DuplicateSets(const Corners& corners) {
    std::visit(
        [&](const auto& numbers) {
            find_duplicates(numbers, [&](uint32_t smallest, uint32_t duplicate) {
                others_[smallest].push_back(duplicate);
                smallest_[duplicate] = smallest;
            });
        },
        corners);
}

std::span<const uint32_t> DuplicateSets::of(uint32_t prim) const {
    if (others_.empty())
        return {};
    const auto found = others_.find(prim);
    return found == others_.end() ? std::span<const uint32_t>() : found->second;
}

uint32_t DuplicateSets::smallest(uint32_t prim) const {
    if (smallest_.empty())
        return prim;
    const auto found = smallest_.find(prim);
    return found == smallest_.end() ? prim : found->second;
}

} // namespace ovc::tachyon
