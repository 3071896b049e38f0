// SPDX-License-Identifier: Apache-2.0
// TriangleSink takes the triangles of a scene in parts, so that nobody need hold all of them.
#pragma once

#include "core/vec.h"

#include <cstddef>
#include <span>

namespace ovc {

/// The corners of a mesh come in parts of whole triangles. Most sources give those of mesh 0 first,
/// then those of mesh 1, and so on; others go on with meshes that they left.
class TriangleSink {
public:
    virtual ~TriangleSink() = default;

    /// Begins the next mesh.
    virtual void begin_mesh() = 0;
    /// Goes on with a mesh that has begun, behind its last corners and normals.
    virtual void go_on_with(size_t mesh) = 0;
    /// Drops the normals that a mesh has so far, because some of its corners have none.
    virtual void drop_normals(size_t mesh) = 0;
    /// Takes the next corners of the mesh, three for each triangle. Returns false where it wants no
    /// more, because nothing can come of the scene.
    virtual bool add_corners(std::span<const vec3> corners) = 0;
    /// Takes the next normals of the mesh, one for each corner, where it has any.
    virtual bool add_normals(std::span<const vec3> normals) = 0;
};

} // namespace ovc
