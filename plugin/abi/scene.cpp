// SPDX-License-Identifier: Apache-2.0
// Scenes: commit, statistics. Arguments are checked here; what is below trusts
// them.
#include "plugin/abi/scene.h"

#include "core/build_progress.h"
#include "core/text/format_text.h"
#include "plugin/abi/config.h"
#include "plugin/abi/device_call.h"
#include "plugin/abi/scene_call.h"
#include "plugin/abi/struct_size.h"

#include <cstddef>
#include <cstring>

namespace ovc {
namespace {

/// Brings the structure up to date with what has changed. Returns false, without a structure, where
/// one must be built; and has none either where this throws.
bool update(ovc_scene_t& scene, BuildProgress* progress) {
    if (!scene.structure)
        return false;
    std::unique_ptr<Structure> structure = std::move(scene.structure);
    const Changes changes = std::exchange(scene.changes, {});
    const Result<bool> updated = structure->update(changes, progress);
    check(updated);
    if (!*updated)
        return false;
    if (progress)
        progress->finish(); // the last chance to be cancelled
    scene.structure = std::move(structure);
    return true;
}

BuildRequest request_of(const ovc_scene_t& scene, BuildProgress* progress) {
    return {*scene.device->gl, scene.config, scene.device->log, progress};
}

void build(ovc_scene_t& scene, BuildProgress* progress) {
    Result<std::unique_ptr<Structure>> built =
        make_structure(scene.soup, request_of(scene, progress), scene.store.get());
    check(built);
    if (progress)
        progress->finish(); // as in update()
    scene.structure = std::move(*built);
    scene.single_rays.count_anew();
    scene.config.saved = nullptr; // the meshes may change now
    scene.config.saved_bytes = 0;
}

/// Returns the store of a scene that is read from a disk; null for one in memory.
std::unique_ptr<LeafStore> store_of(const ovc_scene_config& config) {
    if (!config.host_memory_bytes)
        return nullptr;
    const auto read = [function = config.read_saved,
                       user = config.read_user](uint64_t offset, std::span<std::byte> to) {
        const HostFunction mark;
        return function(user, offset, to.data(), to.size()) == 0;
    };
    return std::make_unique<LeafStore>(config.host_memory_bytes, read, config.saved_bytes);
}

uint64_t soup_bytes(const ovc_scene_t& scene) {
    uint64_t bytes = 0;
    for (const Chunk& chunk : scene.soup.chunks)
        bytes += chunk.owned_bytes();
    for (const auto& [number, chunk] : scene.templates)
        bytes += chunk.owned_bytes();
    return bytes;
}

} // namespace

ovc_result create_scene(ovc_device device, const ovc_scene_config* config, ovc_scene* scene) {
    return on_device(device, "create_scene", [&] {
        if (!scene)
            invalid("create_scene: scene is NULL");
        *scene = nullptr;
        auto created = std::make_unique<ovc_scene_t>();
        created->device = device;
        created->config = checked_config(config);
        // A config that no scene can have is refused now, before anything is added.
        check_config(created->config, device->gl->info());
        if (const char* const variant = created->config.kernel_variant) {
            created->kernel_variant = variant;
            created->config.kernel_variant = created->kernel_variant.c_str();
        }
        created->store = store_of(created->config);
        ++device->scenes;
        *scene = created.release();
    });
}

ovc_result commit(ovc_scene scene) {
    return on_scene(scene, "commit", [&] {
        if (scene->structure && !scene->changes.any())
            return;
        with_progress(scene->config, "commit", [&](BuildProgress* progress) {
            if (!update(*scene, progress))
                build(*scene, progress);
            scene->single_rays.serve(scene->structure.get());
        });
    });
}

ovc_result statistics(ovc_scene scene, ovc_statistics* statistics) {
    return on_scene(scene, "statistics", [&] {
        if (!statistics)
            invalid("statistics: statistics is NULL");
        const size_t size = statistics->struct_size;
        check_size<ovc_statistics>("ovc_statistics", size, offsetof(ovc_statistics, host_bytes));
        ovc_statistics all = committed(scene, "statistics").report();
        scene->single_rays.add_to(all);
        all.struct_size = size;
        all.soup_bytes = soup_bytes(*scene);
        std::memcpy(statistics, &all, size);
    });
}

ovc_result plan(ovc_scene scene, ovc_plan* plan) {
    return on_scene(scene, "plan", [&] {
        if (scene->store && scene->structure)
            invalid("plan: the scene, which lies on a disk, is committed already");
        tell_plan(plan, scene->config, "plan", [&](BuildProgress* progress) {
            return plan_structure(scene->soup, request_of(*scene, progress), scene->store.get());
        });
    });
}

ovc_result active(ovc_scene scene, ovc_active* active) {
    return on_scene(scene, "active", [&] {
        if (!active)
            invalid("active: active is NULL");
        check_size<ovc_active>("ovc_active", active->struct_size, sizeof(ovc_active));
        const Result<ovc_active> told = committed(scene, "active").take_active();
        if (!told)
            throw Failure{code_of(told.error().kind, OVC_ERROR_INVALID_ARGUMENT),
                          "active: " + told.error().message};
        *active = *told;
        active->struct_size = sizeof(ovc_active);
    });
}

ovc_result purge(ovc_scene scene) {
    return on_scene(scene, "purge", [&] {
        if (!scene->structure)
            return;
        if (const Result<Done> purged = scene->structure->purge(); !purged)
            throw Failure{code_of(purged.error().kind, OVC_ERROR_INVALID_ARGUMENT),
                          "purge: " + purged.error().message};
    });
}

ovc_result save(ovc_scene scene, ovc_write_function write, void* user) {
    return on_scene(scene, "save", [&] {
        if (!write)
            invalid("save: write is NULL");
        const Result<Done> saved = committed(scene, "save").save([&](Bytes bytes) {
            const HostFunction mark;
            return write(user, bytes.data(), bytes.size()) == 0;
        });
        if (!saved)
            throw Failure{code_of(saved.error().kind, OVC_ERROR_INVALID_ARGUMENT),
                          "save: " + saved.error().message};
    });
}

/// Whether the call that has the turn of a scene, to which no others come any more, ends while this
/// thread, inside a stream, waits for it.
static bool call_ends(ovc_scene scene) {
    const SharedBudget::Waiting waiting(scene->device->gl->budget());
    const bool has_ended =
        scene->turn.lock_while([&] { return !waiting.is_in_vain(scene->turn.owner()); });
    if (has_ended)
        scene->turn.unlock();
    return has_ended;
}

void destroy_scene(ovc_scene scene) {
    if (!is_scene(scene, "destroy_scene") || in_host_function)
        return;
    ovc_device device = scene->device;
    if (scene->streaming == std::this_thread::get_id()) {
        say(device->log, LogLevel::Error,
            "destroy_scene: called from within the scene's own stream; the scene stays");
        return;
    }
    uint32_t alive = kSceneMagic;
    if (!scene->magic.compare_exchange_strong(alive, kDestroyed))
        return; // another thread destroys it
    if (in_stream && !call_ends(scene)) {
        scene->magic = kSceneMagic;
        say(device->log, LogLevel::Error,
            "destroy_scene: called from within a stream that leaves a call on the scene no room in "
            "the budget that they share; the scene stays");
        return;
    }
    scene->submissions.stop();
    {
        const std::lock_guard turn(scene->turn); // a call that is still running ends first
        scene->single_rays.serve(nullptr);
        scene->structure.reset();
        scene->soup = {};
        scene->templates.clear();
        scene->stored.clear();
        scene->store.reset();
    }
    scene->calls.wait_until_none(); // those that waited for their turn still use the device
    device->destroyed.add(std::unique_ptr<ovc_scene_t>(scene));
    --device->scenes;
}

} // namespace ovc
