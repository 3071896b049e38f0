// SPDX-License-Identifier: Apache-2.0
// Level 1: the KD-tree over a sample is stopped by count; then every cell is padded, and all
// triangles go to the cells that they touch.
#include "kdtree/partition.h"

#include "core/system/parallel.h"
#include "kdtree/build.h"
#include "kdtree/cells.h"
#include "kdtree/sample.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <span>

namespace ovc {
namespace {

/// The margin of a leaf's box, as a share of the leaf's largest extent. The kernel traces a ray
/// within the leaf's box and cannot prove a hit that lies within a rounding of either end. The
/// margin keeps hits in the cell clear of the ends, even on triangles hundreds of times the size of
/// the leaf, whose roundings are as much larger (docs/design/numerics.md).
constexpr double kMargin = 0x1p-10;

void collect_cells(std::span<const KdNode> nodes, uint32_t node, const Box& box, double padding,
                   std::vector<Cell>& cells) {
    if (nodes[node].is_leaf()) {
        cells.push_back({node, box, box.padded(padding)});
        return;
    }
    Box below = box;
    Box above = box;
    below.hi[nodes[node].axis()] = above.lo[nodes[node].axis()] = nodes[node].split();
    collect_cells(nodes, node + 1, below, padding, cells);
    collect_cells(nodes, nodes[node].above(), above, padding, cells);
}

/// Returns members: members[c] are the triangles of cell c, in the order of `triangles`, and the
/// last entry holds those that touch far_cells cells or more. A triangle is a unit of progress.
std::vector<std::vector<TriangleId>> gather(const Soup& soup, const CellFinder& finder,
                                            std::span<const TriangleId> triangles,
                                            uint32_t far_cells, BuildProgress* progress) {
    std::vector<std::vector<std::vector<TriangleId>>> parts(
        kDealtBlocks, std::vector<std::vector<TriangleId>>(finder.cells() + 1));
    deal(soup, finder, triangles, far_cells, progress,
         [&](size_t block, uint32_t c, TriangleId id) { parts[block][c].push_back(id); });
    std::vector<std::vector<TriangleId>> members(finder.cells() + 1);
    parallel_for(members.size(), 1, [&](size_t first, size_t last) {
        for (size_t c = first; c < last; ++c)
            for (auto& part : parts) {
                members[c].insert(members[c].end(), part[c].begin(), part[c].end());
                part[c] = {};
            }
    });
    return members;
}

/// Hands `triangles` to leaves of exactly `max_triangles` each, except for the last, by halving
/// them at the median of their centres along the axis on which these are farthest apart.
void halve(const Soup& soup, std::span<TriangleId> triangles, uint32_t max_triangles,
           std::vector<std::vector<TriangleId>>& lists) {
    assert(max_triangles > 0);
    if (triangles.size() <= max_triangles) {
        lists.emplace_back(triangles.begin(), triangles.end());
        std::ranges::sort(lists.back());
        return;
    }
    const auto center = [&](TriangleId id) {
        const Triangle t = soup.triangle(id);
        return t[0] + t[1] + t[2];
    };
    Box centers;
    for (const TriangleId id : triangles)
        centers.add(center(id));
    const int axis = major_axis(centers.extent());
    const size_t leaves = (triangles.size() + max_triangles - 1) / max_triangles;
    const size_t below = leaves / 2 * max_triangles;
    std::ranges::nth_element(triangles, triangles.begin() + ptrdiff_t(below), {},
                             [&](TriangleId id) { return std::pair(center(id)[axis], id); });
    halve(soup, triangles.first(below), max_triangles, lists);
    halve(soup, triangles.subspan(below), max_triangles, lists);
}

Frame frame_of(const Box& box, double reach) {
    // A triangle may reach far out of its leaf. At up to 2^40 leaf sizes the kernel's cubes of
    // coordinates are still finite.
    const double size = std::max(max_component(box.extent()) * 0.5, reach * 0x1p-40);
    int exponent = 0;
    std::frexp(size, &exponent);
    return {box.center(), size > 0 ? std::ldexp(1.0, -exponent) : 1.0};
}

/// Returns the triangles of a cell that cannot be cut, for several leaves in one place.
std::vector<std::vector<TriangleId>> in_parts(std::span<const TriangleId> triangles,
                                              uint32_t max_triangles) {
    assert(max_triangles > 0);
    std::vector<std::vector<TriangleId>> parts;
    for (size_t at = 0; at < triangles.size(); at += max_triangles) {
        const auto part =
            triangles.subspan(at, std::min<size_t>(max_triangles, triangles.size() - at));
        parts.emplace_back(part.begin(), part.end());
    }
    return parts;
}

/// Builds a Level1 node by node, in depth-first order.
class Partitioner {
public:
    Partitioner(const Soup& soup, const Box& bounds, BuildProgress* progress)
        : soup_(soup), progress_(progress) {
        level1_.bounds = bounds;
        level1_.padding = padding_of(bounds);
    }

    /// Appends the tree over `box`, which holds `triangles`, by a sample of them. Cells with more
    /// triangles than the sample suggested are cut again by all they hold. finds_far: triangles
    /// that reach far may go into a leaf of their own; only where there are no leaves yet.
    void cut(std::span<const TriangleId> triangles, const Box& box, uint32_t max_triangles,
             const Sample& drawn = {}, bool finds_far = false) {
        const uint32_t rate = sample_rate(triangles.size(), max_triangles);
        if (drawn.rate == rate)
            cut(triangles, drawn.triangles, rate, box, max_triangles, finds_far);
        else
            cut(triangles, sample_triangles(soup_, triangles, rate, progress_), rate, box,
                max_triangles, finds_far);
    }

    /// Appends the tree over `box` by all of its triangles.
    void cut_by_all(std::span<const TriangleId> triangles, const Box& box, uint32_t max_triangles) {
        cut(triangles, triangles, /* rate= */ 1, box, max_triangles, /* finds_far= */ false);
    }

    /// Appends a node for a cell, with a leaf for each list; no list stands for an empty cell.
    void add_leaves(const Box& padded_cell, std::vector<std::vector<TriangleId>> lists) {
        const uint32_t first = leaves();
        for (std::vector<TriangleId>& list : lists)
            leaves_.push_back({padded_cell, std::move(list)});
        level1_.nodes.push_back(KdNode::leaf(first, leaves() - first));
    }

    /// Appends a leaf that is in no cell. It must come before all leaves that are in cells.
    void add_far_leaf(std::vector<TriangleId> triangles) {
        assert(leaves() == level1_.far_leaves);
        leaves_.push_back({level1_.bounds.padded(level1_.padding), std::move(triangles)});
        level1_.far_leaves += 1;
    }

    uint32_t leaves() const { return uint32_t(leaves_.size()); }

    /// Appends `nodes`, a tree over `box`; put_cell(cell, node) appends whatever replaces a leaf
    /// node.
    template <class PutCell>
    void copy(std::span<const KdNode> nodes, const Box& box, PutCell&& put_cell) {
        const std::vector<Cell> cells = cells_of(nodes, box, level1_.padding);
        std::vector<uint32_t> now_at(nodes.size()); // the place of each node in level1_.nodes
        auto cell = cells.begin();
        for (uint32_t node = 0; node < nodes.size(); ++node) {
            now_at[node] = uint32_t(level1_.nodes.size());
            if (nodes[node].is_leaf())
                put_cell(*cell++, nodes[node]);
            else
                level1_.nodes.push_back(nodes[node]);
        }
        for (uint32_t node = 0; node < nodes.size(); ++node)
            if (!nodes[node].is_leaf())
                level1_.nodes[now_at[node]].set_above(now_at[nodes[node].above()]);
    }

    Level1 finish() {
        level1_.leaves.resize(leaves_.size());
        parallel_for(leaves_.size(), 1, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                level1_.leaves[i] = make_leaf(soup_, leaves_[i].cell, level1_.padding,
                                              std::move(leaves_[i].triangles));
                add(progress_, 0);
            }
        });
        return std::move(level1_);
    }

    /// Appends `nodes`, a tree over `box`, which holds `triangles`; put_cell(cell, inside) appends
    /// whatever replaces a cell that the triangles `inside` touch.
    template <class PutCell>
    void fill(std::span<const KdNode> nodes, const Box& box, std::span<const TriangleId> triangles,
              PutCell&& put_cell) {
        const std::vector<Cell> cells = cells_of(nodes, box, level1_.padding);
        fill(nodes, box, members(nodes, cells, triangles, kNone), put_cell);
    }

private:
    std::vector<std::vector<TriangleId>> members(std::span<const KdNode> nodes,
                                                 std::span<const Cell> cells,
                                                 std::span<const TriangleId> triangles,
                                                 uint32_t far_cells) const {
        return gather(soup_, CellFinder(nodes, cells, level1_.padding), triangles, far_cells,
                      progress_);
    }

    template <class PutCell>
    void fill(std::span<const KdNode> nodes, const Box& box,
              const std::vector<std::vector<TriangleId>>& lists, PutCell&& put_cell) {
        auto inside = lists.begin();
        copy(nodes, box, [&](const Cell& cell, const KdNode&) { put_cell(cell, *inside++); });
    }

    void cut(std::span<const TriangleId> triangles, std::span<const TriangleId> sample,
             uint32_t rate, const Box& box, uint32_t max_triangles, bool finds_far) {
        const KdTree tree =
            cut_sample(soup_, sample, rate, box, level1_.padding, max_triangles, progress_);
        const std::vector<Cell> cells = cells_of(tree.nodes, box, level1_.padding);
        auto lists = members(tree.nodes, cells, triangles, finds_far ? kFarCells : kNone);
        const uint64_t far = lists.back().size();
        if (far_leaf_pays(far, triangles.size(), max_triangles))
            add_far_leaf(std::move(lists.back()));
        else if (far > 0)
            lists = members(tree.nodes, cells, triangles, kNone);
        fill(tree.nodes, box, lists, [&](const Cell& cell, std::span<const TriangleId> inside) {
            if (inside.size() > max_triangles && rate > 1)
                cut_by_all(inside, cell.box, max_triangles);
            else
                add_leaves(cell.padded, in_parts(inside, max_triangles));
        });
    }

    struct LeafToBe {
        Box cell;
        std::vector<TriangleId> triangles;
    };

    const Soup& soup_;
    BuildProgress* const progress_;
    Level1 level1_;
    std::vector<LeafToBe> leaves_;
};

} // namespace

Leaf make_leaf(const Soup& soup, const Box& cell, double padding,
               std::vector<TriangleId> triangles) {
    Box all;
    for (const TriangleId id : triangles)
        all.add(bounds_of(soup.triangle(id)));
    Leaf leaf = leaf_around(cell, padding, all);
    leaf.triangles = std::move(triangles);
    return leaf;
}

Leaf leaf_around(const Box& cell, double padding, const Box& all) {
    Leaf leaf;
    leaf.cell = cell;
    const Box reached = all.intersection(cell);
    leaf.box = reached.padded(std::max(kMargin * max_component(reached.extent()), padding));
    leaf.reach = max_component(all.extent());
    leaf.frame = frame_of(leaf.box, leaf.reach);
    leaf.grid = leaf.box;
    return leaf;
}

Leaf scene_leaf(const Box& bounds) {
    const double padding = padding_of(bounds);
    Leaf leaf;
    leaf.cell = bounds.padded(padding);
    leaf.box = bounds.padded(std::max(kMargin * max_component(bounds.extent()), padding));
    leaf.frame = frame_of(leaf.box, max_component(bounds.extent()));
    leaf.grid = leaf.box;
    return leaf;
}

void share_frame(Level1& level1) {
    const Leaf scene = scene_leaf(level1.bounds);
    for (Leaf& leaf : level1.leaves) {
        leaf.frame = scene.frame;
        leaf.grid = scene.grid;
    }
    level1.shares_frame = true;
}

void share_frame(std::span<Leaf> leaves) {
    Box box;
    double reach = 0;
    for (const Leaf& leaf : leaves) {
        box.add(leaf.box);
        reach = std::max(reach, leaf.reach);
    }
    box = box.padded(kMargin * max_component(box.extent()));
    for (Leaf& leaf : leaves) {
        leaf.frame = frame_of(box, reach);
        leaf.grid = box;
    }
}

std::vector<LeafRange> parts_of(const Level1& level1) {
    std::vector<LeafRange> parts;
    const auto same = [](const Leaf& a, const Leaf& b) {
        return a.frame == b.frame && a.grid.lo == b.grid.lo && a.grid.hi == b.grid.hi;
    };
    for (uint32_t i = 0; i < level1.leaves.size(); ++i)
        if (i > 0 && same(level1.leaves[i - 1], level1.leaves[i]))
            ++parts.back().count;
        else
            parts.push_back({i, 1});
    return parts;
}

double padding_of(const Box& scene) {
    const double farthest = max_component(glm::max(glm::abs(scene.lo), glm::abs(scene.hi)));
    return std::max(0x1p-48 * farthest, 0x1p-36 * max_component(scene.extent()));
}

KdTree cut_sample(const Soup& soup, std::span<const TriangleId> sample, uint32_t rate,
                  const Box& box, double padding, uint32_t max_leaf_triangles,
                  BuildProgress* progress) {
    KdBuildOptions options;
    // Twice, because a triangle that only touches the padded cell is in it.
    options.padding = 2 * padding;
    // The number of a leaf's triangles in the sample deviates by about its root; this leaves room.
    const double max_triangles = double(max_leaf_triangles);
    options.max_leaf_triangles =
        rate == 1 ? max_leaf_triangles : uint32_t(max_triangles - std::sqrt(max_triangles * rate));
    options.stands_for = rate;
    options.progress = progress;
    KdTree tree = build_kd_tree(soup, sample, box, options);
    if (tree.nodes.empty()) // no triangle of the sample is in the box
        tree.nodes.push_back(KdNode::leaf(0, 0));
    tree.references = {};
    return tree;
}

std::vector<Cell> cells_of(std::span<const KdNode> nodes, const Box& bounds, double padding) {
    assert(!nodes.empty());
    std::vector<Cell> cells;
    collect_cells(nodes, 0, bounds, padding, cells);
    return cells;
}

uint64_t Level1::reference_count() const {
    uint64_t count = 0;
    for (const Leaf& leaf : leaves)
        count += leaf.list().size() + leaf.stored;
    return count;
}

void Level1::own_lists() {
    for (Leaf& leaf : leaves)
        if (!leaf.borrowed.empty()) {
            leaf.triangles.assign(leaf.borrowed.begin(), leaf.borrowed.end());
            leaf.borrowed = {};
        }
}

Leaf whole_leaf(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds) {
    const double padding = padding_of(bounds);
    return make_leaf(soup, bounds.padded(padding), padding, {triangles.begin(), triangles.end()});
}

Level1 partition(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                 uint32_t max_leaf_triangles, BuildProgress* progress, const Sample& drawn,
                 const FarLeaves& far) {
    assert(max_leaf_triangles > 0 && (far.allowed || far.triangles.empty()));
    if (triangles.empty())
        return Level1{.bounds = bounds};
    Partitioner partitioner(soup, bounds, progress);
    std::vector<TriangleId> near;
    if (!far.triangles.empty()) {
        std::ranges::set_difference(triangles, far.triangles, std::back_inserter(near));
        triangles = near;
        partitioner.add_far_leaf({far.triangles.begin(), far.triangles.end()});
    }
    if (triangles.size() <= max_leaf_triangles) // a sample might suggest that they are more
        partitioner.add_leaves(bounds.padded(padding_of(bounds)),
                               {{triangles.begin(), triangles.end()}});
    else
        partitioner.cut(triangles, bounds, max_leaf_triangles,
                        far.triangles.empty() ? drawn : Sample{},
                        far.allowed && far.triangles.empty());
    return partitioner.finish();
}

Level1 partition_by_count(const Soup& soup, std::vector<TriangleId> triangles, const Box& bounds,
                          uint32_t max_leaf_triangles, BuildProgress* progress) {
    if (triangles.empty())
        return Level1{.bounds = bounds};
    std::vector<std::vector<TriangleId>> lists;
    halve(soup, triangles, max_leaf_triangles, lists);
    Partitioner partitioner(soup, bounds, progress);
    partitioner.add_leaves(bounds.padded(padding_of(bounds)), std::move(lists));
    return partitioner.finish();
}

Level1 fill_cells(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                  std::span<const KdNode> nodes, uint32_t max_leaf_triangles) {
    if (nodes.empty())
        return Level1{.bounds = bounds};
    Partitioner partitioner(soup, bounds, nullptr);
    partitioner.fill(nodes, bounds, triangles,
                     [&](const Cell& cell, std::span<const TriangleId> inside) {
                         partitioner.add_leaves(cell.padded, in_parts(inside, max_leaf_triangles));
                     });
    return partitioner.finish();
}

Level1 cut_cell(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                const Box& box, uint32_t max_leaf_triangles, CellCut how) {
    Partitioner partitioner(soup, bounds, nullptr);
    const Box padded = box.padded(padding_of(bounds));
    if (how == CellCut::ByCount) {
        std::vector<TriangleId> all(triangles.begin(), triangles.end());
        std::vector<std::vector<TriangleId>> lists;
        halve(soup, all, max_leaf_triangles, lists);
        partitioner.add_leaves(padded, std::move(lists));
    } else if (how == CellCut::ByAll && triangles.size() > max_leaf_triangles) {
        partitioner.cut_by_all(triangles, box, max_leaf_triangles);
    } else {
        partitioner.add_leaves(padded, in_parts(triangles, max_leaf_triangles));
    }
    return partitioner.finish();
}

uint32_t leaf_at(const Level1& level1, const dvec3& point, TriangleId id) {
    assert(!level1.nodes.empty());
    uint32_t node = 0;
    while (!level1.nodes[node].is_leaf()) {
        const KdNode& n = level1.nodes[node];
        node = point[n.axis()] <= n.split() ? node + 1 : n.above();
    }
    for (uint32_t leaf = 0; leaf < level1.far_leaves; ++leaf)
        if (std::ranges::binary_search(level1.leaves[leaf].list(), id))
            return leaf;
    const KdNode& cell = level1.nodes[node];
    for (uint32_t leaf = cell.first(); leaf < cell.first() + cell.count(); ++leaf)
        if (std::ranges::binary_search(level1.leaves[leaf].list(), id))
            return leaf;
    return cell.count() > 0 ? cell.first() : kNone;
}

Level1 cut_again(const Soup& soup, Level1 level1, std::span<const uint32_t> max_triangles,
                 std::vector<uint32_t>& was, BuildProgress* progress) {
    assert(max_triangles.size() == level1.leaves.size());
    was.clear();
    std::vector<uint32_t> of; // per new leaf: the old one whose frame it keeps; kNone: its own
    Partitioner partitioner(soup, level1.bounds, progress);
    for (uint32_t i = 0; i < level1.far_leaves; ++i) {
        std::vector<std::vector<TriangleId>> lists;
        halve(soup, level1.leaves[i].triangles, max_triangles[i], lists);
        for (std::vector<TriangleId>& list : lists)
            partitioner.add_far_leaf(std::move(list));
        was.resize(partitioner.leaves(), lists.size() == 1 ? i : kNone);
        of.resize(partitioner.leaves(), i);
    }
    partitioner.copy(level1.nodes, level1.bounds, [&](const Cell& cell, const KdNode& node) {
        const uint32_t first = node.first();
        bool share_frame = true;
        uint32_t limit = kNone; // an empty cell stays as it is
        std::vector<std::vector<TriangleId>> lists;
        for (uint32_t i = first; i < first + node.count(); ++i) {
            limit = std::min(limit, max_triangles[i]);
            lists.push_back(std::move(level1.leaves[i].triangles));
            share_frame = share_frame && level1.leaves[i].frame == level1.leaves[first].frame;
        }
        if (limit == kNone) {
            for (uint32_t i = first; i < first + node.count(); ++i) {
                was.push_back(i);
                of.push_back(i);
            }
            partitioner.add_leaves(cell.padded, std::move(lists));
            return;
        }
        std::vector<TriangleId> all;
        for (const auto& list : lists)
            all.insert(all.end(), list.begin(), list.end());
        if (node.count() == 1)
            partitioner.cut(all, cell.box, limit);
        else
            partitioner.add_leaves(cell.padded, in_parts(all, limit));
        was.resize(partitioner.leaves(), kNone);
        of.resize(partitioner.leaves(), share_frame ? first : kNone);
    });
    Level1 cut = partitioner.finish();
    assert(was.size() == cut.leaves.size() && of.size() == cut.leaves.size());
    cut.shares_frame = level1.shares_frame;
    for (size_t i = 0; i < cut.leaves.size(); ++i) {
        if (of[i] == kNone)
            continue;
        cut.leaves[i].frame = level1.leaves[of[i]].frame;
        cut.leaves[i].grid = level1.leaves[of[i]].grid;
    }
    return cut;
}

} // namespace ovc
