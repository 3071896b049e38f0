// SPDX-License-Identifier: Apache-2.0
// An object is a set of shapes under a name, placed by instances; the world's own shapes are an
// object, too.
#pragma once

#include "core/scene.h"
#include "importers/pbrt/interpret/transform.h"
#include "importers/pbrt/shapes/mesh.h"

namespace ovc::pbrt {

/// The visibility of a shape: its holes, and the rays that see it.
struct Sight {
    uint32_t cutout = kNone, shadow_cutout = kNone; // as in MeshInfo
    uint32_t seen_by = kSeenByAll;
    bool wants_uv = false; // for a cutout, or for a texture of the material

    bool operator==(const Sight&) const = default;
};

struct Shape {
    Mesh mesh;
    dmat4 to_object; // places the mesh in its object
    uint32_t material = 0;
    bool reversed = false; // ReverseOrientation
    Sight sight{};
};

/// Returns whether a triangle's corners run the other way than its normals, or ReverseOrientation,
/// say. The caller must turn it round once more for a transform that mirrors.
bool is_flipped(const Shape& shape, size_t triangle);

struct Instance {
    uint32_t object; // index into World::objects, below that of an object that contains this
    dmat4 to_parent;
};

struct Object {
    std::string name;
    std::vector<Shape> shapes;
    std::vector<Instance> instances;
    uint64_t streamed = 0; // triangles of shapes that StreamedShapes has, not this
};

struct World {
    std::vector<Object> objects; // in the order of their ends, so that none can contain itself
    Object top;
};

} // namespace ovc::pbrt
