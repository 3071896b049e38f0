// SPDX-License-Identifier: Apache-2.0
// for_each_blocks() goes through all triangles of a source once, in order, some blocks at a time.
#pragma once

#include "core/soup.h"
#include "core/system/parallel.h"
#include "plugin/structure/triangle_source.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace ovc {

inline constexpr uint32_t kBlockTriangles = 1024;
inline constexpr size_t kBlocksAtOnce = 32;

/// Triangles of one mesh, in order.
struct SourceBlock {
    uint32_t mesh = 0;
    uint32_t first = 0;
    uint32_t count = 0;
    std::vector<std::byte> corners;

    TriangleId id(uint32_t i) const { return {mesh, first + i}; }
    Bytes corners_of(uint32_t i) const {
        const size_t size = corners.size() / count;
        return Bytes(corners).subspan(i * size, size);
    }
};

/// Returns the corners, whose bytes are as of `mesh`, as a chunk that borrows them.
inline Chunk borrowed_chunk(const SourceMesh& mesh, Bytes corners) {
    if (mesh.has_doubles)
        return Chunk::borrowing_doubles(
            mesh.origin,
            {reinterpret_cast<const dvec3*>(corners.data()), corners.size() / sizeof(dvec3)});
    return Chunk::borrowing(mesh.origin, {reinterpret_cast<const vec3*>(corners.data()),
                                          corners.size() / sizeof(vec3)});
}

/// Reads the source's triangles, and calls visit(std::span<const SourceBlock>) with the next of
/// them until there are no more.
template <class Visit>
void for_each_blocks(TriangleSource& source, Visit&& visit) {
    std::vector<SourceBlock> blocks(kBlocksAtOnce);
    size_t used = 0;
    const auto flush = [&] {
        parallel_for(used, 1, [&](size_t first, size_t last) {
            for (size_t b = first; b < last; ++b) {
                SourceBlock& block = blocks[b];
                const SourceMesh& mesh = source.meshes()[block.mesh];
                block.corners.resize(block.count * mesh.triangle_bytes());
                source.read(block.mesh, block.first, block.corners);
            }
        });
        visit(std::span<const SourceBlock>(blocks).first(used));
        used = 0;
    };
    for (uint32_t m = 0; m < source.meshes().size(); ++m) {
        const uint64_t size = source.meshes()[m].triangles;
        assert(size < kNone);
        for (uint64_t first = 0; first < size; first += kBlockTriangles) {
            blocks[used].mesh = m;
            blocks[used].first = uint32_t(first);
            blocks[used].count = uint32_t(std::min<uint64_t>(kBlockTriangles, size - first));
            if (++used == blocks.size())
                flush();
        }
    }
    if (used > 0)
        flush();
}

} // namespace ovc
