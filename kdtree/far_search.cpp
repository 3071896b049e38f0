// SPDX-License-Identifier: Apache-2.0
#include "kdtree/far_search.h"

#include "core/system/parallel.h"

#include <algorithm>

namespace ovc {

void FarSearch::add(TriangleId id, const Box& box) {
    const double extent = max_component(box.extent());
    if (largest_.size() == kMax && extent < largest_.back().extent)
        others_.add(box); // nearly all
    else
        add({extent, id, box});
}

void FarSearch::add(const FarSearch& other) {
    for (const Candidate& candidate : other.largest_)
        add(candidate);
    others_.add(other.others_);
}

void FarSearch::add(const Candidate& candidate) {
    const auto larger = [](const Candidate& a, const Candidate& b) {
        return a.extent > b.extent || (a.extent == b.extent && a.id < b.id);
    };
    largest_.insert(std::ranges::upper_bound(largest_, candidate, larger), candidate);
    if (largest_.size() > kMax) {
        others_.add(largest_.back().box);
        largest_.pop_back();
    }
}

std::vector<TriangleId> FarSearch::found() const {
    Box others = others_;
    for (size_t count = largest_.size(); count > 0; --count) {
        if (!others.empty() &&
            largest_[count - 1].extent >= kMinReach * max_component(others.extent())) {
            std::vector<TriangleId> ids;
            for (const Candidate& candidate : std::span(largest_).first(count))
                ids.push_back(candidate.id);
            std::ranges::sort(ids);
            return ids;
        }
        others.add(largest_[count - 1].box);
    }
    return {};
}

std::vector<TriangleId> find_far(const Soup& soup, std::span<const TriangleId> triangles) {
    const auto search = [&](size_t first, size_t last, FarSearch found) {
        for (const TriangleId id : triangles.subspan(first, last - first))
            found.add(id, bounds_of(soup.triangle(id)));
        return found;
    };
    const auto join = [](FarSearch a, const FarSearch& b) {
        a.add(b);
        return a;
    };
    return parallel_reduce(triangles.size(), FarSearch(), search, join).found();
}

} // namespace ovc
