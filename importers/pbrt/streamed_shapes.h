// SPDX-License-Identifier: Apache-2.0
// StreamedShapes takes the world's own shapes as they are read, and keeps their triangles on disk
// until the origin of the scene is known.
#pragma once

#include "importers/pbrt/interpret/diagnostics.h"
#include "importers/pbrt/mesh_output.h"
#include "importers/pbrt/runs.h"
#include "importers/scratch/scratch_array.h"

namespace ovc::pbrt {

class StreamedShapes {
public:
    explicit StreamedShapes(const Streaming& streaming);

    /// Takes a shape of the world. Error: as the sentences say, or the disk fails.
    Result<Done> add(const Shape& shape, const Place& place);
    /// Counts a shape of an object, which stays in memory for the instances to come.
    Result<Done> keep(const Shape& shape, const Place& place);

    const std::vector<Run>& runs() const { return runs_; }
    uint64_t triangles() const { return triangles_; }
    const Box& bounds() const { return bounds_; }

    /// Passes a run's triangles to the output. Call this once for each run, in order.
    void pass_on(size_t run, const Frame& frame, MeshOutput& output);
    std::vector<vec2> take_uv(size_t run) { return std::move(uv_[run]); }
    /// Returns how the disk failed; null where it did not.
    const Error* error() const { return corners_.error() ? corners_.error() : normals_.error(); }

private:
    Result<Done> check(const Shape& shape, const Place& place) const;
    void add_triangles(const Shape& shape);
    void add_stored(const Shape& shape);

    const uint64_t host_bytes_;
    ScratchArray<dvec3> corners_; // of the world
    ScratchArray<vec3> normals_;
    std::vector<std::vector<vec2>> uv_; // of each run; they stay in memory, for few shapes have any
    std::vector<Run> runs_;
    size_t shapes_ = 0;
    uint64_t triangles_ = 0;
    uint64_t kept_bytes_ = 0; // of objects' shapes, and of texture coordinates
    Box bounds_;
    size_t next_corner_ = 0, next_normal_ = 0; // that pass_on() begins with
};

} // namespace ovc::pbrt
