// SPDX-License-Identifier: Apache-2.0
#include "importers/pbrt/runs.h"

#include "core/system/parallel.h"

#include <cassert>

namespace ovc::pbrt {

namespace {

/// Shapes of more than kSmall triangles stay meshes of their own; a mesh of smaller ones grows to
/// at most kLargestRun.
constexpr uint64_t kSmall = 4096, kLargestRun = uint64_t(1) << 20;

bool belongs(const Run& run, const Shape& shape) {
    return run.material == shape.material && run.has_normals == shape.mesh.has_normals() &&
           run.sight == shape.sight && run.triangles + shape.mesh.size() <= kLargestRun &&
           shape.mesh.size() <= kSmall && run.last_size <= kSmall;
}

/// Returns corner i of the triangle; if `flipped`, corners 1 and 2 change places.
size_t nth_corner(size_t triangle, size_t i, bool flipped) {
    assert(i < 3);
    return 3 * triangle + (flipped && i > 0 ? 3 - i : i);
}

} // namespace

void append(const Shape& shape, size_t index, std::vector<Run>& runs) {
    if (shape.mesh.size() == 0)
        return;
    if (runs.empty() || !belongs(runs.back(), shape))
        runs.push_back({index, index, 0, shape.material, shape.mesh.has_normals(), shape.sight,
                        shape.mesh.name});
    Run& run = runs.back();
    run.last = index + 1;
    run.last_size = shape.mesh.size();
    run.triangles += uint32_t(shape.mesh.size());
    run.normals_left_out += shape.mesh.normals_left_out;
    run.texture_coordinates_left_out += shape.mesh.texture_coordinates_left_out;
}

std::vector<Run> runs_of(const Object& object) {
    std::vector<Run> runs;
    for (size_t i = 0; i < object.shapes.size(); ++i)
        append(object.shapes[i], i, runs);
    return runs;
}

std::array<dvec3, 3> PlacedCorners::of(size_t triangle) const {
    const bool flipped = is_flipped(shape_, triangle) != mirrored_;
    std::array<dvec3, 3> corners;
    for (size_t i = 0; i < 3; ++i)
        corners[i] = point_through(to_world_, shape_.mesh.corner(nth_corner(triangle, i, flipped)));
    return corners;
}

void write_corners(const Shape& shape, const dmat4& place, const Frame& frame, bool mirrored_place,
                   vec3* to) {
    const PlacedCorners placed(shape, place, mirrored_place);
    parallel_for(shape.mesh.size(), 1024, [&](size_t first, size_t last) {
        for (size_t t = first; t < last; ++t) {
            const std::array<dvec3, 3> corners = placed.of(t);
            for (size_t i = 0; i < 3; ++i)
                to[3 * t + i] = frame.offset(corners[i]);
        }
    });
}

void write_normals(const Shape& shape, bool mirrored_place, size_t first, size_t last, vec3* to) {
    assert(shape.mesh.size() == 0 || !shape.mesh.normals.empty());
    const dmat3 turn = normal_matrix(shape.to_object);
    const bool mirrored = swaps_handedness(shape.to_object) != mirrored_place;
    const auto usable = [](const dvec3& n) { return ovc::is_finite(n) && glm::dot(n, n) > 0; };
    for (size_t t = first; t < last; ++t) {
        const bool flipped = is_flipped(shape, t) != mirrored;
        for (size_t i = 0; i < 3; ++i) {
            dvec3 n = turn * dvec3(shape.mesh.normal(nth_corner(t, i, flipped)));
            if (!usable(n)) {
                const dvec3 a = shape.mesh.corner(3 * t);
                n = turn *
                    glm::cross(shape.mesh.corner(3 * t + 1) - a, shape.mesh.corner(3 * t + 2) - a);
            }
            *to++ = usable(n) ? vec3(glm::normalize(n)) : vec3(0);
        }
    }
}

void append_uv(const Shape& shape, bool mirrored_place, std::vector<vec2>& uv) {
    const bool mirrored = swaps_handedness(shape.to_object) != mirrored_place;
    for (size_t t = 0; t < shape.mesh.size(); ++t)
        for (size_t k = 0; k < 3; ++k)
            uv.push_back(shape.mesh.uv_of(nth_corner(t, k, is_flipped(shape, t) != mirrored)));
}

} // namespace ovc::pbrt
