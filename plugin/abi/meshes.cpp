// SPDX-License-Identifier: Apache-2.0
// The table's functions that add meshes and instances to a scene, change them and remove them.
#include "core/text/format_text.h"
#include "plugin/abi/mesh_data.h"
#include "plugin/abi/scene.h"
#include "plugin/abi/scene_call.h"
#include "plugin/abi/struct_size.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <map>
#include <optional>
#include <vector>

namespace ovc {
namespace {

/// Returns a chunk whose corners the host reads.
Chunk stored_chunk_of(ovc_scene scene, const ovc_mesh& mesh) {
    const StoredCorners*& corners =
        scene->stored[{mesh.read_corners, mesh.read_user, mesh.triangle_count, mesh.reads_doubles}];
    const auto read = [function = mesh.read_corners,
                       user = mesh.read_user](uint64_t first, uint64_t count, void* to) {
        const HostFunction mark;
        return function(user, first, count, to) == 0;
    };
    if (!corners)
        corners = &scene->store->add_mesh(mesh.triangle_count, mesh.reads_doubles == 1, read);
    return Chunk::stored({mesh.origin[0], mesh.origin[1], mesh.origin[2]}, *corners,
                         uint32_t(mesh.triangle_count));
}

Chunk chunk_of(const ovc_mesh& mesh) {
    const dvec3 origin(mesh.origin[0], mesh.origin[1], mesh.origin[2]);
    const size_t count = mesh.vertex_count;
    const bool shared = mesh.flags & OVC_MESH_SHARED;
    if (const double* positions = mesh.positions_double)
        return shared ? Chunk::borrowing_doubles(origin,
                                                 {reinterpret_cast<const dvec3*>(positions), count})
                      : Chunk::owning_doubles(origin, copied_double_corners(mesh));
    return shared ? Chunk::borrowing(origin, {reinterpret_cast<const vec3*>(mesh.positions), count})
                  : Chunk::owning(origin, copied_corners(mesh));
}

/// Has enter(changes) enter a change of a committed scene before it is made, or throw and enter
/// nothing. Nothing is traced through the scene from then on until the next commit.
template <class Enter>
void begin_change(ovc_scene scene, Enter&& enter) {
    assert(scene->structure);
    if (scene->store)
        throw Failure{OVC_ERROR_INVALID_STATE,
                      "a scene with host_memory_bytes cannot change after commit"};
    const bool is_first = !scene->changes.any();
    enter(scene->changes);
    if (is_first) {
        scene->single_rays.serve(nullptr);
        scene->structure->leave_soup();
    }
}

/// Room for one element more in a vector that other threads may still read.
template <class T>
class RoomFor {
public:
    explicit RoomFor(std::vector<T>& all) : all_(all) {
        if (all.size() == all.capacity())
            larger_.reserve(2 * all.size() + 1);
    }
    /// Adds it, when nobody reads the vector any more. It takes no memory.
    void add(T item) noexcept {
        if (larger_.capacity() > 0) {
            std::ranges::move(all_, std::back_inserter(larger_));
            all_ = std::move(larger_);
        }
        all_.push_back(std::move(item));
    }

private:
    std::vector<T>& all_;
    std::vector<T> larger_; // without capacity where the vector has room
};

/// Adds the chunk, or throws and adds nothing.
void add_chunk(ovc_scene scene, Chunk chunk, uint32_t source, uint32_t* mesh_id) {
    RoomFor chunks(scene->soup.chunks);
    RoomFor sources(scene->sources);
    if (scene->structure) {
        begin_change(scene, [](Changes& changes) { changes.added = true; });
        chunk.set_moves(); // so that what is built already stays as it is
    }
    chunks.add(std::move(chunk));
    sources.add({source});
    if (mesh_id)
        *mesh_id = uint32_t(scene->soup.chunks.size() - 1);
}

/// Returns whose corners the mesh or instance has. Throws a Failure where there is no such mesh.
uint32_t source_of(ovc_scene scene, const char* field, uint32_t mesh_id) {
    if (mesh_id >= scene->sources.size())
        invalid(format_text("{} is {}, but {} meshes were added so far", field, mesh_id,
                            scene->sources.size()));
    const uint32_t source = scene->sources[mesh_id].mesh;
    if (source == kNone)
        invalid(format_text("{} is {}, which was removed", field, mesh_id));
    return source;
}

/// Returns the chunk with the corners of a mesh that is not removed, or has instances still.
Chunk& chunk_of_mesh(ovc_scene scene, uint32_t mesh_id) {
    const auto found = scene->templates.find(mesh_id);
    return found != scene->templates.end() ? found->second : scene->soup.chunks[mesh_id];
}

/// Throws a Failure where the update is not of the same kind as the mesh, or beyond its end.
void check_update(const ovc_mesh& update, uint64_t first, const Chunk& chunk) {
    if (update.transform || update.mask || update.flags & OVC_MESH_TEMPLATE)
        invalid("update_mesh: ovc_mesh.transform and mask cannot change, nor whether the mesh is a "
                "template; expected NULL, 0 and no OVC_MESH_TEMPLATE");
    for (int axis = 0; axis < 3; ++axis)
        if (update.origin[axis] != chunk.origin()[axis])
            invalid("update_mesh: ovc_mesh.origin is not that of the mesh, which cannot change");
    const uint64_t count = triangles_of(update);
    if (first > chunk.size() || count > chunk.size() - first)
        invalid(format_text("update_mesh: {} triangles from {} on are given, but the mesh has {}",
                            count, first, chunk.size()));
    if (count > 0 && (update.positions_double != nullptr) != !chunk.double_corners().empty())
        invalid("update_mesh: the mesh was added with positions of the other type, floats or "
                "doubles");
    if (chunk.owns_corners() == bool(update.flags & OVC_MESH_SHARED) && count > 0)
        invalid("update_mesh: OVC_MESH_SHARED is set where the mesh was added without it, or is "
                "missing");
    const void* const given =
        update.positions ? static_cast<const void*>(update.positions) : update.positions_double;
    if (count > 0 && !chunk.owns_corners() && given != chunk.address_of(uint32_t(first)))
        invalid("update_mesh: the positions of a mesh with OVC_MESH_SHARED stay where they were "
                "when it was added");
}

/// Enters that these triangles of a mesh are to change, wherever it is placed.
void note_moved(ovc_scene scene, uint32_t mesh_id, uint32_t first, uint32_t end) {
    if (!scene->structure || first == end)
        return;
    const std::vector<MeshSource>& sources = scene->sources;
    std::vector<PrimRange> moved;
    uint32_t left = 1 + sources[mesh_id].instances; // which come after the mesh
    for (uint32_t i = mesh_id; left > 0 && i < sources.size(); ++i) {
        if (sources[i].mesh != mesh_id)
            continue;
        left -= 1;
        if (scene->soup.chunks[i].size() > 0)
            moved.push_back({i, first, end});
    }
    if (!moved.empty())
        begin_change(scene, [&](Changes& changes) {
            changes.moved.insert(changes.moved.end(), moved.begin(), moved.end());
        });
}

} // namespace

ovc_result add_mesh(ovc_scene scene, const ovc_mesh* given, uint32_t* mesh_id) {
    return on_scene(scene, "add_mesh", [&] {
        if (!given)
            invalid("add_mesh: mesh is NULL");
        const ovc_mesh mesh = checked(given);
        const auto transform = transform_of("ovc_mesh.transform", mesh.transform);
        if (triangles_of(mesh) > 0 && !mesh.read_corners != !scene->store)
            invalid("add_mesh: ovc_mesh.read_corners goes with ovc_scene_config.host_memory_bytes: "
                    "all meshes of such a scene have it, and no others");
        Chunk chunk = mesh.read_corners ? stored_chunk_of(scene, mesh) : chunk_of(mesh);
        if (transform)
            chunk.place(*transform);
        chunk.set_mask(mesh.mask);
        if (mesh.flags & OVC_MESH_MOVES)
            chunk.set_moves();
        const auto number = uint32_t(scene->soup.chunks.size());
        std::map<uint32_t, Chunk> hidden; // merging it takes no memory
        if (mesh.flags & OVC_MESH_TEMPLATE) {
            hidden.emplace(number, std::move(chunk));
            chunk = Chunk::owning(dvec3(0), {});
        }
        add_chunk(scene, std::move(chunk), number, mesh_id);
        scene->templates.merge(hidden);
    });
}

ovc_result add_instance(ovc_scene scene, const ovc_instance* given, uint32_t* mesh_id) {
    return on_scene(scene, "add_instance", [&] {
        if (!given)
            invalid("add_instance: instance is NULL");
        const ovc_instance instance = whole("ovc_instance", given, offsetof(ovc_instance, mask));
        const uint32_t source = source_of(scene, "ovc_instance.mesh", instance.mesh);
        if (instance.reserved || instance.reserved1)
            invalid("ovc_instance.reserved has bits that this version does not know");
        const auto transform = transform_of("ovc_instance.transform", instance.transform);
        const Chunk& placed = chunk_of_mesh(scene, instance.mesh);
        Chunk chunk = placed.instance();
        std::map<uint32_t, Transform> placed_first; // as in add_mesh()
        if (const Transform* first = placed.transform())
            placed_first.emplace(uint32_t(scene->soup.chunks.size()), *first);
        if (transform)
            chunk.place(*transform);
        chunk.set_mask(instance.mask);
        add_chunk(scene, std::move(chunk), source, mesh_id);
        scene->placed_first.merge(placed_first);
        scene->sources[source].instances += 1;
    });
}

ovc_result update_mesh(ovc_scene scene, uint32_t mesh_id, const ovc_mesh* given,
                       uint64_t first_triangle) {
    return on_scene(scene, "update_mesh", [&] {
        if (!given)
            invalid("update_mesh: mesh is NULL");
        const uint32_t source = source_of(scene, "update_mesh: mesh_id", mesh_id);
        if (source != mesh_id)
            invalid(format_text("update_mesh: mesh_id is {}, an instance of mesh {}; update that",
                                mesh_id, source));
        const ovc_mesh update = checked(given);
        Chunk& chunk = chunk_of_mesh(scene, mesh_id);
        check_update(update, first_triangle, chunk);
        const auto first = uint32_t(first_triangle);
        const uint32_t end = first + uint32_t(triangles_of(update));
        const auto set = [&](const auto& corners) {
            note_moved(scene, mesh_id, first, end);
            chunk.set_corners(first, corners);
        };
        if (!chunk.owns_corners())
            note_moved(scene, mesh_id, first, end);
        else if (update.positions_double)
            set(copied_double_corners(update));
        else if (is_packed(update))
            set(std::span(reinterpret_cast<const vec3*>(update.positions), update.vertex_count));
        else
            set(copied_corners(update));
    });
}

ovc_result update_instance(ovc_scene scene, uint32_t mesh_id, const double* given) {
    return on_scene(scene, "update_instance", [&] {
        source_of(scene, "update_instance: mesh_id", mesh_id);
        std::optional<Transform> transform = transform_of("update_instance: transform", given);
        Chunk& chunk = chunk_of_mesh(scene, mesh_id);
        if (const auto first = scene->placed_first.find(mesh_id);
            first != scene->placed_first.end())
            transform = transform ? then(first->second, *transform) : first->second;
        Chunk placed = chunk.unplaced();
        placed.place_anew(transform);
        if (scene->structure && scene->soup.chunks[mesh_id].size() > 0) {
            begin_change(scene, [&](Changes& changes) { changes.placed.push_back(mesh_id); });
            chunk.set_moves();
        }
        chunk.take_place(placed);
    });
}

ovc_result remove_mesh(ovc_scene scene, uint32_t mesh_id) {
    return on_scene(scene, "remove_mesh", [&] {
        const uint32_t source = source_of(scene, "remove_mesh: mesh_id", mesh_id);
        Chunk& chunk = scene->soup.chunks[mesh_id];
        std::vector<MeshSource>& sources = scene->sources;
        std::map<uint32_t, Chunk> hidden;                       // as in add_mesh()
        if (source == mesh_id && sources[source].instances > 0) // their corners stay
            hidden.emplace(mesh_id, Chunk::owning(dvec3(0), {}));
        if (scene->structure && chunk.size() > 0)
            begin_change(scene, [&](Changes& changes) {
                changes.removed.push_back({mesh_id, 0, chunk.size()});
            });
        sources[mesh_id].mesh = kNone;
        if (source != mesh_id)
            sources[source].instances -= 1;
        else if (!hidden.empty())
            hidden.begin()->second = std::move(chunk);
        scene->templates.merge(hidden);
        chunk = Chunk::owning(dvec3(0), {});
        if (sources[source].mesh == kNone && sources[source].instances == 0)
            scene->templates.erase(source);
        scene->placed_first.erase(mesh_id);
    });
}

} // namespace ovc
