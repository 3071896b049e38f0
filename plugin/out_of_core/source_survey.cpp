// SPDX-License-Identifier: Apache-2.0
// Blocks are surveyed in parallel and joined in order, so that the sample is in the order of names.
#include "plugin/out_of_core/source_survey.h"

#include "core/corner_hash.h"
#include "core/system/parallel.h"
#include "plugin/out_of_core/source_blocks.h"

#include <vector>

namespace ovc {
namespace {

static_assert(kBlockTriangles % kCornerBlock == 0);

/// Returns the meshes of a source, without sums.
CornerSums unsummed(std::span<const SourceMesh> meshes) {
    CornerSums found;
    uint64_t blocks = 0;
    for (const SourceMesh& mesh : meshes) {
        found.meshes.push_back({mesh.origin, mesh.triangles, blocks});
        blocks += corner_blocks(mesh.triangles);
    }
    found.sums.reserve(blocks);
    return found;
}

/// The survey of one block.
struct BlockSurvey {
    Survey found;
    std::vector<uint32_t> drawn; // in the block
    std::vector<uint64_t> sums;
    FarSearch far;
};

BlockSurvey look_at(const SourceBlock& block, const SourceMesh& mesh, uint32_t rate,
                    BuildProgress* progress) {
    BlockSurvey result;
    const Chunk chunk = borrowed_chunk(mesh, block.corners);
    std::vector<uint8_t> is_hit(block.count);
    result.found = survey(chunk, 0, is_hit, progress);
    for (uint32_t i = 0; i < block.count; ++i) {
        if (!is_hit[i])
            continue;
        const Triangle triangle = chunk.triangle(i);
        result.far.add(block.id(i), bounds_of(triangle));
        if ((triangle_hash(triangle) & (rate - 1)) == 0)
            result.drawn.push_back(i);
    }
    result.sums.resize(corner_blocks(block.count));
    sum_blocks(block.corners, mesh.triangle_bytes(), result.sums);
    return result;
}

} // namespace

SourceSurvey survey_source(TriangleSource& source, uint32_t rate, BuildProgress* progress) {
    const std::span<const SourceMesh> meshes = source.meshes();
    SourceSurvey total{.sums = unsummed(meshes), .sample = LocalSoup(meshes)};
    for_each_blocks(source, [&](std::span<const SourceBlock> blocks) {
        std::vector<BlockSurvey> parts(blocks.size());
        parallel_for(blocks.size(), 1, [&](size_t first, size_t last) {
            for (size_t b = first; b < last; ++b)
                parts[b] = look_at(blocks[b], meshes[blocks[b].mesh], rate, progress);
        });
        for (size_t b = 0; b < blocks.size(); ++b) {
            total.triangles += blocks[b].count;
            total.found.add(parts[b].found);
            total.far.add(parts[b].far);
            total.sums.sums.insert(total.sums.sums.end(), parts[b].sums.begin(),
                                   parts[b].sums.end());
            for (const uint32_t i : parts[b].drawn)
                total.sample.add(blocks[b].id(i), blocks[b].corners_of(i));
        }
    });
    total.sample.finish();
    return total;
}

} // namespace ovc
