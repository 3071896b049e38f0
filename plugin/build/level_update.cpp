// SPDX-License-Identifier: Apache-2.0
// Refits the pages around triangles that have moved. A page is built again where its list of
// triangles changes, or where rays would take much longer through it than through a new one.
#include "plugin/build/level_update.h"

#include "core/system/parallel.h"
#include "gpu/page/node_boxes.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>

namespace ovc {
namespace {

/// By how much the expected cost of a ray may grow before what has caused it is built again: in a
/// page its tree, in a scene its level 1.
constexpr double kMaxGrowth = 4.0 / 3;
/// By what part of its size the space of a frame grows beyond what has left it, so that the next
/// move need not leave it again.
constexpr double kRoomToMove = 1.0 / 16;
/// Up to this part of a level's triangles may come to its leaves; else the leaves are cut anew.
constexpr double kMaxComing = 1.0 / 8;

bool contains(const Box& outer, const Box& inner) {
    return inner.empty() || (outer.contains(inner.lo) && outer.contains(inner.hi));
}

Box with_room(const Box& box) {
    return box.padded(kRoomToMove * max_component(box.extent()));
}

uint64_t count_of(std::span<const PrimRange> ranges) {
    uint64_t count = 0;
    for (const PrimRange& range : ranges)
        count += range.end - range.first;
    return count;
}

/// Returns the box of a page's tree, in the frame of its leaf.
Box box_of(const Page& page) {
    const auto root = page.view().subspan(OVC_ROOT_UNIT * OVC_UNIT_TEXELS);
    const GridHeader grid = header_of(page.view());
    Box box;
    for (size_t child = 0; child < 4; ++child) {
        Box one;
        for (int axis = 0; axis < 3; ++axis) {
            const GridRange range = range_of(root[size_t(axis)], child);
            one.lo[axis] = grid.middle[axis] + (double(range.lo) - kGridMiddle) * grid.cell[axis];
            one.hi[axis] = grid.middle[axis] + (double(range.hi) - kGridMiddle) * grid.cell[axis];
        }
        if (!one.empty())
            box.add(one);
    }
    return box;
}

/// Returns how many of the scene's own pages a ray through all of them meets, by their areas.
double overlap_of(const BuiltScene& scene) {
    Box all;
    double sum = 0;
    for (size_t i = 0; i < scene.level1.leaves.size(); ++i) {
        const Frame& frame = scene.level1.leaves[i].frame;
        const Box local = box_of(scene.pages[i]);
        const Box world{local.lo / frame.scale + frame.origin,
                        local.hi / frame.scale + frame.origin};
        sum += world.half_area();
        all.add(world);
    }
    return all.half_area() > 0 ? sum / all.half_area() : 1;
}

} // namespace

LevelUpdate::LevelUpdate(BuiltScene& scene, std::span<const PrimRange> changed,
                         BuildProgress* progress)
    : scene_(scene),
      changed_(changed),
      progress_(progress),
      moved_(scene.numbers.count()),
      gone_(scene.numbers.count()),
      listed_(scene.numbers.count()),
      work_(scene.level1.leaves.size(), Work::None),
      framed_(scene.level1.leaves.size(), 0) {
    assert(std::ranges::is_sorted(changed));
    for (const PrimRange& range : changed)
        for (uint32_t prim = range.first; prim < range.end; ++prim)
            moved_.add(scene.numbers.of({range.mesh, prim}));
}

bool LevelUpdate::run() {
    if (changed_.empty())
        return true;
    if (scene_.level1.leaves.empty())
        return false;
    if (scene_.built_overlap == 0)
        scene_.built_overlap = overlap_of(scene_);
    find_faults();
    dissolve_duplicates();
    list_anew();
    count_dropped();
    if (!add_to_leaves())
        return false;
    fit_frames();
    return fit_pages() && overlap_of(scene_) <= kMaxGrowth * scene_.built_overlap;
}

bool LevelUpdate::hits(TriangleId id) const {
    return scene_.soup.has(id) && !(is_changed(id) && gone_.has(scene_.numbers.of(id)));
}

void LevelUpdate::find_faults() {
    constexpr size_t kGrain = 4096;
    for (const PrimRange& range : changed_) {
        const uint32_t count = range.end - range.first;
        std::vector<TriangleFault> faults(count, TriangleFault::None);
        const Chunk& chunk = scene_.soup.chunks[range.mesh];
        const bool is_removed = range.end > chunk.size();
        parallel_for(is_removed ? 0 : count, kGrain, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                faults[i] = triangle_fault(chunk.triangle(range.first + uint32_t(i)));
        });
        for (uint32_t i = 0; i < count; ++i) {
            faults_.not_finite += faults[i] == TriangleFault::NotFinite;
            faults_.degenerate += faults[i] == TriangleFault::Degenerate;
            if (is_removed || faults[i] != TriangleFault::None)
                gone_.add(scene_.numbers.of({range.mesh, range.first + i}));
        }
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
    for (size_t i = 0; i < work_.size(); ++i) {
        std::vector<TriangleId>& list = scene_.level1.leaves[i].triangles;
        const auto note = [&](TriangleId id) {
            const uint32_t number = scene_.numbers.of(id);
            const bool is_gone = gone_.has(number);
            work_[i] = std::max(work_[i], is_gone ? Work::Rebuild : Work::Refit);
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
        if (work_[i] == Work::Rebuild)
            std::erase_if(list, [&](TriangleId id) { return gone_.has(scene_.numbers.of(id)); });
    }
    for (const PrimRange& range : changed_)
        for (uint32_t prim = range.first; prim < range.end; ++prim) {
            const uint32_t number = scene_.numbers.of({range.mesh, prim});
            if (!listed_.has(number) && !gone_.has(number))
                come_.push_back({range.mesh, prim});
        }
}

/// Puts the triangles that have come into the leaves whose boxes they widen least.
bool LevelUpdate::add_to_leaves() {
    std::vector<Leaf>& leaves = scene_.level1.leaves;
    if (double(come_.size()) > kMaxComing * double(scene_.triangles))
        return false;
    scene_.triangles += come_.size();
    for (const TriangleId id : come_) {
        const Box box = bounds_of(scene_.soup.triangle(id));
        const auto growth = [&](const Leaf& leaf) {
            Box both = leaf.box;
            both.add(box);
            return both.half_area() - leaf.box.half_area();
        };
        Leaf& leaf = *std::ranges::min_element(leaves, {}, growth);
        leaf.triangles.insert(std::ranges::upper_bound(leaf.triangles, id), id);
        leaf.box.add(box);
        work_[size_t(&leaf - leaves.data())] = Work::Rebuild;
    }
    return true;
}

Box LevelUpdate::bounds_of_moved(const Leaf& leaf) const {
    return parallel_reduce(
        leaf.triangles.size(), Box(),
        [&](size_t first, size_t last, Box box) {
            for (size_t i = first; i < last; ++i)
                if (is_changed(leaf.triangles[i]))
                    box.add(bounds_of(scene_.soup.triangle(leaf.triangles[i])));
            return box;
        },
        [](Box a, const Box& b) {
            a.add(b);
            return a;
        });
}

/// Widens the leaves' boxes to their triangles, and gives those leaves a new frame that their
/// triangles have left. A changed leaf is no cell any more: it holds all of its triangles.
void LevelUpdate::fit_frames() {
    Level1& level1 = scene_.level1;
    const std::vector<LeafRange> parts = parts_of(level1);
    Box all = level1.bounds;
    for (size_t i = 0; i < work_.size(); ++i) {
        Leaf& leaf = level1.leaves[i];
        if (work_[i] == Work::None || leaf.triangles.empty())
            continue;
        const Box moved = bounds_of_moved(leaf);
        all.add(moved);
        leaf.box.add(moved.empty() ? moved : moved.padded(level1.padding));
        leaf.cell = leaf.box;
        leaf.reach = std::max(leaf.reach, max_component(leaf.box.extent()));
    }
    for (const TriangleId id : come_)
        all.add(bounds_of(scene_.soup.triangle(id)));
    const bool leaves_scene = !contains(level1.bounds, all);
    if (leaves_scene) {
        level1.bounds = with_room(all);
        level1.padding = padding_of(level1.bounds);
    }
    const auto has_left = [&](const Leaf& leaf) {
        Box inside = leaf.box.intersection(level1.bounds); // all triangles are in the bounds
        return !contains(leaf.grid, inside);
    };
    if (level1.shares_frame) {
        if (leaves_scene || std::ranges::any_of(level1.leaves, has_left)) {
            share_frame(level1);
            std::ranges::fill(framed_, 1);
        }
        return;
    }
    for (const auto& [first, count] : parts) {
        const auto leaves = std::span(level1.leaves).subspan(first, count);
        if (std::ranges::none_of(leaves, has_left))
            continue;
        for (Leaf& leaf : leaves)
            leaf.box = with_room(leaf.box);
        share_frame(leaves);
        std::fill_n(framed_.begin() + first, count, uint8_t(1));
    }
}

void LevelUpdate::rebuild(uint32_t leaf) {
    Page& page = scene_.pages[leaf];
    const double copies =
        double(scene_.level1.reference_count()) / double(std::max<uint64_t>(scene_.triangles, 1));
    page = build_page(scene_.soup, scene_.numbers, scene_.level1.leaves[leaf], progress_,
                      {page.has_loose_pairs(), std::max(copies, 1.0)});
}

/// Returns whether the page's refit has made it so much dearer than it was when it was built.
bool LevelUpdate::refit(uint32_t leaf) {
    Page& page = scene_.pages[leaf];
    const std::optional<RefitCost> cost =
        refit_page(page, scene_.soup, scene_.numbers, scene_.level1.leaves[leaf],
                   framed_[leaf] ? nullptr : &moved_);
    if (!cost)
        return false;
    if (page.built_cost == 0)
        page.built_cost = float(cost->before);
    return cost->after <= kMaxGrowth * double(page.built_cost);
}

bool LevelUpdate::fit_pages() {
    Level1& level1 = scene_.level1;
    for (uint32_t i = 0; i < work_.size(); ++i) {
        if (framed_[i])
            work_[i] = std::max(work_[i], Work::Refit);
        if (level1.leaves[i].triangles.empty())
            work_[i] = Work::None; // drop_empty_leaves() takes it
    }
    parallel_for(work_.size(), 1, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            if (work_[i] == Work::Refit && !refit(uint32_t(i)))
                work_[i] = Work::Rebuild;
            if (work_[i] == Work::Rebuild)
                rebuild(uint32_t(i));
        }
    });
    const uint64_t max_bytes = scene_.limits.page_bytes_of(work_.size());
    for (uint32_t i = 0; i < work_.size(); ++i) {
        if (work_[i] == Work::Rebuild && scene_.pages[i].bytes() > max_bytes)
            return false;
        if (work_[i] == Work::Refit)
            refitted_.push_back(i);
        if (work_[i] == Work::Rebuild)
            rebuilt_.push_back(i);
    }
    drop_empty_leaves();
    // The planes of level 1 tell nothing of leaves that have changed.
    level1.nodes.assign(1, KdNode::leaf(0, uint32_t(level1.leaves.size())));
    level1.far_leaves = 0;
    return !level1.leaves.empty();
}

void LevelUpdate::drop_empty_leaves() {
    std::vector<Leaf>& leaves = scene_.level1.leaves;
    size_t kept = 0;
    for (size_t i = 0; i < leaves.size(); ++i) {
        if (leaves[i].triangles.empty())
            continue;
        if (kept < i) {
            leaves[kept] = std::move(leaves[i]);
            scene_.pages[kept] = std::move(scene_.pages[i]);
        }
        ++kept;
    }
    drops_leaves_ = kept < leaves.size();
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
