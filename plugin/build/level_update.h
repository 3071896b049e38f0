// SPDX-License-Identifier: Apache-2.0
// LevelUpdate: brings a level 1 and its pages up to date with triangles that have moved, gone or
// come.
#pragma once

#include "core/changes.h"
#include "gpu/page/refit.h"
#include "plugin/build/built_scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Updates the scene's duplicates, leaves and pages, but not those of its shared meshes.
class LevelUpdate {
public:
    /// changed: sorted and disjoint, of chunks that the level is cut from; they have been placed
    /// anew, have new corners, or are empty now.
    LevelUpdate(BuiltScene& scene, std::span<const PrimRange> changed, BuildProgress* progress);

    /// Returns false where the scene must be built anew.
    bool run();

    /// The pages that have changed, by their numbers, which are those of before.
    const std::vector<uint32_t>& refitted() const { return refitted_; }
    const std::vector<uint32_t>& rebuilt() const { return rebuilt_; }
    /// Whether leaves have lost all their triangles, so that others have new numbers.
    bool drops_leaves() const { return drops_leaves_; }

private:
    /// What an update does with a leaf.
    enum class Work : uint8_t { None, Refit, Rebuild };

    void find_faults();
    void dissolve_duplicates();
    void list_anew();
    bool add_to_leaves();
    void fit_frames();
    bool fit_pages();
    void drop_empty_leaves();
    void count_dropped();

    bool hits(TriangleId id) const;
    bool is_changed(TriangleId id) const { return moved_.has(scene_.numbers.of(id)); }
    Box bounds_of_moved(const Leaf& leaf) const;
    bool refit(uint32_t leaf);
    void rebuild(uint32_t leaf);

    BuiltScene& scene_;
    const std::span<const PrimRange> changed_;
    BuildProgress* const progress_;
    NumberSet moved_;              // the changed triangles
    NumberSet gone_;               // those of them that no ray can hit
    NumberSet listed_;             // those of them that were in a leaf, or duplicates of others
    uint64_t hit_before_ = 0;      // how many these are
    Dropped faults_;               // of the changed triangles
    std::vector<TriangleId> come_; // to be put into some leaf
    std::vector<Work> work_;       // for each leaf
    std::vector<uint8_t> framed_;  // for each leaf: whether its frame is new
    std::vector<uint32_t> refitted_;
    std::vector<uint32_t> rebuilt_;
    bool drops_leaves_ = false;
};

} // namespace ovc
