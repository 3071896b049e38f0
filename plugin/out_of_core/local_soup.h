// SPDX-License-Identifier: Apache-2.0
// LocalSoup: some triangles of a source in a soup of their own, which remembers their names.
#pragma once

#include "core/soup.h"
#include "plugin/structure/triangle_source.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Chunks follow the meshes that have triangles here, so local ids are in the order of names.
class LocalSoup {
public:
    explicit LocalSoup(std::span<const SourceMesh> meshes) : meshes_(meshes) {}

    /// Adds a triangle, whose corners are as the source has them. Names rise.
    void add(TriangleId name, Bytes corners);
    /// Makes the soup of what was added; nothing may be added afterwards.
    void finish();

    const Soup& soup() const { return soup_; }
    uint64_t size() const { return size_; }
    /// Returns the local ids of all triangles, sorted.
    std::vector<TriangleId> triangles() const;
    TriangleId name(TriangleId local) const {
        return {mesh_[local.mesh], prims_[local.mesh][local.prim]};
    }

private:
    std::span<const SourceMesh> meshes_;
    uint64_t size_ = 0;
    std::vector<uint32_t> mesh_; // of each chunk
    std::vector<std::vector<uint32_t>> prims_;
    std::vector<vec3> floats_; // of the chunk that is being added to
    std::vector<dvec3> doubles_;
    Soup soup_;
};

} // namespace ovc
