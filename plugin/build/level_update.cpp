// SPDX-License-Identifier: Apache-2.0
// Refits the pages around triangles that have moved. A page is built again where its list of
// triangles changes, or where rays would take much longer through it than through a new one.
#include "plugin/build/level_update.h"

#include "core/system/parallel.h"
#include "gpu/page/node_boxes.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc {
namespace {

/// By how much the expected cost of a ray may grow before what has caused it is built again: in a
/// page its tree, in a scene its level 1.
constexpr double kMaxGrowth = 4.0 / 3;
/// The late leaf has at most this part of a level's triangles, or some; else the leaves are cut
/// anew.
constexpr uint64_t kMaxLatePart = 64, kMaxLate = 64;

uint64_t count_of(std::span<const PrimRange> ranges) {
    uint64_t count = 0;
    for (const PrimRange& range : ranges)
        count += range.end - range.first;
    return count;
}

/// Returns how many of the scene's own pages a ray through all of them meets, by their areas; 1
/// where it is less, because pages far apart are no better than a single one. The late leaf does
/// not count: it may reach far, but is small.
double overlap_of(const BuiltScene& scene) {
    Box all;
    double sum = 0;
    for (size_t i = 0; i < scene.level1.leaves.size(); ++i) {
        if (i == scene.late_leaf)
            continue;
        const Frame& frame = scene.level1.leaves[i].frame;
        const Box local = box_of(scene.pages[i]);
        const Box world{local.lo / frame.scale + frame.origin,
                        local.hi / frame.scale + frame.origin};
        sum += world.half_area();
        all.add(world);
    }
    return all.half_area() > 0 ? std::max(sum / all.half_area(), 1.0) : 1;
}

} // namespace

LevelUpdate::LevelUpdate(BuiltScene& scene, std::span<const PrimRange> changed, FrameChange frame,
                         BuildProgress* progress)
    : scene_(scene),
      changed_(changed),
      frame_(frame),
      progress_(progress),
      moved_(scene.numbers.count()),
      gone_(scene.numbers.count()),
      listed_(scene.numbers.count()),
      framed_(scene.level1.leaves.size(), frame.is_new) {
    assert(std::ranges::is_sorted(changed));
    for (uint32_t i = 0; i < framed_.size(); ++i)
        leaves_.push_back({i});
    for (const PrimRange& range : changed)
        for (uint32_t prim = range.first; prim < range.end; ++prim)
            moved_.add(scene.numbers.of({range.mesh, prim}));
}

/// Whether anything changes, the reach of the frame included.
bool LevelUpdate::is_needed() const {
    const Level1& level1 = scene_.level1;
    return !changed_.empty() || frame_.is_new ||
           (level1.shares_frame && !level1.leaves.empty() &&
            !contains(level1.leaves.front().grid, frame_.reach));
}

bool LevelUpdate::run() {
    if (!is_needed())
        return true;
    if (scene_.level1.leaves.empty())
        return false;
    scene_.level1.own_lists();
    if (scene_.built_overlap == 0)
        scene_.built_overlap = overlap_of(scene_);
    find_faults();
    dissolve_duplicates();
    list_anew();
    count_dropped();
    fit_frames();
    fit_pages();
    if (!fill_late_leaf() || !pages_fit())
        return false;
    drop_empty_leaves();
    // The planes of level 1 tell nothing of leaves that have changed.
    Level1& level1 = scene_.level1;
    level1.nodes.assign(1, KdNode::leaf(0, uint32_t(level1.leaves.size())));
    level1.far_leaves = 0;
    if (frame_.is_new)
        scene_.built_overlap = 0; // boxes along other axes are others
    return !level1.leaves.empty() &&
           (frame_.is_new || overlap_of(scene_) <= kMaxGrowth * scene_.built_overlap);
}

bool LevelUpdate::hits(TriangleId id) const {
    return scene_.soup.has(id) && !(is_changed(id) && gone_.has(scene_.numbers.of(id)));
}

void LevelUpdate::find_faults() {
    for (const PrimRange& range : changed_) {
        const uint32_t count = range.end - range.first;
        std::vector<uint8_t> is_hit(count, 0);
        const Chunk& chunk = scene_.soup.chunks[range.mesh];
        if (range.end <= chunk.size()) { // else it was removed
            const Survey found = survey(chunk, range.first, is_hit);
            faults_.not_finite += found.dropped.not_finite;
            faults_.degenerate += found.dropped.degenerate;
            moved_bounds_.add(found.bounds);
        }
        for (uint32_t i = 0; i < count; ++i)
            if (!is_hit[i])
                gone_.add(scene_.numbers.of({range.mesh, range.first + i}));
    }
}

/// Keeps the duplicates that still are some. New ones are not looked for: they cost a ray that
/// meets them time, and change no answer.
void LevelUpdate::dissolve_duplicates() {
    std::vector<Duplicates::Pair> kept;
    for (const Duplicates::Pair& pair : scene_.duplicates.pairs()) {
        const bool other_changed = is_changed(pair.other);
        hit_before_ += other_changed;
        if (other_changed)
            listed_.add(scene_.numbers.of(pair.other)); // here, and so not missing from leaves
        const bool are_same =
            (!other_changed && !is_changed(pair.smallest)) ||
            (hits(pair.smallest) && hits(pair.other) &&
             same_corners(scene_.soup.triangle(pair.smallest), scene_.soup.triangle(pair.other)));
        if (are_same)
            kept.push_back(pair);
        else if (hits(pair.other))
            come_.push_back(pair.other);
    }
    if (kept.size() < scene_.duplicates.count())
        scene_.duplicates = Duplicates::restored(kept);
}

/// Takes the triangles that have gone out of the leaves, and finds those that no leaf has yet.
void LevelUpdate::list_anew() {
    for (size_t i = 0; i < leaves_.size(); ++i) {
        std::vector<TriangleId>& list = scene_.level1.leaves[i].triangles;
        const auto note = [&](TriangleId id) {
            const uint32_t number = scene_.numbers.of(id);
            const bool is_gone = gone_.has(number);
            leaves_[i].work = std::max(leaves_[i].work, is_gone ? Work::Rebuild : Work::Refit);
            if (listed_.has(number))
                return;
            listed_.add(number);
            hit_before_ += 1;
            scene_.triangles -= is_gone;
        };
        if (changed_.size() > list.size()) {
            for (const TriangleId id : list)
                if (is_changed(id))
                    note(id);
        } else {
            for (const PrimRange& range : changed_) {
                auto id = std::ranges::lower_bound(list, TriangleId{range.mesh, range.first});
                for (; id != list.end() && *id < TriangleId{range.mesh, range.end}; ++id)
                    note(*id);
            }
        }
        if (leaves_[i].work == Work::Rebuild)
            std::erase_if(list, [&](TriangleId id) { return gone_.has(scene_.numbers.of(id)); });
    }
    for (const PrimRange& range : changed_)
        for (uint32_t prim = range.first; prim < range.end; ++prim) {
            const uint32_t number = scene_.numbers.of({range.mesh, prim});
            if (!listed_.has(number) && !gone_.has(number))
                come_.push_back({range.mesh, prim});
        }
    scene_.triangles += come_.size();
}

Box LevelUpdate::bounds_of_moved(const Leaf& leaf) const {
    return parallel_reduce(
        leaf.triangles.size(), Box(),
        [&](size_t first, size_t last, Box box) {
            for (size_t i = first; i < last; ++i)
                if (is_changed(leaf.triangles[i]))
                    box.add(bounds_of(packed(leaf.triangles[i])));
            return box;
        },
        [](Box a, const Box& b) {
            a.add(b);
            return a;
        });
}

/// Returns the bounds of the changed triangles where the pages have them.
Box LevelUpdate::bounds_of_packed() const {
    if (!scene_.packed || moved_bounds_.empty())
        return moved_bounds_;
    const Level1& level1 = scene_.level1;
    const Box about = placed_box(moved_bounds_, scene_.packed->chunks.front().transform());
    if (contains(level1.bounds, about))
        return about;
    Box all;
    for (const Leaf& leaf : level1.leaves)
        all.add(bounds_of_moved(leaf));
    return all;
}

/// Gives leaves that their triangles have left a new frame. A changed leaf is no cell any more: it
/// holds all of its triangles.
void LevelUpdate::fit_frames() {
    Level1& level1 = scene_.level1;
    Box all = bounds_of_packed();
    for (const TriangleId id : come_)
        all.add(bounds_of(packed(id)));
    if (!level1.shares_frame) {
        if (!contains(level1.bounds, all))
            grow_bounds(all);
        for (const LeafRange& part : parts_of(level1))
            share_new_frame(part);
        return;
    }
    all.add(frame_.reach);
    if (contains(level1.bounds, all) && contains(level1.leaves.front().grid, all))
        return;
    grow_bounds(all);
    share_frame(level1);
    std::ranges::fill(framed_, 1);
}

void LevelUpdate::grow_bounds(const Box& to) {
    Level1& level1 = scene_.level1;
    level1.bounds.add(to);
    level1.bounds = with_room(level1.bounds);
    level1.padding = padding_of(level1.bounds);
}

/// Gives a part of the scene a new frame where its triangles have left that which it has.
void LevelUpdate::share_new_frame(LeafRange part) {
    const auto leaves = std::span(scene_.level1.leaves).subspan(part.first, part.count);
    bool has_left = false;
    for (uint32_t i = 0; i < part.count; ++i) {
        if (leaves_[part.first + i].work == Work::None)
            continue;
        Leaf& leaf = leaves[i];
        const Box moved = bounds_of_moved(leaf);
        has_left |= !contains(leaf.grid, moved);
        leaf.box.add(moved);
        leaf.reach = std::max(leaf.reach, max_component(leaf.box.extent()));
    }
    if (!has_left)
        return;
    for (Leaf& leaf : leaves)
        leaf.box = with_room(leaf.box);
    share_frame(leaves);
    std::fill_n(framed_.begin() + part.first, part.count, uint8_t(1));
}

/// Gives the leaf these triangles, and a box that holds all of them.
void LevelUpdate::fill(Leaf& leaf, std::vector<TriangleId> triangles) const {
    const Level1& level1 = scene_.level1;
    Leaf filled = make_leaf(scene_.packed_soup(), level1.bounds.padded(level1.padding),
                            level1.padding, std::move(triangles));
    filled.cell = filled.box;
    if (!leaf.box.empty()) {
        filled.frame = leaf.frame;
        filled.grid = leaf.grid;
    }
    leaf = std::move(filled);
}

void LevelUpdate::rebuild(uint32_t number) {
    Leaf& leaf = scene_.level1.leaves[number];
    Page& page = scene_.pages[number];
    fill(leaf, std::move(leaf.triangles));
    page = build_page(scene_.packed_soup(), scene_.numbers, leaf, progress_,
                      {page.has_loose_pairs(), copies_});
}

/// Returns whether the page is still about as good as it was when it was built.
bool LevelUpdate::refit(uint32_t leaf) {
    Page& page = scene_.pages[leaf];
    std::vector<uint32_t> parted;
    const std::optional<RefitCost> cost =
        refit_page(page, scene_.packed_soup(), scene_.numbers, scene_.level1.leaves[leaf],
                   framed_[leaf] ? nullptr : &moved_, parted);
    if (!cost)
        return false;
    if (page.built_cost == 0)
        page.built_cost = float(cost->before);
    if (cost->after > kMaxGrowth * double(page.built_cost))
        return false;
    if (leaf == scene_.late_leaf && !parted.empty())
        return false; // nowhere else has room for what it loses
    const std::lock_guard lock(mutex_);
    for (const uint32_t number : parted)
        come_.push_back(scene_.numbers.id(number));
    return true;
}

void LevelUpdate::fit_pages() {
    copies_ = std::max(1.0, double(scene_.level1.reference_count()) /
                                double(std::max<uint64_t>(scene_.triangles, 1)));
    for (uint32_t i = 0; i < leaves_.size(); ++i) {
        if (framed_[i])
            leaves_[i].work = std::max(leaves_[i].work, Work::Refit);
        if (scene_.level1.leaves[i].triangles.empty())
            leaves_[i].work = Work::None; // drop_empty_leaves() takes it
    }
    parallel_for(leaves_.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            if (leaves_[i].work == Work::Refit && !refit(uint32_t(i)))
                leaves_[i].work = Work::Rebuild;
            if (leaves_[i].work == Work::Rebuild)
                rebuild(uint32_t(i));
        }
    });
}

/// Takes those triangles out that a page which was built again has.
void LevelUpdate::take_out_built(std::vector<TriangleId>& triangles) const {
    for (uint32_t i = 0; i < leaves_.size(); ++i)
        if (i != scene_.late_leaf && leaves_[i].work == Work::Rebuild) {
            const std::vector<TriangleId>& built = scene_.level1.leaves[i].triangles;
            std::erase_if(triangles,
                          [&](TriangleId id) { return std::ranges::binary_search(built, id); });
        }
}

/// Builds the pages again of all leaves that list one of these triangles.
void LevelUpdate::build_leaves_of(std::span<const TriangleId> triangles) {
    std::vector<uint32_t> numbers;
    for (uint32_t i = 0; i < leaves_.size(); ++i) {
        const std::vector<TriangleId>& list = scene_.level1.leaves[i].triangles;
        if (i != scene_.late_leaf && leaves_[i].work != Work::Rebuild &&
            std::ranges::any_of(
                triangles, [&](TriangleId id) { return std::ranges::binary_search(list, id); }))
            numbers.push_back(i);
    }
    parallel_for(numbers.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            rebuild(numbers[i]);
    });
    for (const uint32_t number : numbers)
        leaves_[number].work = Work::Rebuild;
}

/// Puts the triangles that no page has into the late leaf. Where they are many, those that left
/// their page go back to it. Returns false where too many are left.
bool LevelUpdate::fill_late_leaf() {
    Level1& level1 = scene_.level1;
    std::vector<TriangleId> late = std::move(come_);
    if (scene_.late_leaf != kNone) {
        const std::vector<TriangleId>& before = level1.leaves[scene_.late_leaf].triangles;
        late.insert(late.end(), before.begin(), before.end());
    }
    std::ranges::sort(late);
    late.erase(std::ranges::unique(late).begin(), late.end());
    take_out_built(late);
    const uint64_t max_late = std::max(scene_.triangles / kMaxLatePart, kMaxLate);
    if (late.size() > max_late) {
        build_leaves_of(late);
        take_out_built(late);
        if (late.size() > max_late)
            return false;
    }
    if (scene_.late_leaf == kNone) {
        if (late.empty())
            return true;
        scene_.late_leaf = uint32_t(level1.leaves.size());
        level1.leaves.emplace_back();
        scene_.pages.emplace_back();
        leaves_.push_back({kNone});
    }
    Leaf& leaf = level1.leaves[scene_.late_leaf];
    if (late == leaf.triangles)
        return true;
    leaf.triangles = {};
    if (late.empty())
        return true; // drop_empty_leaves() takes it
    leaf.box = {};   // the leaf gets a frame of its own, unless all share one
    if (level1.shares_frame)
        leaf = {.cell = {},
                .box = level1.bounds,
                .frame = level1.leaves.front().frame,
                .grid = level1.leaves.front().grid};
    fill(leaf, std::move(late));
    scene_.pages[scene_.late_leaf] =
        build_page(scene_.packed_soup(), scene_.numbers, leaf, progress_, LoosePairs());
    leaves_[scene_.late_leaf].work = Work::Rebuild;
    return true;
}

bool LevelUpdate::pages_fit() const {
    const uint64_t max_bytes = scene_.limits.page_bytes_of(leaves_.size());
    return std::ranges::all_of(scene_.pages,
                               [&](const Page& page) { return page.bytes() <= max_bytes; });
}

void LevelUpdate::drop_empty_leaves() {
    std::vector<Leaf>& leaves = scene_.level1.leaves;
    size_t kept = 0;
    uint32_t late_leaf = kNone;
    for (size_t i = 0; i < leaves.size(); ++i) {
        if (leaves[i].triangles.empty())
            continue;
        if (i == scene_.late_leaf)
            late_leaf = uint32_t(kept);
        if (kept < i) {
            leaves[kept] = std::move(leaves[i]);
            scene_.pages[kept] = std::move(scene_.pages[i]);
            leaves_[kept] = leaves_[i];
        }
        ++kept;
    }
    scene_.late_leaf = late_leaf;
    leaves_.resize(kept, {kNone});
    leaves.resize(kept);
    scene_.pages.resize(kept);
}

/// Counts what is dropped among the changed triangles instead of what was before.
void LevelUpdate::count_dropped() {
    Dropped& dropped = scene_.dropped;
    const uint64_t before = count_of(changed_) - hit_before_;
    if (before > 0 && dropped.not_finite > 0 && dropped.degenerate > 0) {
        hittable_triangles(scene_.soup, scene_.once, &dropped, nullptr, progress_);
        return;
    }
    (dropped.not_finite > 0 ? dropped.not_finite : dropped.degenerate) -= before;
    dropped.not_finite += faults_.not_finite;
    dropped.degenerate += faults_.degenerate;
}

} // namespace ovc
