// SPDX-License-Identifier: Apache-2.0
// TwoLevelOptions: the options of two-level, and the limits that they and a budget set.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"
#include "core/soup.h"
#include "gpu/trace/tracer.h"
#include "gpu/tuning/kernel_variant.h"
#include "plugin/build/built_scene.h"
#include "plugin/build/keep_pages.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace ovc {

enum class VariantChoice {
    Default,  // what the device's kind suggests; `compute` says of which kernel
    Measured, // what was measured on the device, or is measured beside the first rays
    Thorough, // measures all that there is at the first rays of each kind, and keeps that
    Given,
};

/// About so many leaves a scene has where nobody says how many (thesis, section 4).
inline constexpr uint64_t kDefaultLeaves = 10;

struct TwoLevelOptions {
    uint64_t budget_bytes = 0;   // 0: the device's default
    uint64_t leaf_triangles = 0; // 0: a tenth of the scene, or more where that is better
    uint64_t leaves = 0;         // instead of leaf_triangles: about so many; or 0
    bool certify = true;         // false: fast precision, the kernel's own choice of triangles
    bool compute = false;        // true: the compute kernel, else the fragment kernel
    bool tell_active = false;    // passes mark the pages that rays are traced through
    bool kernel_alone = false;   // true: it answers all batches of more than kMaxFewRays rays
    /// The way in which the kernel's variant is chosen (docs/decisions/0032).
    VariantChoice variant = VariantChoice::Default;
    KernelVariant given_variant = {}; // VariantChoice::Given
    /// Whether pages move in beside a pass. Default: on a GPU alone, because a software renderer
    /// cannot do two things at once, and moving before a pass has ended moves some 20 % more.
    std::optional<bool> beside;
    uint64_t driver_bytes = ~uint64_t(0); // for tests: as in MemoryPlan
    uint64_t buffer_bytes = 0;            // for tests: as in plan_memory()
    /// Leaves are cut as for a pool, and for buffers, no larger than these, so that ranks cut alike
    /// whatever their budgets are.
    uint64_t cut_pool_bytes = ~uint64_t(0), cut_buffer_bytes = ~uint64_t(0);
    /// For tests: the max rays of a call that are numbered together, in 32 bits.
    uint64_t max_numbered_rays = uint64_t(1) << 31;
    LeafStore* store = nullptr; // reads what was saved, in place of the next
    Bytes saved = {};           // from save() of a structure over the same soup; outlives this one
    /// Returns which pages of a scene that is cut and packed are traced here; null: all. Others are
    /// dropped (keep_pages.h).
    std::function<PagesKept(const BuiltScene&)> choose_pages;
};

/// Returns the plan for the budget that the options ask for, before portals are taken off. Error:
/// as of plan_memory() in gpu/trace/tracer.h, or there are more triangles than a scene takes.
Result<MemoryPlan> plan_memory(uint64_t triangles, const TwoLevelOptions& options,
                               const DeviceInfo& device);
inline Result<MemoryPlan> plan_memory(const Soup& soup, const TwoLevelOptions& options,
                                      const DeviceInfo& device) {
    return plan_memory(soup.triangle_count(), options, device);
}

/// At most so many bytes a triangle has a page in which planes cut nothing: a unit for each, and no
/// more nodes than units.
inline constexpr uint64_t kMaxUncutBytesPerTriangle = 128;

/// How a scene is cut where hardly anything fits. Leaves are cut by count (kdtree/partition.h), so
/// large that a page takes about as much as the tree and the table that lead to all of them, which
/// takes the least together. Counts alone decide, so that plan and commit say the same before
/// anything is built, and every larger budget works too.
struct SmallestCut {
    uint32_t leaf_triangles = 1;
    uint64_t pool_bytes = 0; // upper bound of portals, tree and largest page together
};
SmallestCut smallest_cut(const Soup& soup, const Placed& placed, const TwoLevelOptions& options);

/// Returns the smallest budget that leaves so many bytes to the pool.
uint64_t smallest_budget(uint64_t pool_bytes, const DeviceInfo& device);

/// Error: the budget is too small for the scene; the sentence names the smallest that works.
Result<Done> check_budget(const Soup& soup, const TwoLevelOptions& options, const MemoryPlan& plan,
                          const DeviceInfo& device);

/// Returns the limits on the leaves of a cut with so many hittable triangles. plan: before portals
/// are taken off. unique: the hittable triangles of all cuts of the scene.
LeafLimits limits_of(const TwoLevelOptions& options, const MemoryPlan& plan, uint64_t triangles,
                     uint64_t unique);
inline LeafLimits limits_of(const TwoLevelOptions& options, const MemoryPlan& plan,
                            uint64_t triangles) {
    return limits_of(options, plan, triangles, triangles);
}

} // namespace ovc
