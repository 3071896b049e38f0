// SPDX-License-Identifier: Apache-2.0
// DealtCells: the triangles of each cell of level 1, on a disk until the cell is built.
#pragma once

#include "core/function_ref.h"
#include "core/soup.h"
#include "plugin/out_of_core/local_soup.h"
#include "plugin/structure/triangle_source.h"

#include <concepts>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace ovc {

/// Triangles in the scratch space, one behind the other.
struct DealtExtent {
    uint64_t offset;
    uint64_t checksum;
};

/// A cell whose triangles all lie in the scratch space.
struct DealtCell {
    uint64_t count = 0;
    Box bounds;
    std::vector<DealtExtent> extents; // all full but the last
};

template <class Fields, class AnyCell>
requires std::same_as<std::remove_const_t<AnyCell>, DealtCell>
void each_field(Fields& fields, AnyCell& cell) {
    fields(cell.count, cell.bounds, cell.extents);
}

/// Each cell has a buffer in memory, which goes to the scratch space whenever it is full. Reading
/// throws a Failure where the scratch space gives other bytes than it got.
class DealtCells {
public:
    /// buffer_bytes: of each cell, at most.
    DealtCells(size_t cells, std::span<const SourceMesh> meshes, uint64_t buffer_bytes,
               ScratchSpace& scratch);

    size_t cells() const { return cells_.size(); }

    /// Adds a triangle to a cell. Any number of threads may call this.
    void add(size_t cell, TriangleId name, Bytes corners, const Box& bounds);
    /// Gives up a cell's buffer, once all of its triangles are added; it can then be read.
    void flush(size_t cell);
    /// Forgets a cell's triangles.
    void clear(size_t cell);

    /// Returns the number of a cell's triangles, and the box around them.
    uint64_t count(size_t cell) const { return cells_[cell].dealt.count; }
    const Box& bounds(size_t cell) const { return cells_[cell].dealt.bounds; }
    /// Returns all cells, which are flushed, for restore().
    std::vector<DealtCell> dealt() const;
    /// Takes the cells of an earlier build of the same scene, which lie in the scratch space.
    void restore(std::vector<DealtCell> dealt);
    /// Calls visit(name, corners) for each of a cell's triangles, in any order.
    void for_each(size_t cell, FunctionRef<void(TriangleId, Bytes)> visit) const;
    /// Returns a cell's triangles. Any number of threads may call this.
    LocalSoup read(size_t cell) const;

private:
    struct Cell {
        std::mutex mutex; // guards the other members while triangles are added
        DealtCell dealt;
        std::vector<std::byte> buffer; // its last triangles
    };

    void write_out(Cell& cell);
    void read_extent(const Cell& cell, size_t extent, std::span<std::byte> to) const;
    size_t extent_bytes(const Cell& cell, size_t extent) const;
    Bytes corners_of(const std::byte* record, TriangleId name) const;

    const std::span<const SourceMesh> meshes_;
    ScratchSpace& scratch_;
    const size_t record_bytes_; // a name and corners, as many as the largest triangle has
    const size_t full_bytes_;   // of an extent
    std::vector<Cell> cells_;
};

} // namespace ovc
