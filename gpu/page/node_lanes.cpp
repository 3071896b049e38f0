// SPDX-License-Identifier: Apache-2.0
// meet_children() for any processor, and the choice of the widest vectors.
#include "gpu/page/node_lanes_kernel.h"

namespace ovc {

// node_lanes_avx2.cpp
void meet_children_avx2(const NodeRays& rays, RaySet which, const uint32_t* texels,
                        NodeMeeting& meeting);

static void meet_children_anywhere(const NodeRays& rays, RaySet which, const uint32_t* texels,
                                   NodeMeeting& meeting) {
    meet_children_by<Anywhere>(rays, which, texels, meeting);
}

std::vector<MeetChildren> ways_to_meet_children() {
    std::vector<MeetChildren> ways = {meet_children_anywhere};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2"))
        ways.push_back(meet_children_avx2);
#endif
    return ways;
}

MeetChildren meet_children() {
    static const MeetChildren widest = ways_to_meet_children().back();
    return widest;
}

} // namespace ovc
