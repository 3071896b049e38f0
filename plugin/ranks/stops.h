// SPDX-License-Identifier: Apache-2.0
// Stops: the ranks that a ray has to visit, in the order in which it comes by their pages.
#pragma once

#include "core/box.h"
#include "core/ray.h"
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

/// Boxes around the pages of each rank, in a tree.
class StopFinder {
public:
    /// owners: of each page. here: the rank that stands for every rank, where all have a page.
    StopFinder(std::span<const PageBox> boxes, std::span<const uint32_t> owners, uint32_t here);

    /// Sets `stops` to those of a valid ray, by t and then by rank. No rank stands there twice.
    void find(const Ray& ray, std::vector<Stop>& stops) const;

private:
    struct Part {
        Box box;
        uint32_t rank;
    };
    /// Over parts_[first, first + count); a leaf where count is 1. The left child follows it.
    struct Node {
        Box box;
        uint32_t first, count, right;
    };

    uint32_t build(uint32_t first, uint32_t count);

    std::vector<Part> parts_;
    std::vector<Node> nodes_;
};

} // namespace ovc
