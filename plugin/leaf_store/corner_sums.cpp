// SPDX-License-Identifier: Apache-2.0
// CornerSums: each mesh is summed once, however many instances show it.
#include "plugin/leaf_store/corner_sums.h"

#include "core/file/checksum.h"
#include "core/system/parallel.h"

#include <algorithm>
#include <cassert>
#include <map>

namespace ovc {

uint64_t CornerSums::checksum() const {
    Checksum all;
    for (const SummedMesh& mesh : meshes) {
        all.add(bytes_of(std::span<const dvec3>(&mesh.origin, 1)));
        all.add_value(mesh.triangles);
        all.add_value(mesh.first_sum);
        all.add_value(uint64_t(mesh.moves));
        if (mesh.transform)
            all.add(bytes_of(std::span<const Transform>(mesh.transform, 1)));
    }
    all.add(bytes_of(std::span<const uint64_t>(sums)));
    return all.value();
}

CornerSums unsummed(const Soup& soup) {
    CornerSums found;
    uint64_t blocks = 0;
    std::map<Chunk::MeshKey, uint64_t> first_sum;
    for (const Chunk& chunk : soup.chunks) {
        uint64_t first = blocks;
        if (chunk.size() > 0)
            first = first_sum.try_emplace(chunk.mesh_key(), blocks).first->second;
        if (first == blocks)
            blocks += corner_blocks(chunk.size());
        found.meshes.push_back({chunk.origin(), chunk.size(), first, chunk.moves(),
                                chunk.transform(), chunk.stored_corners()});
    }
    found.sums.resize(blocks);
    return found;
}

void sum_blocks(Bytes corners, size_t triangle_bytes, std::span<uint64_t> sums) {
    const size_t block_bytes = kCornerBlock * triangle_bytes;
    assert(sums.size() == (corners.size() + block_bytes - 1) / block_bytes);
    for (size_t b = 0; b < sums.size(); ++b) {
        const size_t first = b * block_bytes;
        sums[b] =
            checksum_of(corners.subspan(first, std::min(block_bytes, corners.size() - first)));
    }
}

CornerSums corner_sums_of(const Soup& soup) {
    constexpr size_t kBlocksATask = 64;
    CornerSums found = unsummed(soup);
    uint64_t summed = 0; // meshes come in the order of their blocks
    for (size_t m = 0; m < soup.chunks.size(); ++m) {
        const Chunk& chunk = soup.chunks[m];
        if (found.meshes[m].first_sum < summed)
            continue;
        const std::span sums = std::span(found.sums).subspan(summed, corner_blocks(chunk.size()));
        summed += sums.size();
        const Bytes corners = chunk.double_corners().empty() ? bytes_of(chunk.corners())
                                                             : bytes_of(chunk.double_corners());
        const size_t triangle_bytes = sums.empty() ? 1 : corners.size() / chunk.size();
        parallel_for(sums.size(), kBlocksATask, [&](size_t from, size_t to) {
            const size_t begin = from * kCornerBlock * triangle_bytes;
            const size_t end = std::min(to * kCornerBlock * triangle_bytes, corners.size());
            sum_blocks(corners.subspan(begin, end - begin), triangle_bytes,
                       sums.subspan(from, to - from));
        });
    }
    return found;
}

} // namespace ovc
