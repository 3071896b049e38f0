// SPDX-License-Identifier: Apache-2.0
// Checks meshes and transforms of the host.
#include "plugin/abi/mesh_data.h"

#include "core/text/format_text.h"
#include "plugin/abi/scene_call.h"
#include "plugin/abi/struct_size.h"

#include <cmath>
#include <cstring>

namespace ovc {
namespace {

void check_positions(const ovc_mesh& mesh) {
    if (mesh.read_corners) {
        if (mesh.positions || mesh.positions_double || mesh.indices || mesh.vertex_count ||
            mesh.flags & OVC_MESH_SHARED)
            invalid(
                "ovc_mesh.read_corners is set: expected no positions, indices, vertex_count and "
                "OVC_MESH_SHARED");
        return;
    }
    if (mesh.positions && mesh.positions_double)
        invalid("ovc_mesh.positions and positions_double are both set; one says it all");
    if (!mesh.positions && !mesh.positions_double && mesh.vertex_count)
        invalid("ovc_mesh.positions is NULL");
    const auto check = [&](const char* name, const void* positions, size_t size) {
        if (reinterpret_cast<uintptr_t>(positions) % size)
            invalid(
                format_text("ovc_mesh.{} is at an address that is no multiple of {}", name, size));
        if (mesh.stride < 3 * size || mesh.stride % size)
            invalid(format_text(
                "ovc_mesh.stride is {}, expected {} or more and, as {}, a multiple of {}",
                mesh.stride, 3 * size, name, size));
    };
    if (mesh.positions_double)
        check("positions_double", mesh.positions_double, sizeof(double));
    else
        check("positions", mesh.positions, sizeof(float));
}

void check_counts(const ovc_mesh& mesh) {
    if (!mesh.indices && mesh.vertex_count % 3)
        invalid(format_text("ovc_mesh.vertex_count is {} without indices, expected a multiple of 3",
                            mesh.vertex_count));
    const uint64_t triangles = triangles_of(mesh);
    if (!mesh.indices && !mesh.read_corners && mesh.triangle_count &&
        mesh.triangle_count != triangles)
        invalid(
            format_text("ovc_mesh.triangle_count is {}, but {} vertices without indices make {}",
                        mesh.triangle_count, mesh.vertex_count, triangles));
    if (triangles >= kNone)
        invalid(format_text("a mesh holds fewer than {} triangles, not {}; split it", kNone,
                            triangles));
}

template <class Corner>
std::vector<Corner> corners_at(const ovc_mesh& mesh, const void* positions) {
    std::vector<Corner> corners(triangles_of(mesh) * 3);
    if (is_packed(mesh)) {
        if (!corners.empty())
            std::memcpy(corners.data(), positions, corners.size() * sizeof(Corner));
        return corners;
    }
    for (uint64_t i = 0; i < corners.size(); ++i) {
        const uint64_t vertex = mesh.indices ? mesh.indices[i] : i;
        if (vertex >= mesh.vertex_count)
            invalid(format_text("ovc_mesh.indices[{}] is {}, expected less than vertex_count = {}",
                                i, vertex, mesh.vertex_count));
        std::memcpy(&corners[i], static_cast<const char*>(positions) + vertex * mesh.stride,
                    sizeof(Corner));
    }
    return corners;
}

} // namespace

uint64_t triangles_of(const ovc_mesh& mesh) {
    return mesh.indices || mesh.read_corners ? mesh.triangle_count : mesh.vertex_count / 3;
}

ovc_mesh checked(const ovc_mesh* given) {
    ovc_mesh mesh = whole("ovc_mesh", given, offsetof(ovc_mesh, positions_double));
    const uint32_t packed = mesh.positions_double ? 24 : 12;
    if (!mesh.stride)
        mesh.stride = packed;
    check_positions(mesh);
    if (mesh.flags & ~uint32_t(OVC_MESH_SHARED | OVC_MESH_TEMPLATE | OVC_MESH_MOVES) ||
        mesh.reserved || mesh.reserved1 || mesh.reads_doubles > 1 || mesh.reserved2)
        invalid("ovc_mesh.flags or reserved has bits that this version does not know");
    check_counts(mesh);
    if ((mesh.flags & OVC_MESH_SHARED) && (mesh.stride != packed || mesh.indices))
        invalid(format_text("OVC_MESH_SHARED needs stride {} and no indices", packed));
    for (const double coordinate : mesh.origin)
        if (!std::isfinite(coordinate))
            invalid("ovc_mesh.origin is not finite");
    return mesh;
}

bool is_packed(const ovc_mesh& mesh) {
    return !mesh.indices && mesh.stride == (mesh.positions_double ? sizeof(dvec3) : sizeof(vec3));
}

std::vector<vec3> copied_corners(const ovc_mesh& mesh) {
    return corners_at<vec3>(mesh, mesh.positions);
}

std::vector<dvec3> copied_double_corners(const ovc_mesh& mesh) {
    return corners_at<dvec3>(mesh, mesh.positions_double);
}

std::optional<Transform> transform_of(const char* field, const double* given) {
    if (!given)
        return std::nullopt;
    Transform transform;
    for (size_t i = 0; i < 12; ++i) {
        if (!std::isfinite(given[i]))
            invalid(format_text("{}[{}] is not finite", field, i));
        transform.rows[i / 4][i % 4] = given[i];
    }
    return transform;
}

} // namespace ovc
