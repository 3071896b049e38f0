// SPDX-License-Identifier: Apache-2.0
// Chops items into bins along each axis, then chooses the plane between two bins.
#include "gpu/bvh/spatial_split.h"

#include "gpu/bvh/cut_pair.h"

#include <algorithm>

namespace ovc {
namespace {

constexpr int kSplitBins = 16;
constexpr size_t kSplitSample = 2048; // items examined to choose a plane

struct SpatialBin {
    Bounds bounds = Bounds::empty();
    uint32_t begin = 0; // items whose first bin this is
    uint32_t end = 0;   // whose last
};

class SpatialBins {
public:
    SpatialBins(const Bounds& bounds, size_t axis)
        : axis_(axis), lo_(bounds.lo[axis]), width_((bounds.hi[axis] - lo_) / float(kSplitBins)) {}

    /// Whether there are planes to choose from.
    bool usable() const { return width_ > 1e-6f && plane(1) > lo_; }

    /// The plane below bin i.
    float plane(int i) const { return lo_ + float(i) * width_; }

    void add(const Item& item) {
        const int first = bin_of(item.bounds.lo[axis_]);
        const int last = bin_of(item.bounds.hi[axis_]);
        ++bins_[size_t(first)].begin;
        ++bins_[size_t(last)].end;
        Bounds part = item.bounds;
        for (int i = first; i < last; ++i) {
            part.hi[axis_] = plane(i + 1);
            bins_[size_t(i)].bounds.add(part);
            part.lo[axis_] = plane(i + 1);
        }
        part.hi[axis_] = item.bounds.hi[axis_];
        bins_[size_t(last)].bounds.add(part);
    }

    void choose(SpatialSplit& best, uint32_t count, size_t max_added) const {
        std::array<Bounds, kSplitBins> above;
        Bounds rest = Bounds::empty();
        for (int i = kSplitBins - 1; i > 0; --i) {
            rest.add(bins_[size_t(i)].bounds);
            above[size_t(i)] = rest;
        }
        Bounds below = Bounds::empty();
        uint32_t below_count = 0, above_count = count;
        for (int i = 1; i < kSplitBins; ++i) {
            below.add(bins_[size_t(i - 1)].bounds);
            below_count += bins_[size_t(i - 1)].begin;
            above_count -= bins_[size_t(i - 1)].end;
            if (below_count == 0 || above_count == 0 || below_count == count ||
                above_count == count || below_count + above_count - count > max_added)
                continue;
            const float cost = below.half_area() * float(below_count) +
                               above[size_t(i)].half_area() * float(above_count);
            if (cost < best.cost)
                best = {cost,        int(axis_), plane(i), below, above[size_t(i)],
                        below_count, above_count};
        }
    }

private:
    int bin_of(float x) const { return std::clamp(int((x - lo_) / width_), 0, kSplitBins - 1); }

    const size_t axis_;
    const float lo_;
    const float width_;
    std::array<SpatialBin, kSplitBins> bins_;
};

} // namespace

SpatialSplit best_spatial_split(std::span<const Item> items, const Bounds& bounds,
                                size_t max_added) {
    const size_t step = items.size() / kSplitSample + 1;
    const size_t looked_at = (items.size() + step - 1) / step;
    SpatialSplit best;
    for (size_t axis = 0; axis < 3; ++axis) {
        SpatialBins bins(bounds, axis);
        if (!bins.usable())
            continue;
        for (size_t i = 0; i < items.size(); i += step)
            bins.add(items[i]);
        bins.choose(best, uint32_t(looked_at), max_added / step);
    }
    best.cost *= float(step);
    best.below_count *= uint32_t(step);
    best.above_count *= uint32_t(step);
    return best;
}

Halves divide_by_plane(std::span<const Item> items, const SpatialSplit& split,
                       std::span<const TrianglePair> pairs, size_t max_added) {
    const size_t axis = size_t(split.axis);
    const float below_area = split.below.half_area(), above_area = split.above.half_area();
    const float below_count = float(split.below_count), above_count = float(split.above_count);
    Halves halves;
    for (const Item& item : items) {
        if (item.bounds.hi[axis] <= split.plane) {
            halves.below.push_back(item);
            continue;
        }
        if (item.bounds.lo[axis] >= split.plane) {
            halves.above.push_back(item);
            continue;
        }
        const CutPair cut =
            cut_pair(pairs[item.index()], item.bounds.box(), split.axis, split.plane);
        if (cut.below.empty() || cut.above.empty()) {
            (cut.below.empty() ? halves.above : halves.below).push_back(item);
            continue;
        }
        // Reference unsplitting.
        Bounds with_below = split.below, with_above = split.above;
        with_below.add(item.bounds);
        with_above.add(item.bounds);
        const float both = below_area * below_count + above_area * above_count;
        const float only_below =
            with_below.half_area() * below_count + above_area * (above_count - 1);
        const float only_above =
            below_area * (below_count - 1) + with_above.half_area() * above_count;
        if (max_added > 0 && both < only_below && both < only_above) {
            halves.below.push_back(Item::of(cut.below, item.index()));
            halves.above.push_back(Item::of(cut.above, item.index()));
            --max_added;
        } else {
            (only_below < only_above ? halves.below : halves.above).push_back(item);
        }
    }
    return halves;
}

float Halves::cost() const {
    float sum = 0;
    for (const std::vector<Item>* half : {&below, &above}) {
        Bounds bounds = Bounds::empty();
        for (const Item& item : *half)
            bounds.add(item.bounds);
        sum += half->empty() ? 0 : bounds.half_area() * float(half->size());
    }
    return sum;
}

} // namespace ovc
