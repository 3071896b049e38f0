// SPDX-License-Identifier: Apache-2.0
// Stops: the ranks that a ray has to visit, in the order in which it comes by their pages.
#pragma once

#include "core/box.h"
#include "core/ray.h"
#include "plugin/ranks/box_entry.h"
#include "plugin/ranks/shares.h"

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
    /// owners: of each page. here: the rank that stands for every rank, where all have a page.
    StopFinder(std::span<const PageBox> boxes, std::span<const uint32_t> owners, uint32_t here);

    /// Sets `stops` to those of a valid ray, by t and then by rank. No rank stands there twice.
    void find(const Ray& ray, std::vector<Stop>& stops) const;

private:
    /// Boxes side by side, which one loop tests, several at once.
    class Boxes {
    public:
        void add(const Box& box);
        size_t size() const { return sides_[0].size(); }
        /// Sets entries[i] to the entry of box i.
        void enter(const EnteringRay& ray, std::vector<double>& entries) const;

    private:
        std::vector<double> sides_[6]; // lo.x, lo.y, lo.z, hi.x, hi.y, hi.z
    };

    std::vector<uint32_t> ranks_; // that have pages
    Boxes around_;                // all pages of each of these
    std::vector<Boxes> parts_;    // a few boxes around them
};

} // namespace ovc
