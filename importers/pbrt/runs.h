// SPDX-License-Identifier: Apache-2.0
// A run is neighbouring shapes that become one mesh; its corners are placed and turned round here.
#pragma once

#include "importers/pbrt/objects.h"

#include <array>

namespace ovc::pbrt {

struct Run {
    size_t first, last; // indices into the object's shapes
    uint32_t triangles = 0;
    uint32_t material = 0;
    bool has_normals = false;
    Sight sight;
    std::string name;              // of the first shape
    uint64_t last_size = 0;        // triangles of the last shape
    uint32_t normals_from = kNone; // the first mesh made of it, which holds the normals
    uint32_t uv_from = kNone;      // likewise the texture coordinates
    /// The first meshes made of it, whose corners other instances borrow: one as the file has it,
    /// and one with its triangles turned round, for transforms that mirror.
    std::array<uint32_t, 2> corners_from{kNone, kNone};
    uint64_t normals_left_out = 0, texture_coordinates_left_out = 0; // as in MeshInfo

    void tell_left_out(MeshInfo& mesh) const {
        mesh.normals_left_out = normals_left_out;
        mesh.texture_coordinates_left_out = texture_coordinates_left_out;
    }
};

/// Adds shape number `index`, unless it is empty, to the last run, or to a new one. Shapes of one
/// material go together while they are small.
void append(const Shape& shape, size_t index, std::vector<Run>& runs);
std::vector<Run> runs_of(const Object& object);

/// Turns corners in double into offsets in float.
struct Frame {
    dvec3 origin{0};
    double lattice = 0; // the lattice's step; 0: no lattice

    vec3 offset(const dvec3& p) const {
        const dvec3 offset = p - origin;
        return vec3(lattice > 0 ? glm::round(offset / lattice) * lattice : offset);
    }
};

/// Where a shape's corners go: placed, and turned round if the transform mirrors, unless a later
/// one will mirror them as well.
class PlacedCorners {
public:
    PlacedCorners(const Shape& shape, const dmat4& place, bool mirrored_place)
        : shape_(shape),
          to_world_(place * shape.to_object),
          mirrored_(swaps_handedness(to_world_) != mirrored_place) {}

    std::array<dvec3, 3> of(size_t triangle) const;

private:
    const Shape& shape_;
    const dmat4 to_world_;
    const bool mirrored_;
};

/// Writes three corners per triangle to `to`, which may be the mesh's own corners.
void write_corners(const Shape& shape, const dmat4& place, const Frame& frame, bool mirrored_place,
                   vec3* to);
/// Writes the normals of triangles `first` to `last` in the object's coordinates, in the order of
/// write_corners().
void write_normals(const Shape& shape, bool mirrored_place, size_t first, size_t last, vec3* to);
/// Appends texture coordinates in that order.
void append_uv(const Shape& shape, bool mirrored_place, std::vector<vec2>& uv);

} // namespace ovc::pbrt
