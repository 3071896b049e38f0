// SPDX-License-Identifier: Apache-2.0
// Mesh: the triangles of one shape in its own coordinates, however they came.
#pragma once

#include "core/box.h"
#include "core/vec.h"

#include <cstdint>
#include <string>
#include <vector>

namespace ovc::pbrt {

/// Either indexed, with coordinates in double, three numbers a vertex; or, from a PLY file, three
/// single-precision corners a triangle that are added to an origin. Normals of any length, or none:
/// one a vertex where indexed, else one a corner.
struct Mesh {
    std::string name;
    std::vector<double> positions;
    std::vector<uint32_t> indices;
    dvec3 origin{0};
    std::vector<vec3> corners;
    std::vector<vec3> normals;
    uint64_t normals_left_out = 0, texture_coordinates_left_out = 0; // as in MeshInfo

    uint64_t size() const { return (indices.size() + corners.size()) / 3; }
    bool is_indexed() const { return corners.empty(); }

    /// Corner c is that of triangle c / 3.
    dvec3 corner(size_t c) const {
        if (!is_indexed())
            return origin + dvec3(corners[c]);
        const double* p = positions.data() + size_t(indices[c]) * 3;
        return {p[0], p[1], p[2]};
    }
    vec3 normal(size_t c) const { return normals[is_indexed() ? indices[c] : c]; }

    void add_vertex(const dvec3& p) { positions.insert(positions.end(), {p.x, p.y, p.z}); }
    void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
        indices.insert(indices.end(), {a, b, c});
    }
};

} // namespace ovc::pbrt
