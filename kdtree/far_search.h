// SPDX-License-Identifier: Apache-2.0
// FarSearch: finds the few triangles of a scene that reach far beyond all others, as of a floor
// under a small thing. No frame suits both, however few leaves the scene is cut into.
#pragma once

#include "core/box.h"
#include "core/soup.h"

#include <cstddef>
#include <span>
#include <vector>

namespace ovc {

/// Which triangles it finds does not depend on the order in which they are added.
class FarSearch {
public:
    /// box: of the triangle.
    void add(TriangleId id, const Box& box);
    /// Adds all that were added to the other one.
    void add(const FarSearch& other);
    /// Returns up to kMax triangles, sorted, each of which is at least kMinReach times as large as
    /// the box of all that are not among them; none where there are no such, or no others.
    std::vector<TriangleId> found() const;

    static constexpr size_t kMax = 16;
    static constexpr double kMinReach = 8;

private:
    struct Candidate {
        double extent;
        TriangleId id;
        Box box;
    };

    void add(const Candidate& candidate);

    std::vector<Candidate> largest_; // at most kMax, the largest first
    Box others_;
};

/// Returns what FarSearch finds among these triangles.
std::vector<TriangleId> find_far(const Soup& soup, std::span<const TriangleId> triangles);

} // namespace ovc
