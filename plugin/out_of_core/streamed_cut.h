// SPDX-License-Identifier: Apache-2.0
// How level 1 of a source is cut: what its build and its plan have in common.
#pragma once

#include "core/build_progress.h"
#include "core/result.h"
#include "core/soup.h"
#include "gpu/trace/tracer.h"
#include "kdtree/tree.h"
#include "plugin/build/built_scene.h"
#include "plugin/out_of_core/host_budget.h"
#include "plugin/plan/two_level_options.h"
#include "plugin/structure/triangle_source.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

uint64_t triangles_of(std::span<const SourceMesh> meshes);

/// Reads all of the source.
Soup read_soup(TriangleSource& source);

/// Returns the budget that a build of such meshes shares out of so many bytes.
HostBudget host_budget(uint64_t bytes, std::span<const SourceMesh> meshes);

/// Returns the smallest number of bytes that a build of such meshes works with.
uint64_t smallest_host_bytes(std::span<const SourceMesh> meshes);

/// Returns the error of fewer bytes.
Error too_small(uint64_t bytes, std::span<const SourceMesh> meshes);

/// The limits on leaves of a source. Pages that turn out too large are cut again.
struct StreamedLimits {
    LeafLimits limits{};
    uint32_t max_triangles = 1; // of a leaf, so that a thread builds one within the budget
};
StreamedLimits streamed_limits(const TwoLevelOptions& options, const MemoryPlan& plan,
                               const HostBudget& budget, uint64_t triangles);

/// Returns the rate of the sample that planes are chosen by, a power of two.
uint32_t streamed_sample_rate(const HostBudget& budget, uint64_t triangles, uint32_t max_triangles);

/// Returns a tree whose leaf nodes are the cells of so many triangles. drawn: the sample, in which
/// each stands for `rate` of them.
std::vector<KdNode> streamed_planes(const Soup& sample, std::span<const TriangleId> drawn,
                                    uint32_t rate, uint64_t triangles, const Box& bounds,
                                    uint32_t max_triangles, BuildProgress* progress);

} // namespace ovc
