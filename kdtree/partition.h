// SPDX-License-Identifier: Apache-2.0
// Level 1: the soup cut into leaves by triangle count, each with a padded box and a frame of its
// own. Based on: thesis, section 3.3 (algorithm 2).
#pragma once

#include "core/build_progress.h"
#include "core/soup.h"
#include "kdtree/sample.h"
#include "kdtree/tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Maps a leaf's surroundings to [-1, 1]: local = (world - origin) * scale. The scale is a power of
/// two, so only the final rounding to float loses anything.
struct Frame {
    dvec3 origin{0};
    double scale = 1;

    dvec3 to_local(const dvec3& world) const { return (world - origin) * scale; }
    bool operator==(const Frame&) const = default;
};

/// A level-1 leaf. It lists every triangle that touches `cell`. `box` holds the part of the cell
/// that they reach, with a margin around it: rays are traced within the box, so that hits in the
/// cell are clear of the ends of the ray's stretch. A hit counts only where the ray is in the cell,
/// because nearer triangles may be in the next leaf beyond it. The 16-bit boxes of the leaf's page
/// count over `grid`: the box, or that of the scene where leaves share a frame.
struct Leaf {
    Box cell;
    Box box;
    Frame frame;
    Box grid;
    std::vector<TriangleId> triangles; // sorted; empty where they are borrowed
    double reach = 0;                  // the largest extent of all of them, in the cell or not
    /// Those of a leaf that was restored, which the owner keeps alive and unchanged.
    std::span<const TriangleId> borrowed{};
    uint64_t stored = 0; // the number of those of a leaf whose list stays on a disk

    std::span<const TriangleId> list() const { return borrowed.empty() ? triangles : borrowed; }
};

/// The leaf nodes of `nodes` name ranges of `leaves`: no leaf where a cell is empty, several where
/// a cell cannot be cut further.
struct Level1 {
    std::vector<KdNode> nodes;
    std::vector<Leaf> leaves;
    /// How many of the first `leaves` are in no cell. Triangles that reach through many cells, as
    /// of a floor, are in these leaves and in no others.
    uint32_t far_leaves = 0;
    Box bounds;
    double padding = 0;        // of every cell, because rounding may move triangles across planes
    bool shares_frame = false; // all leaves have the frame and the grid of scene_leaf()

    uint64_t reference_count() const;
    /// Copies the lists of all leaves that borrow them, so that they may change.
    void own_lists();
};

/// Returns the leaf of `cell`, which is padded already, with `triangles`, which are sorted and all
/// that touch it. padding: also a bound of how far rounding in double may move a ray, which must
/// not miss the box for that, however small the leaf is.
Leaf make_leaf(const Soup& soup, const Box& cell, double padding,
               std::vector<TriangleId> triangles);

/// Returns the same leaf without its triangles, of which `all` is the box.
Leaf leaf_around(const Box& cell, double padding, const Box& all);

/// Returns a scene in `bounds` as one leaf, without its triangles.
Leaf scene_leaf(const Box& bounds);

/// Gives all leaves the frame and the grid of scene_leaf().
void share_frame(Level1& level1);

/// Gives these leaves one frame and one grid around them all.
void share_frame(std::span<Leaf> leaves);

/// Some neighbours among the leaves.
struct LeafRange {
    uint32_t first;
    uint32_t count;
};

/// Returns the parts of the scene in order: neighbours that share a frame and a grid are a part.
std::vector<LeafRange> parts_of(const Level1& level1);

/// Returns all of `triangles`, which are sorted and lie in `bounds`, as one leaf.
Leaf whole_leaf(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds);

/// Returns the padding of level 1's cells: a few roundings of the coordinates, and enough for rays
/// from a thousand scene sizes away to be walked in double (can_walk).
double padding_of(const Box& scene);

/// Returns level 1's planes, without references: the KD-tree over a sample of the triangles in
/// `box`, each of which stands for `rate` (sample.h). As far as the sample tells, its cells hold at
/// most max_leaf_triangles. It has at least a root. padding: of the cells.
KdTree cut_sample(const Soup& soup, std::span<const TriangleId> sample, uint32_t rate,
                  const Box& box, double padding, uint32_t max_leaf_triangles,
                  BuildProgress* progress = nullptr);

/// A triangle that touches this many cells reaches far. In each of them it would make the leaf's
/// box larger, and a ray that hits it would look for it in one page after the other.
inline constexpr uint32_t kFarCells = 6;

/// Returns whether `far` far-reaching triangles of `all` get a leaf of their own, of at most
/// max_leaf_triangles. Where they are many, each cell does better with its part of them.
inline bool far_leaf_pays(uint64_t far, uint64_t all, uint64_t max_leaf_triangles) {
    return far > 0 && far <= max_leaf_triangles && far <= all / 64;
}

/// Leaves that may lie in no cell.
struct FarLeaves {
    bool allowed = false; // rays come to such leaves
    /// The triangles that are to be in one, sorted (far_search.h). Where there are none,
    /// far_leaf_pays() decides on those that touch many cells.
    std::span<const TriangleId> triangles{};
};

/// Returns `triangles` of the soup, which are sorted and lie in `bounds`, cut into leaves of at
/// most max_leaf_triangles (> 0). A triangle is about two units of progress. drawn: a sample of
/// `triangles`, which is not drawn again where it has the right rate.
Level1 partition(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                 uint32_t max_leaf_triangles, BuildProgress* progress = nullptr,
                 const Sample& drawn = {}, const FarLeaves& far = {});

/// Returns `triangles`, as above, cut into as few leaves of at most max_leaf_triangles (> 0) as
/// possible, each triangle in one of them: by medians of their centres, all in one cell.
Level1 partition_by_count(const Soup& soup, std::vector<TriangleId> triangles, const Box& bounds,
                          uint32_t max_leaf_triangles, BuildProgress* progress = nullptr);

/// Returns level 1 in the cells of a tree over `bounds`, whatever its leaf nodes name: each cell
/// lists the triangles that touch it, in leaves of at most max_leaf_triangles (> 0).
Level1 fill_cells(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                  std::span<const KdNode> nodes, uint32_t max_leaf_triangles);

/// How a cell is cut that holds more triangles than a leaf may have.
enum class CellCut {
    ByAll,   // by planes, as partition() does
    ByCount, // into leaves in one cell, by medians of centres, as partition_by_count() does
    InOrder, // likewise, in the order of triangles
};

/// Returns the tree over one cell, `box`, of the level 1 of a scene in `bounds`, with the leaves of
/// `triangles`, which are sorted and touch the cell.
Level1 cut_cell(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                const Box& box, uint32_t max_leaf_triangles, CellCut how);

/// Returns the leaf around a point of the triangle, preferring one that lists it, because leaves at
/// a cell's border differ by rounding. kNone: the point lies in an empty cell. Level 1 must have
/// nodes.
uint32_t leaf_at(const Level1& level1, const dvec3& point, TriangleId id);

/// Returns the same level 1 with some leaves cut into smaller ones. max_triangles: per leaf the max
/// number of triangles in each of its parts, or kNone, which leaves it as it is. was: receives for
/// each new leaf the number of the old leaf that it was, or kNone for parts.
Level1 cut_again(const Soup& soup, Level1 level1, std::span<const uint32_t> max_triangles,
                 std::vector<uint32_t>& was, BuildProgress* progress = nullptr);

} // namespace ovc
