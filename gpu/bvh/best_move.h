// SPDX-License-Identifier: Apache-2.0
// MoveSearch: finds the place where a subtree of a BVH costs least. Based on: Meister and Bittner
// 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization", section 3 (up from the
// subtree, and down again beside the way, as long as a better place is possible).
#pragma once

#include "gpu/bvh/sibling_tree.h"

#include <array>
#include <cassert>

namespace ovc {

/// A move of the subtree at `from` beside the one at `to`; kNone: it stays.
struct Move {
    uint32_t from = kNone;
    uint32_t to = kNone;
    float gain = 0; // the decrease of the sum of half areas over all inner nodes
};

/// Looks for the best move of one subtree in a tree that does not change meanwhile.
class MoveSearch {
public:
    /// from: not the root. The tree is at most kMaxBvhDepth high.
    MoveSearch(const SiblingTree& tree, uint32_t from)
        : tree_(tree), bounds_(tree.bounds(from)), area_(bounds_.half_area()) {
        assert(tree.height(0) <= uint32_t(kMaxBvhDepth));
        best_.from = from;
    }

    Move best() {
        const uint32_t sibling = SiblingTree::sibling(best_.from);
        look_below(sibling, tree_.half_area(sibling));
        // Without the subtree its parent is not needed, and the nodes above hold less.
        uint32_t above = tree_.parent(best_.from);
        float saved = tree_.half_area(above);
        Bounds rest = tree_.bounds(sibling);
        for (uint32_t next; (next = tree_.parent(above)) != kNone; above = next) {
            const uint32_t beside = SiblingTree::sibling(above);
            look_at(beside, saved);
            rest.add(tree_.bounds(beside));
            saved += tree_.half_area(next) - rest.half_area();
            note(next, saved - tree_.half_area(next)); // beside all that remains below `next`
        }
        return best_;
    }

private:
    /// An inner node, and the area that is saved if the subtree goes below it. It does not count
    /// the new node that holds the subtree there.
    struct Entry {
        uint32_t place;
        float saved;
    };

    /// Whether a place may still gain more than the best: the new node is at least as large as the
    /// subtree.
    bool is_hopeful(float saved) const { return saved - area_ > best_.gain; }

    /// Returns the saving less the area of the node that would hold both.
    float gain_at(uint32_t place, float saved) const {
        Bounds both = tree_.bounds(place);
        both.add(bounds_);
        return saved - both.half_area();
    }

    void note(uint32_t place, float gain) {
        if (gain > best_.gain) {
            best_.gain = gain;
            best_.to = place;
        }
    }

    void look_at(uint32_t place, float saved) {
        if (!is_hopeful(saved))
            return;
        const float gain = gain_at(place, saved);
        note(place, gain);
        look_below(place, gain + tree_.half_area(place));
    }

    void look_below(uint32_t place, float saved) {
        push(place, saved);
        while (size_ > 0) {
            const Entry entry = stack_[--size_];
            if (!is_hopeful(entry.saved))
                continue;
            uint32_t near = tree_.child(entry.place), far = near + 1;
            float near_gain = gain_at(near, entry.saved), far_gain = gain_at(far, entry.saved);
            if (near_gain < far_gain) {
                std::swap(near, far);
                std::swap(near_gain, far_gain);
            }
            note(near, near_gain);
            // The better child is searched first, because a larger best gain rules out more places.
            push(far, far_gain + tree_.half_area(far));
            push(near, near_gain + tree_.half_area(near));
        }
    }

    void push(uint32_t place, float saved) {
        if (!tree_.is_leaf(place) && is_hopeful(saved))
            stack_[size_++] = {place, saved};
    }

    const SiblingTree& tree_;
    const Bounds bounds_;
    const float area_;
    Move best_;
    std::array<Entry, kMaxBvhDepth + 1> stack_; // each level adds one entry
    size_t size_ = 0;
};

} // namespace ovc
