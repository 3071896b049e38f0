// SPDX-License-Identifier: Apache-2.0
// Mesh holds the triangles of one shape in its own coordinates, whatever made them.
#pragma once

#include "core/box.h"
#include "core/vec.h"
#include "importers/scratch/triangle_store.h"

#include <cassert>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace ovc::pbrt {

/// A mesh is either indexed, with three doubles per vertex; or, from a PLY file, has three corners
/// per triangle in single precision, to be added to an origin. It has no normals, or normals of any
/// length: one per vertex if it is indexed, else one per corner. Likewise texture coordinates.
struct Mesh {
    std::string name;
    std::vector<double> positions;
    std::vector<uint32_t> indices;
    dvec3 origin{0};
    std::vector<vec3> corners;
    std::vector<vec3> normals;
    std::vector<vec2> uv;
    /// The corners and normals of a PLY file that is not to be in memory, instead; or null. The
    /// functions below do not see them.
    std::shared_ptr<const TriangleStore> on_disk;
    uint64_t emitters = 0; // the shapes that pbrt-v4 makes of it; 0: one of each triangle
    uint64_t normals_left_out = 0, texture_coordinates_left_out = 0; // as in MeshInfo

    uint64_t size() const {
        return (indices.size() + corners.size() + (on_disk ? on_disk->corners(0) : 0)) / 3;
    }
    bool has_normals() const { return !normals.empty() || (on_disk && on_disk->normals(0) > 0); }
    bool is_indexed() const { return corners.empty(); }

    /// Returns corner c, which belongs to triangle c / 3.
    dvec3 corner(size_t c) const {
        assert(c < 3 * size());
        if (!is_indexed())
            return origin + dvec3(corners[c]);
        assert(size_t(indices[c]) * 3 + 2 < positions.size());
        const double* p = positions.data() + size_t(indices[c]) * 3;
        return {p[0], p[1], p[2]};
    }
    vec3 normal(size_t c) const {
        assert(c < 3 * size() && (is_indexed() ? indices[c] : c) < normals.size());
        return normals[is_indexed() ? indices[c] : c];
    }

    /// Returns pbrt's texture coordinates of corner c, also where the file has none.
    vec2 uv_of(size_t c) const {
        constexpr vec2 kOtherwise[] = {vec2(0, 0), vec2(1, 0), vec2(1, 1)};
        const size_t at = is_indexed() ? indices[c] : c;
        return at < uv.size() ? uv[at] : kOtherwise[c % 3];
    }

    void add_vertex(const dvec3& p) { positions.insert(positions.end(), {p.x, p.y, p.z}); }
    void add_triangle(uint32_t a, uint32_t b, uint32_t c) {
        indices.insert(indices.end(), {a, b, c});
    }
};

} // namespace ovc::pbrt
