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

/// A level-1 leaf. Every triangle that touches `cell` is listed. `box` holds the part of the cell
/// that they reach, and a margin around it: within it rays are traced, so that what is hit in the
/// cell is clear of the ends of the ray's stretch. A hit counts only where the ray is in the cell;
/// beyond, nearer triangles may be in the next leaf. `grid` is what the 16-bit boxes of its page
/// count over: the box, or that of the scene where leaves share a frame.
struct Leaf {
    Box cell;
    Box box;
    Frame frame;
    Box grid;
    std::vector<TriangleId> triangles; // sorted
    double reach = 0;                  // the extent of all of them, in the cell or not
};

/// nodes' leaves name ranges of `leaves`: no leaf where a cell is empty, several where a cell
/// cannot be cut further.
struct Level1 {
    std::vector<KdNode> nodes;
    std::vector<Leaf> leaves;
    /// The first of `leaves`, in no cell: triangles that reach through many cells, a floor say, and
    /// are in none of them.
    uint32_t far_leaves = 0;
    Box bounds;
    double padding =
        0; // of every cell, so that what rounding moves across a plane is on both sides
    bool shares_frame = false; // all leaves have the frame and the grid of scene_leaf()

    uint64_t reference_count() const;
};

/// Of `triangles`, sorted, all that touch `cell`, which is padded already. padding: also what
/// double rounding may move a ray by; the box must not be missed for it, however small the leaf is.
Leaf make_leaf(const Soup& soup, const Box& cell, double padding,
               std::vector<TriangleId> triangles);

/// A scene in `bounds` as one leaf, without its triangles.
Leaf scene_leaf(const Box& bounds);

/// Gives all leaves the frame and the grid of scene_leaf().
void share_frame(Level1& level1);

/// The same for some of them: a frame and a grid around these.
void share_frame(std::span<Leaf> leaves);

/// Some of the leaves, one behind the other.
struct LeafRange {
    uint32_t first;
    uint32_t count;
};

/// The leaves by frames: neighbours that share a frame and a grid are a part of the scene.
std::vector<LeafRange> parts_of(const Level1& level1);

/// All of `triangles`, which lie in `bounds`, as one leaf.
Leaf whole_leaf(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds);

/// What level 1 pads its cells by: a few roundings of the coordinates, and enough for rays from a
/// thousand scene sizes away to be walked in double (can_walk).
double padding_of(const Box& scene);

/// Level 1's planes, without references: the KD-tree over a sample of the triangles in `box`, each
/// of which stands for `rate` (sample.h), into cells of at most max_leaf_triangles, as far as the
/// sample tells. At least a root.
KdTree cut_sample(const Soup& soup, std::span<const TriangleId> sample, uint32_t rate,
                  const Box& box, uint32_t max_leaf_triangles, BuildProgress* progress = nullptr);

/// A triangle that touches so many cells reaches far. In each of them it would make the leaf's box
/// larger, and a ray that hits it would look for it in one page after the other.
inline constexpr uint32_t kFarCells = 6;

/// Whether so many far-reaching triangles of all get a leaf of their own, of at most
/// max_leaf_triangles. Where they are many, each cell does better with its part of them.
inline bool far_leaf_pays(uint64_t far, uint64_t all, uint64_t max_leaf_triangles) {
    return far > 0 && far <= max_leaf_triangles && far <= all / 64;
}

/// Cuts `triangles` of the soup, which lie in `bounds`, into leaves of at most max_leaf_triangles
/// (> 0). A triangle is about two units of progress. drawn: a sample of `triangles`, which is not
/// drawn again where it is the one to cut by. may_have_far_leaves: whether rays come to leaves that
/// lie in no cell.
Level1 partition(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                 uint32_t max_leaf_triangles, BuildProgress* progress = nullptr,
                 const Sample& drawn = {}, bool may_have_far_leaves = false);

/// Cuts `triangles`, as above, into as few leaves of at most max_leaf_triangles (> 0) as there can
/// be, no triangle in two: by medians of their centres, all in one cell.
Level1 partition_by_count(const Soup& soup, std::vector<TriangleId> triangles, const Box& bounds,
                          uint32_t max_leaf_triangles, BuildProgress* progress = nullptr);

/// Level 1 in the cells of a tree over `bounds`, whatever its leaf nodes name: each lists the
/// triangles that touch it, in leaves of at most max_leaf_triangles (> 0).
Level1 fill_cells(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                  std::span<const KdNode> nodes, uint32_t max_leaf_triangles);

/// The leaf around a point of the triangle, one that lists it where there is one: those at a cell's
/// border differ by rounding. kNone: the point lies in an empty cell.
uint32_t leaf_at(const Level1& level1, const dvec3& point, TriangleId id);

/// The same level 1 with some leaves cut into smaller ones. most: per leaf the most triangles that
/// its parts may hold, or kNone: it stays. was: receives for each leaf now which it was, or kNone
/// for parts.
Level1 cut_again(const Soup& soup, Level1 level1, std::span<const uint32_t> most,
                 std::vector<uint32_t>& was, BuildProgress* progress = nullptr);

} // namespace ovc
