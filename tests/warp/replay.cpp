// SPDX-License-Identifier: Apache-2.0
#include "tests/warp/replay.h"

#include "core/system/parallel.h"
#include "tests/warp/replayed_kernel.h"

#include <cassert>

namespace ovc {

static ReplaySlot* kernel_of(const ReplayedVariant& variant) {
    using namespace ovc_replay;
    static constexpr ReplaySlot* kKernels[2][2][2] = {
        {{nearest_both::replay_slot, nearest_both_packets::replay_slot},
         {nearest_branches::replay_slot, nearest_branches_packets::replay_slot}},
        {{any_both::replay_slot, any_both_packets::replay_slot},
         {any_branches::replay_slot, any_branches_packets::replay_slot}}};
    return kKernels[variant.any_hit][variant.branches][variant.packets];
}

std::vector<Steps> replay(const ReplayedVariant& variant, std::span<const uvec4> pool,
                          std::span<const LocalRay> rays) {
    const size_t packet = variant.packets ? 2 : 1;
    assert(rays.size() % packet == 0);
    ReplaySlot* const kernel = kernel_of(variant);
    std::vector<Steps> steps(rays.size() / packet);
    parallel_for(steps.size(), 64, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            steps[i] = kernel(pool, rays, i * packet);
    });
    return steps;
}

} // namespace ovc
