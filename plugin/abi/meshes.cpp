// SPDX-License-Identifier: Apache-2.0
// add_mesh and add_instance: check what is added, and make a chunk of the soup of it.
#include "core/text/format_text.h"
#include "plugin/abi/scene.h"
#include "plugin/abi/scene_call.h"
#include "plugin/abi/struct_size.h"

#include <cmath>
#include <cstring>
#include <optional>

namespace ovc {
namespace {

uint64_t triangles_of(const ovc_mesh& mesh) {
    return mesh.indices ? mesh.triangle_count : mesh.vertex_count / 3;
}

void check_positions(const ovc_mesh& mesh) {
    if (mesh.positions && mesh.positions_double)
        invalid("ovc_mesh.positions and positions_double are both set; one says it all");
    if (!mesh.positions && !mesh.positions_double && mesh.vertex_count)
        invalid("ovc_mesh.positions is NULL");
    if (mesh.positions_double) {
        if (mesh.stride < 24 || mesh.stride % 8 ||
            reinterpret_cast<uintptr_t>(mesh.positions_double) % 8)
            invalid(format_text("ovc_mesh.stride is {}, expected 24 or more and, as "
                                "positions_double, a multiple of 8",
                                mesh.stride));
        return;
    }
    if (mesh.stride < 12 || mesh.stride % 4 || reinterpret_cast<uintptr_t>(mesh.positions) % 4)
        invalid(format_text(
            "ovc_mesh.stride is {}, expected 12 or more and, as positions, a multiple of 4",
            mesh.stride));
}

void check_counts(const ovc_mesh& mesh) {
    if (!mesh.indices && mesh.vertex_count % 3)
        invalid(format_text("ovc_mesh.vertex_count is {} without indices, expected a multiple of 3",
                            mesh.vertex_count));
    const uint64_t triangles = triangles_of(mesh);
    if (!mesh.indices && mesh.triangle_count && mesh.triangle_count != triangles)
        invalid(
            format_text("ovc_mesh.triangle_count is {}, but {} vertices without indices make {}",
                        mesh.triangle_count, mesh.vertex_count, triangles));
    if (triangles >= kNone)
        invalid(format_text("a mesh holds fewer than {} triangles, not {}; split it", kNone,
                            triangles));
}

/// Returns the struct with its stride filled in. Throws a Failure for anything wrong in it, except
/// for indices, which copied_corners() checks.
ovc_mesh checked(const ovc_mesh* given) {
    ovc_mesh mesh = whole("ovc_mesh", given, offsetof(ovc_mesh, positions_double));
    const uint32_t packed = mesh.positions_double ? 24 : 12;
    if (!mesh.stride)
        mesh.stride = packed;
    check_positions(mesh);
    if (mesh.flags & ~uint32_t(OVC_MESH_SHARED | OVC_MESH_TEMPLATE) || mesh.reserved ||
        mesh.reserved1)
        invalid("ovc_mesh.flags or reserved has bits that this version does not know");
    check_counts(mesh);
    if ((mesh.flags & OVC_MESH_SHARED) && (mesh.stride != packed || mesh.indices))
        invalid(format_text("OVC_MESH_SHARED needs stride {} and no indices", packed));
    for (const double coordinate : mesh.origin)
        if (!std::isfinite(coordinate))
            invalid("ovc_mesh.origin is not finite");
    return mesh;
}

template <class Corner>
std::vector<Corner> copied_corners(const ovc_mesh& mesh, const void* positions) {
    std::vector<Corner> corners(triangles_of(mesh) * 3);
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

Chunk chunk_of(const ovc_mesh& mesh) {
    const dvec3 origin(mesh.origin[0], mesh.origin[1], mesh.origin[2]);
    const size_t count = mesh.vertex_count;
    const bool shared = mesh.flags & OVC_MESH_SHARED;
    if (const double* positions = mesh.positions_double)
        return shared ? Chunk::borrowing_doubles(origin,
                                                 {reinterpret_cast<const dvec3*>(positions), count})
                      : Chunk::owning_doubles(origin, copied_corners<dvec3>(mesh, positions));
    return shared ? Chunk::borrowing(origin, {reinterpret_cast<const vec3*>(mesh.positions), count})
                  : Chunk::owning(origin, copied_corners<vec3>(mesh, mesh.positions));
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

void check_open(ovc_scene scene, const char* call) {
    if (scene->structure)
        throw Failure{OVC_ERROR_INVALID_STATE,
                      format_text("{}: the scene is committed; it takes no more meshes", call)};
}

void add_chunk(ovc_scene scene, Chunk chunk, uint32_t* mesh_id) {
    scene->soup.chunks.push_back(std::move(chunk));
    if (mesh_id)
        *mesh_id = uint32_t(scene->soup.chunks.size() - 1);
}

} // namespace

ovc_result add_mesh(ovc_scene scene, const ovc_mesh* given, uint32_t* mesh_id) {
    return on_scene(scene, "add_mesh", [&] {
        if (!given)
            invalid("add_mesh: mesh is NULL");
        check_open(scene, "add_mesh");
        const ovc_mesh mesh = checked(given);
        const auto transform = transform_of("ovc_mesh.transform", mesh.transform);
        Chunk chunk = chunk_of(mesh);
        if (transform)
            chunk.place(*transform);
        chunk.set_mask(mesh.mask);
        if (mesh.flags & OVC_MESH_TEMPLATE) {
            scene->templates.emplace(uint32_t(scene->soup.chunks.size()), std::move(chunk));
            chunk = Chunk::owning(dvec3(0), {});
        }
        add_chunk(scene, std::move(chunk), mesh_id);
    });
}

ovc_result add_instance(ovc_scene scene, const ovc_instance* given, uint32_t* mesh_id) {
    return on_scene(scene, "add_instance", [&] {
        if (!given)
            invalid("add_instance: instance is NULL");
        check_open(scene, "add_instance");
        const ovc_instance instance = whole("ovc_instance", given, offsetof(ovc_instance, mask));
        const size_t meshes = scene->soup.chunks.size();
        if (instance.mesh >= meshes)
            invalid(format_text("ovc_instance.mesh is {}, but {} meshes were added so far",
                                instance.mesh, meshes));
        if (instance.reserved || instance.reserved1)
            invalid("ovc_instance.reserved has bits that this version does not know");
        const auto transform = transform_of("ovc_instance.transform", instance.transform);
        const auto found = scene->templates.find(instance.mesh);
        const Chunk& source =
            found != scene->templates.end() ? found->second : scene->soup.chunks[instance.mesh];
        Chunk chunk = source.instance();
        if (transform)
            chunk.place(*transform);
        chunk.set_mask(instance.mask);
        add_chunk(scene, std::move(chunk), mesh_id);
    });
}

} // namespace ovc
