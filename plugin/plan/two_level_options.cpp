// SPDX-License-Identifier: Apache-2.0
// Tells how a budget limits leaves, and which budgets are too small.
#include "plugin/plan/two_level_options.h"

#include "core/text/format_text.h"
#include "gpu/page/top_level.h"
#include "plugin/build/shared_meshes.h"
#include "plugin/plan/page_rate.h"

#include <algorithm>
#include <cmath>

namespace ovc {
namespace {

// A page takes at most the first of these shares of the pool, so that some stay resident. Where
// leaves are ours to choose it takes at most the second, so that rays bring in little that they do
// not go through, but may always take as much as is worth a move.
constexpr uint64_t kPagesAtOnce = 3;
constexpr uint64_t kPagesByDefault = 32;
constexpr uint64_t kWorthMoving = 512 << 10; // bytes
// Where all pages fit, so many triangles may stay in a leaf whatever their share of the scene: to
// cut them takes longer than rays can gain.
constexpr uint64_t kTooFewToCut = 16384;
// Pages are so small where the pool is several buffers, so that little room is left at their ends.
constexpr uint64_t kPagesABuffer = 8;

} // namespace

Result<MemoryPlan> plan_memory(uint64_t triangles, const TwoLevelOptions& options,
                               const DeviceInfo& device) {
    Result<MemoryPlan> plan =
        plan_memory(options.budget_bytes ? options.budget_bytes : device.default_budget_bytes(),
                    device, sizeof(RayState) + kAnswerBytes, options.buffer_bytes);
    if (!plan)
        return plan;
    if (triangles > OVC_MAX_TRIANGLES)
        return Error{format_text("{} triangles are too many: a scene takes {}", triangles,
                                 OVC_MAX_TRIANGLES),
                     ErrorKind::InvalidArgument};
    plan->driver_bytes = options.driver_bytes;
    return plan;
}

SmallestCut smallest_cut(const Soup& soup, const Placed& placed, const TwoLevelOptions& options) {
    const uint64_t triangles = unique_triangles(soup, placed); // whether they can be hit or not
    const uint64_t active_bytes = options.tell_active ? sizeof(uint32_t) : 0;
    if (triangles == 0)
        return {};
    const uint64_t first_bytes = kPortalBytes + max_top_level_bytes(1);
    const uint64_t leaf_bytes = kMaxBytesPerPart + active_bytes;
    const double balanced =
        std::sqrt(double(triangles) * double(leaf_bytes) / double(kMaxUncutBytesPerTriangle));
    uint64_t max_triangles =
        std::clamp<uint64_t>(uint64_t(balanced), 1, std::min(triangles, uint64_t(kNone - 1)));
    if (options.leaf_triangles)
        max_triangles = std::min(max_triangles, options.leaf_triangles);
    // Each shared mesh may have a leaf that is not full, and is one part with a portal an instance.
    const uint64_t leaves = (triangles + max_triangles - 1) / max_triangles + placed.shared.size();
    uint64_t portals = 0;
    for (const Placed::Shared& meshes : placed.shared)
        portals += meshes.places.size();
    const uint64_t table =
        first_bytes + leaves * leaf_bytes + portals * (kPortalBytes + 2 * OVC_UNIT_BYTES);
    return {uint32_t(max_triangles),
            table + kPageStart + max_triangles * kMaxUncutBytesPerTriangle};
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

Result<Done> check_budget(const Soup& soup, const TwoLevelOptions& options, const MemoryPlan& plan,
                          const DeviceInfo& device) {
    const Placed placed = placed_chunks(soup);
    const SmallestCut cut = smallest_cut(soup, placed, options);
    if (plan.pool_bytes >= cut.pool_bytes)
        return Done{};
    return over_budget(format_text(
        "a GPU budget of {} bytes is too small for this scene: the smallest that works is {} "
        "bytes ({} triangles in leaves of {}, whose tree and largest page take {}; an eighth is "
        "for rays)",
        plan.budget_bytes, smallest_budget(cut.pool_bytes, device), unique_triangles(soup, placed),
        cut.leaf_triangles, cut.pool_bytes));
}

/// Returns the max bytes of a page: a third of the pool, so that some stay resident, but half of it
/// where the tree and the table that lead to so many leaves might find no room beside that.
static uint64_t share_of_page(const MemoryPlan& plan, uint64_t triangles) {
    uint64_t page_bytes = std::max<uint64_t>(plan.pool_bytes / kPagesAtOnce, 1);
    if (triangles * kMaxBytesPerTriangle > plan.buffer_bytes)
        page_bytes = std::min(page_bytes, plan.buffer_bytes / kPagesABuffer);
    const uint64_t leaves = triangles * kMaxBytesPerTriangle / page_bytes;
    const uint64_t table = leaves * kMaxBytesPerPart;
    return table + page_bytes <= plan.pool_bytes ? page_bytes : plan.pool_bytes / 2;
}

LeafLimits limits_of(const TwoLevelOptions& options, const MemoryPlan& here, uint64_t triangles,
                     uint64_t unique) {
    MemoryPlan plan = here;
    plan.pool_bytes = std::min(plan.pool_bytes, options.cut_pool_bytes);
    plan.buffer_bytes = std::min(plan.buffer_bytes, options.cut_buffer_bytes);
    // Halving ends between half full and full, so leaves are this full on average.
    constexpr double kFull = 0.7;
    const uint64_t page_bytes = std::min(share_of_page(plan, unique), plan.buffer_bytes);
    if (options.leaf_triangles)
        return {options.leaf_triangles, page_bytes};
    double max_triangles = double(triangles) / double(kDefaultLeaves);
    if (options.leaves)
        max_triangles = double(triangles) / (options.leaves == 1 ? 1 : kFull * options.leaves);
    LeafLimits limits{std::max<uint64_t>(uint64_t(std::ceil(max_triangles)), 1), page_bytes};
    if (!options.leaves) {
        limits.page_bytes = std::min(
            page_bytes, std::max<uint64_t>(plan.pool_bytes / kPagesByDefault, kWorthMoving));
        const uint64_t table = max_top_level_bytes(1) + sizeof(uint32_t);
        const uint64_t first_buffer = std::min(plan.pool_bytes, plan.buffer_bytes);
        const uint64_t room = first_buffer - std::min(first_buffer, table);
        limits.whole_bytes = unique <= room / kMaxBytesPerTriangle ? LeafLimits::kAny
                             : unique == triangles                 ? room
                                                                   : 0;
        if (limits.whole_bytes == LeafLimits::kAny)
            limits.triangles = std::max(limits.triangles, kTooFewToCut);
    }
    return limits;
}

} // namespace ovc
