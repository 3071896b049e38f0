// SPDX-License-Identifier: Apache-2.0
#include "plugin/smallest_budget.h"

#include "gpu/level1_table.h"
#include "gpu/tracer.h"
#include "plugin/page_rate.h"

#include <algorithm>
#include <cmath>

namespace ovc {

SmallestCut smallest_cut(uint64_t triangles, uint64_t max_leaf_triangles, bool tell_active) {
    if (triangles == 0)
        return {};
    const uint64_t leaf_bytes =
        (level1_texels(2, 1) - level1_texels(1, 1)) * sizeof(uvec4) + (tell_active ? 4 : 0);
    const double balanced =
        std::sqrt(double(triangles) * double(leaf_bytes) / double(kMaxUncutBytesPerTriangle));
    uint64_t most =
        std::clamp<uint64_t>(uint64_t(balanced), 1, std::min(triangles, uint64_t(kNone - 1)));
    if (max_leaf_triangles)
        most = std::min(most, max_leaf_triangles);
    const uint64_t leaves = (triangles + most - 1) / most;
    const uint64_t table =
        level1_texels(1, 1) * sizeof(uvec4) + (tell_active ? 4 : 0) + (leaves - 1) * leaf_bytes;
    return {uint32_t(most), table + kPageStart + most * kMaxUncutBytesPerTriangle};
}

uint64_t smallest_budget(uint64_t pool_bytes, const DeviceInfo& device) {
    const auto holds = [&](uint64_t budget) {
        const Result<MemoryPlan> plan = plan_memory(budget, device);
        return plan && plan->pool_bytes >= pool_bytes;
    };
    uint64_t low = 0, high = 2 * pool_bytes + (1 << 20); // a pool is never less than half of that
    while (high - low > 1) {
        const uint64_t middle = low + (high - low) / 2;
        (holds(middle) ? high : low) = middle;
    }
    return high;
}

} // namespace ovc
