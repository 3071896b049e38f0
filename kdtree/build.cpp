// SPDX-License-Identifier: Apache-2.0
// The KD-tree builder: it cuts by the binned surface-area heuristic over fragments. A fragment is a
// triangle's box within the current cell.
#include "kdtree/build.h"

#include "core/system/parallel.h"
#include "kdtree/clip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {
namespace {

constexpr int kBins = 32;
constexpr int kMaxDepth = 96;
constexpr size_t kWorthIsolating = 64;  // triangles
constexpr size_t kMinToIsolate = 16;    // of a sample: fewer do not tell where the others are
constexpr double kMaxReferences = 24;   // per triangle, over the whole tree
constexpr size_t kParallelBuild = 8192; // fragments; with fewer, a task costs more than it saves

/// The box of the part of a triangle inside a cell. It is in double, because a float cannot tell
/// the millimetres of a scene of many kilometres apart.
struct Fragment {
    Box box;
    TriangleId id;
};

struct Split {
    double cost = std::numeric_limits<double>::infinity();
    int axis = -1;
    double position = 0;
    size_t below = 0, above = 0; // upper bounds of the fragments

    bool found() const { return axis >= 0; }
};

/// Counts the fragments that begin and end in each of kBins slices of the cell, per axis.
struct Bins {
    std::array<std::array<uint32_t, kBins>, 3> begin{};
    std::array<std::array<uint32_t, kBins>, 3> end{};

    Bins& operator+=(const Bins& other) {
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < kBins; ++i) {
                begin[axis][i] += other.begin[axis][i];
                end[axis][i] += other.end[axis][i];
            }
        return *this;
    }
};

class Builder {
public:
    Builder(const Soup& soup, const KdBuildOptions& options, size_t triangles)
        : soup_(soup),
          options_(options),
          // Havran 2000: 8 + 1.3 log2 n levels; a tree stopped by count ends by itself.
          max_depth_(options.max_leaf_triangles
                         ? kMaxDepth
                         : std::min(kMaxDepth, int(8 + 1.3 * std::log2(double(triangles) + 1)))) {}

    /// Appends the subtree over `fragments` in `cell` to `tree`. references: the max number that
    /// the subtree may have. All triangles may overlap in a plane, and there each cut would pay and
    /// double them; level 1 would multiply its references by as much as 1.25 at each of 96 levels.
    void build(std::vector<Fragment> fragments, const Box& cell, int depth, double references,
               KdTree& tree, const Fork& fork) const {
        tree.depth = std::max(tree.depth, depth);
        if (fragments.size() >= kWorthIsolating)
            add(options_.progress, 0);
        const Split split = depth < max_depth_ ? choose_split(fragments, cell) : Split{};
        if (!split.found() || double(split.below + split.above) > references) {
            tree.nodes.push_back(
                KdNode::leaf(uint32_t(tree.references.size()), uint32_t(fragments.size())));
            for (const Fragment& fragment : fragments)
                tree.references.push_back(fragment.id);
            return;
        }
        Box below_cell = cell;
        Box above_cell = cell;
        below_cell.hi[split.axis] = above_cell.lo[split.axis] = split.position;
        std::vector<Fragment> above = divide(fragments, split, below_cell, above_cell);

        const double for_below = references * double(fragments.size()) /
                                 double(std::max<size_t>(fragments.size() + above.size(), 1)),
                     for_above = references - for_below;
        const uint32_t node = uint32_t(tree.nodes.size());
        tree.nodes.push_back(KdNode::inner(split.axis, split.position));
        if (fragments.size() + above.size() < kParallelBuild) {
            build(std::move(fragments), below_cell, depth + 1, for_below, tree, fork);
            tree.nodes[node].set_above(uint32_t(tree.nodes.size()));
            build(std::move(above), above_cell, depth + 1, for_above, tree, fork);
            return;
        }
        KdTree below_tree, above_tree;
        fork(
            [&] {
                build(std::move(fragments), below_cell, depth + 1, for_below, below_tree, fork);
            },
            [&] { build(std::move(above), above_cell, depth + 1, for_above, above_tree, fork); });
        append(tree, below_tree);
        tree.nodes[node].set_above(uint32_t(tree.nodes.size()));
        append(tree, above_tree);
    }

private:
    static void append(KdTree& tree, const KdTree& part) {
        const uint32_t nodes = uint32_t(tree.nodes.size());
        const uint32_t references = uint32_t(tree.references.size());
        for (const KdNode& node : part.nodes)
            tree.nodes.push_back(node.moved(nodes, references));
        tree.references.insert(tree.references.end(), part.references.begin(),
                               part.references.end());
        tree.depth = std::max(tree.depth, part.depth);
    }

    Split choose_split(const std::vector<Fragment>& fragments, const Box& cell) const {
        const size_t count = fragments.size() * options_.stands_for;
        if (fragments.size() < 2)
            return {};
        // Level 1 still cuts a small enough cell where that saves three quarters of the work: a few
        // far-reaching triangles would otherwise stretch its box until the rest is a dot in it.
        const bool stop = options_.max_leaf_triangles != 0;
        const bool enough = stop && count <= options_.max_leaf_triangles;
        if (enough && (count < kWorthIsolating || fragments.size() < kMinToIsolate))
            return {};
        const Split split =
            fragments.size() > kBins ? best_binned(fragments, cell) : best_exact(fragments, cell);
        const double leaf_cost = options_.intersection_cost * double(fragments.size());
        const double worth = enough ? 0.25 * leaf_cost
                             : stop ? 0.9 * leaf_cost + options_.traversal_cost
                                    : leaf_cost;
        return split.cost < worth ? split : Split{};
    }

    /// Makes this cut the best one where the heuristic says that it costs less. A cut that makes
    /// neither side smaller is never taken.
    void consider(Split& best, const Box& cell, int axis, double position, size_t below,
                  size_t above, size_t total) const {
        if (!(position > cell.lo[axis] && position < cell.hi[axis]))
            return;
        if (below >= total && above >= total)
            return;
        // Level 1 splits where the heuristic would not pay yet, but never where a quarter of the
        // triangles land on both sides: the references would multiply with every level.
        if (options_.max_leaf_triangles && below + above > total + total / 4)
            return;
        const dvec3 extent = cell.extent();
        const int a = (axis + 1) % 3;
        const int b = (axis + 2) % 3;
        const double side = extent[a] * extent[b];
        const double rim = extent[a] + extent[b];
        const double area = side + rim * extent[axis];
        const double low = position - cell.lo[axis];
        const double high = cell.hi[axis] - position;
        const double visits =
            area > 0
                ? ((side + rim * low) * double(below) + (side + rim * high) * double(above)) / area
                : double(below + above);
        double cost = options_.traversal_cost + options_.intersection_cost * visits;
        if (below == 0 || above == 0)
            cost *= options_.empty_bonus;
        if (cost < best.cost)
            best = {cost, axis, position, below, above};
    }

    Split best_binned(const std::vector<Fragment>& fragments, const Box& cell) const {
        const double padding = options_.padding;
        const dvec3 extent = cell.extent();
        const dvec3 scale =
            dvec3(kBins) / glm::max(extent, dvec3(std::numeric_limits<double>::min() * kBins));
        const auto bin_of = [&](double x, int axis) {
            return std::clamp(int((x - cell.lo[axis]) * scale[axis]), 0, kBins - 1);
        };
        // Cells are closed: a fragment that begins where a bin does is in the bin before as well,
        // such as all of a floor, which a cut there would put on both sides.
        const auto first_bin_of = [&](double x, int axis) {
            const double place = (x - cell.lo[axis]) * scale[axis];
            const int bin = int(place);
            return std::clamp(bin == place ? bin - 1 : bin, 0, kBins - 1);
        };
        const auto fill = [&](size_t first, size_t last, Bins bins) {
            for (size_t i = first; i < last; ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    ++bins.begin[axis][first_bin_of(fragments[i].box.lo[axis] - padding, axis)];
                    ++bins.end[axis][bin_of(fragments[i].box.hi[axis] + padding, axis)];
                }
            return bins;
        };
        const Bins bins = fragments.size() < kParallelBuild
                              ? fill(0, fragments.size(), Bins{})
                              : parallel_reduce(fragments.size(), Bins{}, fill,
                                                [](Bins a, const Bins& b) { return a += b; });
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            size_t below = 0;
            size_t above = fragments.size();
            for (int i = 1; i < kBins; ++i) {
                below += bins.begin[axis][i - 1];
                above -= bins.end[axis][i - 1];
                consider(best, cell, axis, cell.lo[axis] + extent[axis] * (double(i) / kBins),
                         below, above, fragments.size());
            }
        }
        // All bins may hold everything, as with coincident centres or thin shells, while the
        // fragments' own bounds still allow a cut.
        return best.found() ? best : best_hull(fragments, cell);
    }

    /// Returns the best cut of empty space around all fragments, if there is any.
    Split best_hull(const std::vector<Fragment>& fragments, const Box& cell) const {
        Box hull;
        for (const Fragment& fragment : fragments)
            hull.add(fragment.box);
        hull = hull.padded(options_.padding);
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            consider(best, cell, axis, hull.lo[axis], 0, fragments.size(), fragments.size());
            consider(best, cell, axis, hull.hi[axis], fragments.size(), 0, fragments.size());
        }
        return best;
    }

    Split best_exact(const std::vector<Fragment>& fragments, const Box& cell) const {
        const size_t n = fragments.size();
        assert(n <= kBins);
        std::array<double, kBins> begin, end;
        Split best;
        for (int axis = 0; axis < 3; ++axis) {
            for (size_t i = 0; i < n; ++i) {
                begin[i] = fragments[i].box.lo[axis] - options_.padding;
                end[i] = fragments[i].box.hi[axis] + options_.padding;
            }
            std::sort(begin.begin(), begin.begin() + n);
            std::sort(end.begin(), end.begin() + n);
            // A fragment that only touches the plane is on both sides, because cells are closed.
            const auto consider_at = [&](double x) {
                const size_t below =
                    std::upper_bound(begin.begin(), begin.begin() + n, x) - begin.begin();
                const size_t above =
                    n - (std::lower_bound(end.begin(), end.begin() + n, x) - end.begin());
                consider(best, cell, axis, x, below, above, n);
            };
            for (size_t i = 0; i < n; ++i) {
                // Just before a beginning and just after an end, a plane cuts no more than it must.
                consider_at(std::nextafter(begin[i], cell.lo[axis]));
                consider_at(std::nextafter(end[i], cell.hi[axis]));
            }
        }
        return best;
    }

    /// Leaves the fragments that reach below the plane in `fragments`, and returns those that reach
    /// above it; both are reduced to their cells.
    std::vector<Fragment> divide(std::vector<Fragment>& fragments, const Split& split,
                                 const Box& below_cell, const Box& above_cell) const {
        assert(split.found());
        std::vector<Fragment> above;
        above.reserve(
            size_t(std::count_if(fragments.begin(), fragments.end(), [&](const Fragment& f) {
                return f.box.hi[split.axis] >= split.position;
            })));
        size_t kept = 0;
        for (const Fragment& fragment : fragments) {
            const bool is_below = fragment.box.lo[split.axis] <= split.position;
            const bool is_above = fragment.box.hi[split.axis] >= split.position;
            const bool both = is_below && is_above;
            if (is_above) {
                const Fragment part = both ? reduced(fragment, above_cell) : fragment;
                if (!part.box.empty())
                    above.push_back(part);
            }
            if (is_below) {
                const Fragment part = both ? reduced(fragment, below_cell) : fragment;
                if (!part.box.empty())
                    fragments[kept++] = part;
            }
        }
        fragments.resize(kept);
        if (fragments.capacity() > 2 * kept)
            fragments.shrink_to_fit();
        return above;
    }

    Fragment reduced(const Fragment& fragment, const Box& cell) const {
        const Box clipped = clipped_bounds(soup_.triangle(fragment.id), cell);
        return {clipped.intersection(fragment.box), fragment.id};
    }

    const Soup& soup_;
    const KdBuildOptions options_;
    const int max_depth_;
};

} // namespace

KdTree build_kd_tree(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                     const KdBuildOptions& options) {
    assert(options.stands_for > 0);
    KdTree tree;
    tree.bounds = bounds;
    if (triangles.empty() || bounds.empty())
        return tree;
    const Builder builder(soup, options, triangles.size());
    std::vector<Fragment> fragments(triangles.size());
    parallel_for(triangles.size(), 4096, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            const Box box = bounds_of(soup.triangle(triangles[i]));
            fragments[i] = {box.intersection(bounds), triangles[i]};
        }
    });
    std::erase_if(fragments, [](const Fragment& f) { return f.box.empty(); });
    const double references = kMaxReferences * double(fragments.size());
    in_forks([&](const Fork& fork) {
        builder.build(std::move(fragments), bounds, 0, references, tree, fork);
    });
    return tree;
}

KdTree build_kd_tree(const Soup& soup, const KdBuildOptions& options) {
    Box bounds;
    const std::vector<TriangleId> triangles = hittable_triangles(soup, nullptr, &bounds);
    return build_kd_tree(soup, triangles, bounds, options);
}

} // namespace ovc
