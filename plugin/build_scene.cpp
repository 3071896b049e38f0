// SPDX-License-Identifier: Apache-2.0
// A scene is restored or built, and cut as small as can be where the budget has no room for it.
#include "plugin/build_scene.h"

#include "gpu/level1_table.h"
#include "plugin/level2.h"
#include "plugin/saved_levels.h"

#include <fmt/format.h>

#include <cassert>
#include <optional>

namespace ovc {

uint64_t table_bytes(const BuiltScene& scene, const TwoLevelOptions& options) {
    const uint64_t active_bytes = options.tell_active ? scene.pages.size() * sizeof(uint32_t) : 0;
    return level1_texels(scene.level1) * sizeof(uvec4) + active_bytes;
}

namespace {

/// Whether the pool holds level 1 and each of the pages.
bool has_room(const BuiltScene& scene, const TwoLevelOptions& options, const MemoryPlan& plan) {
    return scene.pages.empty() ||
           table_bytes(scene, options) + scene.largest_page_bytes() <= plan.pool_bytes;
}

/// The scene from what was saved; none where that will not do, and the scene is to be built.
std::optional<BuiltScene> restored(const Soup& soup, const TwoLevelOptions& options,
                                   const MemoryPlan& plan, const LogSink& log) {
    if (options.saved.empty())
        return std::nullopt;
    Result<std::optional<BuiltScene>> found =
        restore_levels(options.saved, soup,
                       [&](uint64_t triangles) { return limits_of(options, plan, triangles); });
    if (!found) {
        say(log, LogLevel::Warning,
            fmt::format("building anew: what was saved {}", found.error().message));
        return std::nullopt;
    }
    if (!*found)
        say(log, LogLevel::Info,
            "building anew: what was saved is of other meshes or other options");
    else if (!has_room(**found, options, plan))
        return std::nullopt;
    return std::move(*found);
}

void warn_of_dropped(const Dropped& dropped, const LogSink& log) {
    if (dropped.not_finite)
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles with a NaN or infinite corner", dropped.not_finite));
    if (dropped.degenerate)
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles without area", dropped.degenerate));
}

Result<BuiltScene> built(const Soup& soup, const TwoLevelOptions& options, const MemoryPlan& plan,
                         bool may_have_far_leaves, BuildProgress* progress) {
    BuiltScene scene(soup);
    begin(progress, "triangles", 0.1, 2 * soup.triangle_count());
    Hittable hittable = take_hittable(scene, progress);
    scene.limits = limits_of(options, plan, scene.triangles);
    if (const Result<Done> done = build_levels(scene, hittable, progress, may_have_far_leaves);
        !done)
        return done.error();
    if (has_room(scene, options, plan))
        return scene;
    const SmallestCut cut = smallest_cut(soup, options);
    build_smallest_levels(scene, std::move(hittable), cut.leaf_triangles, progress);
    assert(has_room(scene, options, plan)); // see check_budget()
    return scene;
}

Result<BuiltScene> with_tree(Result<BuiltScene> scene, const TwoLevelOptions& options,
                             const MemoryPlan& plan) {
    if (!scene || !scene->level1.shares_frame || scene->pages.empty())
        return scene;
    const uint64_t room = plan.pool_bytes - table_bytes(*scene, options);
    scene->top =
        build_top_level(scene->pages, max_links(scene->pages.size(), scene->level2_bytes(), room));
    return scene;
}

} // namespace

Result<BuiltScene> build_scene(const Soup& soup, const TwoLevelOptions& options,
                               const MemoryPlan& plan, const LogSink& log,
                               BuildProgress* progress) {
    std::optional<BuiltScene> found = restored(soup, options, plan, log);
    Result<BuiltScene> scene =
        with_tree(found ? Result<BuiltScene>(std::move(*found))
                        : built(soup, options, plan, /* may_have_far_leaves= */ true, progress),
                  options, plan);
    if (!scene)
        return scene;
    warn_of_dropped(scene->dropped, log);
    // Rays that do not go through the tree come to leaves in cells alone.
    if (scene->level1.far_leaves > 0 &&
        !is_usable(scene->top, scene->pages, plan.pool_bytes - table_bytes(*scene, options)))
        return with_tree(built(soup, options, plan, /* may_have_far_leaves= */ false, progress),
                         options, plan);
    return scene;
}

} // namespace ovc
