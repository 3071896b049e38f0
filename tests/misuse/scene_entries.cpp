// SPDX-License-Identifier: Apache-2.0
// The rows of scenes: what goes in, what is told.
#include "tests/misuse/entries.h"

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
    with("precision", [](auto& c) { c.precision = 2; });
    with("kernel", [](auto& c) { c.kernel = 3; });
    with("structure", [](auto& c) { c.structure = ~0u; });
    with("level1", [](auto& c) { c.level1 = 3; });
    with("level1_build", [](auto& c) { c.level1_build = 2; });
    with("tell_active", [](auto& c) { c.tell_active = 2; });
    with("reserved", [](auto& c) { c.reserved = 1; });
    with("leaves and leaf_triangles", [](auto& c) { c.leaves = c.leaf_triangles = 1; });
    with("saved NULL", [](auto& c) { c.saved_bytes = 64; });
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
    wrong.state("after commit", api().add_mesh(s.field, &mesh, nullptr));
    const auto with = [&](const char* what, auto&& spoil) {
        ovc_mesh spoilt = field_mesh();
        spoil(spoilt);
        wrong.argument(what, api().add_mesh(s.empty, &spoilt, nullptr));
    };
    static const uint32_t indices[3] = {0, 1, ~0u};
    with("struct_size 0", [](auto& m) { m.struct_size = 0; });
    with("positions NULL", [](auto& m) { m.positions = nullptr; });
    with("stride 4", [](auto& m) { m.stride = 4; });
    with("half a triangle", [](auto& m) { m.vertex_count -= 1; });
    with("an index too large",
         [](auto& m) { m.flags = 0, m.indices = indices, m.triangle_count = 1; });
    with("unknown flags", [](auto& m) { m.flags = ~0u; });
    with("origin NaN", [](auto& m) { m.origin[2] = NAN; });
    return wrong.found();
}

ovc_result use_commit(Subject& s) {
    const AbiScene scene(make_field(s.device));
    return scene && field_answers(scene.get()) ? OVC_OK : OVC_ERROR_INTERNAL;
}
Misuses misuse_commit(Subject& s) {
    Wrong wrong(s);
    wrong.without_device("scene NULL", api().commit(nullptr));
    wrong.state("twice", api().commit(s.field));
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
    ovc_scene scene = new_scene(s).get(); // destroyed at the end of this line
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
    wrong.state("after commit", api().add_instance(s.field, &instance, nullptr));
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

constexpr Entry kEntries[] = {
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
};

} // namespace

std::span<const Entry> scene_entries() {
    return kEntries;
}

} // namespace ovc::test
