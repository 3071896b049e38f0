// SPDX-License-Identifier: Apache-2.0
// Objects: shapes under a name, placed by instances; the world is one that is placed once.
#pragma once

#include "importers/pbrt/interpret/transform.h"
#include "importers/pbrt/shapes/mesh.h"

namespace ovc::pbrt {

struct Shape {
    Mesh mesh;
    dmat4 to_object; // where the mesh stands in its object
    uint32_t material = 0;
    bool reversed = false; // ReverseOrientation
};

/// Whether a triangle's corners run the other way than its normals, or ReverseOrientation, say. A
/// transform that mirrors turns it round once more.
bool is_flipped(const Shape& shape, size_t triangle);

struct Instance {
    uint32_t object; // index into World::objects; inside an object, one before it
    dmat4 to_parent;
};

struct Object {
    std::string name;
    std::vector<Shape> shapes;
    std::vector<Instance> instances;
};

struct World {
    std::vector<Object> objects; // as they are completed, so that none can contain itself
    Object top;
};

} // namespace ovc::pbrt
