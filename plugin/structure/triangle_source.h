// SPDX-License-Identifier: Apache-2.0
// StreamedScene: a scene that is built out of core. Its build asks its caller for the corners of
// meshes, in parts, and for scratch space on a disk.
#pragma once

#include "core/file/archive.h"
#include "core/vec.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace ovc {

/// A mesh whose corners are read in parts. They count from `origin`, as those of a Chunk.
struct SourceMesh {
    dvec3 origin{0};
    uint64_t triangles = 0;
    bool has_doubles = false; // else corners are floats

    size_t triangle_bytes() const { return 3 * (has_doubles ? sizeof(dvec3) : sizeof(vec3)); }
};

class TriangleSource {
public:
    virtual ~TriangleSource() = default;

    /// Returns the meshes, which stay as they are.
    virtual std::span<const SourceMesh> meshes() const = 0;
    /// Reads the corners of the mesh's triangles from `first` on, as many as fit into `corners`
    /// exactly. Any number of threads may call this. Throws Cancelled where it cannot.
    virtual void read(uint32_t mesh, uint64_t first, std::span<std::byte> corners) = 0;
};

/// A file of no fixed size. Any number of threads may use it, each on bytes of its own.
class ScratchSpace {
public:
    virtual ~ScratchSpace() = default;

    /// Both throw Cancelled where they cannot. Only what was written before is read.
    virtual void write(uint64_t offset, Bytes bytes) = 0;
    virtual void read(uint64_t offset, std::span<std::byte> bytes) = 0;

    /// Returns the offset of so many bytes that nobody else gets.
    uint64_t allocate(uint64_t bytes) { return end_.fetch_add(bytes); }
    /// Returns how many bytes were allocated.
    uint64_t bytes() const { return end_; }
    /// Goes on behind what an earlier build allocated.
    void go_on_at(uint64_t bytes) { end_ = bytes; }

private:
    std::atomic<uint64_t> end_{0};
};

/// Keeps what a build has done, step by step. A build of the same scene that comes after its end
/// finds the steps, and the scratch space as it was.
class StepKeeper {
public:
    virtual ~StepKeeper() = default;

    /// Returns the steps of the build before, in order.
    virtual std::span<const Bytes> kept() const = 0;
    /// Keeps a step behind those, once all that was passed to the sink before it is kept too.
    /// Throws Cancelled where it cannot, as the next does.
    virtual void keep(Bytes step) = 0;
    /// Reads bytes that the build before passed to its sink, by their offset among all.
    virtual void read_written(uint64_t offset, std::span<std::byte> to) = 0;
};

/// The source of a scene, and the memory that its build may take.
struct StreamedScene {
    TriangleSource& source;
    ScratchSpace& scratch;
    /// The max bytes of host memory, besides what the program takes itself.
    uint64_t host_bytes;
    StepKeeper* steps = nullptr; // null: nothing is kept
};

} // namespace ovc
