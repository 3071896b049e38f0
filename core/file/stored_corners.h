// SPDX-License-Identifier: Apache-2.0
// StoredCorners: the corners of a mesh that lie on a disk instead of in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace ovc {

/// The corners of one mesh, three offsets for each triangle, as a Chunk has them.
class StoredCorners {
public:
    virtual ~StoredCorners() = default;

    /// Whether offsets are doubles; else they are floats.
    virtual bool has_doubles() const = 0;
    size_t triangle_bytes() const { return has_doubles() ? 72 : 36; }
    /// Reads the corners of whole triangles from `first` on, as many as fit into `to` exactly. Any
    /// number of threads may call this. Where they cannot be read, it returns false, `to` becomes
    /// zeros, which no ray hits, and the owner of the corners knows why.
    virtual bool read(uint32_t first, std::span<std::byte> to) const = 0;
    /// Does so for whoever checks what was read, and tells of failures, by itself.
    virtual bool read_unchecked(uint32_t first, std::span<std::byte> to) const {
        return read(first, to);
    }
};

} // namespace ovc
