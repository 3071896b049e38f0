// SPDX-License-Identifier: Apache-2.0
// Triangles sorted by their sorted corners: twins then stand side by side.
#include "plugin/hosts/tachyon/twin_sets.h"

#include <algorithm>
#include <array>

namespace ovc::tachyon {

using Corner = std::array<float, 3>;

static std::array<Corner, 3> sorted_corners(std::span<const float> corners, size_t prim) {
    std::array<Corner, 3> sorted;
    for (size_t i = 0; i < 9; ++i)
        sorted[i / 3][i % 3] = corners[9 * prim + i] + 0.0f; // -0 becomes 0
    std::ranges::sort(sorted);
    return sorted;
}

TwinSets::TwinSets(std::span<const float> corners) {
    struct Keyed {
        std::array<Corner, 3> key;
        uint32_t prim;
        auto operator<=>(const Keyed&) const = default;
    };
    std::vector<Keyed> all(corners.size() / 9);
    for (size_t prim = 0; prim < all.size(); ++prim)
        all[prim] = {sorted_corners(corners, prim), uint32_t(prim)};
    std::ranges::sort(all, [](const Keyed& a, const Keyed& b) { return a < b; });
    for (size_t first = 0, i = 1; i < all.size(); ++i) {
        if (all[i].key == all[first].key)
            others_[all[first].prim].push_back(all[i].prim);
        else
            first = i;
    }
}

std::span<const uint32_t> TwinSets::of(uint32_t prim) const {
    if (others_.empty())
        return {};
    const auto found = others_.find(prim);
    return found == others_.end() ? std::span<const uint32_t>() : found->second;
}

} // namespace ovc::tachyon
