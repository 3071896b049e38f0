// SPDX-License-Identifier: Apache-2.0
// A BVH as reinsertion works on it: siblings lie side by side, every node knows its parent, and a
// subtree moves by changing a few places.
#pragma once

#include "core/ray.h"
#include "gpu/bvh/bvh.h"
#include "gpu/bvh/bvh_items.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <vector>

namespace ovc {

/// Nodes have places: the root 0, siblings 2 k and 2 k + 1. Place 1 is unused.
class SiblingTree {
public:
    static constexpr uint32_t kFirst = 2; // the first place below the root
    static uint32_t sibling(uint32_t place) { return place ^ 1; }

    /// nodes: not empty.
    explicit SiblingTree(const std::vector<BvhNode>& nodes) : places_(2), parents_(2, kNone) {
        assert(!nodes.empty());
        places_.reserve(nodes.size() + 1);
        parents_.reserve(nodes.size() + 1);
        read(nodes, 0, 0);
    }

    /// Returns the tree as it is now, without unused nodes.
    std::vector<BvhNode> nodes() const {
        std::vector<BvhNode> nodes;
        nodes.reserve(places_.size() - 1);
        write(0, nodes);
        return nodes;
    }

    uint32_t end() const { return uint32_t(places_.size()); }
    uint32_t parent(uint32_t place) const { return parents_[place]; } // kNone for the root
    const Bounds& bounds(uint32_t place) const { return places_[place].bounds; }
    float half_area(uint32_t place) const { return bounds(place).half_area(); }
    bool is_leaf(uint32_t place) const { return child(place) == 0; }
    /// Returns the place of the first of an inner node's two children.
    uint32_t child(uint32_t place) const { return places_[place].child(); }
    /// Returns the number of inner nodes on the longest way down: 0 for a leaf.
    uint32_t height(uint32_t place) const { return is_leaf(place) ? 0 : places_[place].value(); }

    /// Whether the subtree at `from`, not the root, can go beside the one at `to`: it must not be
    /// there already, and `to` must not lie inside it.
    bool can_move(uint32_t from, uint32_t to) const {
        if (to == sibling(from) || to == parents_[from])
            return false;
        for (uint32_t place = to; place != kNone; place = parents_[place])
            if (place == from)
                return false;
        return true;
    }

    /// Moves the subtree at `from` beside the one at `to`, if can_move(): a new node at `to` holds
    /// both, and the old sibling takes the place of their parent. Returns the increase of the sum
    /// of half areas over all inner nodes. move(from, its parent before the move) undoes it.
    float move(uint32_t from, uint32_t to) {
        assert(can_move(from, to));
        const uint32_t beside = sibling(from), parent = parents_[from];
        const Place left_behind = places_[beside], joined = places_[to];
        const float before = half_area(parent);
        put(joined, beside);
        put(left_behind, parent);
        places_[to].set_child(from & ~1u);
        parents_[from] = parents_[beside] = to;
        fit(to);
        const float added = half_area(to);
        return added - before + fit_above(to) + fit_above(parent);
    }

    /// Returns the sum of half areas over all inner nodes.
    double cost() const {
        double sum = is_leaf(0) ? 0 : half_area(0);
        for (uint32_t place = kFirst; place < end(); ++place)
            sum += is_leaf(place) ? 0 : half_area(place);
        return sum;
    }

private:
    /// 32 bytes: siblings share a line of the cache.
    struct Place {
        // lo[3] and hi[3] hold the bits of two numbers, as in Item.
        Bounds bounds{};

        uint32_t child() const { return std::bit_cast<uint32_t>(bounds.lo[3]); }
        void set_child(uint32_t place) { bounds.lo[3] = std::bit_cast<float>(place); }
        /// A leaf's item; an inner node's height.
        uint32_t value() const { return std::bit_cast<uint32_t>(bounds.hi[3]); }
        void set_value(uint32_t value) { bounds.hi[3] = std::bit_cast<float>(value); }
    };

    void read(const std::vector<BvhNode>& nodes, uint32_t node, uint32_t place) {
        places_[place].bounds = Bounds::of(nodes[node].box);
        places_[place].set_value(nodes[node].item);
        if (nodes[node].is_leaf())
            return;
        const uint32_t child = end();
        places_.resize(child + 2);
        parents_.resize(child + 2, place);
        places_[place].set_child(child);
        read(nodes, node + 1, child);
        read(nodes, nodes[node].right, child + 1);
        places_[place].set_value(1 + std::max(height(child), height(child + 1)));
    }

    void write(uint32_t place, std::vector<BvhNode>& nodes) const {
        const size_t node = nodes.size();
        nodes.push_back({bounds(place).box(), 0, is_leaf(place) ? places_[place].value() : 0});
        if (is_leaf(place))
            return;
        write(child(place), nodes);
        nodes[node].right = uint32_t(nodes.size());
        write(child(place) + 1, nodes);
    }

    void put(const Place& what, uint32_t place) {
        places_[place] = what;
        if (!is_leaf(place))
            parents_[child(place)] = parents_[child(place) + 1] = place;
    }

    /// Updates an inner node's box and height from its children. Returns false if neither changes.
    bool fit(uint32_t place) {
        const uint32_t first = child(place);
        Place now{bounds(first)};
        now.bounds.add(bounds(first + 1));
        now.set_child(first);
        now.set_value(1 + std::max(height(first), height(first + 1)));
        const bool changes = now.bounds.lo != bounds(place).lo || now.bounds.hi != bounds(place).hi;
        places_[place] = now;
        return changes;
    }

    /// Updates the nodes above, up to the first that does not change. Returns the increase of their
    /// half areas.
    float fit_above(uint32_t place) {
        float grown = 0;
        while ((place = parents_[place]) != kNone) {
            const float before = half_area(place);
            if (!fit(place))
                break;
            grown += half_area(place) - before;
        }
        return grown;
    }

    std::vector<Place> places_;
    std::vector<uint32_t> parents_;
};

} // namespace ovc
