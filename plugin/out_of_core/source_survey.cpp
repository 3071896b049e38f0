// SPDX-License-Identifier: Apache-2.0
// Blocks are surveyed in parallel and joined in order, so that the sample is in the order of names.
#include "plugin/out_of_core/source_survey.h"

#include "core/corner_hash.h"
#include "core/file/checksum.h"
#include "core/system/parallel.h"
#include "plugin/build/saved_levels.h"
#include "plugin/out_of_core/source_blocks.h"

#include <vector>

namespace ovc {
namespace {

/// The checksum of a soup that comes in blocks.
class BlockChecksum {
public:
    explicit BlockChecksum(std::span<const SourceMesh> meshes) : meshes_(meshes) {}

    void add(const SourceBlock& block) {
        begin_up_to(block.mesh + 1);
        sum_.add(block.corners);
    }
    uint64_t finish() {
        begin_up_to(meshes_.size());
        return sum_.value();
    }

private:
    void begin_up_to(size_t end) {
        for (; begun_ < end; ++begun_)
            add_chunk(sum_, meshes_[begun_].origin, meshes_[begun_].triangles);
    }

    std::span<const SourceMesh> meshes_;
    size_t begun_ = 0;
    Checksum sum_;
};

/// What is found in one block.
struct BlockSurvey {
    Survey found;
    std::vector<uint32_t> drawn; // in the block
};

BlockSurvey look_at(const SourceBlock& block, const SourceMesh& mesh, uint32_t rate,
                    BuildProgress* progress) {
    BlockSurvey result;
    const Chunk chunk = borrowed_chunk(mesh, block.corners);
    std::vector<uint8_t> is_hit(block.count);
    result.found = survey(chunk, 0, is_hit, progress);
    for (uint32_t i = 0; i < block.count; ++i)
        if (is_hit[i] && (triangle_hash(chunk.triangle(i)) & (rate - 1)) == 0)
            result.drawn.push_back(i);
    return result;
}

} // namespace

SourceSurvey survey_source(TriangleSource& source, uint32_t rate, BuildProgress* progress) {
    const std::span<const SourceMesh> meshes = source.meshes();
    SourceSurvey total{.sample = LocalSoup(meshes)};
    BlockChecksum checksum(meshes);
    for_each_blocks(source, [&](std::span<const SourceBlock> blocks) {
        std::vector<BlockSurvey> parts(blocks.size());
        const auto look = [&] {
            parallel_for(blocks.size(), 1, [&](size_t first, size_t last) {
                for (size_t b = first; b < last; ++b)
                    parts[b] = look_at(blocks[b], meshes[blocks[b].mesh], rate, progress);
            });
        };
        const auto add_up = [&] {
            for (const SourceBlock& block : blocks)
                checksum.add(block);
        };
        parallel_invoke(look, add_up);
        for (size_t b = 0; b < blocks.size(); ++b) {
            total.triangles += blocks[b].count;
            total.found.add(parts[b].found);
            for (const uint32_t i : parts[b].drawn)
                total.sample.add(blocks[b].id(i), blocks[b].corners_of(i));
        }
    });
    total.checksum = checksum.finish();
    total.sample.finish();
    return total;
}

} // namespace ovc
