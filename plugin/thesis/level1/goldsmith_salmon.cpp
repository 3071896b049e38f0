// SPDX-License-Identifier: Apache-2.0
// Goldsmith and Salmon's insertion, and the choice among trees by shuffled orders.
#include "plugin/thesis/level1/goldsmith_salmon.h"

#include "core/ray.h"
#include "core/system/parallel.h"

#include <cassert>
#include <limits>
#include <mutex>
#include <numeric>
#include <random>
#include <utility>

namespace ovc::thesis {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

/// This limit is not in the paper. Without it triangles in one place all become children of one
/// node, and n of them take n * n steps.
constexpr uint32_t kMaxChildren = 8;

Boxf joined(Boxf a, const Boxf& b) {
    a.add(b);
    return a;
}

class Inserter {
public:
    explicit Inserter(std::span<const Boxf> boxes) : boxes_(boxes) {
        nodes_.reserve(2 * boxes.size());
        nodes_.push_back({{}, kNone, kNone, kNone, 0, kNone, 0});
    }

    void insert(uint32_t item) {
        assert(item < boxes_.size() && !boxes_[item].empty());
        const Place place = best_place(boxes_[item]);
        const uint32_t leaf = uint32_t(nodes_.size());
        nodes_.push_back({boxes_[item], kNone, kNone, kNone, 0, item, 1});
        const uint32_t parent = place.is_leaf ? split(place.node) : place.node;
        adopt(parent, leaf);
        for (uint32_t n = parent; n != kNone; n = nodes_[n].parent) {
            nodes_[n].box.add(boxes_[item]);
            ++nodes_[n].items;
        }
    }

    InsertionTree take() {
        double sum = 0;
        for (const InsertionNode& node : nodes_)
            sum += double(node.box.half_area()) * node.children;
        const double root = nodes_[0].box.half_area();
        return {std::move(nodes_), root > 0 ? sum / root : 0};
    }

private:
    /// A place for a box: among the children of an inner node, or in a new node with a leaf.
    struct Place {
        uint32_t node = 0;
        bool is_leaf = false;
    };

    /// Returns how much more the children of an inner node cost when the box is put below it.
    float growth(const InsertionNode& node, const Boxf& box) const {
        return float(node.children) * (joined(node.box, box).half_area() - node.box.half_area());
    }

    /// Goldsmith and Salmon 1987: goes down the path that grows least, and returns the one of all
    /// places beside it that adds least to the tree's cost.
    Place best_place(const Boxf& box) const {
        Place best;
        float best_cost = kInfinite;
        float inherited = 0; // cost of growing the nodes above, wherever below them the box goes
        const auto consider = [&](float cost, Place place) {
            if (cost < best_cost) {
                best_cost = cost;
                best = place;
            }
        };
        for (uint32_t n = 0; n != kNone && inherited < best_cost;) {
            const InsertionNode& node = nodes_[n];
            if (node.children > 0)
                inherited += growth(node, box);
            if (node.children < kMaxChildren)
                consider(inherited + joined(node.box, box).half_area(), {n, false});
            uint32_t next = kNone;
            float min_cost = kInfinite;
            for (uint32_t c = node.first_child; c != kNone; c = nodes_[c].next_sibling) {
                const InsertionNode& child = nodes_[c];
                if (child.children == 0) {
                    consider(inherited + 2 * joined(child.box, box).half_area(), {c, true});
                    continue;
                }
                const float cost = growth(child, box);
                // Where several grow alike, the smallest family is taken: a chain would be as good,
                // but long.
                if (cost < min_cost || (cost == min_cost && child.items < nodes_[next].items)) {
                    min_cost = cost;
                    next = c;
                }
            }
            n = next;
        }
        return best;
    }

    void adopt(uint32_t parent, uint32_t child) {
        assert(nodes_[parent].item == kNone && parent != child);
        nodes_[child].parent = parent;
        nodes_[child].next_sibling = nodes_[parent].first_child;
        nodes_[parent].first_child = child;
        ++nodes_[parent].children;
    }

    /// Puts a leaf below a new inner node, which takes its number. Returns that number.
    uint32_t split(uint32_t leaf) {
        const uint32_t moved = uint32_t(nodes_.size());
        nodes_.push_back(nodes_[leaf]);
        nodes_[leaf].first_child = kNone;
        nodes_[leaf].children = 0;
        nodes_[leaf].item = kNone;
        adopt(leaf, moved);
        return leaf;
    }

    std::span<const Boxf> boxes_;
    std::vector<InsertionNode> nodes_;
};

/// Returns a shuffled order that is the same on every machine; std::shuffle need not be.
std::vector<uint32_t> shuffled(size_t count, uint32_t seed) {
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::mt19937 random(seed);
    for (size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[random() % i]);
    return order;
}

} // namespace

InsertionTree insert_in_order(std::span<const Boxf> boxes, std::span<const uint32_t> order,
                              BuildProgress* progress) {
    if (boxes.empty())
        return {};
    Inserter inserter(boxes);
    LoopProgress loop(progress);
    for (const uint32_t item : order) {
        inserter.insert(item);
        loop.step();
    }
    loop.finish();
    return inserter.take();
}

InsertionTree best_insertion_tree(std::span<const Boxf> boxes, int shuffles,
                                  BuildProgress* progress) {
    assert(shuffles > 0);
    InsertionTree best;
    size_t best_seed = 0;
    std::mutex mutex;
    parallel_for(size_t(shuffles), 1, [&](size_t first, size_t last) {
        for (size_t seed = first; seed < last; ++seed) {
            InsertionTree tree =
                insert_in_order(boxes, shuffled(boxes.size(), uint32_t(seed) + 1), progress);
            const std::lock_guard lock(mutex);
            const bool better =
                tree.cost < best.cost || (tree.cost == best.cost && seed < best_seed);
            if (best.nodes.empty() || better) {
                best = std::move(tree);
                best_seed = seed;
            }
        }
    });
    return best;
}

} // namespace ovc::thesis
