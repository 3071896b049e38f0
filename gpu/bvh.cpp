// SPDX-License-Identifier: Apache-2.0
// Top-down binned surface-area heuristic, in place, in parallel.
#include "gpu/bvh.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace ovc {
namespace {

constexpr int kBins = 16;
constexpr size_t kParallelBuild = 4096;

/// A box as four floats a corner: the compiler makes one vector operation of each minimum and
/// maximum.
struct alignas(16) Bounds {
    std::array<float, 4> lo;
    std::array<float, 4> hi;

    static Bounds empty() {
        constexpr float inf = std::numeric_limits<float>::infinity();
        return {{inf, inf, inf, inf}, {-inf, -inf, -inf, -inf}};
    }
    void add(const Bounds& b) {
        for (int i = 0; i < 4; ++i) {
            lo[i] = b.lo[i] < lo[i] ? b.lo[i] : lo[i];
            hi[i] = b.hi[i] > hi[i] ? b.hi[i] : hi[i];
        }
    }
    float half_area() const {
        const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
        return x * y + y * z + z * x;
    }
    Boxf box() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

struct Item {
    Bounds
        bounds; // lo[3] holds the index's bits, untouched by min and max because hi[3] is not read
    uint32_t index() const { return std::bit_cast<uint32_t>(bounds.lo[3]); }
    /// Twice the centre along an axis.
    float center(int axis) const { return bounds.lo[axis] + bounds.hi[axis]; }
};

struct Split {
    float cost = std::numeric_limits<float>::infinity();
    int axis = -1;
    int bin = 0;
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

class Builder {
public:
    Builder(std::vector<Item>& items, std::vector<BvhNode>& nodes, BuildProgress* progress)
        : items_(items), nodes_(nodes), progress_(progress) {}

    void build(uint32_t node, size_t first, size_t last, int depth) {
        if (last - first <= kParallelBuild) {
            build_alone(node, first, last, depth);
            add(progress_, last - first);
            return;
        }
        add(progress_, 0);
        const size_t middle = open(node, first, last, depth);
        parallel_invoke([&] { build(node + 1, first, middle, depth + 1); },
                        [&] { build(nodes_[node].right, middle, last, depth + 1); });
    }

private:
    void build_alone(uint32_t node, size_t first, size_t last, int depth) {
        const size_t middle = open(node, first, last, depth);
        if (last - first == 1)
            return;
        build_alone(node + 1, first, middle, depth + 1);
        build_alone(nodes_[node].right, middle, last, depth + 1);
    }

    /// Fills the node in; returns where its items are divided in two, if they are.
    size_t open(uint32_t node, size_t first, size_t last, int depth) {
        Bounds bounds = Bounds::empty();
        Bounds centers = Bounds::empty();
        measure(first, last, bounds, centers);
        nodes_[node].box = bounds.box();
        if (last - first == 1) {
            nodes_[node].item = items_[first].index();
            return first;
        }
        const size_t middle = divide(first, last, centers, depth);
        nodes_[node].right = node + uint32_t(2 * (middle - first));
        return middle;
    }

    void measure(size_t first, size_t last, Bounds& bounds, Bounds& centers) const {
        for (size_t i = first; i < last; ++i) {
            const Bounds& b = items_[i].bounds;
            bounds.add(b);
            Bounds center;
            for (int k = 0; k < 4; ++k)
                center.lo[k] = center.hi[k] = b.lo[k] + b.hi[k];
            centers.add(center);
        }
    }

    size_t divide(size_t first, size_t last, const Bounds& centers, int depth) {
        const size_t count = last - first;
        const int halvings = int(std::bit_width(count - 1));
        const Binning binning = binning_of(centers, count);
        const Split split =
            depth + halvings < kMaxBvhDepth ? best_split(first, last, binning) : Split{};
        if (split.axis < 0)
            return first + count / 2; // all centres in one place, or no depth left to choose
        const auto middle =
            std::partition(items_.begin() + ptrdiff_t(first), items_.begin() + ptrdiff_t(last),
                           [&](const Item& item) { return binning(item, split.axis) < split.bin; });
        return size_t(middle - items_.begin());
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
        struct Bin {
            Bounds bounds = Bounds::empty();
            uint32_t count = 0;
        };
        std::array<std::array<Bin, kBins>, 3> bins;
        for (size_t i = first; i < last; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                Bin& bin = bins[axis][binning(items_[i], axis)];
                bin.bounds.add(items_[i].bounds);
                ++bin.count;
            }
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            if (binning.scale[axis] == 0)
                continue;
            std::array<float, kBins> right_cost;
            Bin right;
            for (int i = binning.bins - 1; i > 0; --i) {
                right.bounds.add(bins[axis][i].bounds);
                right.count += bins[axis][i].count;
                right_cost[i] = right.count ? right.bounds.half_area() * float(right.count) : -1;
            }
            Bin left;
            for (int i = 1; i < binning.bins; ++i) {
                left.bounds.add(bins[axis][i - 1].bounds);
                left.count += bins[axis][i - 1].count;
                if (left.count == 0 || right_cost[i] < 0)
                    continue;
                const float cost = left.bounds.half_area() * float(left.count) + right_cost[i];
                if (cost < best.cost)
                    best = {cost, axis, i};
            }
        }
        return best;
    }

    std::vector<Item>& items_;
    std::vector<BvhNode>& nodes_;
    BuildProgress* progress_;
};

} // namespace

std::vector<BvhNode> build_bvh(std::span<const Boxf> boxes, BuildProgress* progress) {
    std::vector<BvhNode> nodes;
    if (boxes.empty())
        return nodes;
    std::vector<Item> items(boxes.size());
    for (size_t i = 0; i < boxes.size(); ++i) {
        const Boxf& b = boxes[i];
        items[i].bounds = {{b.lo.x, b.lo.y, b.lo.z, std::bit_cast<float>(uint32_t(i))},
                           {b.hi.x, b.hi.y, b.hi.z, 0}};
    }
    nodes.resize(2 * boxes.size() - 1);
    Builder(items, nodes, progress).build(0, 0, items.size(), 0);
    return nodes;
}

} // namespace ovc
