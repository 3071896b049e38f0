// SPDX-License-Identifier: Apache-2.0
// NodeRay: tests a ray against the four boxes of a node at once, in double.
#pragma once

#include <cstdint>
#include <vector>

namespace ovc {

/// A ray in the frame of a tree, made ready for the boxes on the tree's grid. Arrays are by axis.
struct NodeRay {
    double lo[3], hi[3]; // where grid coordinate 0 lies, less and more by the ray's margin
    double cell[3];
    double org[3], inv_dir[3]; // as in PreparedRay
    double from;               // t at which the ray begins
};

/// The children that a ray meets.
struct NodeMeeting {
    alignas(32) double enter[4]; // t of entry; -infinity for a child that it does not meet
    /// The place of each child where all stand by t of entry, the farthest first. Those that are
    /// not met stand last.
    alignas(32) long long place[4];
    uint32_t count; // of children that it meets
};

/// Tests the ray with the children of a node. texels: the first three of the node
/// (shaders/layout.h), an axis each. to: the t beyond which nothing counts. A stretch may be a
/// little too long, but is never too short for a ray whose margin bounds its rounding.
using MeetChildren = void (*)(const NodeRay& ray, const uint32_t* texels, double to,
                              NodeMeeting& meeting);

/// Returns the function with the widest vectors that the processor has.
MeetChildren meet_children();
/// Returns one per width of vectors that the processor has, the widest last: for tests.
std::vector<MeetChildren> ways_to_meet_children();

} // namespace ovc
