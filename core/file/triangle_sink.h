// SPDX-License-Identifier: Apache-2.0
// TriangleSink takes the triangles of a scene in parts, so that nobody need hold all of them.
#pragma once

#include "core/vec.h"

#include <span>

namespace ovc {

/// The corners of mesh 0 come first, then those of mesh 1, and so on, each mesh's in parts of whole
/// triangles.
class TriangleSink {
public:
    virtual ~TriangleSink() = default;

    /// Begins the next mesh.
    virtual void begin_mesh() = 0;
    /// Takes the next corners of the mesh, three for each triangle. Returns false where it wants no
    /// more, because nothing can come of the scene.
    virtual bool add_corners(std::span<const vec3> corners) = 0;
    /// Takes the next normals of the mesh, one for each corner, where it has any.
    virtual bool add_normals(std::span<const vec3> normals) = 0;
};

} // namespace ovc
