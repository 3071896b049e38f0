// SPDX-License-Identifier: Apache-2.0
// Triangles that reach far are dealt to the last cell, and from there to the others where they turn
// out to be too many.
#include "plugin/out_of_core/deal_source.h"

#include "core/system/parallel.h"
#include "kdtree/partition.h"
#include "plugin/out_of_core/source_blocks.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace ovc {
namespace {

class Dealer {
public:
    Dealer(const CellFinder& finder, std::span<const TriangleId> far, uint32_t far_cells,
           DealtCells& dealt)
        : finder_(finder), far_(far), far_cells_(far_cells), dealt_(dealt) {}

    void deal(TriangleId name, Bytes corners, const Triangle& triangle) {
        touched_.clear();
        finder_.find(triangle, [&](uint32_t c) { touched_.push_back(c); });
        if (touched_.size() >= far_cells_ || std::ranges::binary_search(far_, name))
            touched_ = {uint32_t(finder_.cells())};
        const Box box = bounds_of(triangle);
        for (const uint32_t c : touched_)
            dealt_.add(c, name, corners, box);
    }

private:
    const CellFinder& finder_;
    const std::span<const TriangleId> far_;
    const uint32_t far_cells_; // that such a triangle touches
    DealtCells& dealt_;
    std::vector<uint32_t> touched_; // by the triangle that is being dealt
};

void deal_block(const SourceBlock& block, const SourceMesh& mesh, Dealer dealer) {
    const Chunk chunk = borrowed_chunk(mesh, block.corners);
    for (uint32_t i = 0; i < block.count; ++i)
        if (const Triangle triangle = chunk.triangle(i);
            triangle_fault(triangle) == TriangleFault::None)
            dealer.deal(block.id(i), block.corners_of(i), triangle);
}

} // namespace

void deal_source(TriangleSource& source, const CellFinder& finder,
                 std::span<const TriangleId> far_triangles, uint64_t hittable,
                 uint64_t max_leaf_triangles, DealtCells& dealt, BuildProgress* progress) {
    assert(dealt.cells() == finder.cells() + 1);
    const bool by_cells = far_triangles.empty() && finder.cells() > 1;
    const Dealer dealer(finder, far_triangles, by_cells ? kFarCells : kNone, dealt);
    for_each_blocks(source, [&](std::span<const SourceBlock> blocks) {
        parallel_for(blocks.size(), 1, [&](size_t first, size_t last) {
            for (size_t b = first; b < last; ++b) {
                deal_block(blocks[b], source.meshes()[blocks[b].mesh], dealer);
                add(progress, blocks[b].count);
            }
        });
    });
    const size_t far = finder.cells();
    dealt.flush(far);
    if (by_cells && !far_leaf_pays(dealt.count(far), hittable, max_leaf_triangles)) {
        Dealer all(finder, {}, kNone, dealt);
        dealt.for_each(far, [&](TriangleId name, Bytes corners) {
            const SourceMesh& mesh = source.meshes()[name.mesh];
            all.deal(name, corners, borrowed_chunk(mesh, corners).triangle(0));
        });
        dealt.clear(far);
    }
    for (size_t cell = 0; cell < far; ++cell)
        dealt.flush(cell);
}

} // namespace ovc
