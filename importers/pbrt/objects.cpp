// SPDX-License-Identifier: Apache-2.0
// is_flipped() tells which side of a triangle faces outwards.
// Based on: pbrt-v4, Triangle::InteractionFromIntersection: normals decide, where there are any.
#include "importers/pbrt/objects.h"

#include <cassert>

namespace ovc::pbrt {

bool is_flipped(const Shape& shape, size_t triangle) {
    const Mesh& mesh = shape.mesh;
    assert(triangle < mesh.size());
    if (mesh.normals.empty())
        return shape.reversed;
    const size_t c = 3 * triangle;
    const dvec3 a = mesh.corner(c);
    const dvec3 out = glm::cross(mesh.corner(c + 1) - a, mesh.corner(c + 2) - a);
    const vec3 sum = mesh.normal(c) + mesh.normal(c + 1) + mesh.normal(c + 2);
    return (glm::dot(out, dvec3(sum)) < 0) != shape.reversed;
}

} // namespace ovc::pbrt
