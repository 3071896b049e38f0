// SPDX-License-Identifier: Apache-2.0
// StreamedLevelsWriter: saves cells as they are built, and what ties them together at the end.
#pragma once

#include "core/result.h"
#include "plugin/build/saved_levels.h"
#include "plugin/out_of_core/build_steps.h"
#include "plugin/out_of_core/cell_builder.h"
#include "plugin/out_of_core/duplicate_runs.h"
#include "plugin/structure/triangle_source.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// The size of levels that were built.
struct StreamedLevels {
    uint64_t leaves = 0;
    uint64_t triangles = 0;    // in leaves, each counted once
    bool was_streamed = false; // else it was built in memory
};

class StreamedLevelsWriter {
public:
    /// All outlive the writer, which throws Cancelled where the sink wants no more.
    StreamedLevelsWriter(const ByteSink& sink, ScratchSpace& scratch, BuildSteps& steps);

    /// Writes the next cell, by its number among the cells of `planes` in finish(), or the next
    /// part of one, which has one leaf node. The cell of far-reaching triangles comes first, if it
    /// is there.
    void add(size_t cell, bool is_far, BuiltCell built);
    /// Writes the next cell as an earlier build did, if that came so far. Returns whether it did.
    bool add_kept(size_t cell, bool is_far);

    /// Ends the levels. level1: has everything but nodes and leaves. planes: the tree whose leaf
    /// nodes are the cells. Error: there are too many leaves.
    Result<StreamedLevels> finish(const LevelsKey& key, const Dropped& dropped, uint64_t hittable,
                                  Level1 level1, std::span<const KdNode> planes);

private:
    /// The triangles of a leaf, in the scratch space.
    struct List {
        uint64_t offset;
        uint64_t triangles;
        uint64_t checksum;
    };
    /// The place of a leaf that has been written, and all else that is known of it.
    struct KeptLeaf {
        SavedLeaf leaf;
        SavedPage page;
        uint64_t page_offset; // among what was passed to the sink
        List list;
    };
    /// The tree over a cell that is not empty.
    struct CellTree {
        size_t cell;
        std::vector<KdNode> nodes; // which name leaves of the whole scene
        uint32_t end;              // of its leaves
    };

    void add_tree(size_t cell, bool is_far, std::vector<KdNode> nodes, size_t leaves);
    List put_list(std::span<const TriangleId> triangles);
    std::vector<KdNode> joined_nodes(std::span<const KdNode> planes) const;
    void write_lists();

    LevelsWriter writer_;
    ScratchSpace& scratch_;
    BuildSteps& steps_;
    uint32_t far_leaves_ = 0;
    std::vector<List> lists_;
    std::vector<CellTree> trees_; // in the order of cells
    DuplicateRuns duplicates_;
};

} // namespace ovc
