// SPDX-License-Identifier: Apache-2.0
// Restores or builds a scene, and cuts it as small as can be where the budget has no room for it.
#include "plugin/build/build_scene.h"

#include "core/text/dropped.h"
#include "core/text/format_text.h"
#include "plugin/build/level2.h"
#include "plugin/build/restored_levels.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace ovc {

/// Returns the bytes of portals and of marks of active pages.
static uint64_t bytes_beside_pool(const BuiltScene& scene, const TwoLevelOptions& options) {
    return scene.top.table_bytes() +
           (options.tell_active ? scene.pages.size() * sizeof(uint32_t) : 0);
}

uint64_t room_for_pool(const BuiltScene& scene, const TwoLevelOptions& options,
                       const MemoryPlan& plan) {
    return plan.pool_bytes - std::min(plan.pool_bytes, bytes_beside_pool(scene, options));
}

uint64_t smallest_budget(const BuiltScene& scene, const TwoLevelOptions& options,
                         const DeviceInfo& device) {
    return smallest_budget(
        bytes_beside_pool(scene, options) + scene.top.room() + scene.largest_page_bytes(), device);
}

/// Leaves room for what updates make of the tree: meshes that are home may leave through portals.
static void leave_room(BuiltScene& scene) {
    const auto home = size_t(std::ranges::count_if(scene.shared, &SharedMesh::is_home));
    const size_t more = home > 0 ? home + 2 : 0; // with the way back, and one into the home
    scene.top.max_portals = scene.top.portals.size() + more;
    scene.top.spare_bytes = (scene.top.tree.units() / 8 + 1 + 4 * more) * OVC_UNIT_BYTES;
}

/// Drops the pages that are not traced here, and builds the tree as add_tree() does.
static bool finish_scene(BuiltScene& scene, const TwoLevelOptions& options,
                         const MemoryPlan& plan) {
    if (options.choose_pages)
        keep_pages(scene, options.choose_pages(scene));
    return add_tree(scene, options, plan);
}

bool add_tree(BuiltScene& scene, const TwoLevelOptions& options, const MemoryPlan& plan) {
    const size_t pages = scene.pages.size();
    if (pages == 0)
        return true; // every ray misses
    // The tree opens no more than the roots of pages on a disk.
    const size_t links =
        scene.store ? pages : max_links(pages, scene.level2_bytes(), plan.pool_bytes);
    const auto is_fine = [&] {
        return scene.top.table_bytes() <= plan.buffer_bytes &&
               is_usable(scene.top, scene.pages,
                         {room_for_pool(scene, options, plan), plan.buffer_bytes});
    };
    scene.far = far_triangles_of(scene);
    for (const size_t some : {links, pages}) {
        scene.top = top_level_of(scene, some);
        if (!is_fine())
            continue;
        if (scene.expects_updates())
            leave_room(scene);
        if (!is_fine())
            scene.top.spare_bytes = scene.top.max_portals = 0;
        return true;
    }
    return false;
}

void set_limits(BuiltScene& scene, const TwoLevelOptions& options, const MemoryPlan& plan) {
    uint64_t unique = scene.triangles;
    for (const SharedMesh& mesh : scene.shared)
        unique += mesh.scene.triangles;
    scene.limits = limits_of(options, plan, scene.triangles, unique);
    for (SharedMesh& mesh : scene.shared)
        mesh.scene.limits = limits_of(options, plan, mesh.scene.triangles, unique);
}

namespace {

/// Returns the scene that options.saved holds; nothing where the scene must be built.
std::optional<BuiltScene> restored(const Soup& soup, const TwoLevelOptions& options,
                                   const MemoryPlan& plan, const LogSink& log) {
    if (options.saved.empty())
        return std::nullopt;
    Result<std::optional<BuiltScene>> found = restore_levels(
        options.saved, soup,
        [&](uint64_t triangles, uint64_t unique) {
            return limits_of(options, plan, triangles, unique);
        },
        /* takes_any_limits= */ options.leaf_triangles == 0 && options.leaves == 0);
    if (!found) {
        say(log, LogLevel::Warning,
            format_text("building anew: what was saved {}", found.error().message));
        return std::nullopt;
    }
    if (!*found)
        say(log, LogLevel::Info,
            "building anew: what was saved is of other meshes or other options");
    if (*found) {
        set_limits(**found, options, plan);
        if (!finish_scene(**found, options, plan))
            return std::nullopt;
    }
    return std::move(*found);
}

Result<BuiltScene> built(const Soup& soup, const TwoLevelOptions& options, const MemoryPlan& plan,
                         BuildProgress* progress) {
    BuiltScene scene(soup);
    Placed placed = placed_chunks(soup);
    const SmallestCut cut = smallest_cut(soup, placed, options);
    const uint64_t unique = unique_triangles(soup, placed);
    begin(progress, "triangles", 0.1, 2 * unique);
    HittableParts hittable = take_hittable_parts(scene, std::move(placed), progress);
    assert(hittable.shared.size() == scene.shared.size());
    set_limits(scene, options, plan);
    const auto build = [&](BuiltScene& part, const Hittable& of) {
        return build_levels(part, of, progress, double(of.triangles.size()) / double(unique));
    };
    if (const Result<Done> done = build(scene, hittable.once); !done)
        return done.error();
    for (size_t i = 0; i < scene.shared.size(); ++i)
        if (const Result<Done> done = build(scene.shared[i].scene, hittable.shared[i]); !done)
            return done.error();
    gather_pages(scene);
    if (finish_scene(scene, options, plan))
        return scene;
    build_smallest_levels(scene, std::move(hittable.once), cut.leaf_triangles,
                          /* in_one_frame= */ false, progress);
    for (size_t i = 0; i < scene.shared.size(); ++i)
        build_smallest_levels(scene.shared[i].scene, std::move(hittable.shared[i]),
                              cut.leaf_triangles, /* in_one_frame= */ true, progress);
    gather_pages(scene);
    if (finish_scene(scene, options, plan))
        return scene;
    // check_budget() has found enough bytes, so the refusal is about a count.
    if (const uint64_t table = scene.top.table_bytes(); table > plan.buffer_bytes)
        return over_budget(format_text("{} instances are too many: their table takes {} bytes, and "
                                       "a buffer of this device holds {}",
                                       scene.top.portals.size(), table, plan.buffer_bytes));
    return over_budget(format_text("{} pages under a budget are too many: at most {}; let leaves "
                                   "hold more triangles",
                                   scene.pages.size(), OVC_KEY_LEAF - 1));
}

} // namespace

Result<BuiltScene> open_scene(const Soup& soup, const TwoLevelOptions& options,
                              const MemoryPlan& plan, const DeviceInfo& device,
                              const LogSink& log) {
    Result<BuiltScene> scene = open_stored_levels(*options.store, soup);
    if (!scene && scene.error().kind != ErrorKind::OverBudget)
        return Error{"what was saved " + scene.error().message, ErrorKind::Unreadable};
    if (!scene)
        return scene;
    set_limits(*scene, options, plan);
    if (!finish_scene(*scene, options, plan))
        return over_budget(format_text(
            "a GPU budget of {} bytes is too small for what was saved: the smallest that works is "
            "{} bytes (its largest page takes {})",
            plan.budget_bytes, smallest_budget(*scene, options, device),
            scene->largest_page_bytes()));
    warn_of_dropped(scene->dropped, log);
    return scene;
}

Result<BuiltScene> build_scene(const Soup& soup, const TwoLevelOptions& options,
                               const MemoryPlan& plan, const LogSink& log,
                               BuildProgress* progress) {
    std::optional<BuiltScene> found = restored(soup, options, plan, log);
    Result<BuiltScene> scene =
        found ? Result<BuiltScene>(std::move(*found)) : built(soup, options, plan, progress);
    if (scene)
        warn_of_dropped(scene->dropped, log);
    return scene;
}

} // namespace ovc
