// SPDX-License-Identifier: Apache-2.0
// Joins the boxes of each rank to a few, and tests a ray with those of the ranks that it comes by.
#include "plugin/ranks/stops.h"

#include <algorithm>
#include <cassert>

namespace ovc {

/// How many boxes there are around the pages of a rank. More of them send fewer rays to ranks in
/// vain, and take longer to test.
static constexpr size_t kPartsPerRank = 32;

void StopFinder::Boxes::add(const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        sides_[axis].push_back(box.lo[axis]);
        sides_[3 + axis].push_back(box.hi[axis]);
    }
}

void StopFinder::Boxes::enter(const EnteringRay& ray, std::vector<double>& entries) const {
    entries.resize(size());
    const double* in[3];
    const double* out[3];
    for (int axis = 0; axis < 3; ++axis) {
        in[axis] = sides_[ray.goes_down(axis) ? 3 + axis : axis].data();
        out[axis] = sides_[ray.goes_down(axis) ? axis : 3 + axis].data();
    }
    for (size_t i = 0; i < entries.size(); ++i)
        entries[i] = ray.entry({in[0][i], in[1][i], in[2][i]}, {out[0][i], out[1][i], out[2][i]});
}

StopFinder::StopFinder(std::span<const PageBox> boxes, std::span<const uint32_t> owners,
                       uint32_t here) {
    const auto rank_of = [&](const PageBox& box) {
        return owners[box.page] == kEveryRank ? here : owners[box.page];
    };
    std::vector<std::vector<Box>> of_rank;
    for (const PageBox& box : boxes) {
        of_rank.resize(std::max(of_rank.size(), size_t(rank_of(box)) + 1));
        of_rank[rank_of(box)].push_back(box.box);
    }
    for (size_t rank = 0; rank < of_rank.size(); ++rank) {
        const std::vector<Box>& all = of_rank[rank];
        if (all.empty())
            continue;
        ranks_.push_back(uint32_t(rank));
        parts_.emplace_back();
        Box around;
        // Pages stand in the order of the KD-tree, so that neighbours lie together.
        const size_t group = (all.size() + kPartsPerRank - 1) / kPartsPerRank;
        for (size_t first = 0; first < all.size(); first += group) {
            Box part;
            for (size_t i = first; i < std::min(all.size(), first + group); ++i)
                part.add(all[i]);
            parts_.back().add(part);
            around.add(part);
        }
        around_.add(around);
    }
}

void StopFinder::find(const Ray& ray, std::vector<Stop>& stops) const {
    stops.clear();
    thread_local std::vector<double> of_ranks, of_parts;
    const EnteringRay entering(ray);
    around_.enter(entering, of_ranks);
    for (size_t i = 0; i < ranks_.size(); ++i) {
        if (of_ranks[i] == kNoEntry)
            continue;
        parts_[i].enter(entering, of_parts);
        const double t = *std::ranges::min_element(of_parts);
        if (t != kNoEntry)
            stops.push_back({t, ranks_[i]});
    }
    std::ranges::sort(stops, [](const Stop& a, const Stop& b) {
        return a.t < b.t || (a.t == b.t && a.rank < b.rank);
    });
}

} // namespace ovc
