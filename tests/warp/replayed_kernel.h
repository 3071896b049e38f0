// SPDX-License-Identifier: Apache-2.0
// The variants of the kernel that are compiled as C++.
#pragma once

#include "tests/warp/replay.h"

namespace ovc {

using ReplaySlot = Steps(std::span<const uvec4> pool, std::span<const LocalRay> rays, size_t first);

} // namespace ovc

#define OVC_REPLAYED(name)                                                                         \
    namespace ovc_replay::name {                                                                   \
    ovc::ReplaySlot replay_slot;                                                                   \
    }
OVC_REPLAYED(nearest_both)
OVC_REPLAYED(nearest_both_packets)
OVC_REPLAYED(nearest_branches)
OVC_REPLAYED(nearest_branches_packets)
OVC_REPLAYED(any_both)
OVC_REPLAYED(any_both_packets)
OVC_REPLAYED(any_branches)
OVC_REPLAYED(any_branches_packets)
#undef OVC_REPLAYED
