// SPDX-License-Identifier: Apache-2.0
// PartOutline: the boxes of a portal's node, four around what lies behind the portal.
#pragma once

#include "core/box.h"
#include "core/transform.h"
#include "gpu/page/page.h"
#include "kdtree/partition.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace ovc {

/// Around a plant that was turned, the box of its own box is half empty, and rays that meet only
/// that would go through a portal for nothing. So a part is outlined by the boxes of its largest
/// nodes, in four groups, and each group's box in the world is that of its boxes there.
class PartOutline {
public:
    static constexpr size_t kGroups = 4;
    using Groups = std::array<Box, kGroups>; // those of fewer groups are empty

    /// pages: of the part; they share a frame and a grid.
    explicit PartOutline(std::span<const Page> pages);

    /// Returns the groups' boxes in the world. frame: that of the pages; transform: as in
    /// portal_into(). They hold all that the pages' boxes hold, rounding included
    /// (docs/design/numerics.md, "Frames").
    Groups placed(const Frame& frame, const Transform* transform) const;

private:
    struct Block { // of space, in the pages' frame
        dvec3 center;
        dvec3 half_extent;
    };

    std::array<std::vector<Block>, kGroups> groups_;
};

} // namespace ovc
