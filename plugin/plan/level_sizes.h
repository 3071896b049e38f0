// SPDX-License-Identifier: Apache-2.0
// LevelSizes: how large level 1 and its pages will be, estimated from how many triangles touch each
// cell.
#pragma once

#include "gpu/trace/tracer.h"
#include "kdtree/cells.h"
#include "plugin/build/built_scene.h"
#include "plugin/overcast.h"
#include "plugin/plan/page_rate.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

struct LevelSizes {
    std::vector<uint64_t> pages; // bytes, in the order of leaves
    uint64_t references = 0;
    uint64_t nodes = 0;
    uint64_t parts = 0; // in frames of their own
    uint64_t largest_page = 0;

    uint64_t level2_bytes() const;
    void add(const LevelSizes& more);
};

/// A level 1 that is cut, but not built.
struct CountedCells {
    std::span<const Cell> cells;
    std::span<const uint64_t> counts; // of triangles in each; behind them, of those that reach far
    uint64_t nodes;                   // of the tree
    uint64_t triangles;               // in all, each counted once
    uint32_t leaf_triangles;          // at most
    Box padded;                       // around all
    bool one_frame;                   // whether it suits the scene
};

/// Returns the sizes of leaves that keep to the limits.
LevelSizes estimated_sizes(const CountedCells& level, const PageRates& rates,
                           const LeafLimits& limits);

/// The sizes of all cuts of a scene, and the numbers that memory depends on besides.
struct AllSizes {
    LevelSizes cuts;
    uint64_t portals = 0;
    uint64_t duplicates = 0;
    uint64_t cut_count = 1;
    uint64_t corner_blocks = 0; // of all meshes
};

/// Fills in what follows from the sizes, which are of at least one page. host_bytes: of a scene
/// that lies in memory.
void fill_in(ovc_plan& plan, const AllSizes& all, const MemoryPlan& memory);

} // namespace ovc
