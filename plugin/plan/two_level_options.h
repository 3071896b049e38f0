// SPDX-License-Identifier: Apache-2.0
// TwoLevelOptions: what a host asks of two-level, and what that makes of a budget.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"
#include "core/soup.h"
#include "gpu/trace/tracer.h"
#include "plugin/build/built_scene.h"

#include <cstdint>
#include <optional>

namespace ovc {

struct TwoLevelOptions {
    uint64_t budget_bytes = 0;   // 0: the device's default
    uint64_t leaf_triangles = 0; // 0: a tenth of the scene, or all where that is better
    uint64_t leaves = 0;         // instead: about this many
    bool certify = true;         // false: fast precision, the kernel's own answers
    bool compute = false;        // which kernel
    bool tell_active = false;    // passes mark the pages that rays are traced through
    /// Pages move in beside a pass. Default: on a GPU; a software renderer cannot do two things at
    /// once, and what is moved before a pass has ended is some 20 % more.
    std::optional<bool> beside;
    uint64_t driver_bytes = ~uint64_t(0); // for tests: as in MemoryPlan
    uint64_t buffer_bytes = 0;            // for tests: as in plan_memory()
    Bytes saved = {}; // what save() of a structure over the same soup wrote; outlives this one
};

/// The plan for the budget that the options ask for, portals not yet taken off. Error: as of
/// plan_memory(); more triangles than a scene takes.
Result<MemoryPlan> plan_memory(const Soup& soup, const TwoLevelOptions& options,
                               const DeviceInfo& device);

/// Of a page in which planes cut nothing: a unit a triangle, and a node above every two.
inline constexpr uint64_t kMaxUncutBytesPerTriangle = 128;

/// How a scene is cut where hardly anything fits: leaves by count (kdtree/partition.h), all of them
/// about as large as what leads to them is, which takes the least together. Told by counts alone,
/// so that plan and commit say the same before anything is built, and every larger budget works
/// too.
struct SmallestCut {
    uint32_t leaf_triangles = 1;
    uint64_t pool_bytes = 0; // that portals, tree and the largest page take, at most
};
SmallestCut smallest_cut(const Soup& soup, const Placed& placed, const TwoLevelOptions& options);

/// The smallest budget that leaves so much to the pool.
uint64_t smallest_budget(uint64_t pool_bytes, const DeviceInfo& device);

/// Error: a budget too small for the scene, with the smallest that works.
Result<Done> check_budget(const Soup& soup, const TwoLevelOptions& options, const MemoryPlan& plan,
                          const DeviceInfo& device);

/// What leaves may be under a plan of which portals are not yet taken off, where so many triangles
/// can be hit, and `unique` with those of meshes that are cut by themselves.
LeafLimits limits_of(const TwoLevelOptions& options, const MemoryPlan& plan, uint64_t triangles,
                     uint64_t unique);
inline LeafLimits limits_of(const TwoLevelOptions& options, const MemoryPlan& plan,
                            uint64_t triangles) {
    return limits_of(options, plan, triangles, triangles);
}

} // namespace ovc
