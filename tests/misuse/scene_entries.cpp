// SPDX-License-Identifier: Apache-2.0
// The rows of scenes: meshes, commits, and what is reported.
#include "tests/misuse/entries.h"

#include <cstring>

namespace ovc::test {
namespace {

AbiScene new_scene(Subject& s, const ovc_scene_config* config = nullptr) {
    ovc_scene scene = nullptr;
    api().create_scene(s.device, config, &scene);
    return AbiScene(scene);
}

ovc_result use_create_scene(Subject& s) {
    return new_scene(s) ? OVC_OK : OVC_ERROR_INTERNAL;
}
Misuses misuse_create_scene(Subject& s) {
    Wrong wrong(s);
    ovc_scene scene;
    wrong.without_device("device NULL", api().create_scene(nullptr, nullptr, &scene));
    wrong.argument("scene NULL", api().create_scene(s.device, nullptr, nullptr));
    const auto with = [&](const char* what, auto&& spoil) {
        auto config = sized<ovc_scene_config>();
        spoil(config);
        wrong.argument(what, api().create_scene(s.device, &config, &scene));
    };
    with("struct_size 0", [](auto& c) { c.struct_size = 0; });
    with("struct_size of a later header", [](auto& c) { c.struct_size += 8; });
    with("struct_size within a field", [](auto& c) { c.struct_size -= 1; });
    with("precision", [](auto& c) { c.precision = 2; });
    with("kernel", [](auto& c) { c.kernel = 3; });
    with("structure", [](auto& c) { c.structure = ~0u; });
    with("level1", [](auto& c) { c.level1 = 3; });
    with("level1_build", [](auto& c) { c.level1_build = 2; });
    with("tell_active", [](auto& c) { c.tell_active = 2; });
    with("reserved", [](auto& c) { c.reserved = 1; });
    with("leaves and leaf_triangles", [](auto& c) { c.leaves = c.leaf_triangles = 1; });
    with("saved NULL", [](auto& c) { c.saved_bytes = 64; });
    with("nothing to read from", [](auto& c) { c.host_memory_bytes = 1 << 20; });
    with("read_saved without host_memory_bytes",
         [](auto& c) { c.read_saved = [](void*, uint64_t, void*, size_t) { return 0; }; });
    return wrong.found();
}

ovc_result use_add_mesh(Subject& s) {
    const ovc_mesh mesh = field_mesh();
    return api().add_mesh(new_scene(s).get(), &mesh, nullptr);
}
Misuses misuse_add_mesh(Subject& s) {
    Wrong wrong(s);
    const ovc_mesh mesh = field_mesh();
    wrong.without_device("scene NULL", api().add_mesh(nullptr, &mesh, nullptr));
    wrong.argument("mesh NULL", api().add_mesh(s.empty, nullptr, nullptr));
    const auto with = [&](const char* what, auto&& spoil) {
        ovc_mesh spoilt = field_mesh();
        spoil(spoilt);
        wrong.argument(what, api().add_mesh(s.empty, &spoilt, nullptr));
    };
    static const uint32_t indices[3] = {0, 1, ~0u};
    with("struct_size 0", [](auto& m) { m.struct_size = 0; });
    with("struct_size within a field",
         [](auto& m) { m.struct_size = offsetof(ovc_mesh, transform) + 1; });
    with("positions NULL", [](auto& m) { m.positions = nullptr; });
    with("stride 4", [](auto& m) { m.stride = 4; });
    with("half a triangle", [](auto& m) { m.vertex_count -= 1; });
    with("an index too large",
         [](auto& m) { m.flags = 0, m.indices = indices, m.triangle_count = 1; });
    with("unknown flags", [](auto& m) { m.flags = ~0u; });
    with("origin NaN", [](auto& m) { m.origin[2] = NAN; });
    with("reads_doubles", [](auto& m) { m.reads_doubles = 2; });
    with("reserved2", [](auto& m) { m.reserved2 = 1; });
    const auto read = [](void*, uint64_t, uint64_t, void*) { return 0; };
    with("positions and read_corners", [&](auto& m) { m.read_corners = read; });
    with("read_corners without host_memory_bytes", [&](auto& m) {
        m = sized<ovc_mesh>();
        m.read_corners = read;
        m.triangle_count = 1;
    });
    return wrong.found();
}

ovc_result use_commit(Subject& s) {
    const AbiScene scene(make_field(s.device));
    return scene && field_answers(scene.get()) ? OVC_OK : OVC_ERROR_INTERNAL;
}
Misuses misuse_commit(Subject& s) {
    Wrong wrong(s);
    wrong.without_device("scene NULL", api().commit(nullptr));
    wrong.on_device("twice: nothing to do", OVC_OK, api().commit(s.field));
    auto config = sized<ovc_scene_config>();
    config.progress = [](void*, double, const char*) { return 1; };
    wrong.on_device("cancelled", OVC_ERROR_CANCELLED, api().commit(new_scene(s, &config).get()));
    return wrong.found();
}

ovc_result use_statistics(Subject& s) {
    auto told = sized<ovc_statistics>();
    const ovc_result result = api().statistics(s.field, &told);
    return told.triangles == kCells ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_statistics(Subject& s) {
    Wrong wrong(s);
    auto told = sized<ovc_statistics>();
    ovc_statistics unsized{};
    wrong.without_device("scene NULL", api().statistics(nullptr, &told));
    wrong.argument("statistics NULL", api().statistics(s.field, nullptr));
    wrong.argument("struct_size 0", api().statistics(s.field, &unsized));
    wrong.state("before commit", api().statistics(s.empty, &told));
    return wrong.found();
}

ovc_result use_destroy_scene(Subject& s) {
    api().destroy_scene(nullptr);
    return use_create_scene(s);
}
Misuses misuse_destroy_scene(Subject& s) {
    Wrong wrong(s);
    ovc_scene scene = new_scene(s).get(); // It is destroyed at the end of this line.
    api().destroy_scene(scene);
    wrong.argument("used after it", api().commit(scene));
    return wrong.found();
}

ovc_result use_plan(Subject& s) {
    auto told = sized<ovc_plan>();
    const ovc_result result = api().plan(s.field, &told);
    return told.triangles == kCells && told.fits ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_plan(Subject& s) {
    Wrong wrong(s);
    auto told = sized<ovc_plan>();
    ovc_plan unsized{};
    wrong.without_device("scene NULL", api().plan(nullptr, &told));
    wrong.argument("plan NULL", api().plan(s.field, nullptr));
    wrong.argument("struct_size 0", api().plan(s.field, &unsized));
    return wrong.found();
}

ovc_result use_active(Subject& s) {
    auto config = sized<ovc_scene_config>();
    config.tell_active = 1;
    const AbiScene scene = new_scene(s, &config);
    const ovc_mesh mesh = field_mesh();
    auto told = sized<ovc_active>();
    if (api().add_mesh(scene.get(), &mesh, nullptr) != OVC_OK ||
        api().commit(scene.get()) != OVC_OK || !field_answers(scene.get()))
        return OVC_ERROR_INTERNAL;
    const ovc_result result = api().active(scene.get(), &told);
    return told.pages > 0 ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_active(Subject& s) {
    Wrong wrong(s);
    auto told = sized<ovc_active>();
    ovc_active unsized{};
    wrong.without_device("scene NULL", api().active(nullptr, &told));
    wrong.argument("active NULL", api().active(s.field, nullptr));
    wrong.argument("struct_size 0", api().active(s.field, &unsized));
    wrong.argument("not asked for", api().active(s.field, &told));
    wrong.state("before commit", api().active(s.empty, &told));
    return wrong.found();
}

int count_bytes(void* user, const void*, size_t size) {
    *static_cast<size_t*>(user) += size;
    return 0;
}
ovc_result use_save(Subject& s) {
    size_t bytes = 0;
    const ovc_result result = api().save(s.field, count_bytes, &bytes);
    return bytes > 0 ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_save(Subject& s) {
    Wrong wrong(s);
    size_t bytes = 0;
    const auto stop = [](void*, const void*, size_t) { return 1; };
    wrong.without_device("scene NULL", api().save(nullptr, count_bytes, &bytes));
    wrong.argument("write NULL", api().save(s.field, nullptr, nullptr));
    wrong.state("before commit", api().save(s.empty, count_bytes, &bytes));
    wrong.on_device("stopped", OVC_ERROR_CANCELLED, api().save(s.field, stop, nullptr));
    return wrong.found();
}

/// The field as a scene that streams, whose scratch space is not needed.
ovc_streamed_scene streamed_field(size_t& bytes) {
    static const ovc_streamed_mesh mesh = {{0, 0, 0}, kCells, 0, 0};
    auto scene = sized<ovc_streamed_scene>();
    scene.meshes = &mesh;
    scene.mesh_count = 1;
    scene.user = &bytes;
    scene.read_corners = [](void*, uint32_t, uint64_t first, uint64_t count, void* corners) {
        std::memcpy(corners, field_positions().data() + 9 * first, 36 * count);
        return 0;
    };
    scene.write_scratch = [](void*, uint64_t, const void*, size_t) { return 1; };
    scene.read_scratch = [](void*, uint64_t, void*, size_t) { return 1; };
    scene.write = count_bytes;
    return scene;
}
ovc_result use_save_streamed(Subject& s) {
    size_t bytes = 0;
    const ovc_streamed_scene scene = streamed_field(bytes);
    const ovc_result result = api().save_streamed(s.device, nullptr, &scene);
    return bytes > 0 ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_save_streamed(Subject& s) {
    Wrong wrong(s);
    size_t bytes = 0;
    const ovc_streamed_scene field = streamed_field(bytes);
    wrong.without_device("device NULL", api().save_streamed(nullptr, nullptr, &field));
    wrong.argument("scene NULL", api().save_streamed(s.device, nullptr, nullptr));
    auto config = sized<ovc_scene_config>();
    config.precision = 2;
    wrong.argument("precision", api().save_streamed(s.device, &config, &field));
    const auto with = [&](const char* what, auto&& spoil) {
        ovc_streamed_scene scene = field;
        ovc_streamed_mesh mesh = *field.meshes;
        scene.meshes = &mesh;
        spoil(scene, mesh);
        wrong.argument(what, api().save_streamed(s.device, nullptr, &scene));
    };
    with("struct_size 0", [](auto& of, auto&) { of.struct_size = 0; });
    with("meshes NULL", [](auto& of, auto&) { of.meshes = nullptr; });
    with("read_corners NULL", [](auto& of, auto&) { of.read_corners = nullptr; });
    with("write NULL", [](auto& of, auto&) { of.write = nullptr; });
    with("reserved", [](auto& of, auto&) { of.reserved = 1; });
    with("kept NULL", [](auto& of, auto&) { of.kept_count = 1; });
    with("has_doubles", [](auto&, auto& mesh) { mesh.has_doubles = 2; });
    with("a mesh too large", [](auto&, auto& mesh) { mesh.triangle_count = ~uint64_t(0); });
    with("origin NaN", [](auto&, auto& mesh) { mesh.origin[1] = NAN; });
    ovc_streamed_scene stops = field;
    stops.write = [](void*, const void*, size_t) { return 1; };
    wrong.on_device("stopped", OVC_ERROR_CANCELLED, api().save_streamed(s.device, nullptr, &stops));
    return wrong.found();
}

ovc_result use_plan_streamed(Subject& s) {
    size_t bytes = 0;
    const ovc_streamed_scene scene = streamed_field(bytes);
    auto plan = sized<ovc_plan>();
    const ovc_result result = api().plan_streamed(s.device, nullptr, &scene, &plan);
    return plan.triangles == kCells && bytes == 0 ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_plan_streamed(Subject& s) {
    Wrong wrong(s);
    size_t bytes = 0;
    ovc_streamed_scene field = streamed_field(bytes);
    auto plan = sized<ovc_plan>();
    wrong.without_device("device NULL", api().plan_streamed(nullptr, nullptr, &field, &plan));
    wrong.argument("scene NULL", api().plan_streamed(s.device, nullptr, nullptr, &plan));
    wrong.argument("plan NULL", api().plan_streamed(s.device, nullptr, &field, nullptr));
    auto unsized = ovc_plan{};
    wrong.argument("struct_size 0", api().plan_streamed(s.device, nullptr, &field, &unsized));
    field.read_corners = nullptr;
    wrong.argument("read_corners NULL", api().plan_streamed(s.device, nullptr, &field, &plan));
    field.read_corners = [](void*, uint32_t, uint64_t, uint64_t, void*) { return 1; };
    wrong.on_device("stopped", OVC_ERROR_CANCELLED,
                    api().plan_streamed(s.device, nullptr, &field, &plan));
    return wrong.found();
}

ovc_result use_add_instance(Subject& s) {
    const AbiScene scene = new_scene(s);
    const ovc_mesh mesh = field_mesh();
    auto instance = sized<ovc_instance>();
    const ovc_result added = api().add_mesh(scene.get(), &mesh, nullptr);
    return added == OVC_OK ? api().add_instance(scene.get(), &instance, nullptr) : added;
}
Misuses misuse_add_instance(Subject& s) {
    Wrong wrong(s);
    const double transform[12] = {NAN};
    auto instance = sized<ovc_instance>();
    wrong.without_device("scene NULL", api().add_instance(nullptr, &instance, nullptr));
    wrong.argument("instance NULL", api().add_instance(s.empty, nullptr, nullptr));
    wrong.argument("no such mesh", api().add_instance(s.empty, &instance, nullptr));
    const AbiScene scene = new_scene(s);
    const ovc_mesh mesh = field_mesh();
    api().add_mesh(scene.get(), &mesh, nullptr);
    instance.transform = transform;
    if (scene)
        wrong.argument("transform NaN", api().add_instance(scene.get(), &instance, nullptr));
    return wrong.found();
}

ovc_result use_purge(Subject& s) {
    const ovc_result purged = api().purge(s.field);
    return purged != OVC_OK || field_answers(s.field) ? purged : OVC_ERROR_INTERNAL;
}
Misuses misuse_purge(Subject& s) {
    Wrong wrong(s);
    wrong.without_device("scene NULL", api().purge(nullptr));
    wrong.on_device("before commit: nothing to do", OVC_OK, api().purge(s.empty));
    return wrong.found();
}

/// Moves the field into other cells and back, by `update`.
ovc_result use_update(Subject& s, ovc_result (*update)(ovc_scene scene, bool there)) {
    const AbiScene scene(make_field(s.device));
    ovc_hit hit;
    const ovc_ray ray = into_cell(kCells, 1); // The field is not there until it is moved.
    if (!scene || update(scene.get(), true) != OVC_OK ||
        api().intersect(scene.get(), &ray, 1, &hit, nullptr) != OVC_ERROR_INVALID_STATE ||
        api().commit(scene.get()) != OVC_OK ||
        api().intersect(scene.get(), &ray, 1, &hit, nullptr) != OVC_OK ||
        !is_in_cell(hit, kCells - kSide, 1) || update(scene.get(), false) != OVC_OK ||
        api().commit(scene.get()) != OVC_OK || !field_answers(scene.get()))
        return OVC_ERROR_INTERNAL;
    return OVC_OK;
}

ovc_result use_update_instance(Subject& s) {
    return use_update(s, [](ovc_scene scene, bool there) {
        const double up[12] = {1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0};
        return api().update_instance(scene, 0, there ? up : nullptr);
    });
}
Misuses misuse_update_instance(Subject& s) {
    Wrong wrong(s);
    const double transform[12] = {NAN};
    wrong.without_device("scene NULL", api().update_instance(nullptr, 0, nullptr));
    wrong.argument("no such mesh", api().update_instance(s.field, 1, nullptr));
    wrong.argument("transform NaN", api().update_instance(s.field, 0, transform));
    return wrong.found();
}

ovc_result use_update_mesh(Subject& s) {
    static std::vector<float> positions = field_positions();
    const AbiScene scene = new_scene(s);
    ovc_mesh mesh = field_mesh();
    mesh.positions = positions.data();
    ovc_hit hit;
    const ovc_ray ray = into_cell(0, 1);
    if (api().add_mesh(scene.get(), &mesh, nullptr) != OVC_OK ||
        api().commit(scene.get()) != OVC_OK)
        return OVC_ERROR_INTERNAL;
    for (size_t i = 0; i < 3; ++i)
        positions[3 * i + 2] = -1; // This moves the first triangle only.
    mesh.vertex_count = 3;
    if (api().update_mesh(scene.get(), 0, &mesh, 0) != OVC_OK ||
        api().commit(scene.get()) != OVC_OK ||
        api().intersect(scene.get(), &ray, 1, &hit, nullptr) != OVC_OK || !is_in_cell(hit, 0, 2))
        return OVC_ERROR_INTERNAL;
    return OVC_OK;
}
Misuses misuse_update_mesh(Subject& s) {
    Wrong wrong(s);
    const ovc_mesh mesh = field_mesh();
    wrong.without_device("scene NULL", api().update_mesh(nullptr, 0, &mesh, 0));
    wrong.argument("mesh NULL", api().update_mesh(s.field, 0, nullptr, 0));
    wrong.argument("no such mesh", api().update_mesh(s.field, 1, &mesh, 0));
    wrong.argument("beyond its end", api().update_mesh(s.field, 0, &mesh, 1));
    const auto with = [&](const char* what, auto&& spoil) {
        ovc_mesh spoilt = field_mesh();
        spoil(spoilt);
        wrong.argument(what, api().update_mesh(s.field, 0, &spoilt, 0));
    };
    static const double transform[12] = {};
    with("struct_size 0", [](auto& m) { m.struct_size = 0; });
    with("other memory", [](auto& m) { m.positions += 9, m.vertex_count -= 3; });
    with("not shared", [](auto& m) { m.flags = 0; });
    with("a transform", [](auto& m) { m.transform = transform; });
    with("a mask", [](auto& m) { m.mask = 1; });
    with("another origin", [](auto& m) { m.origin[1] = 1; });
    with("doubles", [](auto& m) {
        m.positions = nullptr, m.positions_double = transform, m.vertex_count = 3;
    });
    const AbiScene scene = new_scene(s);
    auto instance = sized<ovc_instance>();
    api().add_mesh(scene.get(), &mesh, nullptr);
    api().add_instance(scene.get(), &instance, nullptr);
    wrong.argument("an instance", api().update_mesh(scene.get(), 1, &mesh, 0));
    return wrong.found();
}

ovc_result use_remove_mesh(Subject& s) {
    const AbiScene scene(make_field(s.device));
    ovc_hit hit;
    const ovc_ray ray = into_cell(0, 1);
    if (!scene || api().remove_mesh(scene.get(), 0) != OVC_OK ||
        api().commit(scene.get()) != OVC_OK)
        return OVC_ERROR_INTERNAL;
    const ovc_result result = api().intersect(scene.get(), &ray, 1, &hit, nullptr);
    return hit.mesh == OVC_NONE ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_remove_mesh(Subject& s) {
    Wrong wrong(s);
    wrong.without_device("scene NULL", api().remove_mesh(nullptr, 0));
    wrong.argument("no such mesh", api().remove_mesh(s.field, 1));
    const AbiScene scene(make_field(s.device));
    api().remove_mesh(scene.get(), 0);
    wrong.argument("twice", api().remove_mesh(scene.get(), 0));
    const ovc_mesh mesh = field_mesh();
    wrong.argument("updated after it", api().update_mesh(scene.get(), 0, &mesh, 0));
    return wrong.found();
}

constexpr Entry kSceneEntries[] = {
    OVC_ENTRY(create_scene, use_create_scene, misuse_create_scene),
    OVC_ENTRY(add_mesh, use_add_mesh, misuse_add_mesh),
    OVC_ENTRY(commit, use_commit, misuse_commit),
    OVC_ENTRY(statistics, use_statistics, misuse_statistics),
    OVC_ENTRY(destroy_scene, use_destroy_scene, misuse_destroy_scene),
    OVC_ENTRY(plan, use_plan, misuse_plan),
    OVC_ENTRY(active, use_active, misuse_active),
    OVC_ENTRY(save, use_save, misuse_save),
    OVC_ENTRY(add_instance, use_add_instance, misuse_add_instance),
    OVC_ENTRY(purge, use_purge, misuse_purge),
    OVC_ENTRY(update_mesh, use_update_mesh, misuse_update_mesh),
    OVC_ENTRY(update_instance, use_update_instance, misuse_update_instance),
    OVC_ENTRY(remove_mesh, use_remove_mesh, misuse_remove_mesh),
    OVC_ENTRY(save_streamed, use_save_streamed, misuse_save_streamed),
    OVC_ENTRY(plan_streamed, use_plan_streamed, misuse_plan_streamed),
};

} // namespace

std::span<const Entry> scene_entries() {
    return kSceneEntries;
}

} // namespace ovc::test
