// SPDX-License-Identifier: Apache-2.0
// KdTree: nodes, triangle references, bounds. build.h makes it; traverse.h and restart.h walk it.
#pragma once

#include "core/box.h"
#include "core/ray.h"

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// An inner node cuts its cell at `split` along `axis`. The node below is the next one in memory,
/// and the node above lies anywhere later. A leaf node names a range of references.
class KdNode {
public:
    static KdNode inner(int axis, double split) {
        assert(axis >= 0 && axis < 3);
        return KdNode(split, uint32_t(axis), 0);
    }
    static KdNode leaf(uint32_t first, uint32_t count) {
        assert(count < 1u << 30);
        return KdNode(0, kLeaf | count << 2, first);
    }

    bool is_leaf() const { return (bits_ & 3) == kLeaf; }

    int axis() const {
        assert(!is_leaf());
        return int(bits_ & 3);
    }
    double split() const {
        assert(!is_leaf());
        return split_;
    }
    uint32_t above() const {
        assert(!is_leaf());
        return index_;
    }
    void set_above(uint32_t node) {
        assert(!is_leaf());
        index_ = node;
    }

    uint32_t first() const {
        assert(is_leaf());
        return index_;
    }
    uint32_t count() const {
        assert(is_leaf());
        return bits_ >> 2;
    }

    /// Returns the node for a tree whose nodes begin at `nodes` and references at `references`.
    KdNode moved(uint32_t nodes, uint32_t references) const {
        KdNode node = *this;
        node.index_ += is_leaf() ? references : nodes;
        return node;
    }

private:
    static constexpr uint32_t kLeaf = 3;

    KdNode(double split, uint32_t bits, uint32_t index)
        : split_(split), bits_(bits), index_(index) {}

    double split_;
    uint32_t bits_;  // axis, or kLeaf and the count above it
    uint32_t index_; // node above, or first reference
};
static_assert(sizeof(KdNode) == 16);

/// nodes[0] is the root; there are no nodes where there are no triangles. Every triangle that
/// touches a leaf's closed cell is referenced there.
struct KdTree {
    std::vector<KdNode> nodes;
    std::vector<TriangleId> references;
    Box bounds; // of the hittable triangles
    int depth = 0;

    std::span<const TriangleId> triangles(const KdNode& leaf) const {
        assert(leaf.first() + size_t(leaf.count()) <= references.size());
        return {references.data() + leaf.first(), leaf.count()};
    }
};

} // namespace ovc
