// SPDX-License-Identifier: Apache-2.0
// Builds top-down by the binned surface-area heuristic, in place and in parallel.
#include "gpu/bvh/bvh.h"

#include "core/system/parallel.h"
#include "gpu/bvh/bvh_items.h"
#include "gpu/bvh/spatial_split.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <limits>

namespace ovc {
namespace {

constexpr int kBins = 16;
constexpr size_t kParallelBuild = 4096;
constexpr size_t kParallelSum = 32768;
// The builder looks for a plane at nodes of at least so many items, if the boxes of the best two
// sides share this much of the node's area. It takes the plane if less than this of the cost
// remains.
constexpr size_t kMinToCut = 64;
constexpr float kMinOverlap = 0.1f;
constexpr float kWorthCutting = 0.95f;
// After so many nodes in vain, one below the other, the builder looks for no plane further down:
// the parts of a mesh are as smooth as the whole (docs/decisions/0022).
constexpr int kMaxInVain = 4;

struct Split {
    float cost = std::numeric_limits<float>::infinity();
    int axis = -1;
    int bin = 0;
    float overlap = 0; // half the surface area of the intersection of both sides' boxes
};

/// Bin numbers of centres between two bounds, per axis; all zero along an axis without extent.
struct Binning {
    std::array<float, 3> offset;
    std::array<float, 3> scale;
    int bins;

    int operator()(const Item& item, int axis) const {
        return int((item.center(axis) - offset[axis]) * scale[axis]);
    }
};

/// The bounds of items, and of twice their centres.
struct Extent {
    Bounds bounds = Bounds::empty();
    Bounds centers = Bounds::empty();

    void add(const Item& item) {
        const Bounds& b = item.bounds;
        bounds.add(b);
        Bounds center;
        for (size_t k = 0; k < 4; ++k)
            center.lo[k] = center.hi[k] = b.lo[k] + b.hi[k];
        centers.add(center);
    }
    void add(const Extent& other) {
        bounds.add(other.bounds);
        centers.add(other.centers);
    }
};

struct Bin {
    Bounds bounds;
    uint32_t count;
};

struct Bins {
    const Binning* binning;
    std::array<std::array<Bin, kBins>, 3> bins; // [axis]; most nodes have few items, and few bins

    explicit Bins(const Binning& b) : binning(&b) {
        for (auto& along : bins)
            std::fill_n(along.begin(), b.bins, Bin{Bounds::empty(), 0});
    }

    void add(const Item& item) {
        for (int axis = 0; axis < 3; ++axis) {
            Bin& bin = bins[axis][(*binning)(item, axis)];
            bin.bounds.add(item.bounds);
            ++bin.count;
        }
    }
    void add(const Bins& other) {
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < binning->bins; ++i) {
                bins[axis][i].bounds.add(other.bins[axis][i].bounds);
                bins[axis][i].count += other.bins[axis][i].count;
            }
    }
};

/// The items of a subtree, [first, last), and room for more up to `end`.
struct Range {
    size_t first;
    size_t last;
    size_t end;
    int in_vain = 0; // nodes above at which no plane was found, since one was taken

    size_t count() const { return last - first; }
    size_t spare() const { return end - last; }
};

class Builder {
public:
    Builder(std::vector<Item>& items, std::vector<BvhNode>& nodes,
            std::span<const TrianglePair> pairs, BuildProgress* progress)
        : items_(items), nodes_(nodes), pairs_(pairs), progress_(progress) {}

    void build(uint32_t node, const Range& range, int depth, const Fork& fork) {
        if (range.count() <= kParallelBuild) {
            build_alone(node, range, depth);
            add(progress_, range.count());
            return;
        }
        add(progress_, 0);
        Range left, right;
        open(node, range, depth, left, right);
        fork([&] { build(node + 1, left, depth + 1, fork); },
             [&] { build(nodes_[node].right, right, depth + 1, fork); });
    }

private:
    void build_alone(uint32_t node, const Range& range, int depth) {
        Range left, right;
        if (!open(node, range, depth, left, right))
            return;
        build_alone(node + 1, left, depth + 1);
        build_alone(nodes_[node].right, right, depth + 1);
    }

    /// Fills the node in. Returns true if its items are divided in two.
    bool open(uint32_t node, const Range& range, int depth, Range& left, Range& right) {
        assert(range.count() > 0 && range.last <= range.end && depth <= kMaxBvhDepth);
        Extent extent;
        gather(range.first, range.last, extent);
        nodes_[node].box = extent.bounds.box();
        if (range.count() == 1) {
            nodes_[node].item = items_[range.first].index();
            return false;
        }
        divide(range, extent.bounds, extent.centers, depth, left, right);
        assert(left.count() > 0 && right.count() > 0 && left.end == right.first);
        nodes_[node].right = node + uint32_t(2 * (left.end - left.first));
        assert(nodes_[node].right < nodes_.size());
        return true;
    }

    /// Adds items [first, last) to the sum, which holds none yet.
    template <class Sum>
    void gather(size_t first, size_t last, Sum& sum) const {
        const auto add_some = [&](size_t from, size_t to, Sum& some) {
            for (size_t i = from; i < to; ++i)
                some.add(items_[i]);
        };
        if (last - first < kParallelSum)
            return add_some(first, last, sum);
        sum = parallel_reduce(
            last - first, sum,
            [&](size_t from, size_t to, Sum some) {
                add_some(first + from, first + to, some);
                return some;
            },
            [](Sum a, const Sum& b) {
                a.add(b);
                return a;
            });
    }

    void divide(const Range& range, const Bounds& bounds, const Bounds& centers, int depth,
                Range& left, Range& right) {
        const size_t first = range.first, last = range.last;
        const int halvings = int(std::bit_width(range.count() - 1));
        // Two items are halved, and so are all items by count once no depth is left.
        const bool free = range.count() > 2 && depth + halvings < kMaxBvhDepth;
        const Binning binning = binning_of(centers, range.count());
        const Split split = free ? best_split(first, last, binning) : Split{};
        const bool may_cut = can_cut(range, bounds, split);
        if (may_cut && divide_in_space(range, bounds, split, left, right))
            return;
        size_t middle = first + range.count() / 2; // if all centres lie in one place
        if (split.axis >= 0)
            middle = size_t(std::partition(items_.begin() + ptrdiff_t(first),
                                           items_.begin() + ptrdiff_t(last),
                                           [&](const Item& item) {
                                               return binning(item, split.axis) < split.bin;
                                           }) -
                            items_.begin());
        // Both sides share the room by count, until too many nodes have looked in vain.
        const int in_vain = range.in_vain + may_cut;
        const size_t spare = in_vain < kMaxInVain ? range.spare() : 0;
        const size_t room = spare * (middle - first) / range.count();
        if (room > 0)
            std::move_backward(items_.begin() + ptrdiff_t(middle), items_.begin() + ptrdiff_t(last),
                               items_.begin() + ptrdiff_t(last + room));
        left = {first, middle, middle + room, in_vain};
        right = {middle + room, last + room, last + spare, in_vain};
    }

    static bool can_cut(const Range& range, const Bounds& bounds, const Split& split) {
        return split.axis >= 0 && range.spare() > 0 && range.count() >= kMinToCut &&
               split.overlap >= kMinOverlap * bounds.half_area();
    }

    /// Cuts the items by a plane if that gains enough. Returns whether it did.
    bool divide_in_space(const Range& range, const Bounds& bounds, const Split& split, Range& left,
                         Range& right) {
        const std::span<const Item> items(items_.data() + range.first, range.count());
        const SpatialSplit plane = best_spatial_split(items, bounds, range.spare());
        if (!(plane.cost < kWorthCutting * split.cost))
            return false;
        const auto [below, above] = checked(divide_by_plane(items, plane, pairs_, range.spare()),
                                            kWorthCutting * split.cost, items.size());
        if (below.empty())
            return false;
        const size_t count = below.size() + above.size();
        const size_t room = (range.end - range.first - count) * below.size() / count;
        left = {range.first, range.first + below.size(), range.first + below.size() + room};
        right = {left.end, left.end + above.size(), range.end};
        std::copy(below.begin(), below.end(), items_.begin() + ptrdiff_t(left.first));
        std::copy(above.begin(), above.end(), items_.begin() + ptrdiff_t(right.first));
        return true;
    }

    /// Returns the halves, or none if they cost more or one of them is as large as the whole.
    static Halves checked(Halves halves, float max_cost, size_t whole) {
        const bool fine =
            halves.below.size() < whole && halves.above.size() < whole && halves.cost() < max_cost;
        return fine ? std::move(halves) : Halves{};
    }

    static Binning binning_of(const Bounds& centers, size_t count) {
        Binning binning;
        binning.bins = std::min(kBins, int(4 + count / 8));
        for (int axis = 0; axis < 3; ++axis) {
            const float extent = centers.hi[axis] - centers.lo[axis];
            binning.offset[axis] = centers.lo[axis];
            const float scale = float(binning.bins) * 0.9999f / extent;
            binning.scale[axis] = extent > 0 && scale < 1e30f ? scale : 0;
        }
        return binning;
    }

    Split best_split(size_t first, size_t last, const Binning& binning) const {
        Bins sums(binning);
        gather(first, last, sums);
        const auto& bins = sums.bins;
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (binning.scale[axis] == 0)
                continue;
            std::array<float, kBins> right_cost;
            Bin right{Bounds::empty(), 0};
            for (int i = binning.bins - 1; i > 0; --i) {
                right.bounds.add(bins[axis][i].bounds);
                right.count += bins[axis][i].count;
                right_cost[i] = right.count ? right.bounds.half_area() * float(right.count) : -1;
            }
            Bin left{Bounds::empty(), 0};
            for (int i = 1; i < binning.bins; ++i) {
                left.bounds.add(bins[axis][i - 1].bounds);
                left.count += bins[axis][i - 1].count;
                if (left.count == 0 || right_cost[i] < 0)
                    continue;
                const float cost = left.bounds.half_area() * float(left.count) + right_cost[i];
                if (cost < best.cost)
                    best = {cost, axis, i, 0};
            }
        }
        if (best.axis >= 0 && last - first >= kMinToCut) { // else nobody asks for the overlap
            std::array<Bounds, 2> sides{Bounds::empty(), Bounds::empty()};
            for (int i = 0; i < binning.bins; ++i)
                sides[i >= best.bin].add(bins[best.axis][i].bounds);
            best.overlap = sides[0].box().intersection(sides[1].box()).half_area();
        }
        return best;
    }

    std::vector<Item>& items_;
    std::vector<BvhNode>& nodes_;
    const std::span<const TrianglePair> pairs_;
    BuildProgress* progress_;
};

} // namespace

std::vector<BvhNode> build_split_bvh(std::span<const Boxf> boxes,
                                     std::span<const TrianglePair> pairs, size_t max_added,
                                     BuildProgress* progress) {
    std::vector<BvhNode> nodes;
    if (boxes.empty())
        return nodes;
    const size_t max_boxes = boxes.size() + max_added;
    std::vector<Item> items(max_boxes);
    for (size_t i = 0; i < boxes.size(); ++i)
        items[i] = Item::of(boxes[i], uint32_t(i));
    nodes.resize(2 * max_boxes - 1);
    Builder builder(items, nodes, pairs, progress);
    in_forks([&](const Fork& fork) { builder.build(0, {0, boxes.size(), max_boxes}, 0, fork); });
    return nodes;
}

std::vector<BvhNode> build_bvh(std::span<const Boxf> boxes, BuildProgress* progress) {
    return build_split_bvh(boxes, {}, 0, progress);
}

} // namespace ovc
