// SPDX-License-Identifier: Apache-2.0
// Joins the boxes of each rank to a few, builds a tree over them by medians, and walks it.
#include "plugin/ranks/stops.h"

#include "plugin/ranks/box_entry.h"

#include <algorithm>
#include <cassert>

namespace ovc {

/// How many boxes there are around the pages of a rank. More of them send fewer rays to ranks in
/// vain, and take longer to walk.
static constexpr size_t kPartsPerRank = 64;

StopFinder::StopFinder(std::span<const PageBox> boxes, std::span<const uint32_t> owners,
                       uint32_t here) {
    const auto rank_of = [&](const PageBox& box) {
        return owners[box.page] == kEveryRank ? here : owners[box.page];
    };
    std::vector<size_t> left; // boxes of each rank that are to come
    for (const PageBox& box : boxes) {
        left.resize(std::max(left.size(), size_t(rank_of(box)) + 1));
        ++left[rank_of(box)];
    }
    // Pages stand in the order of the KD-tree, so that neighbours lie together.
    std::vector<size_t> group(left.size()); // how many boxes make one part
    for (size_t rank = 0; rank < left.size(); ++rank)
        group[rank] = (left[rank] + kPartsPerRank - 1) / kPartsPerRank;
    std::vector<size_t> open(left.size()), filled(left.size());
    for (const PageBox& box : boxes) {
        const uint32_t rank = rank_of(box);
        if (filled[rank] == 0) {
            open[rank] = parts_.size();
            parts_.push_back({{}, rank});
        }
        parts_[open[rank]].box.add(box.box);
        filled[rank] = (filled[rank] + 1) % group[rank];
    }
    if (!parts_.empty())
        build(0, uint32_t(parts_.size()));
}

uint32_t StopFinder::build(uint32_t first, uint32_t count) {
    const auto number = uint32_t(nodes_.size());
    nodes_.push_back({{}, first, count, 0});
    Box centers;
    for (uint32_t i = first; i < first + count; ++i) {
        nodes_[number].box.add(parts_[i].box);
        centers.add(parts_[i].box.center());
    }
    if (count == 1)
        return number;
    const int axis = major_axis(centers.extent());
    const auto begin = parts_.begin() + first;
    const uint32_t half = count / 2;
    std::nth_element(begin, begin + half, begin + count, [&](const Part& a, const Part& b) {
        return a.box.center()[axis] < b.box.center()[axis];
    });
    build(first, half);
    const uint32_t right = build(first + half, count - half);
    nodes_[number].right = right;
    return number;
}

void StopFinder::find(const Ray& ray, std::vector<Stop>& stops) const {
    stops.clear();
    if (nodes_.empty())
        return;
    constexpr size_t kMaxDepth = 64; // halves of at most 2^32 parts
    uint32_t stack[kMaxDepth];
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
        const uint32_t number = stack[--depth];
        const Node& node = nodes_[number];
        const double t = box_entry(ray, node.box);
        if (t == kNoEntry)
            continue;
        if (node.count > 1) {
            stack[depth++] = node.right;
            stack[depth++] = number + 1;
            continue;
        }
        const uint32_t rank = parts_[node.first].rank;
        const auto known = std::ranges::find(stops, rank, &Stop::rank);
        if (known == stops.end())
            stops.push_back({t, rank});
        else
            known->t = std::min(known->t, t);
    }
    std::ranges::sort(stops, [](const Stop& a, const Stop& b) {
        return a.t < b.t || (a.t == b.t && a.rank < b.rank);
    });
}

} // namespace ovc
