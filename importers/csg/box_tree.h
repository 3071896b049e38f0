// SPDX-License-Identifier: Apache-2.0
// A tree of boxes that finds the boxes touching a given one. Nodes are halved at the median of
// their longest axis.
#pragma once

#include "core/box.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace ovc::csg {

class BoxTree {
public:
    BoxTree() = default;
    explicit BoxTree(const std::vector<Box>& boxes) : boxes_(boxes), order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        if (!boxes.empty())
            build(0, uint32_t(boxes.size()));
    }

    Box bounds() const { return nodes_.empty() ? Box() : nodes_[0].box; }

    /// Calls visit(index) for each box that touches `box`.
    template <class Visit>
    void visit(const Box& box, Visit&& visit) const {
        if (nodes_.empty())
            return;
        uint32_t stack[64], depth = 0;
        stack[depth++] = 0;
        while (depth > 0) {
            const uint32_t at = stack[--depth];
            const Node& node = nodes_[at];
            if (!node.box.touches(box))
                continue;
            if (node.second != 0) {
                stack[depth++] = node.second;
                stack[depth++] = at + 1;
            } else
                for (uint32_t i = node.first; i < node.last; ++i)
                    if (boxes_[order_[i]].touches(box))
                        visit(order_[i]);
        }
    }

    /// Returns the indices of the boxes that touch `box`, in order.
    std::vector<uint32_t> touching(const Box& box) const {
        std::vector<uint32_t> found;
        visit(box, [&](uint32_t i) { found.push_back(i); });
        std::ranges::sort(found);
        return found;
    }

private:
    struct Node {
        Box box;
        uint32_t first, last;
        uint32_t second = 0; // The second child, 0 in a leaf. The first child follows its parent.
    };

    void build(uint32_t first, uint32_t last) {
        const size_t at = nodes_.size();
        nodes_.push_back({{}, first, last});
        Box box, centers;
        for (uint32_t i = first; i < last; ++i) {
            box.add(boxes_[order_[i]]);
            centers.add(boxes_[order_[i]].center());
        }
        nodes_[at].box = box;
        if (last - first <= 4)
            return;
        const int axis = major_axis(centers.extent());
        const uint32_t middle = first + (last - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                         [&](uint32_t a, uint32_t b) {
                             return boxes_[a].center()[axis] < boxes_[b].center()[axis];
                         });
        build(first, middle);
        nodes_[at].second = uint32_t(nodes_.size());
        build(middle, last);
    }

    std::vector<Box> boxes_;
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace ovc::csg
