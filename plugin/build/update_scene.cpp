// SPDX-License-Identifier: Apache-2.0
// Updates the levels whose triangles have changed, takes meshes in that are new, and builds the
// top-level tree again.
#include "plugin/build/update_scene.h"

#include "plugin/build/build_scene.h"
#include "plugin/build/level2.h"
#include "plugin/build/level_update.h"
#include "plugin/build/resting.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ovc {
namespace {

/// Returns the ranges sorted, and joined where they touch.
std::vector<PrimRange> joined(std::vector<PrimRange> ranges) {
    std::ranges::sort(ranges);
    std::vector<PrimRange> all;
    for (const PrimRange& range : ranges) {
        if (!all.empty() && all.back().mesh == range.mesh && range.first <= all.back().end)
            all.back().end = std::max(all.back().end, range.end);
        else
            all.push_back(range);
    }
    return all;
}

class SceneUpdate {
public:
    SceneUpdate(BuiltScene& scene, const Changes& changes, const TwoLevelOptions& options,
                const MemoryPlan& plan, BuildProgress* progress)
        : scene_(scene),
          soup_(scene.soup),
          changes_(changes),
          moved_(joined(changes.moved)),
          resting_(scene, changes.placed),
          options_(options),
          plan_(plan),
          progress_(progress) {}

    std::optional<PageChanges> run() {
        Placed placed = placed_chunks(soup_, [&](uint32_t chunk) { return known_box(chunk); });
        if (!keeps_once(placed.once) || !numbers_suffice() ||
            std::ranges::any_of(scene_.shared, &SharedMesh::has_lines))
            return std::nullopt;
        begin(progress_, "update", 0.9, std::max<uint64_t>(scene_.reference_count(), 1));
        unique_ = unique_triangles(soup_, placed);
        choose_resting(placed);
        scene_.numbers.append(soup_);
        scene_.copies = std::move(placed.copies);
        scene_.pages.resize(scene_.level1.leaves.size());
        for (const SharedMesh& mesh : scene_.shared)
            take_drops_off(mesh);
        if (!update_once() || !update_shared(placed))
            return std::nullopt;
        scene_.once = std::move(placed.once);
        scene_.was_updated = true;
        gather_pages(scene_);
        note_pages();
        if (!add_tree(scene_, options_, plan_))
            return std::nullopt;
        scene_.from_saved = false;
        return std::move(done_);
    }

private:
    /// Returns what has moved of a chunk, sorted and joined.
    std::span<const PrimRange> moved_of(uint32_t chunk) const {
        return std::ranges::equal_range(moved_, chunk, {}, &PrimRange::mesh);
    }

    /// Returns a box around a mesh that is shared by itself, of which few corners have changed at
    /// most.
    std::optional<Box> known_box(uint32_t chunk) const {
        const SharedMesh* mesh =
            chunk < scene_.mesh_of_chunk.size() ? scene_.shared_mesh_of(chunk) : nullptr;
        if (!mesh || mesh->soup->chunks.size() > 1)
            return std::nullopt;
        Box box = mesh->box;
        uint64_t moved = 0;
        for (const PrimRange& range : moved_of(chunk)) {
            moved += range.end - range.first;
            if (moved > soup_.chunks[chunk].size() / 16)
                return std::nullopt;
            for (uint32_t prim = range.first; prim < range.end; ++prim)
                for (const dvec3& corner : mesh->soup->chunks.front().triangle(prim)) {
                    if (!is_finite(corner))
                        return std::nullopt;
                    box.add(corner);
                }
        }
        return box;
    }

    /// Whether level 1 is still of the same chunks, except for those that were removed.
    bool keeps_once(std::span<const uint32_t> once) const {
        std::vector<uint32_t> left;
        std::ranges::copy_if(scene_.once, std::back_inserter(left),
                             [&](uint32_t chunk) { return soup_.chunks[chunk].size() > 0; });
        return std::ranges::equal(left, once);
    }

    /// Whether the triangles of chunks that were added still have numbers.
    bool numbers_suffice() const {
        uint64_t count = scene_.numbers.count();
        for (uint64_t i = scene_.numbers.meshes(); i < soup_.chunks.size(); ++i)
            count += soup_.chunks[i].size();
        return count <= OVC_MAX_TRIANGLES;
    }

    void choose_resting(const Placed& placed) {
        Box bounds;
        for (const Placed::Shared& meshes : placed.shared)
            for (const uint32_t place : meshes.places)
                bounds.add(placed_box(meshes.box, soup_.chunks[place].transform()));
        resting_.set_bounds(bounds);
        for (const Placed::Shared& meshes : placed.shared) {
            const uint32_t was = mesh_before(meshes, scene_.shared, scene_.mesh_of_chunk);
            if (was == kNone || meshes.places.size() > 1)
                continue;
            const uint32_t chunk = meshes.places.front();
            uint64_t moved = 0;
            for (const PrimRange& range : moved_of(chunk))
                moved += range.end - range.first;
            resting_.consider(scene_.shared[was], chunk, meshes.box, moved, unique_);
        }
    }

    bool update_once() {
        std::vector<PrimRange> changed;
        const auto add = [&](const PrimRange& range) {
            if (std::ranges::binary_search(scene_.once, range.mesh))
                changed.push_back(range);
        };
        std::ranges::for_each(moved_, add);
        std::ranges::for_each(changes_.removed, add);
        for (const uint32_t chunk : changes_.placed)
            add({chunk, 0, soup_.chunks[chunk].size()});
        if (!update_level(scene_, joined(std::move(changed)), {.reach = resting_.reach()}, 0))
            return false;
        resting_.find_home();
        return true;
    }

    /// Updates a level whose pages begin with `first_page`.
    bool update_level(BuiltScene& level, std::span<const PrimRange> changed,
                      LevelUpdate::FrameChange frame, uint32_t first_page) {
        LevelUpdate update(level, changed, frame, progress_);
        if (!update.run())
            return false;
        for (const LevelUpdate::LeafChange& leaf : update.leaves()) {
            done_.refitted += leaf.work == LevelUpdate::Work::Refit;
            done_.rebuilt += leaf.work == LevelUpdate::Work::Rebuild;
        }
        levels_.push_back({first_page, update.leaves()});
        return true;
    }

    /// Tells what has become of the pages of all levels, which are gathered again.
    void note_pages() {
        done_.was.assign(scene_.pages.size(), kNone);
        for (size_t level = 0; level < levels_.size(); ++level) {
            uint32_t page = level == 0 ? 0 : scene_.shared[level - 1].first_page;
            for (const LevelUpdate::LeafChange& leaf : levels_[level].leaves) {
                if (leaf.was != kNone) {
                    done_.was[page] = levels_[level].first_page_before + leaf.was;
                    if (leaf.work != LevelUpdate::Work::None)
                        done_.changed.push_back(page);
                }
                ++page;
            }
        }
    }

    /// Keeps the meshes that are placed still, and builds those that are new.
    bool update_shared(const Placed& placed) {
        std::vector<SharedMesh> before = std::exchange(scene_.shared, {});
        const std::vector<uint32_t> of_chunk = std::exchange(scene_.mesh_of_chunk, {});
        if (placed.shared.empty() && !before.empty())
            return false; // without portals, pages must lie in the frame of the scene
        if (!placed.shared.empty())
            scene_.mesh_of_chunk.assign(soup_.chunks.size(), kNone);
        for (const Placed::Shared& meshes : placed.shared) {
            const uint32_t was = mesh_before(meshes, before, of_chunk);
            if (!(was == kNone ? build(meshes) : keep(std::move(before[was]), meshes)))
                return false;
            enter(scene_.shared.back());
        }
        return true;
    }

    /// Returns what these meshes were among the shared ones before; kNone: none of them, or they
    /// were shared with others. of_chunk: as BuiltScene::mesh_of_chunk.
    static uint32_t mesh_before(const Placed::Shared& meshes, std::span<const SharedMesh> before,
                                std::span<const uint32_t> of_chunk) {
        for (const uint32_t place : meshes.places)
            if (const uint32_t was = place < of_chunk.size() ? of_chunk[place] : kNone;
                was != kNone && before[was].soup &&
                before[was].soup->chunks.size() == meshes.chunks &&
                before[was].place_of(place) == place)
                return was;
        return kNone;
    }

    bool keep(SharedMesh mesh, const Placed::Shared& meshes) {
        mesh.places = meshes.places;
        mesh.box = meshes.box;
        std::vector<PrimRange> changed;
        meshes.for_each_chunk([&](uint32_t chunk) {
            for (const PrimRange& range : moved_of(chunk))
                changed.push_back({chunk - mesh.place_of(chunk), range.first, range.end});
            scene_.mesh_of_chunk[chunk] = uint32_t(scene_.shared.size());
        });
        changed = joined(std::move(changed));
        const std::optional<bool> rests = resting_.prepare(mesh);
        const bool updated =
            rests && update_level(mesh.scene, changed, {.is_new = *rests}, mesh.first_page);
        for (const PrimRange& range : changed)
            if (!mesh.has_lines)
                look_for_lines(mesh, range);
        const bool has_lines = mesh.has_lines;
        scene_.shared.push_back(std::move(mesh));
        return updated && !has_lines;
    }

    bool build(const Placed::Shared& meshes) {
        SharedMesh& shared = scene_.share(meshes);
        BuiltScene& mesh = shared.scene;
        const Hittable hittable = take_hittable(mesh, progress_);
        look_for_lines(shared);
        mesh.limits = limits_of(options_, plan_, mesh.triangles, unique_);
        const bool built = bool(build_levels(mesh, hittable, progress_, 0));
        done_.rebuilt += mesh.pages.size();
        levels_.push_back(
            {kNone, std::vector<LevelUpdate::LeafChange>(mesh.pages.size(), {kNone})});
        return built && !shared.has_lines;
    }

    void take_drops_off(const SharedMesh& mesh) {
        scene_.dropped.not_finite -= mesh.places.size() * mesh.scene.dropped.not_finite;
        scene_.dropped.degenerate -= mesh.places.size() * mesh.scene.dropped.degenerate;
    }

    /// Counts what the instances of the mesh drop, and widens the scene's bounds to them.
    void enter(const SharedMesh& mesh) {
        scene_.dropped.not_finite += mesh.places.size() * mesh.scene.dropped.not_finite;
        scene_.dropped.degenerate += mesh.places.size() * mesh.scene.dropped.degenerate;
        Level1& level1 = scene_.level1;
        if (mesh.scene.level1.leaves.empty()) // rays have nothing to look for
            return;
        for (const uint32_t place : mesh.places)
            level1.bounds.add(placed_box(mesh.box, soup_.chunks[place].transform()));
        level1.padding = padding_of(level1.bounds);
    }

    BuiltScene& scene_;
    const Soup& soup_;
    const Changes& changes_;
    const std::vector<PrimRange> moved_; // sorted and joined
    Resting resting_;
    const TwoLevelOptions& options_;
    const MemoryPlan& plan_;
    BuildProgress* const progress_;
    uint64_t unique_ = 0; // triangles that are packed
    struct Level {
        uint32_t first_page_before;
        std::vector<LevelUpdate::LeafChange> leaves;
    };
    std::vector<Level> levels_; // the scene's own, then those of the shared meshes
    PageChanges done_;
};

} // namespace

std::optional<PageChanges> update_scene(BuiltScene& scene, const Changes& changes,
                                        const TwoLevelOptions& options, const MemoryPlan& plan,
                                        BuildProgress* progress) {
    return SceneUpdate(scene, changes, options, plan, progress).run();
}

} // namespace ovc
