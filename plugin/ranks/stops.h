// SPDX-License-Identifier: Apache-2.0
// Stops: the ranks that a ray has to visit, in the order in which it comes by their pages.
#pragma once

#include "core/ray.h"
#include "plugin/ranks/box_lanes.h"
#include "plugin/ranks/page_boxes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// A rank, and a lower bound of the t of every hit that the ray has there.
struct Stop {
    double t;
    uint32_t rank;
};

/// Boxes around the pages of each rank.
class StopFinder {
public:
    /// here: the rank that stands for every rank, where all have a page.
    StopFinder(std::span<const OwnedBox> boxes, uint32_t here);

    /// So many rays are looked at together before each is by itself: neighbours, best of all.
    static constexpr size_t kPacket = 64;

    /// Appends the stops of at most kPacket rays, ray after ray, by t and then by rank; a rank
    /// stands there once for a ray. An invalid ray has `here` as its stop. Sets ends[i] to
    /// stops.size() behind those of ray i.
    void find(std::span<const Ray> rays, std::vector<Stop>& stops, std::span<uint32_t> ends) const;
    /// Returns the first rank on a ray's way whose pages no other rank has; kNone where there is
    /// none, and for an invalid ray. It is the same on all ranks.
    uint32_t first_owner(const Ray& ray) const;

private:
    struct Part {
        uint32_t owner = kNone; // kEveryRank: of pages that all ranks have
        BoxLanes boxes;         // around them
    };

    void find(const Ray& ray, std::span<const Part* const> parts, std::vector<Stop>& stops) const;
    uint32_t rank_of(const Part& part) const {
        return part.owner == kEveryRank ? here_ : part.owner;
    }

    const uint32_t here_;
    std::vector<Part> parts_;      // one for each owner
    std::vector<const Part*> all_; // of these
};

} // namespace ovc
