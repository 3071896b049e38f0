// SPDX-License-Identifier: Apache-2.0
#include "importers/pbrt/streamed_shapes.h"

#include "importers/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace ovc::pbrt {

namespace {

constexpr size_t kTrianglesOfPart = 1 << 14;

uint64_t bytes_of(const Mesh& mesh) {
    return mesh.positions.size() * sizeof(double) + mesh.indices.size() * sizeof(uint32_t) +
           (mesh.corners.size() + mesh.normals.size()) * sizeof(vec3) +
           mesh.uv.size() * sizeof(vec2);
}

} // namespace

/// The rest of the memory is for a shape while it is read, objects, meshes and their names.
StreamedShapes::StreamedShapes(const Streaming& streaming)
    : host_bytes_(streaming.host_bytes),
      corners_(streaming.folder, streaming.host_bytes / 16),
      normals_(streaming.folder, streaming.host_bytes / 32) {}

/// A shape takes its bytes twice while it is read: its numbers are doubles first.
Result<Done> StreamedShapes::check(const Shape& shape, const Place& place) const {
    const uint64_t allowed = host_bytes_ / 4, bytes = 2 * bytes_of(shape.mesh);
    if (bytes > allowed)
        return error_at(place, fmt::format("found a shape that takes {} bytes of host memory, and "
                                           "may take a quarter of {}: the smallest number that "
                                           "works is {}",
                                           bytes, host_bytes_, 4 * bytes));
    if (runs_.size() * kMeshBytes > allowed)
        return error_at(place, fmt::format("found more than {} meshes, which take {} bytes of host "
                                           "memory each, and may take a quarter of {}",
                                           runs_.size() - 1, kMeshBytes, host_bytes_));
    if (kept_bytes_ > allowed)
        return error_at(place, fmt::format("objects and texture coordinates take {} bytes of host "
                                           "memory up to here, and may take a quarter of {}",
                                           kept_bytes_, host_bytes_));
    return Done{};
}

Result<Done> StreamedShapes::keep(const Shape& shape, const Place& place) {
    kept_bytes_ += bytes_of(shape.mesh) + sizeof(Shape);
    return check(shape, place);
}

Result<Done> StreamedShapes::add(const Shape& shape, const Place& place) {
    append(shape, shapes_++, runs_);
    if (shape.mesh.size() == 0)
        return Done{};
    uv_.resize(runs_.size());
    if (shape.sight.wants_uv) {
        append_uv(shape, /* mirrored_place= */ false, uv_.back());
        kept_bytes_ += 3 * shape.mesh.size() * sizeof(vec2);
    }
    if (const Result<Done> fine = check(shape, place); !fine)
        return fine;
    if (shape.mesh.on_disk)
        add_stored(shape);
    else
        add_triangles(shape);
    if (error())
        return *error();
    if (shape.mesh.on_disk && shape.mesh.on_disk->error())
        return *shape.mesh.on_disk->error();
    return Done{};
}

/// Adds triangles that wait on a disk, some at a time.
void StreamedShapes::add_stored(const Shape& shape) {
    const TriangleStore& store = *shape.mesh.on_disk;
    Shape part{{.origin = shape.mesh.origin}, shape.to_object, shape.material, shape.reversed};
    for (uint64_t first = 0; first < store.corners(0); first += part.mesh.corners.size()) {
        part.mesh.corners.resize(std::min(3 * kTrianglesOfPart, store.corners(0) - first));
        part.mesh.normals.resize(store.normals(0) > 0 ? part.mesh.corners.size() : 0);
        if (!store.read_corners(0, first, part.mesh.corners) ||
            !store.read_normals(0, first, part.mesh.normals))
            return;
        add_triangles(part);
    }
}

void StreamedShapes::add_triangles(const Shape& shape) {
    const size_t count = shape.mesh.size();
    const PlacedCorners placed(shape, dmat4(1), /* mirrored_place= */ false);
    for (size_t t = 0; t < count; ++t)
        for (const dvec3& corner : placed.of(t)) {
            if (ovc::is_finite(corner))
                bounds_.add(corner);
            corners_.push_back(corner);
        }
    triangles_ += count;
    std::vector<vec3> normals;
    for (size_t t = 0; t < count && !shape.mesh.normals.empty(); t += kTrianglesOfPart) {
        const size_t end = std::min(t + kTrianglesOfPart, count);
        normals.resize(3 * (end - t));
        write_normals(shape, /* mirrored_place= */ false, t, end, normals.data());
        for (const vec3& normal : normals)
            normals_.push_back(normal);
    }
}

void StreamedShapes::pass_on(size_t run, const Frame& frame, MeshOutput& output) {
    const size_t end = next_corner_ + 3 * size_t(runs_[run].triangles);
    std::vector<vec3> normals;
    while (next_corner_ < end && output.is_wanted()) {
        std::vector<vec3> corners(std::min(3 * kTrianglesOfPart, end - next_corner_));
        for (vec3& corner : corners)
            corner = frame.offset(corners_[next_corner_++]);
        normals.resize(runs_[run].has_normals ? corners.size() : 0);
        for (vec3& normal : normals)
            normal = normals_[next_normal_++];
        output.add(Chunk::owning(frame.origin, std::move(corners)), normals);
    }
}

} // namespace ovc::pbrt
