// SPDX-License-Identifier: Apache-2.0
// CornerSums: checksums of a soup's corners, block by block, so that a few triangles can be read
// and checked without all others.
#pragma once

#include "core/file/archive.h"
#include "core/soup.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// The triangles of a block: with floats 4,608 bytes, which is about what a disk reads at once.
inline constexpr uint32_t kCornerBlock = 128;

inline uint64_t corner_blocks(uint64_t triangles) {
    return (triangles + kCornerBlock - 1) / kCornerBlock;
}

/// A mesh without its corners.
struct SummedMesh {
    dvec3 origin{0};
    uint64_t triangles = 0;
    uint64_t first_sum = 0; // of its blocks; an instance has those of its mesh
    bool moves = false;     // and is cut by itself
    const Transform* transform = nullptr;
    const StoredCorners* stored = nullptr; // of a mesh that lies on a disk
};

struct CornerSums {
    std::vector<SummedMesh> meshes;
    std::vector<uint64_t> sums; // of all blocks

    /// Returns one number for the soup: origins, transforms and corners.
    uint64_t checksum() const;
};

/// Returns the meshes of the soup, whose sums are all 0. Transforms stay in the soup.
CornerSums unsummed(const Soup& soup);

/// Returns the sums of a soup in memory.
CornerSums corner_sums_of(const Soup& soup);

/// Writes the checksums of some triangles, which are whole blocks except at the end of a mesh.
void sum_blocks(Bytes corners, size_t triangle_bytes, std::span<uint64_t> sums);

} // namespace ovc
