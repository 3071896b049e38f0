// SPDX-License-Identifier: Apache-2.0
// HostBudget: how a build out of core shares out the host memory that it may take.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ovc {

// Measured with /usr/bin/time (docs/benchmarks.md, "Conversion under a budget").
inline constexpr uint64_t kBytesInMemory = 500; // a triangle of a scene that is built in memory
inline constexpr uint64_t kBytesOfCell = 500;   // a triangle of a cell that is being built
inline constexpr uint64_t kBytesOfSample = 400; // a triangle of the sample, with the tree over it
inline constexpr uint64_t kBytesOfDouble = 80;  // that one of doubles takes besides in a cell
inline constexpr uint64_t kBytesOfMesh = 512;   // of tables, where there are more than a few

/// A budget counts at least so many threads, so that most cells which hold more than their sample
/// made believe are built whole.
inline constexpr size_t kMinThreads = 3;

/// The parts of a budget. A quarter goes to the sample, an eighth to the buffers of cells, and half
/// to cells that are being built; tables and blocks that are read share the rest.
struct HostBudget {
    uint64_t bytes; // besides tables of the meshes
    size_t threads;
    bool has_doubles = false; // some of the triangles

    bool holds(uint64_t triangles) const { return triangles <= bytes / kBytesInMemory; }
    /// Returns the rate of the largest sample that there is room for, a power of two.
    uint32_t sample_rate(uint64_t triangles) const;
    /// Returns how many triangles all cells that are being built may have together.
    uint64_t triangles_at_once() const {
        return bytes / 2 / (kBytesOfCell + (has_doubles ? kBytesOfDouble : 0));
    }
    /// Returns how many triangles a leaf may have, so that each thread builds one.
    uint64_t leaf_triangles() const { return triangles_at_once() / threads; }
    /// Returns the bytes of a cell's buffer.
    uint64_t buffer_bytes(size_t cells) const;
};

/// Returns the smallest budget that holds the buffers and tables of so many triangles' cells, on so
/// many threads. Cells that hold too many triangles are parted, so it works with all scenes.
uint64_t smallest_host_budget(uint64_t triangles, size_t threads);

} // namespace ovc
