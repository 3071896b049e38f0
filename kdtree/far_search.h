// SPDX-License-Identifier: Apache-2.0
// FarSearch: finds the few triangles of a scene that reach far beyond all others, as of a floor
// under a small thing. No frame suits both, however few leaves the scene is cut into.
#pragma once

#include "core/box.h"
#include "core/soup.h"
#include "kdtree/partition.h"

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

    static constexpr size_t kMax = 32; // a room of six planes in four triangles each has 24
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

/// Whether triangles that reach far are to be looked for by their size. If not, partition() sees
/// which they are, because they touch many cells. one_frame: one frame suits most triangles; where
/// there are few in all, most rays may still go to those that it leaves in doubt.
inline bool needs_far_search(uint64_t triangles, uint32_t max_leaf_triangles, bool one_frame) {
    constexpr uint64_t kFew = 4096;
    return !one_frame || triangles <= kFew || triangles / kFarCells <= max_leaf_triangles;
}

/// Returns what FarSearch finds among these triangles.
std::vector<TriangleId> find_far(const Soup& soup, std::span<const TriangleId> triangles);

} // namespace ovc
