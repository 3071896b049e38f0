// SPDX-License-Identifier: Apache-2.0
// Packer: a binary BVH into units of the layout of shaders/layout.h, four children a node.
#pragma once

#include "core/build_progress.h"
#include "gpu/bvh.h"
#include "gpu/page.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

inline uint32_t bits(float x) {
    return std::bit_cast<uint32_t>(x);
}

/// The grid that 16-bit boxes count on, as a page's header says it.
struct GridHeader {
    vec3 org;
    vec3 cell;
};

/// Grid: lo(box, axis) and hi(box, axis), the 16-bit coordinates of a box of the BVH.
/// PutItem: put(item, unit) writes the four texels of a leaf of the BVH.
template <class Grid, class PutItem>
class Packer {
public:
    /// Keeps the references. The BVH has nodes.
    Packer(const std::vector<BvhNode>& nodes, const GridHeader& header, const Grid& grid,
           const PutItem& put, BuildProgress* progress)
        : nodes_(nodes), header_(header), grid_(grid), put_(put), progress_(progress) {}

    Page pack() {
        add_units(1 + 1);
        unit(0)[0] = {bits(header_.org.x), bits(header_.org.y), bits(header_.org.z), 0};
        unit(0)[1] = {bits(header_.cell.x), bits(header_.cell.y), bits(header_.cell.z), 0};
        unit(0)[2] = {OVC_ROOT_UNIT, 0xffffffffu, 0, 0};
        unit(0)[3] = uvec4(0);
        // Even a single item gets a node above it, so that its box is tested.
        pending_.push_back({0, OVC_ROOT_UNIT, 1});
        LoopProgress loop(progress_);
        while (!pending_.empty()) {
            const Pending next = pending_.back();
            pending_.pop_back();
            page_.depth = std::max(page_.depth, next.depth);
            pack_node(next);
            loop.step();
        }
        loop.finish();
        return std::move(page_);
    }

private:
    struct Pending {
        uint32_t node; // of the BVH
        uint32_t unit;
        uint32_t depth;
    };

    std::span<uvec4, OVC_UNIT_TEXELS> unit(uint32_t index) {
        return std::span(page_.texels)
            .subspan(size_t(index) * OVC_UNIT_TEXELS)
            .template first<OVC_UNIT_TEXELS>();
    }

    uint32_t add_units(uint32_t count) {
        const size_t first = page_.texels.size() / OVC_UNIT_TEXELS;
        page_.texels.resize(page_.texels.size() + size_t(count) * OVC_UNIT_TEXELS, uvec4(0));
        return uint32_t(first);
    }

    /// Up to four descendants that together hold the node's boxes: the widest inner one is opened
    /// until four are found.
    int children(uint32_t node, std::array<uint32_t, 4>& found) const {
        if (nodes_[node].is_leaf()) {
            found[0] = node;
            return 1;
        }
        int count = 2;
        found[0] = node + 1;
        found[1] = nodes_[node].right;
        while (count < 4) {
            int widest = -1;
            float area = -1;
            for (int i = 0; i < count; ++i) {
                const BvhNode& n = nodes_[found[i]];
                if (!n.is_leaf() && n.box.half_area() > area) {
                    area = n.box.half_area();
                    widest = i;
                }
            }
            if (widest < 0)
                break;
            const uint32_t opened = found[widest];
            found[widest] = opened + 1;
            found[count++] = nodes_[opened].right;
        }
        return count;
    }

    void pack_node(const Pending& at) {
        std::array<uint32_t, 4> child;
        const int count = children(at.node, child);
        const uint32_t base = add_units(uint32_t(count));
        for (int axis = 0; axis < 3; ++axis) {
            std::array<uint32_t, 4> lo{0xffff, 0xffff, 0xffff, 0xffff};
            std::array<uint32_t, 4> hi{0, 0, 0, 0};
            for (int i = 0; i < count; ++i) {
                lo[i] = grid_.lo(nodes_[child[i]].box, axis);
                hi[i] = grid_.hi(nodes_[child[i]].box, axis);
            }
            unit(at.unit)[axis] = {lo[0] | lo[1] << 16, lo[2] | lo[3] << 16, hi[0] | hi[1] << 16,
                                   hi[2] | hi[3] << 16};
        }
        unit(at.unit)[3] = {base, 0, 0, 0};
        for (int i = 0; i < count; ++i) {
            const BvhNode& node = nodes_[child[i]];
            if (node.is_leaf())
                put_(node.item, unit(base + uint32_t(i)));
            else
                pending_.push_back({child[i], base + uint32_t(i), at.depth + 1});
        }
    }

    const std::vector<BvhNode>& nodes_;
    const GridHeader header_;
    const Grid& grid_;
    const PutItem& put_;
    BuildProgress* progress_;
    Page page_;
    std::vector<Pending> pending_;
};

} // namespace ovc
