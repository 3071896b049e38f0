// SPDX-License-Identifier: Apache-2.0
// NodeRay: tests rays against the four boxes of a node at once, in double.
#pragma once

#include <cstdint>
#include <vector>

namespace ovc {

/// A ray in the frame of a tree, made ready for the boxes on the tree's grid. Arrays are by axis.
struct NodeRay {
    double lo[3], hi[3];       // where grid coordinate 0 lies, less and more by the ray's margin
    double org[3], inv_dir[3]; // as in PreparedRay
    double from, to;           // the t between which it counts
};

/// Some rays of a group, a bit each.
using RaySet = uint32_t;

/// A group of rays in the frame of a tree.
struct NodeRays {
    static constexpr uint32_t kMax = 16;

    double cell[3]; // of the tree's grid, by axis
    NodeRay rays[kMax];
};

/// The children that at least one of the rays meets.
struct NodeMeeting {
    alignas(32) double enter[4];   // the least t of entry; -infinity for a child that no ray meets
    alignas(32) long long rays[4]; // those that meet the child, a bit each
    /// The place of each child where all stand by t of entry, the farthest first. Those that are
    /// not met stand last.
    alignas(32) long long place[4];
    uint32_t count; // of children that are met
};

/// Tests those of the rays that are in `which` (not empty) with the children of a node. texels: the
/// first three of the node (shaders/layout.h), an axis each. A stretch may be a little too long,
/// but is never too short for a ray whose margin bounds its rounding.
using MeetChildren = void (*)(const NodeRays& rays, RaySet which, const uint32_t* texels,
                              NodeMeeting& meeting);

/// Returns the function with the widest vectors that the processor has.
MeetChildren meet_children();
/// Returns one per width of vectors that the processor has, the widest last: for tests.
std::vector<MeetChildren> ways_to_meet_children();

} // namespace ovc
