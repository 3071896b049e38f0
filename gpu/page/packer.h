// SPDX-License-Identifier: Apache-2.0
// Packer: turns a binary BVH into units of the layout of shaders/layout.h, four children a node.
#pragma once

#include "core/build_progress.h"
#include "core/system/parallel.h"
#include "gpu/bvh/bvh.h"
#include "gpu/bvh/collapse.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/page.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace ovc {

inline uint32_t bits(float x) {
    return std::bit_cast<uint32_t>(x);
}

/// Grid: range(box, axis) returns where a box of the BVH lies on it.
/// PutItem: put(item, unit) writes the four texels of a leaf of the BVH. Several threads call it.
template <class Grid, class PutItem>
class Packer {
public:
    /// Keeps the references. The BVH has nodes. This and pack() throw Cancelled if `progress` is
    /// told to stop.
    Packer(const std::vector<BvhNode>& nodes, const GridHeader& header, const Grid& grid,
           const PutItem& put, BuildProgress* progress)
        : nodes_(nodes),
          header_(header),
          grid_(grid),
          put_(put),
          progress_(progress),
          collapse_(nodes, progress),
          below_(nodes.size()) {}

    Page pack() {
        assert(!nodes_.empty());
        const Extent all = measure(collapse_.root());
        page_.texels.assign(size_t(kFirstFree + all.units) * OVC_UNIT_TEXELS, uvec4(0));
        page_.depth = all.depth;
        unit(0)[0] = {bits(header_.middle.x), bits(header_.middle.y), bits(header_.middle.z), 0};
        unit(0)[1] = {bits(header_.cell.x), bits(header_.cell.y), bits(header_.cell.z), 0};
        unit(0)[2] = {OVC_ROOT_UNIT, 0xffffffffu, 0, 0};
        // Even a single item gets a node above it, so that its box is tested.
        write(collapse_.root(), OVC_ROOT_UNIT, kFirstFree);
        return std::move(page_);
    }

private:
    static constexpr uint32_t kFirstFree = OVC_ROOT_UNIT + 1;
    static constexpr uint32_t kParallelPack = 16384; // nodes of the BVH

    /// The extent of a subtree: the units below its root, and the nodes on the longest way down,
    /// root included.
    struct Extent {
        uint32_t units;
        uint32_t depth;
    };

    std::span<uvec4, OVC_UNIT_TEXELS> unit(uint32_t index) {
        assert(index < page_.units());
        return std::span(page_.texels)
            .subspan(size_t(index) * OVC_UNIT_TEXELS)
            .template first<OVC_UNIT_TEXELS>();
    }

    bool is_leaf(Subtree of) const { return nodes_[of.node].is_leaf(); }

    /// Calls visit(i) for each child, in parallel where they are large.
    template <class Visit>
    void for_each(const Children& children, Subtree of, Visit&& visit) {
        if (of.end - of.node <= kParallelPack) {
            for (int i = 0; i < children.count; ++i)
                visit(size_t(i));
            return;
        }
        parallel_for(size_t(children.count), 1, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                visit(i);
        });
        add(progress_, 0);
    }

    Extent measure(Subtree of) {
        const Children children = collapse_.children(of);
        std::array<Extent, 4> extent{};
        for_each(children, of, [&](size_t i) {
            if (!is_leaf(children.subtree[i]))
                extent[i] = measure(children.subtree[i]);
        });
        Extent all{uint32_t(children.count), 0};
        for (const Extent& e : extent) {
            all.units += e.units;
            all.depth = std::max(all.depth, e.depth);
        }
        ++all.depth;
        return below_[of.node] = all;
    }

    /// Writes the node into the unit `at`, and its subtree into the units from `free` on: the
    /// children come first, then the subtree of each.
    void write(Subtree of, uint32_t at, uint32_t free) {
        const Children children = largest_first(collapse_.children(of));
        put_boxes(children, at);
        unit(at)[3] = {free, 0, 0, 0};
        std::array<uint32_t, 4> free_of{};
        uint32_t next = free + uint32_t(children.count);
        for (size_t i = 0; i < size_t(children.count); ++i) {
            free_of[i] = next;
            if (!is_leaf(children.subtree[i]))
                next += below_[children.subtree[i].node].units;
        }
        for_each(children, of, [&](size_t i) {
            const Subtree child = children.subtree[i];
            if (is_leaf(child))
                put_(nodes_[child.node].item, unit(free + uint32_t(i)));
            else
                write(child, free + uint32_t(i), free_of[i]);
        });
    }

    /// Puts the largest child first. Occlusion rays look for any hit and go through children in
    /// this order (docs/decisions/0020-occlusion-has-its-own-kernel.md).
    Children largest_first(Children children) const {
        const auto area = [&](int i) {
            return nodes_[children.subtree[size_t(i)].node].box.half_area();
        };
        for (int last = 1; last < children.count; ++last)
            for (int i = last; i > 0 && area(i - 1) < area(i); --i)
                std::swap(children.subtree[size_t(i - 1)], children.subtree[size_t(i)]);
        return children;
    }

    void put_boxes(const Children& children, uint32_t at) {
        for (int axis = 0; axis < 3; ++axis)
            for (size_t i = 0; i < 4; ++i)
                put_range(unit(at)[size_t(axis)], i,
                          i < size_t(children.count)
                              ? grid_.range(nodes_[children.subtree[i].node].box, axis)
                              : GridRange());
    }

    const std::vector<BvhNode>& nodes_;
    const GridHeader header_;
    const Grid& grid_;
    const PutItem& put_;
    BuildProgress* progress_;
    const Collapse collapse_;
    std::vector<Extent> below_; // for each node of the BVH that remains
    Page page_;
};

} // namespace ovc
