// SPDX-License-Identifier: Apache-2.0
// A mesh at rest has the frame, the grid and the numbers of the scene in its pages, so that these
// hang in the scene's own tree as long as the mesh stays where it is.
#include "plugin/build/resting.h"

#include "gpu/frame/frames.h"
#include "gpu/page/refit.h"
#include "plugin/build/level_update.h"

#include <algorithm>
#include <cassert>

namespace ovc {
namespace {

/// A commit brings meshes to rest until they have this part of the scene's triangles. Their pages
/// are refitted, and refitting all takes a tenth of building the scene.
constexpr uint64_t kMaxPart = 3;

/// Returns an even sample of the triangles of a level, as they are named in the whole scene's soup.
/// chunk: whose they are there; kNone: the level is the scene's own.
std::vector<TriangleId> sample_of(const BuiltScene& level, const Soup& soup, uint32_t chunk) {
    constexpr size_t kSample = 4096;
    std::vector<TriangleId> sample;
    const size_t step = level.triangles / kSample + 1;
    for (const Leaf& leaf : level.level1.leaves)
        for (size_t i = 0; i < leaf.list().size(); i += step) {
            const TriangleId own = leaf.list()[i];
            const TriangleId id{chunk == kNone ? own.mesh : chunk, own.prim};
            if (soup.has(id)) // else it was removed, and its leaf is not up to date yet
                sample.push_back(id);
        }
    return sample;
}

} // namespace

Resting::Resting(BuiltScene& scene, std::span<const uint32_t> placed)
    : scene_(scene), placed_(placed.begin(), placed.end()) {
    std::ranges::sort(placed_);
}

/// Whether the mesh would be home, and is not where rays need no portal to it anyway.
bool Resting::may_rest(const SharedMesh& mesh, uint32_t chunk) const {
    const bool is_alone = scene_.shared.size() == 1 && scene_.once.empty() &&
                          scene_.numbers.of({chunk, 0}) == mesh.scene.numbers.first();
    const Level1& level1 = scene_.level1;
    return !is_alone && !mesh.scene.level1.leaves.empty() &&
           (level1.leaves.empty() || level1.shares_frame);
}

/// Whether the frame suits the mesh where it is placed.
bool Resting::suits(const SharedMesh& mesh, uint32_t chunk, const Frame& frame) const {
    return doubtful_share(scene_.soup, sample_of(mesh.scene, scene_.soup, chunk), frame) <=
           kMaxDoubtful;
}

void Resting::set_bounds(const Box& bounds) {
    if (bounds.empty())
        return;
    const Level1& level1 = scene_.level1;
    const Leaf* const home = !level1.leaves.empty() ? &level1.leaves.front()
                             : scene_.home          ? &*scene_.home
                                                    : nullptr;
    Box all = bounds;
    if (!level1.leaves.empty())
        all.add(level1.bounds);
    const Leaf larger = scene_leaf(with_room(all));
    // The frame does not grow for meshes that would leave all others in doubt.
    const bool grows = !home || (!contains(home->grid, bounds) &&
                                 doubtful_share(scene_.soup, sample_of(scene_, scene_.soup, kNone),
                                                larger.frame) <= kMaxDoubtful);
    frame_ = grows ? larger.frame : home->frame;
    grid_ = grows ? larger.grid : home->grid;
}

void Resting::consider(SharedMesh& mesh, uint32_t chunk, const Box& box, uint64_t moved,
                       uint64_t unique) {
    const bool is_placed = std::ranges::binary_search(placed_, chunk);
    mesh.commits_in_place = is_placed ? 0 : mesh.commits_in_place + 1;
    mesh.is_doubtful = mesh.is_doubtful && !is_placed;
    if (!may_rest(mesh, chunk))
        return;
    const Box here = placed_box(box, scene_.soup.chunks[chunk].transform());
    if (!mesh.lies_at_rest(scene_)) {
        const uint64_t triangles = scene_.soup.chunks[chunk].size();
        const bool is_refitted = 2 * moved >= triangles;
        const bool stays = mesh.commits_in_place > 0 && kMaxPart * triangles_ < unique;
        if (mesh.is_doubtful || (!is_refitted && !stays))
            return;
        mesh.is_doubtful = !contains(grid_, here) || !suits(mesh, chunk, frame_);
        if (mesh.is_doubtful)
            return;
        triangles_ += is_refitted ? 0 : triangles;
        coming_.push_back(chunk);
    }
    if (contains(grid_, here))
        reach_.add(here);
}

void Resting::find_home() {
    ovc::find_home(scene_);
    const bool holds_all = scene_.home && contains(scene_.home->grid, reach_);
    if (scene_.level1.leaves.empty() && !reach_.empty() && !holds_all)
        scene_.home = scene_leaf(with_room(reach_));
}

void Resting::bring_home(SharedMesh& mesh, uint32_t chunk) {
    const uint32_t first = scene_.numbers.of({chunk, 0});
    if (const uint32_t before = mesh.scene.numbers.first(); first != before)
        for (Page& page : mesh.scene.pages)
            renumber(page, first - before);
    mesh.put_to_rest(or_identity(scene_.soup.chunks[chunk].transform()), first);
    Level1& level1 = mesh.scene.level1;
    level1.bounds = scene_.home->grid;
    level1.padding = padding_of(level1.bounds);
    level1.shares_frame = true;
    for (Leaf& leaf : level1.leaves) {
        leaf.frame = scene_.home->frame;
        leaf.cell = leaf.box = leaf.grid = scene_.home->grid;
    }
}

/// Whether the mesh comes to rest, or does so again because the home is another one.
bool Resting::comes_home(SharedMesh& mesh, uint32_t chunk) const {
    const Transform* const place = scene_.soup.chunks[chunk].transform();
    if (!scene_.home || !contains(scene_.home->grid, placed_box(mesh.box, place)))
        return false;
    if (std::ranges::binary_search(coming_, chunk))
        return true;
    if (!mesh.lies_at_rest(scene_) || mesh.has_frame_of(scene_) || mesh.is_doubtful)
        return false;
    mesh.is_doubtful = !suits(mesh, chunk, scene_.home->frame);
    return !mesh.is_doubtful;
}

std::optional<bool> Resting::prepare(SharedMesh& mesh) {
    const uint32_t chunk = mesh.places.front();
    if (comes_home(mesh, chunk)) {
        bring_home(mesh, chunk);
        return true;
    }
    if (!mesh.rest || mesh.scene.level1.leaves.empty())
        return false;
    const Box& frame = mesh.scene.level1.leaves.front().grid;
    const bool is_near = std::ranges::all_of(mesh.places, [&](uint32_t place) {
        return is_well_moved(mesh.rest_place(), or_identity(scene_.soup.chunks[place].transform()),
                             frame);
    });
    return is_near ? std::optional(false) : std::nullopt;
}

} // namespace ovc
