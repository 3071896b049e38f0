// SPDX-License-Identifier: Apache-2.0
// Triangles with the same three corners: Overcast names the smallest of them for all, but a
// renderer may give each another look.
#pragma once

#include "plugin/hosts/tachyon/corners.h"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace ovc::tachyon {

class DuplicateSets {
public:
    DuplicateSets() = default;
    /// The corners of two duplicates may be in any order.
    explicit DuplicateSets(const Corners& corners);

    /// The others of the set whose smallest is `prim`, ascending; none where it has no duplicates.
    std::span<const uint32_t> of(uint32_t prim) const;

    /// The smallest of the set that `prim` is in; `prim` where it has no duplicates.
    uint32_t smallest(uint32_t prim) const;

private:
    std::unordered_map<uint32_t, std::vector<uint32_t>> others_; // by smallest
    std::unordered_map<uint32_t, uint32_t> smallest_;            // of all but the smallest
};

} // namespace ovc::tachyon
