// SPDX-License-Identifier: Apache-2.0
// LevelUpdate: brings a level 1 and its pages up to date with triangles that have moved, gone or
// come.
#pragma once

#include "core/changes.h"
#include "gpu/page/refit.h"
#include "plugin/build/built_scene.h"

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace ovc {

inline bool contains(const Box& outer, const Box& inner) {
    return inner.empty() || (outer.contains(inner.lo) && outer.contains(inner.hi));
}

/// Returns the box for a frame that something has left: larger by a part of its size, so that the
/// next move need not leave it again.
inline Box with_room(const Box& box) {
    constexpr double kRoomToMove = 1.0 / 16;
    return box.padded(kRoomToMove * max_component(box.extent()));
}

/// Updates the scene's duplicates, leaves and pages, but not those of its shared meshes.
class LevelUpdate {
public:
    /// The change of the frame of the leaves, where they share one.
    struct FrameChange {
        bool is_new = false; // the frame is another one, or the place of all triangles in it
        Box reach = {};      // lies inside afterwards
    };

    /// changed: sorted and disjoint, of chunks that the level is cut from; they have been placed
    /// anew, have new corners, or are empty now.
    LevelUpdate(BuiltScene& scene, std::span<const PrimRange> changed, FrameChange frame,
                BuildProgress* progress);

    /// Returns false where the scene must be built anew.
    bool run();

    /// An update's work on the page of a leaf.
    enum class Work : uint8_t { None, Refit, Rebuild };
    struct LeafChange {
        uint32_t was; // its number before; kNone: it is new
        Work work = Work::None;
    };
    /// Returns what has become of each leaf that there is now.
    const std::vector<LeafChange>& leaves() const { return leaves_; }

private:
    void find_faults();
    void dissolve_duplicates();
    void list_anew();
    void fit_frames();
    void fit_pages();
    void take_out_built(std::vector<TriangleId>& triangles) const;
    void build_leaves_of(std::span<const TriangleId> triangles);
    bool fill_late_leaf();
    bool pages_fit() const;
    void drop_empty_leaves();
    void count_dropped();

    bool is_needed() const;
    Triangle packed(TriangleId id) const { return scene_.packed_soup().triangle(id); }
    bool hits(TriangleId id) const;
    bool is_changed(TriangleId id) const { return moved_.has(scene_.numbers.of(id)); }
    Box bounds_of_moved(const Leaf& leaf) const;
    Box bounds_of_packed() const;
    void grow_bounds(const Box& to);
    void share_new_frame(LeafRange part);
    void fill(Leaf& leaf, std::vector<TriangleId> triangles) const;
    bool refit(uint32_t leaf);
    void rebuild(uint32_t leaf);

    BuiltScene& scene_;
    const std::span<const PrimRange> changed_;
    const FrameChange frame_;
    BuildProgress* const progress_;
    NumberSet moved_;              // the changed triangles
    NumberSet gone_;               // those of them that no ray can hit
    NumberSet listed_;             // those of them that were in a leaf, or duplicates of others
    uint64_t hit_before_ = 0;      // how many these are
    Dropped faults_;               // of the changed triangles
    Box moved_bounds_;             // of those that can be hit
    std::vector<TriangleId> come_; // to be put into the late leaf
    std::mutex mutex_;             // guards come_ while pages are refitted
    std::vector<LeafChange> leaves_;
    std::vector<uint8_t> framed_; // for each leaf: whether its frame is new
    double copies_ = 1;           // as in LoosePairs
};

} // namespace ovc
